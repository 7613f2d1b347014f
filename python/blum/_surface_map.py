"""Distances over surfaces.

The module computes maps as textures, thickness, Hausdorff distances and deviations.
"""

from __future__ import annotations

import os
import tempfile
from dataclasses import dataclass, field
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
from ._mesh import Mesh, MeshLike, Sites, as_mesh, mesh_of_arrays, moved_mesh
from ._methods import Rebuilt
from ._options import takes
from ._progress import Progress, ProgressCallback, reporting
from ._structs import (
    DeviationOptions,
    DirectedHausdorff,
    HausdorffDistance,
    HausdorffOptions,
    ResultWarning,
    SurfaceDeviation,
    SurfaceMapOptions,
    SurfaceMapStatistics,
    ThicknessOptions,
)
from ._warn import warn_all

__all__ = [
    "SurfaceMap",
    "SurfaceMapper",
    "Thickness",
    "directed_hausdorff_distance",
    "hausdorff_distance",
    "read_surface_map",
    "self_distance_map",
    "surface_deviation",
    "surface_distance_map",
    "thickness",
    "thickness_map",
]


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """Distance vector field over the surface of a mesh, as a texture.

    Texel [j, i] is the square from (i, j) to (i + 1, j + 1) of the texture; row 0 is at the top. The texel's value is
    that of one point of one triangle. Between texels, lookups use the nearest texel or are bilinear. Pickles and copies
    hold the .npz file of :meth:`write`, which is first written to a temporary folder.

    Examples
    --------
    >>> import blum
    >>> map = blum.surface_distance_map(blum.generate("box"), blum.generate("sphere"), texel=0.1)
    >>> map.vector.shape == (*map.distance.shape, 3), len(map.corners), len(map.vertex_distance)
    (True, 12, 8)
    """

    quantity: str  #: "distance", "self-distance", "ray-thickness" or "ball-thickness".
    #: Distances: (h, w), mesh units. Infinite if nothing was found, NaN in texels of no triangle.
    distance: npt.NDArray[np.float32]
    #: Vectors from the point of the surface to the closest point: (h, w, 3), mesh units. For thickness, to the point on
    #: the far side.
    vector: npt.NDArray[np.float32]
    site: IntArray  #: Site that contains the closest point: (h, w), see :class:`Sites`. -1 if none.
    triangle: IntArray  #: Triangle of the mesh: (h, w). -1 in texels of no triangle.
    corners: FloatArray  #: Corners of each triangle in the texture: (t, 3, 2), texels, x then y.
    #: Bound for each triangle: (t,), mesh units. At any of its points, the distance differs from a lookup by at most
    #: this. None for thickness, which may jump.
    error: npt.NDArray[np.float32] | None
    vertex_distance: FloatArray  #: Exact values at the vertices of the mesh: (v,).
    faces: npt.NDArray[np.float32]  #: Smallest, largest and mean value of each triangle's texels: (t, 3).
    sign_rule: str  #: Rule that decided the signs.
    sign_reason: str  #: Reason for this rule, one sentence.
    seconds: dict[str, float]  #: Wall-clock seconds of each phase.
    mesh: Mesh  #: Mesh of the map.
    _handle: Any = None
    #: Warnings about the signs, also issued as :class:`InputWarning`. Files do not hold them.
    warnings: list[ResultWarning] = field(default_factory=list)
    _others: tuple[Mesh, ...] | None = ()

    def __repr__(self) -> str:
        height, width = self.distance.shape
        return f"SurfaceMap({self.quantity}, {width} x {height} texels, {len(self.corners):,} triangles)"

    def __reduce__(self) -> tuple[Any, ...]:
        with tempfile.TemporaryDirectory(prefix="blum-") as folder:
            path = Path(folder, "map.npz")
            self.write(path)
            file = path.read_bytes()
        return _restored, (file, self.mesh, self._others, self.sign_reason, self.seconds, self.warnings)

    @property
    def texture_coordinates(self) -> FloatArray:
        """Texture coordinates of the corners of triangles: (t, 3, 2), 0 to 1.

        v points down, as in glTF files. OBJ files have 1 - v.
        """
        height, width = self.distance.shape
        return self.corners / (width, height)

    def write(self, path: PathLike, *, units: str = "", range: tuple[Real, Real] | None = None) -> None:
        """Writes the map. The extension selects the format.

        ``.npz`` holds everything as arrays. ``.png`` is the texture in colours with a bar. ``.glb`` is the mesh with
        the texture. ``.ply`` and ``.vtp`` hold the values of vertices and triangles.

        Parameters
        ----------
        path : path
            An existing file is replaced only by a complete file.
        units : str
            Units of the mesh, for example "mm", for the bar and the metadata.
        range : (float, float), optional
            Distances at the two ends of the colour scale. Default: smallest and largest value of the map; except for
            thickness, 0 is included.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> map = blum.thickness_map(blum.generate("box"), texel=0.1)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     map.write(pathlib.Path(folder) / "box.png", units="mm")
        ...     (pathlib.Path(folder) / "box.png").stat().st_size > 1000
        True
        """
        ends = None if range is None else (number(range[0], "range"), number(range[1], "range"))
        metadata = [("tool", "blum")]
        _core.write_surface_map(Path(os.fspath(path)), self.mesh._arrays, self._handle, metadata, ends, units)

    def statistics(self) -> SurfaceMapStatistics:
        """Returns mean, root mean square and percentiles of the values, by area.

        Examples
        --------
        >>> import blum
        >>> thick = blum.thickness_map(blum.generate("box", size_z=0.5), texel=0.05).statistics()
        >>> round(thick.percentiles[0], 6), round(thick.percentiles[6], 6), round(thick.mean, 6)
        (0.5, 1.0, 0.75)
        """
        found: SurfaceMapStatistics = _core.surface_map_statistics(self.mesh._arrays, self._handle)
        return found

    @cached_property
    def object(self) -> IntArray:
        """Index of the closest of the other meshes at each texel: (h, w). -1 if no closest point was found.

        Maps from files raise ValueError, because files do not record this index.
        """
        if self._others is None:
            raise ValueError("the map is from a file, and files do not record which of the other meshes is closest")
        out = np.where(self.site >= 0, 0, -1).astype(np.int32)
        if len(self._others) > 1:
            ends = np.cumsum([len(other.vertices) for other in self._others])
            known = self.site >= 0
            vertices = Sites(_joined(self._others)).vertices(self.site[known])[:, 0]
            out[known] = np.searchsorted(ends, vertices, side="right")
        return out


