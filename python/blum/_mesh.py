"""Meshes, their topology and their sites."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
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
    check_finite,
    existing_file,
    float_rows,
    indices,
    integer,
    number,
    optional_number,
    points_and_shape,
    source_name,
    thread_number,
)
from ._errors import InvalidMesh
from ._mesh_like import MeshioLike, Open3DLike, Open3DTensorLike, PyVistaLike, TrimeshLike
from ._methods import Rebuilt, Shown
from ._progress import Progress, reporting
from ._structs import Bounds, Topology
from ._warn import warn

__all__ = [
    "Mesh",
    "MeshLike",
    "SelfIntersections",
    "Sites",
    "WindingNumber",
    "as_mesh",
    "pseudonormals",
    "read_mesh",
    "self_intersections",
    "topology",
    "weld",
    "weld_clusters",
]

Betti = tuple[int, int, int]


def betti_of(values: Sequence[int]) -> Betti:
    """Returns Betti numbers from the library's numbers."""
    components, tunnels, voids = values
    return int(components), int(tunnels), int(voids)


class Mesh:
    """Triangles, segments and points over shared vertices. Any soup is valid.

    Parameters
    ----------
    vertices : (n, 3) array
        Positions, mesh units. C-contiguous float64 is not copied; other types are converted.
    triangles : (m, 3) array of integers, optional
        Vertices of each triangle, counter-clockwise as seen from outside. C-contiguous int32 and uint32 are not copied;
        int64 is converted.
    segments : (s, 2) array of integers, optional
        Vertices of free segments.
    points : (p,) array of integers, optional
        Vertices that are free points of the shape. Without triangles, segments and points, all vertices are free
        points.

    Arrays must not change during a call, but may change between calls (see :class:`FieldSolver`).

    Examples
    --------
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
        #: Facts of the mesh's file: format, counts before any change, and what was welded.
        self.file_info: dict[str, Any] = {}
        #: Name of the mesh's file, for the metadata of files.
        self.source: str = ""
        self._weld: float | None = None
        self._arrays = _core.MeshArrays(self._vertices, self._triangles, self._segments, self._points)

    @property
    def vertices(self) -> FloatArray:
        """Positions: (n, 3), mesh units. Values may change in place between calls. Other arrays need another Mesh."""
        return self._vertices

    @property
    def triangles(self) -> IntArray:
        """Vertices of the triangles: (m, 3)."""
        return self._triangles

    @property
    def segments(self) -> IntArray:
        """Vertices of the free segments: (s, 2)."""
        return self._segments

    @property
    def points(self) -> IntArray:
        """Vertices that are free points: (p,)."""
        return self._points

    def __reduce__(self) -> tuple[Any, ...]:
        stated = {"source": self.source, "file_info": self.file_info, "_weld": self._weld}
        return Mesh, (self._vertices, self._triangles, self._segments, self._points), stated

    @property
    def bounds(self) -> Bounds:
        """Box around the vertices of triangles, segments and points, as (lower, upper)."""
        return cast(Bounds, self._arrays.bounds())

    def write(self, path: PathLike) -> None:
        """Writes .obj, .off, .stl, .ply or .glb. The file appears under its name only when it is complete.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     blum.generate("box").write(pathlib.Path(folder) / "box.stl")
        ...     blum.read_mesh(pathlib.Path(folder) / "box.stl")
        Mesh(8 vertices, 12 triangles)
        """
        _core.write_mesh(Path(os.fspath(path)), self._arrays)

    def to_trimesh(self) -> Any:
        """Returns a trimesh.Trimesh of the triangles, unprocessed. Without trimesh, returns (vertices, triangles).

        Examples
        --------
        >>> import blum
        >>> type(blum.generate("box").to_trimesh()).__name__ in ("Trimesh", "tuple")
        True
        """
        try:
            import trimesh
        except ImportError:
            return self.vertices, self.triangles
        return trimesh.Trimesh(self.vertices, self.triangles, process=False)

    def to_pyvista(self) -> Any:
        """Returns a pyvista.PolyData of triangles, segments and points. Without PyVista, returns a dict of arrays.

        Examples
        --------
        >>> import blum
        >>> type(blum.generate("box").to_pyvista()).__name__ in ("PolyData", "dict")
        True
        """
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
    """Returns cells in the form of VTK: each is preceded by its number of corners. None without cells."""
    if len(cells) == 0:
        return None
    width = np.full((len(cells), 1), cells.shape[1], dtype=np.int64)
    return np.hstack([width, cells]).ravel()


def mesh_of_arrays(arrays: tuple[Any, Any, Any, Any]) -> Mesh:
    """Returns a mesh from the library's arrays."""
    vertices, triangles, segments, points = arrays
    return Mesh(vertices, triangles, segments, points)


