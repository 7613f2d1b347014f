"""Closest points and winding numbers."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, Integer, Real, float_rows, integer, number, points_and_shape
from ._errors import InvalidOption
from ._mesh import Mesh, MeshLike, MeshOrVertices, as_mesh, moved_mesh
from ._methods import Rebuilt, Shown
from ._options import takes
from ._progress import Progress, ProgressCallback, reporting
from ._structs import ClosestPointOptions, ResultWarning
from ._warn import warn_all

__all__ = ["ClosestPointQuery", "ClosestPoints", "NearPrimitives", "closest_points", "winding_number"]


@dataclass(frozen=True, eq=False, repr=False)
class ClosestPoints(Shown):
    """Result of :func:`closest_points`. All arrays have the shape of the queries without the last axis.

    Examples
    --------
    >>> import blum
    >>> found = blum.closest_points(blum.generate("box"), [0, 0, 2], max_distance=1)
    >>> float(found.distance), int(found.site), int(found.triangle)
    (inf, -1, -1)
    """

    closest: FloatArray  #: Closest point on the mesh: (..., 3). The query itself if nothing lies within max_distance.
    distance: FloatArray  #: Mesh units, negative inside when signed. Infinite if nothing lies within max_distance.
    site: IntArray  #: Site of the mesh, see :class:`Sites`. -1 if none.
    triangle: IntArray  #: Smallest index of a triangle that contains the site. -1 if none.
    #: Unit vector in which the distance grows: (..., 3). None unless the call asks for it, see
    #: :meth:`ClosestPointQuery.__call__`.
    gradient: FloatArray | None = None
    sign_rule: str = field(default="none", repr=False)  #: Rule for signs: "normals", "winding" or "none".
    sign_reason: str = field(default="", repr=False)  #: Reason for this rule, one sentence.
    warnings: list[ResultWarning] = field(default_factory=list, repr=False)  #: Warnings about the signs.


@dataclass(frozen=True, eq=False)
class NearPrimitives:
    """Result of :meth:`ClosestPointQuery.within` and :meth:`ClosestPointQuery.nearest_primitives`.

    Query q has the entries ``first[q]`` to ``first[q + 1] - 1``, by ascending distance, then primitive. Queries are
    numbered in C order, whatever their shape.

    Examples
    --------
    >>> import blum
    >>> query = blum.ClosestPointQuery(blum.generate("box"))
    >>> query.within([[0, 0, 1], [0, 0, 5]], 0.7)
    NearPrimitives(2 of 2 queries)
    """

    first: npt.NDArray[np.int64]  #: First entry of each query: (queries + 1,).
    #: Primitives: (n,). The triangles of the mesh are numbered first, then its segments, then its points.
    primitive: IntArray
    site: IntArray  #: Site that contains the closest point of the primitive: (n,), see :class:`Sites`.
    distance: FloatArray  #: Unsigned distance: (n,), mesh units.
    closest: FloatArray  #: Closest point of the primitive: (n, 3).

    def __repr__(self) -> str:
        return f"NearPrimitives({len(self.primitive):,} of {len(self.first) - 1:,} queries)"


@takes("ClosestPointOptions")
class ClosestPointQuery(Rebuilt):
    """Exact closest-point queries on one mesh. Queries may run on many threads at once, but not during :meth:`refit`.

    A pickle or copy holds the mesh and the options. The copy builds its search structure again at its first use, from
    the arrays of the mesh, which must not have changed in place.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> query = blum.ClosestPointQuery(blum.generate("box"))
    >>> query([[0, 0, 5]]).closest.tolist()
    [[0.0, 0.0, 0.5]]
    """

    _built = "_query"

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
        self._start(as_mesh(mesh, triangles, weld=weld), dict(options), threads, progress)

    def _start(self, mesh: Mesh, options: dict[str, Any], threads: int, progress: Progress, queries: int = 0) -> None:
        """Builds the query. If the number of queries is given, also builds the structure for that many queries."""
        self._mesh = mesh
        self._options = options
        with reporting(progress) as report:
            self._query = self._make(integer(threads, "threads"), report, queries)
        warn_all(self._query.warnings)

    def _make(self, threads: int, report: ProgressCallback | None, queries: int = 0) -> _core.ClosestPointQuery:
        return _core.ClosestPointQuery(self._mesh._arrays, self._options, threads, report, queries)

    @cached_property
    def _query(self) -> _core.ClosestPointQuery:
        return self._make(0, None)

    def __repr__(self) -> str:
        return f"ClosestPointQuery({self._mesh!r}, sign_rule={self.sign_rule!r})"

    @property
    def sign_rule(self) -> str:
        """Rule for signs: "normals", "winding" or "none"."""
        return str(self._query.sign_rule)

    @property
    def sign_reason(self) -> str:
        """Reason for this rule, one sentence."""
        return str(self._query.sign_reason)

    @property
    def warnings(self) -> list[ResultWarning]:
        """Warnings about the signs, also issued as :class:`InputWarning`."""
        return list(self._query.warnings)

    def __call__(
        self, points: Any, *, gradient: bool = False, threads: int = 0, progress: Progress = False
    ) -> ClosestPoints:
        """Returns the closest points of queries of shape (..., 3).

        Parameters
        ----------
        points : array of shape (..., 3)
        gradient : bool
            If true, the result has the gradient of the distance at each query. Outside, the gradient points away from
            the surface. Inside, it points towards the surface. On the surface, up to rounding, the gradient is the
            normal of the closest site: for an edge or vertex, the pseudonormal (:func:`pseudonormals`), with length 1.
            The gradient is NaN if nothing lies within max_distance, or if the query lies on a site without a normal. On
            the medial axis, where several points are closest, the gradient belongs to one of these points.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> query = blum.ClosestPointQuery(blum.generate("box"))
        >>> query([[0, 0, 5], [0, 0, 0.4]]).distance.round(6).tolist()
        [4.5, -0.1]
        >>> query([[0, 0, 5], [0.1, 0, 0.5]], gradient=True).gradient.tolist()
        [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
        """
        rows, shape = points_and_shape(points, "points")
        count = integer(threads, "threads")
        slopes = None
        with reporting(progress) as report:
            if gradient:
                columns, slopes = self._query.nearest_with_gradients(rows, count, report)
            else:
                columns = self._query.nearest(rows, count, report)
        found, distance, site, triangle = columns
        return ClosestPoints(
            found.reshape((*shape, 3)),
            distance.reshape(shape),
            site.reshape(shape),
            triangle.reshape(shape),
            None if slopes is None else slopes.reshape((*shape, 3)),
            self.sign_rule,
            self.sign_reason,
            self.warnings,
        )

    def within(self, points: Any, distance: Real, *, threads: int = 0, progress: Progress = False) -> NearPrimitives:
        """Returns all triangles, segments and points of the mesh within a distance of each query.

        Parameters
        ----------
        points : array of shape (..., 3)
        distance : float
            Mesh units, not negative. The `max_distance` of the query object is a further limit.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
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
        """Returns the k closest triangles, segments and points for each query.

        A query has fewer than k results if the mesh has fewer than k primitives within `max_distance`.

        Parameters
        ----------
        points : array of shape (..., 3)
        k : int
            Not negative.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
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
        """Moves the vertices of the mesh. Later results equal those of a new query object, which takes longer to make.

        The vertices are copied.

        This method must not run at the same time as queries. Without signs, a refit takes about 2 ms for 100,000
        triangles on two cores. The sign rule is chosen again, as in a new query object.

        Parameters
        ----------
        vertices : (n, 3) array
            New positions of all vertices that the mesh has after welding.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
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
        self._mesh = moved_mesh(self._mesh, rows)
        warn_all(self._query.warnings)


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
    """Returns the closest point of a mesh, its distance, site and triangle for every query. Exact, not interpolated.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of shape (..., 3)
    **options

    Examples
    --------
    >>> import blum
    >>> found = blum.closest_points(blum.generate("sphere"), [[0, 0, 3], [0, 0, 0.2]])
    >>> [round(distance, 2) for distance in found.distance.tolist()]
    [2.0, -0.8]
    """
    rows, shape = points_and_shape(points, "points")
    query = ClosestPointQuery.__new__(ClosestPointQuery)
    query._start(as_mesh(mesh, weld=weld), dict(options), threads, progress, len(rows))
    return query(rows.reshape((*shape, 3)), threads=threads, progress=progress)


def winding_number(
    mesh: MeshLike,
    points: Any,
    *,
    max_error: Real = 1e-6,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> FloatArray:
    """Returns the generalized winding number of a mesh at many points. For a closed mesh, this is a whole number.

    :class:`WindingNumber` returns values and sides one at a time.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of shape (..., 3)
    max_error : float
        Bound on the error of each value; bounds below 2e-11 are replaced by 2e-11. If the surface has a long boundary,
        a smaller bound takes more time. Soups of 70,000 triangles take about 30 microseconds per point with a bound of
        1e-3, and 250 microseconds with 1e-6. Closed meshes, and meshes with a few holes, take 0.2 to 2 microseconds per
        point.

    Examples
    --------
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
