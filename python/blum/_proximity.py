"""Collisions of meshes that move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np

from . import _core
from ._arguments import FloatArray, IntArray, as_array, integer
from ._errors import InvalidMesh
from ._mesh import MeshLike, MeshOrVertices, as_mesh, end_vertices
from ._options import takes
from ._progress import Progress, reporting
from ._proximity_results import earliest_of
from ._structs import ImpactOptions


@dataclass(frozen=True, eq=False)
class ContinuousCollisions:
    """What of a mesh meets something else of it between two frames."""

    vertex_face: IntArray  #: (n, 4): a vertex, then the corners of the triangle that it meets; rising
    face: IntArray  #: (n,): the triangle
    vertex_face_time: FloatArray  #: (n,): when they meet first, 0 to 1
    edge_edge: IntArray  #: (m, 4): the ends of one edge, then those of the other; rising
    edge_edge_time: FloatArray  #: (m,)
    box_pairs: int  #: pairs of features whose moving boxes touch
    exact_tests: int  #: pairs that were tested

    @property
    def earliest(self) -> float | None:
        """The first time at which anything meets; None where nothing does."""
        return earliest_of(self.vertex_face_time, self.edge_edge_time)

    def __repr__(self) -> str:
        return f"ContinuousCollisions({len(self.vertex_face):,} vertex_face, {len(self.edge_edge):,} edge_edge)"


@takes("ImpactOptions")
def continuous_collisions(
    mesh: MeshLike,
    end: MeshOrVertices,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ImpactOptions],
) -> ContinuousCollisions:
    """All pairs of a vertex and a triangle, and of two edges, of a mesh that meet while its vertices move along
    straight lines; exact for the coordinates as they are.

    Pairs that share a vertex are left out; vertices in one place at both ends are one vertex.

    Parameters
    ----------
    mesh : anything that stands for a mesh
        At time 0.
    end : (n, 3) array, or anything that stands for a mesh
        Its vertices at time 1, or the mesh then, with the same triangles. Arrays of doubles are used as they are,
        without a copy.
    **options

    Returns
    -------
    ContinuousCollisions

    >>> import blum
    >>> floor, falling = [[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 1], [2, 1, 2], [1, 2, 2]]
    >>> down = [[x, y, z - 4] for x, y, z in falling]
    >>> found = blum.continuous_collisions((floor + falling, [[0, 1, 2], [3, 4, 5]]), floor + down)
    >>> found.vertex_face[0].tolist(), round(found.earliest, 4)
    ([3, 0, 1, 2], 0.25)
    """
    start = as_mesh(mesh)
    last = end_vertices(end, "end", start.triangles)
    with reporting(progress) as report:
        found = _core.continuous_collisions(start._arrays, last, dict(options), integer(threads, "threads"), report)
    return ContinuousCollisions(*found)


@takes("ImpactOptions")
def vertex_face_impacts(
    start: Any, end: Any, *, threads: int = 0, progress: Progress = False, **options: Unpack[ImpactOptions]
) -> FloatArray:
    """When moving vertices meet moving triangles for the first time; exact for the coordinates as they are.

    Parameters
    ----------
    start, end : (n, 4, 3) arrays
        For each question the vertex, then the corners of the triangle, at time 0 and at time 1.
    **options

    Returns
    -------
    (n,) array
        Times from 0 to 1, never late; NaN where they do not meet.

    >>> import blum
    >>> triangle = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    >>> blum.vertex_face_impacts([[[1, 1, 1], *triangle]], [[[1, 1, -1], *triangle]]).round(4).tolist()
    [0.5]
    """
    return _impacts(_core.vertex_face_impacts, start, end, options, threads, progress)


@takes("ImpactOptions")
def edge_edge_impacts(
    start: Any, end: Any, *, threads: int = 0, progress: Progress = False, **options: Unpack[ImpactOptions]
) -> FloatArray:
    """When moving edges meet for the first time; as :func:`vertex_face_impacts`, of the ends of one edge, then those of
    the other.

    Parameters
    ----------
    start, end : (n, 4, 3) arrays
    **options
    """
    return _impacts(_core.edge_edge_impacts, start, end, options, threads, progress)


def _impacts(answer: Any, start: Any, end: Any, options: Any, threads: int, progress: Progress) -> FloatArray:
    first, last = _four_points(start, "start"), _four_points(end, "end")
    if len(first) != len(last):
        raise InvalidMesh(f"start has {len(first)} questions, and end {len(last)}; they must be as many")
    with reporting(progress) as report:
        times: FloatArray = answer(first, last, dict(options), integer(threads, "threads"), report)
    return times


def _four_points(value: Any, name: str) -> FloatArray:
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}")
    if array.ndim != 3 or array.shape[1:] != (4, 3):
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n, 4, 3)")
    return np.ascontiguousarray(array, dtype=np.float64)