def moved_mesh(mesh: Mesh, vertices: FloatArray) -> Mesh:
    """Returns a mesh with the same parts and copied vertices."""
    moved = Mesh(vertices.copy(), mesh.triangles, mesh.segments, mesh.points)
    moved.source, moved._weld = mesh.source, mesh._weld
    return moved


#: Mesh argument of functions: a Mesh, a path, a pair (vertices, triangles), or a mesh of another package. These are
#: trimesh, Open3D (legacy or tensors), meshio and PyVista.
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
#: The same, or vertices if triangles are a separate argument.
MeshOrVertices = MeshLike | npt.ArrayLike


def as_mesh(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    name: str = "mesh",
    *,
    weld: Real | None = None,
) -> Mesh:
    """Returns any object that functions accept as a mesh as a :class:`Mesh`.

    All functions and methods that take a mesh call this. Use it to convert a mesh once for many calls. A :class:`Mesh`
    is returned as it is. From meshio, triangles, quads, lines and vertices are used; from PyVista's datasets, the
    surface, the lines and the vertex cells.

    Parameters
    ----------
    mesh, triangles
        As for :func:`distance_field`. The type hint of `mesh` without `triangles` is ``blum.MeshLike``.
    name : str
        Name of the argument in error messages.
    weld : float, optional
        As for :func:`distance_field`.

    Raises
    ------
    InvalidMesh (a ValueError), TypeError, FileNotFoundError, FileError, FormatError

    Examples
    --------
    >>> import blum
    >>> def centroid(part: blum.MeshLike) -> list[float]:
    ...     mesh: blum.Mesh = blum.as_mesh(part)
    ...     return mesh.vertices.mean(axis=0).tolist()
    >>> centroid(([[0, 0, 0], [3, 0, 0], [0, 3, 0]], [[0, 1, 2]]))
    [1.0, 1.0, 0.0]
    """
    if weld is None:
        own = _converted(mesh, triangles, name)
        if triangles is None and not isinstance(mesh, (Mesh, str, os.PathLike, tuple, list)):
            _warn_of_seams(own, type(mesh).__name__)
        return own
    if triangles is None and isinstance(mesh, (str, os.PathLike)):
        return read_mesh(mesh, weld=weld)
    given = _converted(mesh, triangles, name)
    tolerance = number(weld, "weld")
    welded = mesh_of_arrays(_core.weld(given._arrays, tolerance))
    welded.source, welded._weld = given.source, tolerance
    return welded


def end_vertices(end: MeshOrVertices, name: str, triangles: IntArray | None = None) -> FloatArray:
    """Returns the vertices at the end of a motion, from an (n, 3) array or a mesh.

    With `triangles`, a mesh must have the same triangles.
    """
    words = ("vertices", "vertex", "extract_surface", "points")
    if not (_is_pair(end) or isinstance(end, (str, os.PathLike)) or any(hasattr(end, word) for word in words)):
        return float_rows(end, name)
    mesh = as_mesh(end, name=name)
    if triangles is not None and not np.array_equal(mesh.triangles, triangles):
        raise InvalidMesh(f"{name} has other triangles than the mesh at the start: give frames of one mesh")
    return float_rows(mesh.vertices, name)


def _is_pair(mesh: Any) -> bool:
    """Returns True for a pair of vertices and triangles."""
    return isinstance(mesh, (tuple, list)) and len(mesh) == 2 and np.ndim(mesh[0]) == 2


