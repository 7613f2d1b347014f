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
from ._arguments import (
    FloatArray,
    IntArray,
    Integer,
    PathLike,
    Real,
    as_array,
    existing_file,
    float_rows,
    integer,
    number,
    points_and_shape,
)
from ._mesh import Mesh, MeshLike, Sites, as_mesh, mesh_of_arrays
from ._options import takes
from ._progress import Progress, reporting
from ._structs import (
    DeviationOptions,
    DirectedHausdorff,
    HausdorffDistance,
    HausdorffOptions,
    SurfaceDeviation,
    SurfaceMapOptions,
    SurfaceMapStatistics,
    ThicknessOptions,
)
from ._warn import warn_all


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
    _others: tuple[Mesh, ...] | None = ()

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

    def statistics(self) -> SurfaceMapStatistics:
        """Mean, root mean square and percentiles of the values, by area.

        >>> import blum
        >>> thick = blum.thickness_map(blum.generate("box", size_z=0.5), texel=0.05).statistics()
        >>> round(thick.percentiles[0], 6), round(thick.percentiles[6], 6), round(thick.mean, 6)
        (0.5, 1.0, 0.75)
        """
        found: SurfaceMapStatistics = _core.surface_map_statistics(self.mesh._arrays, self._handle)
        return found

    @cached_property
    def object(self) -> IntArray:
        """(h, w): which of the other meshes is closest, in their order; -1 where there is nothing; not of files."""
        if self._others is None:
            raise ValueError("files of maps do not tell which of the other meshes is closest")
        out = np.where(self.site >= 0, 0, -1).astype(np.int32)
        if len(self._others) > 1:
            ends = np.cumsum([len(other.vertices) for other in self._others])
            known = self.site >= 0
            vertices = Sites(_joined(self._others)).vertices(self.site[known])[:, 0]
            out[known] = np.searchsorted(ends, vertices, side="right")
        return out


def read_surface_map(path: PathLike) -> SurfaceMap:
    """Reads a map, and the mesh that it is of, from an .npz file of :meth:`SurfaceMap.write` or ``blum surface-map``.

    The numbers are the same, bit by bit. Which of several other meshes is closest is not in the file.

    Raises
    ------
    FileNotFoundError, FileError, FormatError

    >>> import blum, tempfile, os
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     blum.thickness_map(blum.generate("box"), texel=0.1).write(os.path.join(folder, "box.npz"))
    ...     again = blum.read_surface_map(os.path.join(folder, "box.npz"))
    >>> again.quantity, again.mesh
    ('ray-thickness', Mesh(8 vertices, 12 triangles))
    """
    mesh, found = _core.read_surface_map(existing_file(path))
    return _map(found, mesh_of_arrays(mesh), None)


