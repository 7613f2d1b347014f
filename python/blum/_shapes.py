"""Shapes and images that Blum generates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, cast

from . import _core
from ._arguments import number
from ._errors import InvalidOption
from ._image import Image, image_of_parts
from ._mesh import Betti, Mesh, mesh_of_arrays


@dataclass(frozen=True)
class ShapeParameter:
    """A number that a shape can be asked for with."""

    name: str
    description: str
    default: float
    minimum: float  #: inclusive
    maximum: float  #: inclusive
    integer: bool


@dataclass(frozen=True)
class ShapeInfo:
    """A shape that :func:`generate` makes."""

    name: str
    description: str
    kind: Literal["mesh", "image"]
    parameters: tuple[ShapeParameter, ...]


def shapes() -> dict[str, ShapeInfo]:
    """All shapes by name, with their parameters.

    >>> import blum
    >>> [parameter.name for parameter in blum.shapes()["torus"].parameters]
    ['ring_radius', 'tube_radius', 'ring_segments', 'tube_segments']
    """
    return {
        entry["name"]: ShapeInfo(
            entry["name"],
            entry["description"],
            entry["kind"],
            tuple(ShapeParameter(*parameter) for parameter in entry["parameters"]),
        )
        for entry in _core.catalogue()
    }


def _arguments(name: str, parameters: dict[str, Any]) -> tuple[ShapeInfo, dict[str, float]]:
    known = shapes()
    if name not in known:
        raise InvalidOption(f"there is no shape {name!r}; there are {', '.join(sorted(known))}")
    return known[name], {key: number(value, key) for key, value in parameters.items()}


def generate(name: str, **parameters: float) -> Mesh | Image:
    """Makes the shape of a name: a :class:`Mesh`, or an :class:`Image` for those whose name ends in ``_image``.

    Parameters are those that ``blum make NAME --help`` lists, and :func:`shapes`.

    >>> import blum
    >>> blum.generate("sphere", frequency=4)
    Mesh(162 vertices, 320 triangles)
    >>> blum.generate("ball_image", size=16)
    Image(uint8 (16, 16, 16), spacing=(1.0, 1.0, 1.0))
    """
    shape, given = _arguments(name, parameters)
    if shape.kind == "image":
        return image_of_parts(*_core.make_image(name, given))
    return mesh_of_arrays(_core.make_shape(name, given))


def known_betti(name: str, **parameters: float) -> Betti | None:
    """Components, tunnels and voids of a shape, from its construction; None where it bounds no solid.

    >>> import blum
    >>> blum.known_betti("plate", holes_x=2, holes_y=2)
    (1, 4, 0)
    """
    shape, given = _arguments(name, parameters)
    return cast("Betti | None", _core.known_betti(name, shape.kind, given))