def _warn_of_seams(mesh: Mesh, name: str) -> None:
    """Warns about a mesh of another package that is open only along seams.

    Other packages keep a vertex for each of its texture coordinates, so the mesh is open along texture seams.
    """
    welded = weld(mesh)
    if len(welded.vertices) == len(mesh.vertices) or topology(mesh).closed or not topology(welded).closed:
        return
    text = f"the {name} is open only along seams where equal vertices are separate, as in textures: weld=0 merges them"
    warn(text, "other-vertices")


def _converted(mesh: Any, triangles: Any, name: str) -> Mesh:
    """Returns any mesh-like object as a Mesh, without welding, except that of its file format."""
    if triangles is not None:
        _check_two(mesh, triangles, name)
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
        return _of_meshio(mesh, name)
    raise TypeError(
        f"{name} is a {type(mesh).__name__}, but must be a blum.Mesh, a path, a pair (vertices, triangles), or an "
        f"object of trimesh, Open3D, meshio or PyVista{_advice(mesh)}"
    )


def _check_two(mesh: Any, triangles: Any, name: str) -> None:
    """Raises TypeError if the arguments for vertices and triangles are other objects."""
    if hasattr(triangles, "positions_of"):
        raise TypeError("triangles is a blum.Grid, but must be an array (m, 3): pass a grid by its name, grid=...")
    words = ("vertices", "vertex", "extract_surface", "cells_dict")
    if isinstance(mesh, (str, os.PathLike)) or any(hasattr(mesh, word) for word in words):
        raise TypeError(
            f"{name} is a {type(mesh).__name__}, which has triangles of its own: leave out triangles, or pass arrays"
        )


def _advice(given: Any) -> str:
    """Returns advice on how to make a mesh from an object, or an empty string."""
    if getattr(given, "ndim", None) == 3 or hasattr(given, "GetPixelIDTypeAsString") or hasattr(given, "_arrays"):
        return ": smooth_surface(image) makes one of an image"
    if hasattr(given, "geometry") and hasattr(given, "to_mesh"):  # A trimesh.Scene.
        return ": its method to_mesh() makes one (older versions of trimesh: dump(concatenate=True))"
    if hasattr(given, "geometry") and hasattr(given, "dump"):  # A Scene of an older trimesh.
        return ": its method dump(concatenate=True) makes one"
    if hasattr(given, "combine") and hasattr(given, "extract_surface"):  # A pyvista.MultiBlock.
        return ": its method combine() makes one"
    if hasattr(given, "GetDataObjectType"):  # An object of VTK itself.
        return ": pyvista.wrap() makes one of an object of VTK"
    if hasattr(given, "vertices") and hasattr(given, "vertex_nodes"):  # A trimesh.path.Path3D.
        return ": blum.Mesh(path.vertices, segments=path.vertex_nodes) makes one of segments"
    if hasattr(given, "vertices"):  # A trimesh.PointCloud.
        return ": blum.Mesh(cloud.vertices) makes one of points alone"
    if hasattr(given, "points") or (isinstance(given, np.ndarray) and given.ndim == 2 and given.shape[1] == 3):
        return ": blum.Mesh(points) makes one of points alone"
    return ""


def _of_open3d_tensors(mesh: Any, name: str) -> Mesh:
    """Returns an open3d.t.geometry.TriangleMesh as a Mesh."""

    def array(values: Any) -> npt.NDArray[Any]:
        return np.asarray(values.cpu().numpy() if hasattr(values, "cpu") else values)

    try:
        positions, corners = mesh.vertex["positions"], mesh.triangle["indices"]
    except (KeyError, IndexError, RuntimeError, TypeError) as error:
        raise TypeError(f"{name} has no vertex.positions and triangle.indices: {error}") from error
    return Mesh(array(positions), array(corners))


#: Cells of meshio that become triangles, segments and points.
_FLAT_CELLS = ("triangle", "quad", "line", "vertex")
_VOLUME_CELLS = ("tetra", "hexa", "wedge", "pyramid", "polyhedron", "penta")


