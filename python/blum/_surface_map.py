"""Distances over surfaces: maps as textures, thickness, Hausdorff distances, deviations."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, PathLike, Real, integer, number, points_and_shape
from ._mesh import Mesh, Sites, as_mesh
from ._options import takes
from ._progress import Progress, reporting
from ._structs import (
    DeviationOptions,
    DirectedHausdorff,
    HausdorffDistance,
    HausdorffOptions,
    SurfaceDeviation,
    SurfaceMapOptions,
    ThicknessOptions,
)


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """A distance vector field over the surface of a mesh, as a texture.

    Texel [j, i] is the square from (i, j) to (i + 1, j + 1) of the texture, with rows from the top; its value is that
    of one point of one triangle. Between texels the texture is read by the nearest one or bilinearly.
    """

    quantity: str  #: "distance", "self-distance", "ray-thickness" or "ball-thickness"
    #: (h, w) float32: mesh units; infinite where there is nothing, not a number in texels of no triangle
    distance: npt.NDArray[np.float32]
    #: (h, w, 3) float32: from the point of the surface to the closest point (of thickness, the one on the far side)
    vector: npt.NDArray[np.float32]
    site: IntArray  #: (h, w): what the closest point lies on, see :class:`Sites`; -1 where there is nothing
    triangle: IntArray  #: (h, w): of the mesh; -1 in texels of no triangle
    corners: FloatArray  #: (t, 3, 2): where the corners of each triangle are in the texture, in texels, x then y
    #: (t,) float32: how much the distance at any point of a triangle may differ from what is read there; None of
    #: thickness, which may jump
    error: npt.NDArray[np.float32] | None
    vertex_distance: FloatArray  #: (v,): exact, at the vertices of the mesh
    faces: npt.NDArray[np.float32]  #: (t, 3): smallest, largest and mean value of the texels of each triangle
    sign_rule: str
    sign_reason: str  #: why by this rule
    seconds: dict[str, float]  #: where time went
    mesh: Mesh  #: that the map is of
    _handle: Any = None
    _parts: tuple[Mesh, ...] = ()
    _joined: Mesh | None = None

    def __repr__(self) -> str:
        height, width = self.distance.shape
        return f"SurfaceMap({self.quantity}, {width} x {height} texels, {len(self.corners):,} triangles)"

    @property
    def texture_coordinates(self) -> FloatArray:
        """(t, 3, 2): of the corners of triangles, 0 to 1, v down as in glTF files (OBJ files have 1 - v)."""
        height, width = self.distance.shape
        return self.corners / (width, height)

    def write(self, path: PathLike, *, units: str = "", range: tuple[Real, Real] | None = None) -> None:
        """Writes the map; the format goes by the extension.

        ``.npz`` everything as arrays; ``.png`` the texture in colours with a bar; ``.glb`` the mesh with the texture;
        ``.ply``, ``.vtp`` values of vertices and triangles.

        Parameters
        ----------
        path : path
            An existing file is replaced by a complete one.
        units : str
            Of the mesh, such as "mm", for the bar and the metadata.
        range : (float, float), optional
            The distances at the ends of the colours. Default: those of the map.
        """
        ends = None if range is None else (number(range[0], "range"), number(range[1], "range"))
        metadata = [("tool", "blum")]
        _core.write_surface_map(Path(os.fspath(path)), self.mesh._arrays, self._handle, metadata, ends, units)

    @cached_property
    def object(self) -> IntArray:
        """(h, w): which of the other meshes is closest, in their order; -1 where there is nothing."""
        out = np.where(self.site >= 0, 0, -1).astype(np.int32)
        if len(self._parts) > 1:
            ends = np.cumsum([len(part.vertices) for part in self._parts])
            known = self.site >= 0
            vertices = Sites(self._joined).vertices(self.site[known])[:, 0]
            out[known] = np.searchsorted(ends, vertices, side="right")
        return out


@takes("SurfaceMapOptions")
def surface_distance_map(
    target: Any,
    *others: Any,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SurfaceMapOptions],
) -> SurfaceMap:
    """The distance from every point of a surface to other meshes, as a texture with certain errors.

    Parameters
    ----------
    target : mesh
        With triangles. Meshes come as for :func:`distance_field`.
    *others : meshes
        Any soups; :attr:`SurfaceMap.object` tells which of them is closest.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> map = blum.surface_distance_map(blum.generate("box"), blum.generate("sphere"), texel=0.05)
    >>> map.quantity, bool(map.error.max() < 0.05)
    ('distance', True)
    """
    if not others:
        raise TypeError("surface_distance_map() needs another mesh; for a mesh and itself there is self_distance_map()")
    of = as_mesh(target, name="target", weld=weld)
    parts = tuple(as_mesh(other, name="other", weld=weld) for other in others)
    joined = parts[0] if len(parts) == 1 else _joined(parts)
    with reporting(progress) as report:
        found = _core.surface_distance_map(
            of._arrays, joined._arrays, dict(options), integer(threads, "threads"), report
        )
    return SurfaceMap(**found, mesh=of, _parts=parts, _joined=joined)


@takes("SurfaceMapOptions", "sign")
def self_distance_map(
    target: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SurfaceMapOptions],
) -> SurfaceMap:
    """The distance from every point of a surface to those triangles of the same mesh that share no vertex with its own.

    Parameters
    ----------
    target, weld, threads, progress
        As for :func:`surface_distance_map`.
    **options

    >>> import blum
    >>> map = blum.self_distance_map(blum.generate("torus"), texel=0.1)
    >>> map.quantity
    'self-distance'
    """
    of = as_mesh(target, name="target", weld=weld)
    with reporting(progress) as report:
        found = _core.self_distance_map(of._arrays, dict(options), integer(threads, "threads"), report)
    return SurfaceMap(**found, mesh=of, _parts=(of,), _joined=of)


@takes("SurfaceMapOptions", "sign")
def thickness_map(
    solid: Any,
    *,
    kind: str = "ray",
    separation: Real = 30,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SurfaceMapOptions],
) -> SurfaceMap:
    """How thick a solid is, over its surface, as a texture.

    Parameters
    ----------
    solid, kind, separation
        As for :func:`thickness`.
    weld, threads, progress
        As for :func:`surface_distance_map`.
    **options

    >>> import blum
    >>> map = blum.thickness_map(blum.generate("box"), texel=0.1)
    >>> float(map.faces[:, 1].max().round(5))
    1.0
    """
    of = as_mesh(solid, name="solid", weld=weld)
    meaning = {"kind": kind, "separation": separation}
    with reporting(progress) as report:
        found = _core.thickness_map(of._arrays, dict(options), meaning, integer(threads, "threads"), report)
    return SurfaceMap(**found, mesh=of, _parts=(of,), _joined=of)


@dataclass(frozen=True, eq=False)
class Thickness:
    """What :func:`thickness` finds; all arrays have the shape of the points without the last axis."""

    thickness: FloatArray  #: mesh units; infinite where there is nothing on the far side
    opposite: FloatArray  #: (..., 3): where the ray leaves, or the ball touches; else the point itself
    triangle: IntArray  #: that this point lies on; -1 where there is nothing


@takes("ThicknessOptions")
def thickness(
    solid: Any,
    points: Any = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ThicknessOptions],
) -> Thickness:
    """How thick a solid is at points of its surface.

    By `ray`: how far it is, from the point against the normal of its triangle, to the first other triangle through
    which one leaves the solid. By `ball`: the diameter of the largest ball that touches the triangle at the point from
    inside, and holds no point of a triangle that is turned by `separation` or more.

    Parameters
    ----------
    solid : mesh
        Its triangles face outwards.
    points : array of the shape (..., 3), optional
        Each stands for the point of the surface that is closest to it. Default: the centroids of the triangles.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> plate = blum.generate("box", size_x=4, size_y=4, size_z=0.5)
    >>> blum.thickness(plate, [[0.5, 0.3, 0.25]]).thickness.round(6).tolist()
    [0.5]
    """
    of = as_mesh(solid, name="solid", weld=weld)
    rows, shape = (None, (len(of.triangles),)) if points is None else points_and_shape(points, "points")
    with reporting(progress) as report:
        found = _core.thickness(of._arrays, rows, dict(options), integer(threads, "threads"), report)
    values, opposite, triangle = found
    return Thickness(values.reshape(shape), opposite.reshape((*shape, 3)), triangle.reshape(shape))


@takes("HausdorffOptions")
def hausdorff_distance(
    a: Any,
    b: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[HausdorffOptions],
) -> HausdorffDistance:
    """The Hausdorff distance of two meshes: an interval that holds it for certain, and witnesses.

    Parameters
    ----------
    a, b : meshes
        Any soups, as for :func:`distance_field`.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> small, large = blum.generate("box"), blum.generate("box", size_x=2, size_y=2, size_z=2)
    >>> found = blum.hausdorff_distance(small, large, tolerance=1e-6)
    >>> found.lower <= 3**0.5 / 2 <= found.upper, found.upper - found.lower <= 1e-6
    (True, True)
    """
    first, second = as_mesh(a, name="a", weld=weld), as_mesh(b, name="b", weld=weld)
    with reporting(progress) as report:
        found: HausdorffDistance = _core.hausdorff_distance(
            first._arrays, second._arrays, dict(options), integer(threads, "threads"), report
        )
    return found


@takes("HausdorffOptions")
def directed_hausdorff_distance(
    mesh: Any,
    other: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[HausdorffOptions],
) -> DirectedHausdorff:
    """How far a mesh is, at most, from another one: one side of :func:`hausdorff_distance`.

    Parameters
    ----------
    mesh, other : meshes
        Any soups, as for :func:`distance_field`.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> small, large = blum.generate("box"), blum.generate("box", size_x=2, size_y=2, size_z=2)
    >>> found = blum.directed_hausdorff_distance(small, large, tolerance=1e-6)
    >>> found.lower <= 0.5 <= found.upper
    True
    """
    first, second = as_mesh(mesh, weld=weld), as_mesh(other, name="other", weld=weld)
    with reporting(progress) as report:
        found: DirectedHausdorff = _core.directed_hausdorff_distance(
            first._arrays, second._arrays, dict(options), integer(threads, "threads"), report
        )
    return found


@takes("DeviationOptions")
def surface_deviation(
    mesh: Any,
    other: Any,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[DeviationOptions],
) -> SurfaceDeviation:
    """Mean, root mean square and percentiles of the distance of a surface from another mesh, with certain errors.

    Parameters
    ----------
    mesh : mesh
        With triangles, such as a scan.
    other : mesh
        Any soup, such as a design.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> small, large = blum.generate("box"), blum.generate("box", size_x=2, size_y=2, size_z=2)
    >>> round(blum.surface_deviation(small, large, pieces=1000).mean, 6)
    0.5
    """
    first, second = as_mesh(mesh, weld=weld), as_mesh(other, name="other", weld=weld)
    with reporting(progress) as report:
        found: SurfaceDeviation = _core.surface_deviation(
            first._arrays, second._arrays, dict(options), integer(threads, "threads"), report
        )
    return found


def _joined(parts: tuple[Mesh, ...]) -> Mesh:
    """Meshes as one, in their order."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    moved = [
        [cells + start for cells in (part.triangles, part.segments, part.points)]
        for part, start in zip(parts, starts, strict=True)
    ]
    cells = [np.concatenate(kind).astype(np.int32) for kind in zip(*moved, strict=True)]
    return Mesh(np.concatenate([part.vertices for part in parts]), *cells)
