"""Continuous collisions of meshes."""

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
from ._proximity_results import FirstContact, earliest_of, warn_of_start
from ._structs import ImpactOptions

__all__ = [
    "ContinuousCollisions",
    "continuous_collisions",
    "edge_edge_impacts",
    "first_contact",
    "vertex_face_impacts",
]


@dataclass(frozen=True, eq=False)
class ContinuousCollisions:
    """Pairs of features of a mesh that meet between two frames; the result of :func:`continuous_collisions`.

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.continuous_collisions(box, box.vertices + [1, 0, 0])
    >>> found, found.earliest
    (ContinuousCollisions(0 vertex_face, 0 edge_edge), None)
    """

    vertex_face: IntArray  #: A vertex, then the corners of the triangle that it meets: (n, 4), ascending.
    face: IntArray  #: Triangles that are met: (n,).
    vertex_face_time: FloatArray  #: Times of first contact, 0 to 1: (n,).
    edge_edge: IntArray  #: Ends of one edge, then those of the other: (m, 4), ascending.
    edge_edge_time: FloatArray  #: Times of first contact, 0 to 1: (m,).
    box_pairs: int  #: Number of pairs of features whose moving boxes touch.
    exact_tests: int  #: Number of pairs that were tested.

    @property
    def earliest(self) -> float | None:
        """Earliest time of all pairs, 0 to 1. None without pairs."""
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
    """Returns all pairs of a vertex and a triangle, and of two edges, of a mesh that meet while its vertices move.

    Vertices move along straight lines. The set of pairs is exact for the given coordinates. Pairs that share a vertex
    are left out. Vertices that coincide at both times count as one vertex. A warning reports pairs that meet at the
    start, because their times are 0.

    Parameters
    ----------
    mesh : mesh
        The mesh at time 0, as for :func:`distance_field`.
    end : (n, 3) array, or mesh
        The vertices at time 1, or the mesh at time 1 with the same triangles. C-contiguous float64 is not copied.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    ContinuousCollisions

    Examples
    --------
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
    out = ContinuousCollisions(*found)
    warn_of_start(out.vertex_face_time, out.edge_edge_time)
    return out


@takes("ImpactOptions")
def first_contact(
    mesh: MeshLike,
    end: MeshOrVertices,
    other: MeshLike | None = None,
    other_end: MeshOrVertices | None = None,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ImpactOptions],
) -> FirstContact | None:
    """Returns the first contact of two moving meshes, or of one mesh with itself. None if nothing meets.

    The first contact is the pair of features with the smallest time of contact. If many pairs meet, this search is much
    faster than :func:`continuous_collisions`. Vertices move along straight lines. :class:`ProximityScene` finds the
    first contact of several meshes.

    Parameters
    ----------
    mesh : mesh
        The mesh at time 0, as for :func:`distance_field`.
    end : (n, 3) array, or mesh
        The vertices at time 1, or the mesh at time 1 with the same triangles. C-contiguous float64 is not copied.
    other, other_end
        The other mesh at time 0 and at time 1. Without `other_end`, it rests. With `other`, contacts of a mesh with
        itself are ignored.
    threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> lid = box.vertices + [0.25, 0.25, 3], box.triangles
    >>> blum.first_contact(box, box.vertices + [0, 0, 4], lid).time
    0.5
    """
    if other is None and other_end is not None:
        raise TypeError("other_end is given, but other is not: give both meshes, or only mesh and end")
    start = as_mesh(mesh)
    last = end_vertices(end, "end", start.triangles)
    partner = None if other is None else as_mesh(other)
    partner_last = (
        None if partner is None or other_end is None else end_vertices(other_end, "other_end", partner.triangles)
    )
    arrays = None if partner is None else partner._arrays
    count = integer(threads, "threads")
    with reporting(progress) as report:
        found: Any = _core.first_contact(start._arrays, last, arrays, partner_last, dict(options), count, report)
    return FirstContact(*found) if found is not None else None


@takes("ImpactOptions")
def vertex_face_impacts(
    start: Any, end: Any, *, threads: int = 0, progress: Progress = False, **options: Unpack[ImpactOptions]
) -> FloatArray:
    """Returns the first time at which each moving vertex meets a moving triangle.

    The existence of a contact is exact for the given coordinates.

    Parameters
    ----------
    start, end : (n, 4, 3) arrays
        For each query the vertex, then the corners of the triangle, at time 0 and at time 1.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    (n,) array
        Times from 0 to 1, never after the first contact; NaN if vertex and triangle do not meet.

    Examples
    --------
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
    """Returns the first time at which two moving edges meet.

    The existence of a contact is exact for the given coordinates.

    Parameters
    ----------
    start, end : (n, 4, 3) arrays
        For each query the ends of one edge, then those of the other, at time 0 and at time 1.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    (n,) array
        As for :func:`vertex_face_impacts`.

    Examples
    --------
    >>> import blum
    >>> edge = [[-1, 0, 0], [1, 0, 0]]
    >>> start, end = [[*edge, [0, -1, 1], [0, 1, 1]]], [[*edge, [0, -1, -1], [0, 1, -1]]]
    >>> blum.edge_edge_impacts(start, end).round(4).tolist()
    [0.5]
    """
    return _impacts(_core.edge_edge_impacts, start, end, options, threads, progress)


def _impacts(answer: Any, start: Any, end: Any, options: Any, threads: int, progress: Progress) -> FloatArray:
    """Returns the times of impact of many queries."""
    first, last = _four_points(start, "start"), _four_points(end, "end")
    if len(first) != len(last):
        raise InvalidMesh(f"start has {len(first)} queries, but end has {len(last)}: give equal numbers")
    with reporting(progress) as report:
        times: FloatArray = answer(first, last, dict(options), integer(threads, "threads"), report)
    return times


def _four_points(value: Any, name: str) -> FloatArray:
    """Returns an (n, 4, 3) array of float64."""
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}")
    if array.ndim != 3 or array.shape[1:] != (4, 3):
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n, 4, 3)")
    return np.ascontiguousarray(array, dtype=np.float64)
