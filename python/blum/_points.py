"""Signed distances and samples.

Samples are points of a surface, or points near it.
"""

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
from ._methods import Shown
from ._options import takes
from ._progress import Progress, reporting
from ._structs import ClosestPointOptions, NearSampleOptions, ResultWarning, SampleOptions
from ._warn import warn_all

__all__ = ["NearSamples", "SignedDistances", "SurfaceSamples", "sample_near", "sample_surface", "signed_distance"]


@dataclass(frozen=True, eq=False, repr=False)
class SignedDistances(Shown):
    """Result of :func:`signed_distance`. All arrays have the shape of the queries without the last axis.

    Examples
    --------
    >>> import blum
    >>> found = blum.signed_distance(blum.generate("box"), [0.1, 0, 2])
    >>> round(float(found.distance), 6), float(found.gradient[2])
    (1.5, 1.0)
    """

    distance: FloatArray  #: Mesh units, negative inside. Infinite if nothing lies within max_distance.
    #: Unit vector in which the distance grows: (..., 3). It points away from the surface outside, and towards it
    #: inside. On the surface it is the normal of the site, see :meth:`ClosestPointQuery.__call__`. NaN if nothing lies
    #: within max_distance. On the medial axis it is one of several directions.
    gradient: FloatArray
    closest: FloatArray  #: Closest point of the mesh: (..., 3).
    site: IntArray  #: Site of the mesh, see :class:`Sites`. -1 if none.
    triangle: IntArray  #: Smallest index of a triangle that contains the site. -1 if none.
    _mesh: Mesh = field(repr=False)
    sign_rule: str = field(default="none", repr=False)  #: Rule for signs: "normals", "winding" or "none".
    sign_reason: str = field(default="", repr=False)  #: Reason for this rule, one sentence.
    warnings: list[ResultWarning] = field(default_factory=list, repr=False)  #: Warnings about the signs.

    @cached_property
    def barycentric(self) -> FloatArray:
        """Weights of the triangle's corners, whose weighted mean is the closest point: (..., 3).

        Weights are NaN if the closest point lies on no triangle. Weights are computed at the first access, from the
        mesh's vertices at that time.
        """
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
    """Returns exact signed distances at any points, with gradients, closest points, sites and triangles.

    :class:`ClosestPointQuery` is faster for many calls with one mesh.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    points : array of shape (..., 3)
    **options

    Examples
    --------
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
    found = query(rows, gradient=True, threads=threads, progress=progress)
    assert found.gradient is not None
    return SignedDistances(
        found.distance.reshape(shape),
        found.gradient.reshape((*shape, 3)),
        found.closest.reshape((*shape, 3)),
        found.site.reshape(shape),
        found.triangle.reshape(shape),
        of,
        found.sign_rule,
        found.sign_reason,
        found.warnings,
    )


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Result of :func:`sample_surface`. Row k of each array belongs to point k.

    Examples
    --------
    >>> import blum
    >>> found = blum.sample_surface(blum.generate("box"), 10)
    >>> found.points.shape, found.normals.shape, found.triangle.shape
    ((10, 3), (10, 3), (10,))
    """

    points: FloatArray  #: Positions: (n, 3), mesh units.
    normals: FloatArray  #: Unit normals of the triangles: (n, 3). Files call this column `normal`.
    triangle: IntArray  #: Triangles that contain the points: (n,).

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
    """Returns random points of a surface, uniform by area. The same mesh and seed give the same points.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    count : int
        Number of points, not negative.
    **options

    Examples
    --------
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
    """Result of :func:`sample_near`. Row k of each array belongs to point k.

    Files of ``blum sample --near`` also contain gradients. In Python, :func:`signed_distance` computes them.

    Examples
    --------
    >>> import blum
    >>> found = blum.sample_near(blum.generate("box"), 10)
    >>> found.points.shape, found.distance.shape
    ((10, 3), (10,))
    """

    points: FloatArray  #: Positions: (n, 3), mesh units.
    distance: FloatArray  #: Exact distances, negative inside: (n,), mesh units.
    closest: FloatArray  #: Closest points of the mesh: (n, 3).
    site: IntArray  #: Sites that contain the closest points: (n,), see :class:`Sites`.
    triangle: IntArray  #: Smallest index of a triangle that contains the site: (n,). -1 if none.
    sign_rule: str  #: Rule for signs: "normals", "winding" or "none".
    sign_reason: str  #: Reason for this rule, one sentence.
    warnings: list[ResultWarning] = field(default_factory=list)  #: Warnings about the signs.

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
    """Returns random points near a surface with their exact signed distances, for example to train networks.

    The points near the surface come first, then the points that are uniformly distributed in a box (`in_box`). This box
    is the mesh's box, with sides multiplied by 1.1 about its centre.

    Parameters
    ----------
    mesh, weld, threads, progress
        As for :func:`distance_field`.
    count : int
        Number of points, not negative.
    **options

    Examples
    --------
    >>> import blum
    >>> found = blum.sample_near(blum.generate("sphere"), 500, sigma=0.01, in_box=0.5)
    >>> found, bool(abs(found.distance[:250]).max() < 0.06)
    (NearSamples(500 points), True)
    """
    of = as_mesh(mesh, weld=weld)
    number = _count(count)
    with reporting(progress) as report:
        points, closest, distance, site, triangle, rule, reason, warnings = _core.sample_near(
            of._arrays, number, dict(options), integer(threads, "threads"), report
        )
    warn_all(warnings)
    return NearSamples(points, distance, closest, site, triangle, rule, reason, list(warnings))


def _count(value: Integer) -> int:
    """Returns a number of points, which must not be negative."""
    count = integer(value, "count", 64)
    if count < 0:
        raise InvalidOption(f"count is {count}, but must be 0 or more")
    return count
