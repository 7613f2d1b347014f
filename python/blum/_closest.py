"""Closest points and winding numbers of any points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, Integer, Real, float_rows, integer, number, points_and_shape
from ._errors import InvalidOption
from ._mesh import MeshLike, MeshOrVertices, as_mesh
from ._options import takes
from ._progress import Progress, reporting
from ._structs import ClosestPointOptions


@dataclass(frozen=True, eq=False)
class ClosestPoints:
    """What :func:`closest_points` finds; all arrays have the shape of the queries without the last axis."""

    closest: FloatArray  #: (..., 3): on the mesh; the query itself where nothing is within max_distance
    distance: FloatArray  #: mesh units, negative inside when signed; infinite where nothing is within max_distance
    site: IntArray  #: of the mesh, see :class:`Sites`; -1 where there is none
    triangle: IntArray  #: the smallest triangle that the site lies on; -1 where there is none


@dataclass(frozen=True, eq=False)
class NearPrimitives:
    """What :meth:`ClosestPointQuery.within` and :meth:`ClosestPointQuery.nearest_primitives` find.

    Entries ``first[q]`` to ``first[q + 1]`` (without) belong to query q, by rising distance, then primitive. Queries
    count in one row, whatever their shape.
    """

    first: npt.NDArray[np.int64]  #: (queries + 1,)
    primitive: IntArray  #: (n,): the triangles of the mesh, then its segments, then its points, counted in one row
    site: IntArray  #: (n,): that the closest point of the primitive lies on, see :class:`Sites`
    distance: FloatArray  #: (n,): mesh units, without sign
    closest: FloatArray  #: (n, 3): the closest point of the primitive

    def __repr__(self) -> str:
        return f"NearPrimitives({len(self.primitive):,} of {len(self.first) - 1:,} queries)"


@takes("ClosestPointOptions")
class ClosestPointQuery:
    """Closest-point queries on one mesh, exact; may be called from many threads at once.

    Parameters
    ----------
    mesh, triangles, weld
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> query = blum.ClosestPointQuery(blum.generate("box"))
    >>> query([[0, 0, 5]]).closest.tolist()
    [[0.0, 0.0, 0.5]]
    """

    def __init__(
        self,
        mesh: MeshOrVertices,
        triangles: npt.ArrayLike | None = None,
        *,
        weld: Real | None = None,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[ClosestPointOptions],
    ) -> None:
        self._mesh = as_mesh(mesh, triangles, weld=weld)
        with reporting(progress) as report:
            self._query = _core.ClosestPointQuery(
                self._mesh._arrays,
                dict(options),
                integer(threads, "threads"),
                report,
            )

    def __repr__(self) -> str:
        return f"ClosestPointQuery({self._mesh!r}, sign_rule={self.sign_rule!r})"

    @property
    def sign_rule(self) -> str:
        """How signs are found: "normals", "winding" or "none"."""
        return str(self._query.sign_rule)

    @property
    def sign_reason(self) -> str:
        """Why, in one sentence."""
        return str(self._query.sign_reason)

    def __call__(self, points: Any, *, threads: int = 0, progress: Progress = False) -> ClosestPoints:
        """Queries of the shape (..., 3)."""
        rows, shape = points_and_shape(points, "points")
        with reporting(progress) as report:
            found, distance, site, triangle = self._query.nearest(rows, integer(threads, "threads"), report)
        return ClosestPoints(
            found.reshape((*shape, 3)), distance.reshape(shape), site.reshape(shape), triangle.reshape(shape)
        )

    def within(self, points: Any, distance: Real, *, threads: int = 0, progress: Progress = False) -> NearPrimitives:
        """All triangles, segments and points of the mesh within a distance of points of the shape (..., 3).

        >>> import blum
        >>> query = blum.ClosestPointQuery(blum.generate("box"))
        >>> found = query.within([[0, 0, 1], [0, 0, 5]], 0.7)
        >>> found.first.tolist(), found.distance.tolist()
        ([0, 2, 2], [0.5, 0.5])
        """
        rows, _ = points_and_shape(points, "points")
        limit = number(distance, "distance")
        with reporting(progress) as report:
            return NearPrimitives(*self._query.within(rows, limit, integer(threads, "threads"), report))

    def nearest_primitives(
        self, points: Any, k: Integer, *, threads: int = 0, progress: Progress = False
    ) -> NearPrimitives:
        """The k closest of them; fewer where there are fewer, or fewer within `max_distance`.

        >>> import blum
        >>> query = blum.ClosestPointQuery(blum.generate("box"))
        >>> query.nearest_primitives([[0, 0, 1]], 3).distance.round(3).tolist()
        [0.5, 0.5, 0.707]
        """
        rows, _ = points_and_shape(points, "points")
        count = integer(k, "k", 64)
        if count < 0:
            raise InvalidOption(f"k is {count}, but must be 0 or more")
        with reporting(progress) as report:
            return NearPrimitives(*self._query.nearest_primitives(rows, count, integer(threads, "threads"), report))

    def refit(self, vertices: Any, *, threads: int = 0, progress: Progress = False) -> None:
        """Moves the vertices of the mesh: answers are those of a new query, which takes longer to make.

        Must not run beside calls. Unsigned it takes some 2 ms for 100,000 triangles on two cores; signs are planned
        anew, as in a new query.

        Parameters
        ----------
        vertices : array (n, 3)
            As many as the mesh has (after welding).

        >>> import blum
        >>> box = blum.generate("box")
        >>> query = blum.ClosestPointQuery(box)
        >>> query.refit(box.vertices * 2)
        >>> query([[0, 0, 5]]).distance.tolist()
        [4.0]
        """
        rows = float_rows(vertices, "vertices")
        with reporting(progress) as report:
            self._query.refit(rows, integer(threads, "threads"), report)


@takes("ClosestPointOptions")
def closest_points(
    mesh: MeshLike,
    points: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ClosestPointOptions],
) -> ClosestPoints:
    """The closest point of a mesh, its distance, site and triangle for every query; exact, not interpolated.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of the shape (..., 3)
    **options

    >>> import blum
    >>> found = blum.closest_points(blum.generate("sphere"), [[0, 0, 3], [0, 0, 0.2]])
    >>> [round(distance, 2) for distance in found.distance.tolist()]
    [2.0, -0.8]
    """
    query = ClosestPointQuery(mesh, weld=weld, threads=threads, progress=progress, **options)
    return query(points, threads=threads, progress=progress)


def winding_number(
    mesh: MeshLike,
    points: Any,
    *,
    max_error: Real = 1e-6,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> FloatArray:
    """The generalized winding number of a mesh at any points, which share what they can; whole for closed meshes.

    For values one by one, and for sides, see :class:`WindingNumber`.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of the shape (..., 3)
    max_error : float
        Values are off by no more. It matters where the surface has a long boundary: soups of 70,000 triangles take
        some 30 microseconds a point at 1e-3, 250 at 1e-6; closed meshes and those with some holes 0.2 to 2.

    >>> import blum
    >>> blum.winding_number(blum.generate("box"), [[0, 0, 0], [5, 5, 5]]).tolist()
    [1.0, 0.0]
    """
    rows, shape = points_and_shape(points, "points")
    of = as_mesh(mesh, weld=weld)
    most = number(max_error, "max_error")
    with reporting(progress) as report:
        values: FloatArray = _core.winding_numbers(of._arrays, rows, most, integer(threads, "threads"), report)
    return values.reshape(shape)