def _of_meshio(mesh: Any, name: str) -> Mesh:
    """Returns a meshio.Mesh as a Mesh. Quads become two triangles, and missing z coordinates 0.

    Cells of volumes are left out if there are triangles or quads, which are then their surface.
    """
    cells: Mapping[str, Any] = mesh.cells_dict
    has_faces = "triangle" in cells or "quad" in cells
    wrong = [kind for kind in cells if kind not in _FLAT_CELLS and not (has_faces and kind.startswith(_VOLUME_CELLS))]
    if wrong:
        raise InvalidMesh(
            f"{name} has cells of the kind {wrong[0]!r}, but must have triangle, quad, line or vertex: "
            "pyvista.from_meshio(mesh) makes a grid, whose surface is accepted"
        )
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
    """Returns the surface, the lines and the vertex cells of a PyVista dataset as a Mesh.

    A dataset without cells has the points of a cloud.
    """
    if getattr(mesh, "n_cells", None) == 0:
        return Mesh(np.asarray(mesh.points))
    surface = mesh
    if not hasattr(mesh, "is_all_triangles"):
        try:
            surface = mesh.extract_surface(algorithm=None)
        except TypeError:  # PyVista before 0.47.
            surface = mesh.extract_surface()
    lines = [np.stack([line[:, :-1], line[:, 1:]], axis=-1).reshape(-1, 2) for line in _cells_of(surface.lines)]
    points = [cell.ravel() for cell in _cells_of(surface.verts)]
    return Mesh(
        np.asarray(surface.points),
        _triangles_of(surface),
        np.vstack(lines) if lines else (),
        np.concatenate(points) if points else (),
    )


def _triangles_of(surface: Any) -> npt.NDArray[Any]:
    """Returns the faces and strips of a pyvista.PolyData as triangles (m, 3)."""
    faces = np.asarray(surface.faces)
    if surface.n_strips or len(faces) % 4 or not (faces[::4] == 3).all():
        bare = surface.copy(deep=False)
        bare.clear_data()  # PyVista warns about columns of lines, which triangulate() drops.
        faces = np.asarray(bare.triangulate().faces)
    return faces.reshape(-1, 4)[:, 1:]


def _cells_of(padded: Any) -> list[npt.NDArray[Any]]:
    """Returns VTK's cells, each of which is preceded by its number of corners, as arrays (n, corners)."""
    cells = np.asarray(padded).ravel()
    if len(cells) == 0:
        return []
    width = int(cells[0]) + 1
    if len(cells) % width == 0 and (cells[::width] == cells[0]).all():
        return [cells.reshape(-1, width)[:, 1:]]
    found, at = [], 0
    while at < len(cells):
        found.append(cells[at + 1 : at + 1 + cells[at]].reshape(1, -1))
        at += 1 + int(cells[at])
    return found


def read_mesh(path: PathLike, *, weld: Real | None = None) -> Mesh:
    """Reads .obj, .off, .stl (text, binary) or .ply (text, binary).

    Parameters
    ----------
    path : path
    weld : float, optional
        Merges vertices at most this far apart, mesh units. 0 merges equal vertices. Default: 0 for .stl, no merging for
        other formats.

    Raises
    ------
    FileNotFoundError, FileError, FormatError
        FileError and FormatError name the file and the place of the problem.

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "box.ply"
    ...     blum.generate("box").write(path)
    ...     blum.read_mesh(path, weld=1e-6)
    Mesh(8 vertices, 12 triangles)
    """
    tolerance = optional_number(weld, "weld")
    arrays, info = _core.read_mesh(existing_file(path), tolerance)
    mesh = mesh_of_arrays(arrays)
    mesh.file_info = dict(info)
    mesh.source = source_name(path)
    mesh._weld = tolerance
    return mesh


def weld(mesh: MeshLike, tolerance: Real = 0.0) -> Mesh:
    """Returns the mesh with merged vertices: vertices that coincide, or are joined by steps of at most `tolerance`.

    Parameters
    ----------
    mesh : mesh
        As for :func:`distance_field`.
    tolerance : float
        Longest step, mesh units. All vertices of a chain of steps become one vertex, however long the chain is.

    Examples
    --------
    >>> import blum
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    >>> blum.weld((corners, [[0, 1, 2], [3, 4, 5]]))
    Mesh(4 vertices, 2 triangles)
    """
    return mesh_of_arrays(_core.weld(as_mesh(mesh)._arrays, number(tolerance, "tolerance")))