@takes("SurfaceMapOptions")
def surface_distance_map(
    target: MeshLike,
    *others: MeshLike,
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
    return _map(found, of, parts)


@takes("SurfaceMapOptions")
class SurfaceMapper:
    """Maps of surfaces that move: the texture stays.

    Parameters
    ----------
    target, other : meshes
        As for :func:`surface_distance_map`.
    texture_coordinates : array (t, 3, 2), optional
        Where the corners of each triangle of the target are in a texture that it has, 0 to 1, v down (OBJ files have 1
        - v). Triangles must not overlap. Default: a texture of its own.
    texture_size : (int, int), optional
        Width and height of that texture, in texels.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    >>> import blum
    >>> part, ball = blum.generate("box"), blum.generate("sphere", radius=2)
    >>> mapper = blum.SurfaceMapper(part, ball, texel=0.1)
    >>> before = mapper.map().distance
    >>> mapper.move_target(part.vertices * 0.5)
    >>> bool((mapper.map().faces[:, 0] > 1).all())
    True
    """

    def __init__(
        self,
        target: MeshLike,
        other: MeshLike,
        *,
        texture_coordinates: Any = None,
        texture_size: tuple[Integer, Integer] = (1024, 1024),
        weld: Real | None = None,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[SurfaceMapOptions],
    ) -> None:
        self._target = as_mesh(target, name="target", weld=weld)
        facing = as_mesh(other, name="other", weld=weld)
        width, height = (integer(side, "texture_size") for side in texture_size)
        places = None if texture_coordinates is None else _places(texture_coordinates, width, height)
        with reporting(progress) as report:
            self._mapper = _core.SurfaceMapper(
                self._target._arrays,
                facing._arrays,
                dict(options),
                places,
                width,
                height,
                integer(threads, "threads"),
                report,
            )

    def move_target(self, vertices: Any) -> None:
        """New places of the vertices of the target, as many as it has."""
        moved = float_rows(vertices, "vertices")
        self._mapper.move_target(moved)
        mesh = self._target
        self._target = Mesh(moved.copy(), mesh.triangles, mesh.segments, mesh.points)

    def move_other(self, vertices: Any, *, threads: int = 0) -> None:
        """New places of the vertices of the other mesh, as many as it has."""
        self._mapper.move_other(float_rows(vertices, "vertices"), integer(threads, "threads"))

    def replace_other(self, other: MeshLike, *, weld: Real | None = None, threads: int = 0) -> None:
        """Another mesh instead of the other one."""
        mesh = as_mesh(other, name="other", weld=weld)
        self._mapper.replace_other(mesh._arrays, integer(threads, "threads"))

    def map(self, *, threads: int = 0, progress: Progress = False) -> SurfaceMap:
        """The map of the meshes as they are now."""
        with reporting(progress) as report:
            found = self._mapper.map(integer(threads, "threads"), report)
        return _map(found, self._target)


def _map(found: dict[str, Any], mesh: Mesh, others: tuple[Mesh, ...] | None = ()) -> SurfaceMap:
    """A map of the library, with what it warns of."""
    warn_all(found.pop("warnings"))
    return SurfaceMap(**found, mesh=mesh, _others=others)


def _places(coordinates: Any, width: int, height: int) -> FloatArray:
    """Texture coordinates in texels."""
    array = as_array(coordinates, "texture_coordinates")
    if array.ndim != 3 or array.shape[1:] != (3, 2):
        raise ValueError(f"texture_coordinates has the shape {array.shape}, but must have (triangles, 3, 2)")
    return np.ascontiguousarray(array * np.array([width, height]), dtype=np.float64)


@takes("SurfaceMapOptions", "sign")
def self_distance_map(
    target: MeshLike,
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
    return _map(found, of)


@takes("SurfaceMapOptions", "sign")
def thickness_map(
    solid: MeshLike,
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
    return _map(found, of)


@dataclass(frozen=True, eq=False)
class Thickness:
    """What :func:`thickness` finds; all arrays have the shape of the points without the last axis."""

    thickness: FloatArray  #: mesh units; infinite where there is nothing on the far side
    opposite: FloatArray  #: (..., 3): where the ray leaves, or the ball touches; else the point itself
    triangle: IntArray  #: that this point lies on; -1 where there is nothing

    def __repr__(self) -> str:
        points = self.thickness.size
        return f"Thickness({points:,} {'point' if points == 1 else 'points'})"


@takes("ThicknessOptions")
def thickness(
    solid: MeshLike,
    points: Any = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ThicknessOptions],
) -> Thickness:
    """How thick a solid is at points of its surface.

    By `ray`: how far it is, from the point against the normal of its triangle, to the first other triangle through
    which one leaves the solid. By `ball`: the diameter of the largest ball that touches the surface at the point from
    inside, and holds no point of a triangle that is turned by `separation` or more; triangles that are turned by less
    count as one smooth surface.

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
    warn_all(_core.thickness_warnings(of._arrays, integer(threads, "threads")))
    values, opposite, triangle = found
    return Thickness(values.reshape(shape), opposite.reshape((*shape, 3)), triangle.reshape(shape))


@takes("HausdorffOptions")
def hausdorff_distance(
    a: MeshLike,
    b: MeshLike,
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
    meshes = as_mesh(a, name="a", weld=weld), as_mesh(b, name="b", weld=weld)
    found: HausdorffDistance = _compared(_core.hausdorff_distance, meshes, dict(options), threads, progress)
    return found


@takes("HausdorffOptions")
def directed_hausdorff_distance(
    mesh: MeshLike,
    other: MeshLike,
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
    meshes = as_mesh(mesh, name="mesh", weld=weld), as_mesh(other, name="other", weld=weld)
    found: DirectedHausdorff = _compared(_core.directed_hausdorff_distance, meshes, dict(options), threads, progress)
    return found


@takes("DeviationOptions")
def surface_deviation(
    mesh: MeshLike,
    other: MeshLike,
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
    meshes = as_mesh(mesh, name="mesh", weld=weld), as_mesh(other, name="other", weld=weld)
    found: SurfaceDeviation = _compared(_core.surface_deviation, meshes, dict(options), threads, progress)
    return found


def _compared(
    compare: Any, meshes: tuple[Mesh, Mesh], options: dict[str, Any], threads: int, progress: Progress
) -> Any:
    """What a function of the library says of two meshes."""
    with reporting(progress) as report:
        return compare(meshes[0]._arrays, meshes[1]._arrays, options, integer(threads, "threads"), report)


def _joined(parts: tuple[Mesh, ...]) -> Mesh:
    """Meshes as one, in their order."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    moved = [
        [cells + start for cells in (part.triangles, part.segments, part.points)]
        for part, start in zip(parts, starts, strict=True)
    ]
    cells = [np.concatenate(kind).astype(np.int32) for kind in zip(*moved, strict=True)]
    return Mesh(np.concatenate([part.vertices for part in parts]), *cells)
