"""Distance fields of meshes and images."""

from __future__ import annotations

import os
import threading
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, Unpack, cast, overload

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
    device_name,
    existing_file,
    integer,
    label_of,
    number,
    optional_number,
    points_and_shape,
    source_name,
)
from ._grid import Grid, grid_for, mask_array
from ._image import as_image, labelled
from ._mesh import Mesh, MeshOrVertices, as_mesh, mesh_of_arrays
from ._methods import Rebuilt
from ._options import takes
from ._progress import Progress, reporting
from ._structs import FieldOptions, ResultWarning, VoxelTopology
from ._warn import warn_all

__all__ = ["Field", "FieldSolver", "distance_field", "read_field", "selected_voxels", "voxel_topology"]


class Field:
    """Distance and closest site at every node of a grid; the result of :func:`distance_field` and similar functions.

    ``Field(distance, grid)`` makes a field from an array (z, y, x), which is copied, for example to extract surfaces.

    Parameters
    ----------
    distance : (z, y, x) array
        Real numbers, mesh units. The field stores them as float32.
    grid : Grid
        Its shape must be that of `distance`.

    Examples
    --------
    >>> import blum, numpy as np
    >>> grid = blum.Grid((-1, -1, -1), 0.25, (9, 9, 9))
    >>> ball = blum.Field(np.linalg.norm(grid.positions(), axis=-1) - 0.6, grid)
    >>> blum.topology(ball.zero_surface()).betti
    (1, 0, 0)
    """

    def __init__(self, distance: Any, grid: Grid) -> None:
        array = as_array(distance, "distance")
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        if array.dtype.kind not in "fiu":
            raise TypeError(f"distance must hold real numbers, not {array.dtype}")
        if array.shape != grid.shape:
            raise ValueError(f"distance has the shape {array.shape}, but the grid's is {grid.shape}")
        values = np.ascontiguousarray(array, dtype=np.float32)
        self._take(_core.Field(values, grid._spec, None, None, None, None, "features", None, "none", ""))

    @classmethod
    def _of(cls, core: _core.Field, mesh: Mesh | None = None, source: str = "", space: str = "") -> Field:
        field = cls.__new__(cls)
        field._take(core, mesh, source, space)
        return field

    def _take(self, core: _core.Field, mesh: Mesh | None = None, source: str = "", space: str = "") -> None:
        self._core = core
        self._space = space
        #: Mesh of the field, if known.
        self.mesh = mesh
        #: Name of the shape's file, for the metadata of files.
        self.source = source
        self._distance: npt.NDArray[np.float32] = core.distance
        self._site = cast("IntArray | None", core.site)
        self._distance2 = cast("npt.NDArray[np.float32] | None", core.distance2)
        self._site2 = cast("IntArray | None", core.site2)
        # Read now, because a solver that reuses its field may be writing it later.
        self._grid = Grid._of(core.grid)
        self._seconds = dict(core.seconds)
        self._device, self._device_reason = str(core.device), str(core.device_reason)
        self._sign_rule, self._sign_reason = str(core.sign_rule), str(core.sign_reason)
        self._warnings: list[ResultWarning] = list(core.warnings)

    def __reduce__(self) -> tuple[Any, ...]:
        stated = (self.site_ids, self.band, self.sign_rule, self.sign_reason)
        arrays = (self.distance, self.grid, self.site, self.distance2, self.site2, self.second)
        known = {
            "_seconds": self._seconds,
            "_device": self._device,
            "_device_reason": self._device_reason,
            "_warnings": self._warnings,
        }
        return _restored, (*arrays, *stated, self.mesh, self.source, self._space), known

    @property
    def distance(self) -> npt.NDArray[np.float32]:
        """Distance, negative inside when signed: float32 (z, y, x), mesh units. Outside a band, it is +-band."""
        return self._distance

    @property
    def site(self) -> IntArray | None:
        """Closest site, -1 if none: int32 (z, y, x). None for a field without sites."""
        return self._site

    @property
    def distance2(self) -> npt.NDArray[np.float32] | None:
        """Distance to the second site, never negative: float32 (z, y, x), mesh units. None for a field of order 1.

        If a node has no second site, the value is infinite; with a band, it is the band's half-width.
        """
        return self._distance2

    @property
    def site2(self) -> IntArray | None:
        """Second site, -1 if none: int32 (z, y, x). None for a field of order 1 or without sites."""
        return self._site2

    @property
    def second(self) -> str | None:
        """Rule for second sites: "no-common-vertex" or "other-object". None for a field of order 1."""
        found: str | None = self._core.second
        return found

    @property
    def grid(self) -> Grid:
        """Grid of the nodes."""
        return self._grid

    @property
    def origin(self) -> tuple[float, float, float]:
        """Position of node (0, 0, 0), in x, y, z order."""
        return self.grid.origin

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Distance between neighbouring nodes, in x, y, z order."""
        return self.grid.spacing

    @property
    def site_ids(self) -> str:
        """Numbering of the sites: "features" (see :class:`Sites`), "triangles" or "voxels" (flat indices)."""
        return str(self._core.site_ids)

    @property
    def band(self) -> float | None:
        """Half-width of the band, mesh units. None without a band."""
        found: float | None = self._core.band
        return found

    @property
    def sign_rule(self) -> str:
        """Rule that decided the signs: "normals", "winding", "label", "balls" or "none"."""
        return self._sign_rule

    @property
    def device(self) -> str:
        """Device that computed the field: "cpu" or "cuda:K"."""
        return self._device

    @property
    def device_reason(self) -> str:
        """Reason why the CPU was used, one sentence, if `device="auto"` was requested. Otherwise empty."""
        return self._device_reason

    @property
    def sign_reason(self) -> str:
        """Reason for the sign rule, one sentence."""
        return self._sign_reason

    @property
    def warnings(self) -> list[ResultWarning]:
        """Warnings about the signs, also issued as :class:`InputWarning`. Files do not hold them."""
        return list(self._warnings)

    @property
    def seconds(self) -> dict[str, float]:
        """Wall-clock seconds of each phase."""
        return dict(self._seconds)

    @overload
    def interpolate(
        self, points: Any, *, gradient: Literal[False] = False, threads: int = 0, progress: Progress = False
    ) -> FloatArray: ...
    @overload
    def interpolate(
        self, points: Any, *, gradient: Literal[True], threads: int = 0, progress: Progress = False
    ) -> tuple[FloatArray, FloatArray]: ...
    def interpolate(
        self, points: Any, *, gradient: bool = False, threads: int = 0, progress: Progress = False
    ) -> FloatArray | tuple[FloatArray, FloatArray]:
        """Returns the distance at points of shape (..., 3), trilinear between nodes, and NaN outside the grid.

        The interpolated distance is not exact. Next to edges and bisectors, errors are up to about half the diagonal of
        a grid cell. :func:`closest_points` is exact.

        Parameters
        ----------
        points : array of shape (..., 3)
        gradient : bool
            True: also returns the gradient of the trilinear interpolant, of shape (..., 3).
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> field = blum.distance_field(blum.generate("sphere"), resolution=64)
        >>> round(float(field.interpolate([0.5, 0, 0])), 2)
        -0.5
        >>> distance, gradient = field.interpolate([0.52, 0.01, 0.01], gradient=True)
        >>> gradient.round(1).tolist()
        [1.0, 0.0, 0.0]
        """
        rows, shape = points_and_shape(points, "points")
        count = integer(threads, "threads")
        with reporting(progress) as report:
            if gradient:
                values, slopes = self._core.interpolate_with_gradient(rows, count, report)
                return values.reshape(shape), slopes.reshape((*shape, 3))
            only: FloatArray = self._core.interpolate(rows, count, report)
        return only.reshape(shape)

    def zero_surface(self, level: Real = 0.0, *, threads: int = 0, progress: Progress = False) -> Mesh:
        """Returns the surface at which the distance equals a level. Triangles face larger values.

        At edges and corners of the surface, vertices deviate from it by up to half the diagonal of a grid cell. An
        `InputWarning` is issued if the surface leaves the grid, or if the shape is only one node thick.

        Parameters
        ----------
        level : float
            Mesh units.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> field = blum.distance_field(blum.generate("torus"), resolution=32)
        >>> blum.topology(field.zero_surface()).betti
        (1, 1, 0)
        """
        at, count = number(level, "level"), integer(threads, "threads")
        with reporting(progress) as report:
            found = mesh_of_arrays(self._core.zero_surface(at, count, report))
        warn_all(self._core.level_warnings(at, count))
        return found

    def write(self, path: PathLike, *, progress: Progress = False) -> None:
        """Writes .nrrd (with separate files for sites and for order 2), .npz or .vti.

        Files appear under their names only when they are complete. If a field without sites replaces a field with sites
        as .nrrd, the file of the old sites is removed.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> field = blum.distance_field(blum.generate("box"), resolution=8)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     field.write(pathlib.Path(folder) / "box.nrrd")
        ...     sorted(path.name for path in pathlib.Path(folder).iterdir())
        ['box.nrrd', 'box.site.nrrd']
        """
        with reporting(progress) as report:
            arrays = None if self.mesh is None else self.mesh._arrays
            _core.write_field(Path(os.fspath(path)), self._core, arrays, self.source, self._space, 0, report)

    def to_pyvista(self) -> Any:
        """Returns a pyvista.ImageData with the point data `distance` and `site`; without PyVista, a dict of arrays.

        If the grid is not aligned with the coordinate axes, the result is a pyvista.StructuredGrid, which needs 24 more
        bytes per node. The reason is that several filters ignore the direction of ImageData, for example VTK's
        vtkContourFilter and PyVista's `contour`.

        A field of order 2 also has `distance2` and `site2`. The point data are copies, because VTK would hold the
        library's memory beyond the end of Python, and a leak would be reported.

        Examples
        --------
        >>> import blum
        >>> image = blum.distance_field(blum.generate("box"), resolution=8).to_pyvista()
        >>> type(image).__name__ in ("ImageData", "dict")
        True
        """
        try:
            import pyvista
        except ImportError:
            second = {} if self.distance2 is None else {"distance2": self.distance2, "site2": self.site2}
            return {
                "distance": self.distance,
                "site": self.site,
                **second,
                "origin": self.origin,
                "spacing": self.spacing,
                "direction": self.grid.direction,
            }
        out = _pyvista_nodes(pyvista, self.grid)
        out.point_data["distance"] = np.array(self.distance).ravel()
        if self.site is not None:
            out.point_data["site"] = np.array(self.site).ravel()
        if self.distance2 is not None:
            out.point_data["distance2"] = np.array(self.distance2).ravel()
        if self.site2 is not None:
            out.point_data["site2"] = np.array(self.site2).ravel()
        return out

    def __repr__(self) -> str:
        return f"Field({self.distance.shape}, {self.grid!r}, sign_rule={self.sign_rule!r})"


def _restored(
    distance: Any,
    grid: Grid,
    site: Any,
    distance2: Any,
    site2: Any,
    second: str | None,
    site_ids: str,
    band: float | None,
    sign_rule: str,
    sign_reason: str,
    mesh: Mesh | None,
    source: str,
    space: str,
) -> Field:
    core = _core.Field(distance, grid._spec, site, distance2, site2, second, site_ids, band, sign_rule, sign_reason)
    return Field._of(core, mesh, source, space)


def _pyvista_nodes(pyvista: Any, grid: Grid) -> Any:
    """Returns the nodes of a grid without data. They are points of space if the grid is not aligned with the axes."""
    if np.array_equal(grid.direction, np.eye(3)):
        return pyvista.ImageData(dimensions=grid.size, spacing=grid.spacing, origin=grid.origin)
    out = pyvista.StructuredGrid()
    out.dimensions = grid.size
    out.points = grid.positions().reshape(-1, 3)
    return out


def _objects_array(objects: Any) -> npt.NDArray[np.uint32] | None:
    """Returns the object of each vertex as numbers from 0. Any integers may identify objects."""
    if objects is None:
        return None
    labels = as_array(objects, "objects")
    if labels.ndim != 1 or labels.dtype.kind not in "iub":
        raise ValueError(f"objects must be integers of the shape (n,), not {labels.dtype} {labels.shape}")
    return np.ascontiguousarray(np.unique(labels, return_inverse=True)[1].reshape(-1), dtype=np.uint32)


@takes("FieldOptions")
def distance_field(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    resolution: Integer | None = None,
    spacing: Real | None = None,
    padding: Real = 0.1,
    bounds: Any = None,
    grid: Grid | None = None,
    weld: Real | None = None,
    objects: Any = None,
    threads: int = 0,
    device: str = "cpu",
    progress: Progress = False,
    **options: Unpack[FieldOptions],
) -> Field:
    """Computes the exact distance and closest site at every node of a grid. For order 2, also the second site.

    Parameters
    ----------
    mesh, triangles
        Vertices (n, 3) and triangles (m, 3). Or one argument: a :class:`Mesh`, a path, a pair (vertices, triangles), or
        an object of trimesh, Open3D, meshio or PyVista. Any soup is valid.
    resolution : int, optional
        Number of nodes along the longest side of the padded box around the mesh, 2 to 65536. Default: 256.
    spacing : float, optional
        Distance between neighbouring nodes, mesh units. Excludes `resolution`.
    padding : float
        Padding of the box on each side, as a fraction of its longest side.
    bounds : ((x0, y0, z0), (x1, y1, z1)), optional
        Box that the grid covers, without padding; see :meth:`Grid.within`.
    grid : Grid, optional
        The grid itself. Excludes `bounds`, `spacing` and `resolution`.
    weld : float, optional
        First merges vertices at most this far apart, mesh units. 0 merges equal vertices. Default: as for
        :func:`read_mesh`.
    objects : (n,) of integers, optional
        The object of each vertex, for ``order=2, second="other-object"``. Default: the connected parts of the mesh.
    threads : int
        0: all cores. Results do not depend on the number of threads.
    device : "cpu", "auto", "cuda" or "cuda:K"
        Device that computes distances. "auto" uses the first CUDA device if that works, otherwise the CPU.
    progress : bool or function
        True: a bar of tqdm. A function is called with (fraction, phase).
    **options

    Returns
    -------
    Field
        Distances are float32, and differ from the exact distances by at most 1e-6 of the diagonal of the box around
        mesh and grid.

    Raises
    ------
    InvalidMesh, InvalidGrid, InvalidOption (all ValueError), TypeError, OutOfMemory, DeviceError, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> field = blum.distance_field(blum.generate("box"), resolution=32)
    >>> field.distance.shape, field.sign_rule
    ((32, 32, 32), 'normals')
    >>> both = blum.distance_field(blum.generate("box"), resolution=32, order=2)
    >>> bool((both.distance2 >= abs(both.distance)).all())
    True
    """
    shape = as_mesh(mesh, triangles, weld=weld)
    nodes = grid_for(shape, grid, bounds, resolution, spacing, padding)
    with reporting(progress) as report:
        core = _core.distance_field(
            shape._arrays,
            nodes._spec,
            _objects_array(objects),
            dict(options),
            integer(threads, "threads"),
            device_name(device),
            report,
        )
    warn_all(core.warnings)
    return Field._of(core, shape, shape.source)


@takes("FieldOptions")
class FieldSolver(Rebuilt):
    """Fields of a deforming mesh on one grid, frame after frame.

    A pickle or copy holds the grid and the options.

    Parameters
    ----------
    grid : Grid
    device
        As for :func:`distance_field`.
    reuse : bool
        True: all frames are written into the same arrays, which is faster. So the next frame overwrites the last one.
        False: each frame has its own arrays.
    **options

    Examples
    --------
    >>> import numpy as np, blum
    >>> mesh = blum.generate("sphere", frequency=4)
    >>> solver = blum.FieldSolver(blum.Grid.around(mesh, resolution=16, padding=0.5))
    >>> smaller = solver.compute(mesh.vertices * 0.5, mesh.triangles)
    >>> bool(np.all(smaller.distance >= solver.compute(mesh).distance - 1e-6))
    True
    """

    _built = "_solver"

    def __init__(
        self,
        grid: Grid,
        *,
        device: str = "cpu",
        reuse: bool = False,
        **options: Unpack[FieldOptions],
    ) -> None:
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        self._options = dict(options)
        self._device = device_name(device)
        self._grid = grid
        self._reuse = bool(reuse)
        _ = self._solver  # so that wrong options are rejected now
        self._busy = threading.Lock()
        self._owner: int | None = None  # Thread that computes.

    @cached_property
    def _solver(self) -> _core.FieldSolver:
        return _core.FieldSolver(self._grid._spec, self._options, self._device)

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), "_busy": None, "_owner": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _busy=threading.Lock())

    def __repr__(self) -> str:
        return f"FieldSolver({self._grid!r}{', reuse=True' if self._reuse else ''})"

    def compute(
        self,
        mesh: MeshOrVertices,
        triangles: npt.ArrayLike | None = None,
        *,
        weld: Real | None = None,
        objects: Any = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> Field:
        """Returns the field of this frame's mesh. Threads that share a solver wait for each other.

        Parameters
        ----------
        mesh, triangles, weld, threads, progress
            As for :func:`distance_field`.
        objects : (n,) of integers, optional
            The object of each vertex in this frame, as for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> solver = blum.FieldSolver(blum.Grid((-1, -1, -1), 0.5, (5, 5, 5)))
        >>> solver.compute(blum.generate("box")).distance.shape
        (5, 5, 5)
        """
        shape = as_mesh(mesh, triangles, weld=weld)
        labels = _objects_array(objects)
        compute = self._solver.compute_in_place if self._reuse else self._solver.compute
        count = integer(threads, "threads")
        if self._owner == threading.get_ident():
            raise RuntimeError(
                "this solver is computing: its progress callback and signal handlers must not call compute()"
            )
        with self._busy, reporting(progress) as report:
            self._owner = threading.get_ident()
            try:
                self._solver.set_objects(labels)
                core = compute(shape._arrays, count, report)
            finally:
                self._owner = None
            found = Field._of(core, shape, shape.source)
        warn_all(core.warnings)
        return found


def selected_voxels(
    image: Any,
    *,
    label: Integer | None = None,
    threshold: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> npt.NDArray[np.bool_]:
    """Returns the mask [z, y, x] of the voxels of a label or of at least a threshold. Default: nonzero voxels.

    Parameters
    ----------
    image : (z, y, x) array, Image, path, or image of SimpleITK
    label : int, optional
        Selects the voxels of this value.
    threshold : float, optional
        Selects the voxels of at least this value. Excludes `label`.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum, numpy as np
    >>> blum.selected_voxels(np.array([[[0, 1, 2, 3]]]), threshold=2).tolist()
    [[[False, False, True, True]]]
    """
    chosen = None if label is None else label_of(label, "label")
    given = labelled(as_image(image), None if chosen is None else [chosen])
    with reporting(progress) as report:
        mask: npt.NDArray[np.uint8] = _core.selected_voxels(
            given._arrays,
            chosen,
            optional_number(threshold, "threshold"),
            integer(threads, "threads"),
            report,
        )
    return mask.view(np.bool_)


def voxel_topology(mask: Any, *, threads: int = 0, progress: Progress = False) -> VoxelTopology:
    """Returns the Betti numbers and the Euler characteristic of the voxels of a mask [z, y, x].

    Examples
    --------
    >>> import blum
    >>> blum.voxel_topology(blum.generate("tube_image", nodes=2).values).betti
    (1, 5, 0)
    """
    with reporting(progress) as report:
        found: VoxelTopology = _core.voxel_topology(mask_array(mask, "mask"), integer(threads, "threads"), report)
    return found


def read_field(path: PathLike) -> Field:
    """Reads a field from .nrrd (with the separate file of sites), .npz or .vti.

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "box.npz"
    ...     blum.distance_field(blum.generate("box"), resolution=8).write(path)
    ...     blum.read_field(path).distance.shape
    (8, 8, 8)
    """
    core = _core.read_field(existing_file(path))
    warn_all(core.warnings)
    return Field._of(core, None, source_name(path))
