"""Any points: signed distances, samples of surfaces and near them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Unpack

import numpy as np

from . import _core
from ._arguments import FloatArray, IntArray, Integer, Real, integer, points_and_shape
from ._closest import ClosestPointQuery
from ._errors import InvalidOption
from ._mesh import Mesh, MeshLike, as_mesh
from ._options import takes
from ._progress import Progress, reporting
from ._structs import ClosestPointOptions, NearSampleOptions, SampleOptions
from ._warn import warn_all


@dataclass(frozen=True, eq=False)
class SignedDistances:
    """What :func:`signed_distance` finds; all arrays have the shape of the queries without the last axis."""

    distance: FloatArray  #: mesh units, negative inside; infinite where nothing is within max_distance
    #: (..., 3): where the distance grows, of length 1: away from the surface outside, towards it inside. Not a number
    #: on the surface, where rounding would tell, and where nothing is within max_distance. On the medial axis one of
    #: several directions.
    gradient: FloatArray
    closest: FloatArray  #: (..., 3): the closest point of the mesh
    site: IntArray  #: of the mesh, see :class:`Sites`; -1 where there is none
    triangle: IntArray  #: the smallest triangle that the site lies on; -1 where there is none
    _mesh: Mesh = field(repr=False)

    @cached_property
    def barycentric(self) -> FloatArray:
        """(..., 3): weights of the triangle's corners, of which the closest point is the mean; not a number where there
        is no triangle. Computed when first asked for, with the mesh's vertices as they are then."""
        rows, shape = points_and_shape(self.closest, "points")
        site, triangle = (np.ascontiguousarray(ids.reshape(-1)) for ids in (self.site, self.triangle))
        weights: FloatArray = _core.barycentric(self._mesh._arrays, rows, site, triangle)
        return weights.reshape((*shape, 3))


@takes("ClosestPointOptions")
def signed_distance(
    mesh: MeshLike,
    points: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ClosestPointOptions],
) -> SignedDistances:
    """Exact signed distances of any points, with their gradients, closest points, sites and triangles.

    For many calls with one mesh see :class:`ClosestPointQuery`.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of the shape (..., 3)
    **options

    >>> import blum
    >>> found = blum.signed_distance(blum.generate("box"), [[0, 0, 2], [0.3, 0, 0]])
    >>> found.distance.round(6).tolist(), found.gradient.round(6).tolist()
    ([1.5, -0.2], [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
    >>> found.barycentric.sum(axis=1).round(6).tolist()
    [1.0, 1.0]
    """
    of = as_mesh(mesh, weld=weld)
    rows, shape = points_and_shape(points, "points")
    query = ClosestPointQuery(of, threads=threads, progress=progress, **options)
    found = query(rows, threads=threads, progress=progress)
    warn_all(_core.sign_warnings(of._arrays, query._query, integer(threads, "threads")))
    closest, distance = np.ascontiguousarray(found.closest), np.ascontiguousarray(found.distance)
    gradient: FloatArray = _core.gradients(rows, closest, distance)
    return SignedDistances(
        found.distance.reshape(shape),
        gradient.reshape((*shape, 3)),
        found.closest.reshape((*shape, 3)),
        found.site.reshape(shape),
        found.triangle.reshape(shape),
        of,
    )


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """What :func:`sample_surface` makes; row k of each array belongs to point k."""

    points: FloatArray  #: (n, 3): mesh units
    normals: FloatArray  #: (n, 3): of the triangle, of length 1
    triangle: IntArray  #: (n,): that the point lies on

    def __repr__(self) -> str:
        return f"SurfaceSamples({len(self.points):,} points)"


@takes("SampleOptions")
def sample_surface(
    mesh: MeshLike,
    count: Integer,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SampleOptions],
) -> SurfaceSamples:
    """Random points of a surface, uniform by area: the same for the same mesh and seed.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    count : int
        Of points.
    **options

    >>> import blum
    >>> found = blum.sample_surface(blum.generate("box"), 1000, seed=1)
    >>> found, float(abs(found.points).max())
    (SurfaceSamples(1,000 points), 0.5)
    """
    of = as_mesh(mesh, weld=weld)
    number = _count(count)
    with reporting(progress) as report:
        found = _core.sample_surface(of._arrays, number, dict(options), integer(threads, "threads"), report)
    return SurfaceSamples(*found)


@dataclass(frozen=True, eq=False)
class NearSamples:
    """What :func:`sample_near` makes; row k of each array belongs to point k."""

    points: FloatArray  #: (n, 3): mesh units
    distance: FloatArray  #: (n,): exact, negative inside
    closest: FloatArray  #: (n, 3): the closest point of the mesh
    site: IntArray  #: (n,)
    triangle: IntArray  #: (n,)

    def __repr__(self) -> str:
        return f"NearSamples({len(self.points):,} points)"


@takes("NearSampleOptions")
def sample_near(
    mesh: MeshLike,
    count: Integer,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[NearSampleOptions],
) -> NearSamples:
    """Points near a surface with their exact signed distances: what learning signed distances needs. First come those
    near the surface, then those in the box.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    count : int
        Of points.
    **options

    >>> import blum
    >>> found = blum.sample_near(blum.generate("sphere"), 500, sigma=0.01, in_box=0.5)
    >>> found, bool(abs(found.distance[:250]).max() < 0.06)
    (NearSamples(500 points), True)
    """
    of = as_mesh(mesh, weld=weld)
    number = _count(count)
    with reporting(progress) as report:
        points, closest, distance, site, triangle = _core.sample_near(
            of._arrays, number, dict(options), integer(threads, "threads"), report
        )
    return NearSamples(points, distance, closest, site, triangle)


def _count(value: Integer) -> int:
    count = integer(value, "count", 64)
    if count < 0:
        raise InvalidOption(f"count is {count}, but must be 0 or more")
    return count
