"""Motions that are proven free of contact."""

from __future__ import annotations

from typing import Any, Unpack

from . import _core
from ._arguments import FloatArray, integer, triple
from ._mesh import MeshLike, as_mesh
from ._options import takes
from ._rigid import as_place
from ._structs import CertifiedMotion, MotionOptions

__all__ = ["MotionCertifier", "certify_motion"]


class MotionCertifier:
    """Certifies motions of a body among obstacles that rest.

    It keeps copies of the meshes. Only surfaces count: a body inside the solid of an obstacle does not meet it.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points.
    threads
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> certifier = blum.MotionCertifier(blum.generate("box"), blum.generate("sphere"))
    >>> turn = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    >>> start, goal = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [3, 0, 0]), (turn, [0, 3, 0])
    >>> certifier.certify(start, goal).verdict
    'free'
    >>> certifier.certify(start, goal, clearance=0.7).verdict
    'too_close'
    """

    def __init__(self, body: MeshLike, obstacles: MeshLike, *, threads: int = 0) -> None:
        first, second = as_mesh(body), as_mesh(obstacles)
        self._shown = f"MotionCertifier({first!r}, {second!r})"
        self._certifier = _core.MotionCertifier(first._arrays, second._arrays, integer(threads, "threads"))

    def __repr__(self) -> str:
        return self._shown

    @takes("MotionOptions")
    def certify(
        self, start: Any, goal: Any, *, centre: Any = None, **options: Unpack[MotionOptions]
    ) -> CertifiedMotion:
        """Returns a proof that a motion keeps its clearance, or the first place where it may not.

        The centre of the body moves along a straight line. The body turns about it, by at most 180 degrees, at a
        constant speed. The proof holds for all times between the poses, not only for samples.

        Parameters
        ----------
        start, goal
            Poses: (3, 4) or (4, 4) arrays, or pairs of a rotation (3, 3) and a translation (3,).
        centre : 3 numbers, optional
            Centre of the rotation, in the coordinates of the body. Default: the middle of its box.
        **options
        """
        x, y, z = self._certifier.centre() if centre is None else triple(centre, "centre")
        return self._certify(as_place(start), as_place(goal), (x, y, z), dict(options))

    def _certify(
        self, start: FloatArray, goal: FloatArray, centre: tuple[float, float, float], options: dict[str, Any]
    ) -> CertifiedMotion:
        """Certifies a motion between poses (3, 4). Planners call it for each edge, so it checks no types."""
        found: CertifiedMotion = self._certifier.certify(start, goal, *centre, options)
        return found


@takes("MotionOptions")
def certify_motion(
    body: MeshLike,
    obstacles: MeshLike,
    start: Any,
    goal: Any,
    *,
    centre: Any = None,
    threads: int = 0,
    **options: Unpack[MotionOptions],
) -> CertifiedMotion:
    """Returns a proof that a motion among obstacles keeps its clearance, or the first place where it may not.

    See :meth:`MotionCertifier.certify`. For many motions, :class:`MotionCertifier` is faster.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points. Only surfaces count.
    start, goal
        Poses: (3, 4) or (4, 4) arrays, or pairs of a rotation (3, 3) and a translation (3,).
    centre : 3 numbers, optional
        Centre of the rotation, in the coordinates of the body. Default: the middle of its box.
    threads
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> box, sphere = blum.generate("box"), blum.generate("sphere")
    >>> found = blum.certify_motion(box, sphere, (identity, [-5, 0, 0]), (identity, [5, 0, 0]))
    >>> found.verdict, round(10 * found.free_until - 5, 3)
    ('colliding', -1.5)
    """
    certifier = MotionCertifier(body, obstacles, threads=threads)
    return certifier.certify(start, goal, centre=centre, **options)
