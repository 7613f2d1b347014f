"""Copies of proximity scenes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._arguments import FloatArray
from ._mesh import Mesh

if TYPE_CHECKING:
    from ._proximity_scene import ProximityScene


@dataclass(frozen=True)
class SceneObject:
    """Facts about an object of a scene, in addition to its mesh."""

    layers: int
    meets: int
    compare_self: bool
    name: str
    place: FloatArray


def restored_scene(
    kind: type[ProximityScene],
    options: Any,
    objects: list[tuple[Mesh, SceneObject] | None],
    excluded: list[tuple[int, int]],
) -> ProximityScene:
    """Returns a copy of a scene. Its objects have the same numbers."""
    scene = kind(**options)
    for each in objects:
        if each is None:
            scene.remove(scene.add(Mesh([[0.0, 0.0, 0.0]])))
        else:
            mesh, own = each
            scene.add(
                mesh,
                layers=own.layers,
                meets=own.meets,
                compare_self=own.compare_self,
                name=own.name,
                transform=own.place,
            )
    for a, b in excluded:
        scene.exclude(a, b)
    return scene