def weld_clusters(vertices: Any, tolerance: Real = 0.0) -> IntArray:
    """Returns, for each of (n, 3) vertices, the smallest index of the vertices that :func:`weld` merges with it: (n,).

    Examples
    --------
    >>> import blum
    >>> blum.weld_clusters([[0, 0, 0], [1, 0, 0], [0, 0, 0]]).tolist()
    [0, 1, 0]
    """
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
    """Returns the facts of a mesh as a surface and as a solid.

    It does not search for crossings; :func:`self_intersections` does.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> blum.topology(blum.generate("torus")).betti
    (1, 1, 0)
    """
    with reporting(progress) as report:
        found: Topology = _core.topology(as_mesh(mesh, triangles, weld=weld)._arrays, thread_number(threads), report)
    return found


@dataclass(frozen=True, eq=False, repr=False)
class SelfIntersections(Shown):
    """Pairs of triangles that share more than a corner or an edge; the result of :func:`self_intersections`.

    Examples
    --------
    >>> import blum
    >>> cross = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]]
    >>> found = blum.self_intersections(cross, [[0, 1, 2], [3, 4, 5]])
    >>> found.pairs.tolist(), found.crosses.tolist(), found.complete
    ([[0, 1]], [True], True)
    """

    pairs: IntArray  #: Triangles of each pair, the smaller first: (n, 2), ascending.
    crosses: npt.NDArray[np.bool_]  #: True if the pair crosses, False if it only touches: (n,).
    complete: bool  #: False if more pairs than the limit exist.


