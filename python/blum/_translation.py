"""The least translation that separates two solids."""

from __future__ import annotations

from typing import Unpack

from ._mesh import MeshLike
from ._options import takes
from ._progress import Progress
from ._proximity_scene import scene_of_named
from ._structs import LeastTranslation, TranslationOptions

__all__ = ["least_translation"]


@takes("TranslationOptions")
def least_translation(
    a: MeshLike, b: MeshLike, *, threads: int = 0, progress: Progress = False, **options: Unpack[TranslationOptions]
) -> LeastTranslation:
    """Returns bounds on the shortest translation of solid ``a`` that separates it from solid ``b``.

    This length is also called penetration depth, for example by EPA. Both bounds are equal, except for rounding, if
    both solids are convex. Both bounds are 0 if the solids are apart or touch.

    Parameters
    ----------
    a, b : meshes
        Closed meshes that face outwards.
    threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.least_translation(box, (box.vertices + [0.75, 0, 0], box.triangles))
    >>> round(found.lower, 6), round(found.upper, 6), round(found.translation[0], 6)
    (0.25, 0.25, -0.25)
    """
    scene = scene_of_named((("a", a), ("b", b)), threads)
    return scene.least_translation(0, 1, threads=threads, progress=progress, **options)