def _restored(
    file: bytes,
    mesh: Mesh,
    others: tuple[Mesh, ...] | None,
    sign_reason: str,
    seconds: dict[str, float],
    warnings: list[ResultWarning],
) -> SurfaceMap:
    with tempfile.TemporaryDirectory(prefix="blum-") as folder:
        path = Path(folder, "map.npz")
        path.write_bytes(file)
        _, found = _core.read_surface_map(path)
    known = {"sign_reason": sign_reason, "seconds": seconds, "warnings": warnings}
    return SurfaceMap(**{**found, **known}, mesh=mesh, _others=others)


def read_surface_map(path: PathLike) -> SurfaceMap:
    """Reads a map and its mesh from an .npz file of :meth:`SurfaceMap.write` or ``blum surface-map``.

    All numbers are restored bit by bit. The file does not record which of several other meshes is closest.

    Raises
    ------
    FileNotFoundError, FileError, FormatError

    Examples
    --------
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
    """Computes the distance from every point of a surface to other meshes, as a texture with guaranteed error bounds.

    Parameters
    ----------
    target : mesh
        A mesh with triangles, as for :func:`distance_field`.
    *others : meshes
        Any soups. :attr:`SurfaceMap.object` contains the index of the closest of these meshes for each texel.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> map = blum.surface_distance_map(blum.generate("box"), blum.generate("sphere"), texel=0.05)
    >>> map.quantity, bool(map.error.max() < 0.05)
    ('distance', True)
    """
    if not others:
        raise TypeError("surface_distance_map() needs another mesh: use self_distance_map() for a mesh and itself")
    of = as_mesh(target, name="target", weld=weld)
    parts = tuple(as_mesh(other, name="other", weld=weld) for other in others)
    joined = parts[0] if len(parts) == 1 else _joined(parts)
    with reporting(progress) as report:
        found = _core.surface_distance_map(
            of._arrays, joined._arrays, dict(options), integer(threads, "threads"), report
        )
    return _map(found, of, parts)


@takes("SurfaceMapOptions")
class SurfaceMapper(Rebuilt):
    """Maps of surfaces that move. The layout of the texture stays.

    A pickle or copy holds the meshes and the options, and builds its structures again at its first use. Moved vertices
    are copied.

    Parameters
    ----------
    target, other : meshes
        As for :func:`surface_distance_map`.
    texture_coordinates : array (t, 3, 2), optional
        Texture coordinates of the corners of each triangle of the target, 0 to 1, v down (OBJ files have 1 - v).
        Triangles must not overlap. Default: a layout that Blum makes.
    texture_size : (int, int), optional
        Width and height of the given texture, in texels.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> part, ball = blum.generate("box"), blum.generate("sphere", radius=2)
    >>> mapper = blum.SurfaceMapper(part, ball, texel=0.1)
    >>> before = mapper.map().distance
    >>> mapper.move_target(part.vertices * 0.5)
    >>> bool((mapper.map().faces[:, 0] > 1).all())
    True
    """

    _built = "_mapper"

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
        self._target = self._first = as_mesh(target, name="target", weld=weld)
        self._other = as_mesh(other, name="other", weld=weld)
        self._options = dict(options)
        width, height = (integer(side, "texture_size") for side in texture_size)
        self._size = width, height
        self._places = None if texture_coordinates is None else _places(texture_coordinates, width, height)
        with reporting(progress) as report:
            self._mapper = self._made(integer(threads, "threads"), report)

    def _made(self, threads: int, report: ProgressCallback | None) -> _core.SurfaceMapper:
        """Returns the mapper of the first target, whose texture all later ones have."""
        arrays = self._first._arrays, self._other._arrays
        return _core.SurfaceMapper(*arrays, self._options, self._places, *self._size, threads, report)

    @cached_property
    def _mapper(self) -> _core.SurfaceMapper:
        mapper = self._made(0, None)
        if self._target is not self._first:
            mapper.move_target(self._target.vertices)
        return mapper

    def __repr__(self) -> str:
        return f"SurfaceMapper({self._target!r})"

    def move_target(self, vertices: Any) -> None:
        """Sets new positions of all vertices of the target.

        Examples
        --------
        >>> import blum
        >>> box = blum.generate("box")
        >>> mapper = blum.SurfaceMapper(box, box, texel=0.2)
        >>> mapper.move_target(box.vertices + [3, 0, 0])
        >>> float(mapper.map().faces[:, 0].min())
        2.0
        """
        moved = float_rows(vertices, "vertices")
        self._mapper.move_target(moved)
        self._target = moved_mesh(self._target, moved)

    def move_other(self, vertices: Any, *, threads: int = 0) -> None:
        """Sets new positions of all vertices of the other mesh.

        Examples
        --------
        >>> import blum
        >>> box = blum.generate("box")
        >>> mapper = blum.SurfaceMapper(box, box, texel=0.2)
        >>> mapper.move_other(box.vertices + [3, 0, 0])
        >>> float(mapper.map().faces[:, 0].min())
        2.0
        """
        moved = float_rows(vertices, "vertices")
        self._mapper.move_other(moved, integer(threads, "threads"))
        self._other = moved_mesh(self._other, moved)

    def replace_other(self, other: MeshLike, *, weld: Real | None = None, threads: int = 0) -> None:
        """Replaces the other mesh.

        Examples
        --------
        >>> import blum
        >>> box = blum.generate("box")
        >>> mapper = blum.SurfaceMapper(box, box, texel=0.2)
        >>> mapper.replace_other(blum.Mesh([[0, 0, 3]]))
        >>> round(float(mapper.map().faces[:, 0].min()), 6)
        2.5
        """
        mesh = as_mesh(other, name="other", weld=weld)
        self._mapper.replace_other(mesh._arrays, integer(threads, "threads"))
        self._other = mesh

    def map(self, *, threads: int = 0, progress: Progress = False) -> SurfaceMap:
        """Returns the map of the meshes as they are now.

        Examples
        --------
        >>> import blum
        >>> box = blum.generate("box")
        >>> blum.SurfaceMapper(box, box, texel=0.2).map().quantity
        'distance'
        """
        with reporting(progress) as report:
            found = self._mapper.map(integer(threads, "threads"), report)
        return _map(found, self._target)


def _map(found: dict[str, Any], mesh: Mesh, others: tuple[Mesh, ...] | None = ()) -> SurfaceMap:
    """Returns a map of the library, and issues its warnings."""
    found["warnings"] = list(found["warnings"])
    warn_all(found["warnings"])
    return SurfaceMap(**found, mesh=mesh, _others=others)


def _places(coordinates: Any, width: int, height: int) -> FloatArray:
    """Returns texture coordinates in texels."""
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
    """Computes the distance from every point of a surface to the rest of the same mesh, as a texture.

    The rest are the triangles, segments and points that share no vertex with the point's triangle.

    Parameters
    ----------
    target, weld, threads, progress
        As for :func:`surface_distance_map`.
    **options

    Examples
    --------
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
    """Computes the thickness of a solid over its surface, as a texture.

    Parameters
    ----------
    solid, kind, separation
        As for :func:`thickness`.
    weld, threads, progress
        As for :func:`surface_distance_map`.
    **options

    Examples
    --------
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
    """Result of :func:`thickness`. All arrays have the shape of the points without the last axis.

    Examples
    --------
    >>> import blum
    >>> found = blum.thickness(blum.generate("box"), [0.1, 0.2, 0.5])
    >>> float(found.thickness), found.opposite.round(5).tolist()
    (1.0, [0.1, 0.2, -0.5])
    """

    thickness: FloatArray  #: Mesh units. Infinite if nothing lies on the far side.
    #: Point at which the ray leaves or the ball touches: (..., 3). The point itself if nothing was found.
    opposite: FloatArray
    triangle: IntArray  #: Triangle that contains it. -1 if nothing was found.

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
    """Computes the thickness of a solid at points of its surface.

    - `ray`: distance from the point, against the normal of its triangle, to the first other triangle through which the
      ray leaves the solid.

    - `ball`: diameter of the largest ball that touches the surface at the point from inside. The ball contains no point
      of a triangle whose normal differs from that of the point's triangle by `separation` or more. Triangles whose
      normals differ by less are treated as one smooth surface.

    Parameters
    ----------
    solid : mesh
        Its triangles must face outwards.
    points : array of shape (..., 3), optional
        Each point is replaced by the closest point of the surface. Default: the centroids of the triangles.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
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
    """Computes the Hausdorff distance of two meshes: an interval that is guaranteed to contain it, and witnesses.

    Parameters
    ----------
    a, b : meshes
        Any soups, as for :func:`distance_field`.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
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
    """Computes the largest distance of a point of a mesh to another mesh: one direction of :func:`hausdorff_distance`.

    Parameters
    ----------
    mesh, other : meshes
        Any soups, as for :func:`distance_field`.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
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
    """Computes mean, root mean square and percentiles of the distance of a surface from another mesh.

    The errors are guaranteed bounds.

    Parameters
    ----------
    mesh : mesh
        A mesh with triangles, for example a scan.
    other : mesh
        Any soup, for example a design.
    weld, threads, progress
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> small, large = blum.generate("box"), blum.generate("box", size_x=2, size_y=2, size_z=2)
    >>> round(blum.surface_deviation(small, large, pieces=1000).mean, 6)
    0.5
    """
    meshes = as_mesh(mesh, name="mesh", weld=weld), as_mesh(other, name="other", weld=weld)
    found: SurfaceDeviation = _compared(_core.surface_deviation, meshes, dict(options), threads, progress)
    warn_all(found.warnings)
    return found


def _compared(
    compare: Any, meshes: tuple[Mesh, Mesh], options: dict[str, Any], threads: int, progress: Progress
) -> Any:
    """Returns the result of a library function of two meshes."""
    with reporting(progress) as report:
        return compare(meshes[0]._arrays, meshes[1]._arrays, options, integer(threads, "threads"), report)


def _joined(parts: tuple[Mesh, ...]) -> Mesh:
    """Returns meshes as one, in their order."""
    starts = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    moved = [
        [cells + start for cells in (part.triangles, part.segments, part.points)]
        for part, start in zip(parts, starts, strict=True)
    ]
    cells = [np.concatenate(kind).astype(np.int32) for kind in zip(*moved, strict=True)]
    return Mesh(np.concatenate([part.vertices for part in parts]), *cells)