def self_intersections(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    limit: int = 100000,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> SelfIntersections:
    """Returns the pairs of triangles that cross or touch beyond shared corners and edges.

    The answer is exact for the given coordinates.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.
    limit : int
        Largest number of pairs, at least 0. The search ends when it finds more.

    Examples
    --------
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


class Sites(Rebuilt):
    """Vertices, open edges and open faces of a mesh, numbered as the sites of its fields.

    With V vertices, E distinct edges and F triangles, ids [0, V) are the vertices. Ids [V, V + E) are the edges of
    triangles and segments, ascending by (smaller, larger vertex). Ids [V + E, V + E + F) are the triangles.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> sites = blum.Sites(blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    >>> len(sites), sites.kind([0, 4, 6]).tolist()
    (7, ['vertex', 'edge', 'face'])
    >>> sites.vertices([4]).tolist()
    [[0, 2, -1]]
    """

    _built = "_table"

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
            self._table = _core.SiteTable(self._mesh._arrays, thread_number(threads), report)

    @cached_property
    def _table(self) -> _core.SiteTable:
        return _core.SiteTable(self._mesh._arrays, 0, None)

    def __repr__(self) -> str:
        faces = len(self) - self.vertex_count - len(self.edges)
        return f"Sites({self.vertex_count:,} vertices, {len(self.edges):,} edges, {faces:,} faces)"

    @property
    def vertex_count(self) -> int:
        """Number of vertices, which have the first ids."""
        return int(self._table.vertex_count)

    @property
    def edges(self) -> IntArray:
        """Vertices of each edge: (E, 2), the smaller index first."""
        found: IntArray = self._table.edges
        return found

    @property
    def triangle_edges(self) -> IntArray:
        """Edges of each triangle: (F, 3). Entry k is the index of the edge between corners k and (k + 1) % 3."""
        found: IntArray = self._table.triangle_edges
        return found

    def __len__(self) -> int:
        return self.vertex_count + len(self.edges) + int(self._table.face_count)

    def kind(self, ids: Any) -> npt.NDArray[np.str_]:
        """Returns 'vertex', 'edge' or 'face' for each id.

        Examples
        --------
        >>> import blum
        >>> blum.Sites(blum.generate("box")).kind([7, 8, 37]).tolist()
        ['vertex', 'edge', 'face']
        """
        found = self._checked(ids)
        names = np.array(["vertex", "edge", "face"])
        return names[np.searchsorted([self.vertex_count, self.vertex_count + len(self.edges)], found, side="right")]

    def index(self, ids: Any) -> IntArray:
        """Returns the index of each id within its kind: of the vertex, the edge or the triangle.

        Examples
        --------
        >>> import blum
        >>> blum.Sites(blum.generate("box")).index([7, 8, 37]).tolist()
        [7, 0, 11]
        """
        found = self._checked(ids)
        edges_from, faces_from = self.vertex_count, self.vertex_count + len(self.edges)
        return np.where(
            found < edges_from, found, np.where(found < faces_from, found - edges_from, found - faces_from)
        ).astype(np.int32)

    def vertices(self, ids: Any) -> IntArray:
        """Returns the one, two or three vertices of each site, padded with -1: (n, 3).

        Examples
        --------
        >>> import blum
        >>> blum.Sites([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).vertices([1, 5, 6]).tolist()
        [[1, -1, -1], [1, 2, -1], [0, 1, 2]]
        """
        found: IntArray = self._table.vertices(self._checked(ids))
        return found

    def triangles(self, ids: Any) -> IntArray:
        """Returns the smallest index of a triangle that contains each site, -1 if no triangle does: (n,).

        Examples
        --------
        >>> import blum
        >>> blum.Sites([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).triangles([0, 3, 6]).tolist()
        [0, 0, 0]
        """
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
    """Returns the angle-weighted normals of all sites: (sites, 3), not normalised; zero for sites on no triangle.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> blum.pseudonormals([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])[6].round(6).tolist()
    [0.0, 0.0, 1.0]
    """
    with reporting(progress) as report:
        found: FloatArray = _core.pseudonormals(
            as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
        )
    return found


class WindingNumber(Rebuilt):
    """Generalized winding number of the triangles of a mesh: 1 inside a closed surface that faces outwards, 0 outside.

    A pickle or copy holds the mesh, and builds its search structure again at its first use.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> inside = blum.WindingNumber(blum.generate("box"))
    >>> inside([[0, 0, 0], [5, 5, 5]]).round(6).tolist()
    [1.0, 0.0]
    """

    _built = "_winding"

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

    @cached_property
    def _winding(self) -> _core.WindingNumber:
        return _core.WindingNumber(self._mesh._arrays, 0, None)

    def __repr__(self) -> str:
        return f"WindingNumber({self._mesh!r})"

    def __call__(
        self, points: Any, *, approximate: Real | None = None, threads: int = 0, progress: Progress = False
    ) -> FloatArray:
        """Returns the winding number at points of shape (..., 3).

        Parameters
        ----------
        points : array of shape (..., 3)
            Finite.
        approximate : float, optional
            Above 1. Clusters of triangles further away than this many times their size are replaced by a series; 2
            gives errors of about 1e-3. Default: the full sum, with an error of about 1e-12.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> winding = blum.WindingNumber(blum.generate("sphere"))
        >>> round(float(winding([0, 0, 0], approximate=2)), 2)
        1.0
        """
        beta = -1.0 if approximate is None else number(approximate, "approximate")
        if approximate is not None and not 1 < beta < float("inf"):
            raise ValueError(f"approximate is {beta}, but must be above 1 and finite")
        rows, shape = points_and_shape(points, "points")
        check_finite(rows, shape, "points")
        with reporting(progress) as report:
            values: FloatArray = self._winding.values(rows, beta, integer(threads, "threads"), report)
        return values.reshape(shape)

    def is_inside(self, points: Any, *, threads: int = 0, progress: Progress = False) -> npt.NDArray[np.bool_]:
        """Returns True for each of the points (..., 3) whose winding number, by the full sum, is above 1/2.

        Examples
        --------
        >>> import blum
        >>> blum.WindingNumber(blum.generate("box")).is_inside([[0, 0, 0], [5, 5, 5]]).tolist()
        [True, False]
        """
        rows, shape = points_and_shape(points, "points")
        check_finite(rows, shape, "points")
        with reporting(progress) as report:
            inside: npt.NDArray[np.uint8] = self._winding.is_inside(rows, integer(threads, "threads"), report)
        return inside.view(np.bool_).reshape(shape)
