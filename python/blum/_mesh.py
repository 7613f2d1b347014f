"""Meshes: what Blum takes as one, and what is asked of it."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import (
    FloatArray,
    IntArray,
    PathLike,
    Real,
    as_array,
    existing_file,
    float_rows,
    indices,
    integer,
    number,
    optional_number,
    points_and_shape,
    source_name,
)
from ._errors import InvalidMesh
from ._mesh_like import MeshioLike, Open3DLike, Open3DTensorLike, PyVistaLike, TrimeshLike
from ._progress import Progress, reporting
from ._structs import Bounds, Topology
from ._warn import warn

Betti = tuple[int, int, int]


def betti_of(values: Sequence[int]) -> Betti:
    """Betti numbers of what the library hands over."""
    components, tunnels, voids = values
    return int(components), int(tunnels), int(voids)


class Mesh:
    """A set of triangles, segments and points over shared vertices; nothing is assumed of it.

    Parameters
    ----------
    vertices : (n, 3) array
        Positions, in mesh units. C-contiguous float64 is used as it is, without a copy; anything else is converted.
    triangles : (m, 3) array of integers, optional
        Vertices of each triangle, counter-clockwise as seen from outside. C-contiguous int32 and uint32 are used as
        they are; int64 is converted.
    segments : (s, 2) array of integers, optional
    points : (p,) array of integers, optional
        Vertices that are part of the shape by themselves. Without triangles, segments and points, all are.

    The arrays must not change while a call runs; between calls they may (see :class:`FieldSolver`).

    >>> import blum
    >>> tetrahedron = blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...                         [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> tetrahedron
    Mesh(4 vertices, 4 triangles)
    >>> blum.topology(tetrahedron).betti
    (1, 0, 0)
    """

    def __init__(self, vertices: Any, triangles: Any = None, segments: Any = None, points: Any = None) -> None:
        self._vertices = float_rows(vertices, "vertices")
        count = len(self._vertices)
        is_cloud = triangles is None and segments is None and points is None
        if is_cloud:
            points = np.arange(count, dtype=np.int32)
        none: tuple[int, ...] = ()
        self._triangles = indices(none if triangles is None else triangles, "triangles", 3, count)
        self._segments = indices(none if segments is None else segments, "segments", 2, count)
        self._points = indices(none if points is None else points, "points", None, count)
        #: Facts of the file that the mesh was read from: format, counts before Blum changed anything, what was welded.
        self.file_info: dict[str, Any] = {}
        #: Where the mesh came from, for the metadata of files.
        self.source: str = ""
        self._weld: float | None = None
        self._arrays = _core.MeshArrays(self._vertices, self._triangles, self._segments, self._points)

    @property
    def vertices(self) -> FloatArray:
        """(n, 3): positions. Their numbers may be changed in place between calls; other arrays make another Mesh."""
        return self._vertices

    @property
    def triangles(self) -> IntArray:
        """(m, 3): indices of vertices."""
        return self._triangles

    @property
    def segments(self) -> IntArray:
        """(k, 2): free segments, as indices of vertices."""
        return self._segments

    @property
    def points(self) -> IntArray:
        """(l,): free points, as indices of vertices."""
        return self._points

    def __reduce__(self) -> tuple[Any, ...]:
        told = {"source": self.source, "file_info": self.file_info, "_weld": self._weld}
        return Mesh, (self._vertices, self._triangles, self._segments, self._points), told

    @property
    def bounds(self) -> Bounds:
        """The box around all vertices that are named, as (lower, upper)."""
        return cast(Bounds, self._arrays.bounds())

    def write(self, path: PathLike) -> None:
        """Writes .obj, .off, .stl, .ply or .glb; the file appears complete or not at all."""
        _core.write_mesh(Path(os.fspath(path)), self._arrays)

    def to_trimesh(self) -> Any:
        """A trimesh.Trimesh of the triangles, unprocessed; (vertices, triangles) where trimesh is not installed."""
        try:
            import trimesh
        except ImportError:
            return self.vertices, self.triangles
        return trimesh.Trimesh(self.vertices, self.triangles, process=False)

    def to_pyvista(self) -> Any:
        """A pyvista.PolyData of triangles, segments and points; a dict of the arrays where PyVista is not installed."""
        try:
            import pyvista
        except ImportError:
            return {
                "vertices": self.vertices,
                "triangles": self.triangles,
                "segments": self.segments,
                "points": self.points,
            }
        return pyvista.PolyData(
            self.vertices,
            faces=_padded(self.triangles),
            lines=_padded(self.segments),
            verts=_padded(self.points.reshape(-1, 1)),
        )

    def __repr__(self) -> str:
        parts = [f"{len(self.vertices):,} vertices"]
        for name in ("triangles", "segments", "points"):
            if len(getattr(self, name)):
                parts.append(f"{len(getattr(self, name)):,} {name}")
        return f"Mesh({', '.join(parts)})"


def _padded(cells: IntArray) -> npt.NDArray[Any] | None:
    """Cells as VTK lists them, each after its number of corners; None where there are none."""
    if len(cells) == 0:
        return None
    width = np.full((len(cells), 1), cells.shape[1], dtype=np.int64)
    return np.hstack([width, cells]).ravel()


def mesh_of_arrays(arrays: tuple[Any, Any, Any, Any]) -> Mesh:
    """A mesh of what the library hands over."""
    vertices, triangles, segments, points = arrays
    return Mesh(vertices, triangles, segments, points)


#: What functions take as a mesh: one of Blum's, a path, a pair (vertices, triangles), a mesh of trimesh, Open3D (legacy
#: or of tensors), meshio or PyVista.
MeshLike = (
    Mesh
    | str
    | os.PathLike[str]
    | tuple[npt.ArrayLike, npt.ArrayLike]
    | TrimeshLike
    | Open3DLike
    | Open3DTensorLike
    | MeshioLike
    | PyVistaLike
)
#: The same, or vertices where triangles are an argument of their own.
MeshOrVertices = MeshLike | npt.ArrayLike


def as_mesh(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    name: str = "mesh",
    *,
    weld: Real | None = None,
) -> Mesh:
    """Anything that stands for a mesh, as a Mesh, its vertices merged where `weld` is given.

    All functions and methods that take a mesh call it. Of meshio's cells the triangles, quads, lines and vertices
    count; of PyVista's datasets the surface.
    """
    if weld is None:
        own = _converted(mesh, triangles, name)
        if triangles is None and not isinstance(mesh, (Mesh, str, os.PathLike, tuple, list)):
            _tell_of_seams(own, type(mesh).__name__)
        return own
    if triangles is None and isinstance(mesh, (str, os.PathLike)):
        return read_mesh(mesh, weld=weld)
    given = _converted(mesh, triangles, name)
    tolerance = number(weld, "weld")
    welded = mesh_of_arrays(_core.weld(given._arrays, tolerance))
    welded.source, welded._weld = given.source, tolerance
    return welded


def end_vertices(end: MeshOrVertices, name: str, triangles: IntArray | None = None) -> FloatArray:
    """Where vertices are at the end of a motion: an (n, 3) array, or what stands for the mesh there.

    With `triangles`, a mesh must have the same ones.
    """
    words = ("vertices", "vertex", "extract_surface", "points")
    if not (_is_pair(end) or isinstance(end, (str, os.PathLike)) or any(hasattr(end, word) for word in words)):
        return float_rows(end, name)
    mesh = as_mesh(end, name=name)
    if triangles is not None and not np.array_equal(mesh.triangles, triangles):
        raise InvalidMesh(f"{name} has other triangles than the mesh at the start: give frames of one mesh")
    return float_rows(mesh.vertices, name)


def _is_pair(mesh: Any) -> bool:
    """Whether this is vertices with triangles."""
    return isinstance(mesh, (tuple, list)) and len(mesh) == 2 and np.ndim(mesh[0]) == 2


def _tell_of_seams(mesh: Mesh, name: str) -> None:
    """Other packages keep a vertex for each texture coordinate at it: the mesh is then open along seams."""
    welded = weld(mesh)
    if len(welded.vertices) == len(mesh.vertices) or topology(mesh).closed or not topology(welded).closed:
        return
    text = f"the {name} is open only where equal vertices are apart, as along texture seams: weld=0 merges them"
    warn(text, "other-vertices")


def _converted(mesh: Any, triangles: Any, name: str) -> Mesh:
    if triangles is not None:
        return Mesh(mesh, triangles)
    if isinstance(mesh, Mesh):
        return mesh
    if isinstance(mesh, (str, os.PathLike)):
        return read_mesh(mesh)
    if _is_pair(mesh):
        return Mesh(mesh[0], mesh[1])
    if hasattr(mesh, "vertices"):
        for faces in ("faces", "triangles"):
            if hasattr(mesh, faces):
                return Mesh(mesh.vertices, getattr(mesh, faces))
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):
        return _of_open3d_tensors(mesh, name)
    if hasattr(mesh, "extract_surface") and hasattr(mesh, "points"):
        return _of_pyvista(mesh)
    if hasattr(mesh, "points") and hasattr(mesh, "cells_dict"):
        return _of_meshio(mesh)
    raise TypeError(
        f"{name} is a {type(mesh).__name__}, but must be a blum.Mesh, a path, a pair (vertices, triangles), or an "
        f"object of trimesh, Open3D, meshio or PyVista{_advice(mesh)}"
    )


def _advice(given: Any) -> str:
    """What to do about something that is no mesh, where that can be told."""
    if hasattr(given, "geometry") and hasattr(given, "to_mesh"):  # a trimesh.Scene
        return ": .to_mesh() makes one of it"
    if hasattr(given, "points") or (isinstance(given, np.ndarray) and given.ndim == 2 and given.shape[1] == 3):
        return ": blum.Mesh(points) makes one of points alone"
    return ""


def _of_open3d_tensors(mesh: Any, name: str) -> Mesh:
    """An open3d.t.geometry.TriangleMesh."""

    def array(values: Any) -> npt.NDArray[Any]:
        return np.asarray(values.cpu().numpy() if hasattr(values, "cpu") else values)

    try:
        positions, corners = mesh.vertex["positions"], mesh.triangle["indices"]
    except (KeyError, IndexError, RuntimeError, TypeError) as error:
        raise TypeError(f"{name} has no vertex.positions and triangle.indices: {error}") from error
    return Mesh(array(positions), array(corners))


def _of_meshio(mesh: Any) -> Mesh:
    cells: Mapping[str, Any] = mesh.cells_dict
    triangles = [np.asarray(cells["triangle"])] if "triangle" in cells else []
    if "quad" in cells:
        quads = np.asarray(cells["quad"])
        triangles += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    points = np.asarray(mesh.points, dtype=np.float64)
    if points.shape[1] == 2:
        points = np.hstack([points, np.zeros((len(points), 1))])
    vertex = cells.get("vertex")
    return Mesh(
        points,
        np.vstack(triangles) if triangles else (),
        cells.get("line", ()),
        () if vertex is None else np.asarray(vertex).ravel(),
    )


def _of_pyvista(mesh: Any) -> Mesh:
    surface = mesh
    if not hasattr(mesh, "is_all_triangles"):
        try:
            surface = mesh.extract_surface(algorithm=None)
        except TypeError:  # PyVista before 0.47
            surface = mesh.extract_surface()
    if not surface.is_all_triangles:
        surface = surface.triangulate()
    lines = np.asarray(surface.lines).ravel()
    segments: list[tuple[int, int]] = []
    at = 0
    while at < len(lines):  # each line is its number of points, then these
        line = lines[at + 1 : at + 1 + lines[at]]
        segments += [(int(a), int(b)) for a, b in pairwise(line)]
        at += 1 + int(lines[at])
    faces = np.asarray(surface.faces).reshape(-1, 4)[:, 1:]
    is_cloud = len(faces) == 0 and len(segments) == 0
    return Mesh(np.asarray(surface.points), None if is_cloud else faces, None if is_cloud else np.array(segments))


def read_mesh(path: PathLike, *, weld: Real | None = None) -> Mesh:
    """Reads .obj, .off, .stl (text, binary) or .ply (text, binary).

    Parameters
    ----------
    path : path
    weld : float, optional
        Merge vertices closer than this (mesh units); 0: equal ones. Default: equal ones for .stl, none for the others.

    Raises
    ------
    FileNotFoundError, FileError, FormatError
        The latter two name the file and where it is wrong.
    """
    tolerance = optional_number(weld, "weld")
    arrays, info = _core.read_mesh(existing_file(path), tolerance)
    mesh = mesh_of_arrays(arrays)
    mesh.file_info = dict(info)
    mesh.source = source_name(path)
    mesh._weld = tolerance
    return mesh


def weld(mesh: MeshLike, tolerance: Real = 0.0) -> Mesh:
    """Merges vertices at the same place, or that steps no longer than `tolerance` (mesh units) join.

    >>> import blum
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> blum.weld((corners, [[0, 1, 2], [3, 4, 5]]))
    Mesh(4 vertices, 2 triangles)
    """
    return mesh_of_arrays(_core.weld(as_mesh(mesh)._arrays, number(tolerance, "tolerance")))


def weld_clusters(vertices: Any, tolerance: Real = 0.0) -> IntArray:
    """For each of (n, 3) vertices, the smallest index of those that :func:`weld` would merge it with."""
    found: IntArray = _core.weld_clusters(float_rows(vertices, "vertices"), number(tolerance, "tolerance"))
    return found


def topology(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> Topology:
    """What a mesh is as a surface and as a solid. Crossings are not looked for: :func:`self_intersections`.

    >>> import blum
    >>> blum.topology(blum.generate("torus")).betti
    (1, 1, 0)
    """
    with reporting(progress) as report:
        found: Topology = _core.topology(
            as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
        )
    return found


@dataclass(frozen=True, eq=False)
class SelfIntersections:
    """Pairs of triangles that have more in common than a corner or an edge."""

    pairs: IntArray  #: (n, 2), the smaller triangle first, rising
    crosses: npt.NDArray[np.bool_]  #: (n,): whether they cross; else they touch
    complete: bool  #: False where there are more than the limit


def self_intersections(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    limit: int = 100000,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> SelfIntersections:
    """Where a mesh crosses or touches itself; exact for the coordinates as they are.

    >>> import blum
    >>> len(blum.self_intersections(blum.generate("sphere")).pairs)
    0
    """
    most = integer(limit, "limit")
    if most < 0:
        raise ValueError(f"limit is {most}, but must be at least 0")
    with reporting(progress) as report:
        pairs, crosses, complete = _core.self_intersections(
            as_mesh(mesh, triangles, weld=weld)._arrays, most, integer(threads, "threads"), report
        )
    return SelfIntersections(pairs, crosses.view(np.bool_), complete)


class Sites:
    """The vertices, open edges and open faces of a mesh, numbered as the sites of its fields are.

    Ids [0, V) are the vertices, [V, V + E) the distinct edges in rising order of (smaller, larger vertex), and
    [V + E, V + E + F) the triangles.

    >>> import blum
    >>> sites = blum.Sites(blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    >>> len(sites), sites.kind([0, 4, 6]).tolist()
    (7, ['vertex', 'edge', 'face'])
    >>> sites.vertices([4]).tolist()
    [[0, 2, -1]]
    """

    def __init__(
        self,
        mesh: MeshOrVertices,
        triangles: npt.ArrayLike | None = None,
        *,
        weld: Real | None = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> None:
        with reporting(progress) as report:
            self._table = _core.SiteTable(
                as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
            )

    def __repr__(self) -> str:
        faces = len(self) - self.vertex_count - len(self.edges)
        return f"Sites({self.vertex_count:,} vertices, {len(self.edges):,} edges, {faces:,} faces)"

    @property
    def vertex_count(self) -> int:
        """How many of the ids are vertices: the first ones."""
        return int(self._table.vertex_count)

    @property
    def edges(self) -> IntArray:
        """(E, 2): the vertices of each edge, the smaller one first."""
        found: IntArray = self._table.edges
        return found

    @property
    def triangle_edges(self) -> IntArray:
        """(F, 3): entry k is the edge between corners k and (k + 1) % 3, counted among the edges."""
        found: IntArray = self._table.triangle_edges
        return found

    def __len__(self) -> int:
        return self.vertex_count + len(self.edges) + int(self._table.face_count)

    def kind(self, ids: Any) -> npt.NDArray[np.str_]:
        """'vertex', 'edge' or 'face' for each id."""
        found = self._checked(ids)
        names = np.array(["vertex", "edge", "face"])
        return names[np.searchsorted([self.vertex_count, self.vertex_count + len(self.edges)], found, side="right")]

    def index(self, ids: Any) -> IntArray:
        """What each id counts within its kind: the vertex, the edge, the triangle."""
        found = self._checked(ids)
        edges_from, faces_from = self.vertex_count, self.vertex_count + len(self.edges)
        return np.where(
            found < edges_from, found, np.where(found < faces_from, found - edges_from, found - faces_from)
        ).astype(np.int32)

    def vertices(self, ids: Any) -> IntArray:
        """(n, 3): the one, two or three vertices of each site, padded with -1."""
        found: IntArray = self._table.vertices(self._checked(ids))
        return found

    def triangles(self, ids: Any) -> IntArray:
        """(n,): the smallest triangle that each site lies on; -1 where there is none."""
        found: IntArray = self._table.triangles(self._checked(ids))
        return found

    def _checked(self, ids: Any) -> IntArray:
        return indices(np.atleast_1d(as_array(ids, "ids")), "ids", None, len(self))


def pseudonormals(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> FloatArray:
    """(sites, 3): angle-weighted normals of all sites, not normalised; zero where a site lies on no triangle."""
    with reporting(progress) as report:
        found: FloatArray = _core.pseudonormals(
            as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
        )
    return found


class WindingNumber:
    """The generalized winding number of the triangles of a mesh: 1 inside of a closed surface, 0 outside.

    >>> import blum
    >>> inside = blum.WindingNumber(blum.generate("box"))
    >>> inside([[0, 0, 0], [5, 5, 5]]).round(6).tolist()
    [1.0, 0.0]
    """

    def __init__(
        self,
        mesh: MeshOrVertices,
        triangles: npt.ArrayLike | None = None,
        *,
        weld: Real | None = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> None:
        self._mesh = as_mesh(mesh, triangles, weld=weld)
        with reporting(progress) as report:
            self._winding = _core.WindingNumber(self._mesh._arrays, integer(threads, "threads"), report)

    def __repr__(self) -> str:
        return f"WindingNumber({self._mesh!r})"

    def __call__(
        self, points: Any, *, approximate: Real | None = None, threads: int = 0, progress: Progress = False
    ) -> FloatArray:
        """The number at points of the shape (..., 3).

        Parameters
        ----------
        approximate : float, optional
            Above 1: replace triangles further away than this many times the size of their cluster by a series; 2 gives
            errors of about 1e-3. Default: the full sum, good to about 1e-12.
        """
        beta = -1.0 if approximate is None else number(approximate, "approximate")
        if approximate is not None and not 1 < beta < float("inf"):
            raise ValueError(f"approximate is {beta}, but must be above 1, and finite")
        rows, shape = points_and_shape(points, "points")
        if not np.isfinite(rows).all():
            raise ValueError("points must be finite")
        with reporting(progress) as report:
            values: FloatArray = self._winding.values(rows, beta, integer(threads, "threads"), report)
        return values.reshape(shape)

    def is_inside(self, points: Any, *, threads: int = 0, progress: Progress = False) -> npt.NDArray[np.bool_]:
        """Whether the number is above 1/2 at points of the shape (..., 3), as the full sum decides it."""
        rows, shape = points_and_shape(points, "points")
        if not np.isfinite(rows).all():
            raise ValueError("points must be finite")
        with reporting(progress) as report:
            inside: npt.NDArray[np.uint8] = self._winding.is_inside(rows, integer(threads, "threads"), report)
        return inside.view(np.bool_).reshape(shape)
