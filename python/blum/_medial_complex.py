"""Medial axes as complexes.

Such axes have files and certificates.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
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
    float_list,
    float_rows,
    indices,
    integer,
    number,
    site_ids,
)
from ._axis_graph import mesh_of
from ._certificate import Claim, ShapeVerifier
from ._complex import core_arguments
from ._errors import InvalidOption
from ._extend import ExtendedAxis, extend_axis
from ._field import Field
from ._grid import Grid, grid_for
from ._image import Image
from ._medial_columns import ROLES, MedialColumns, NestedComplex
from ._mesh import Mesh, MeshOrVertices
from ._options import takes
from ._progress import Progress, reporting
from ._structs import Bounds, Certificate, CertificateOptions, ExtendOptions

__all__ = ["MedialComplex", "ball_union_field", "certify", "read_medial"]

EVERYTHING = {"radii": True, "footprints": True, "angles": True, "sites": True, "labels": True}


@dataclass(frozen=True)
class Origin:
    """Origin of a complex, for its certificate and its files."""

    shape: Mesh | Image | None = None
    label: int | None = None
    threshold: float | None = None
    theta: float | None = None
    lambda_: float | None = None
    spacing: float | None = None
    deviation: float | None = None
    solid_rule: str = ""
    grid: Grid | None = None
    source: str = ""
    weld: float | None = None
    smooth: int | None = None
    fitted: bool = False
    site_ids: str = "features"
    version: str = ""  #: Version of the Blum that wrote the file from which the complex was read.


# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex


class MedialComplex(MedialColumns):
    """Medial axis as vertices, edges and triangles. Arrays are read-only views of the library's memory.

    :meth:`MedialAxis.simplify` and :func:`read_medial` return it. It can also be made from arrays, of which only the
    vertices are required.

    Parameters
    ----------
    vertices : (n, 3) array
    radius : (n,) array, optional
        Distance from each vertex to the surface, mesh units.
    footprints : (n, 2, 3) array, optional
    sites : (n, 2) array of integers, optional
        -1 if unknown.
    separation_angle : (n,) array, optional
        Degrees.
    role : (n,) array of integers, optional
        Indices into ROLES.
    edges : (e, 2) array of integers, optional
    edge_angle, edge_role : (e,) arrays, optional
    triangles : (m, 3) array of integers, optional
    triangle_angle, triangle_sheet : (m,) arrays, optional

    Examples
    --------
    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=32).simplify(60)
    >>> axis.counts["sheets"] > 0, axis.certificate.holds
    (True, True)
    """

    def __init__(
        self,
        vertices: Any,
        *,
        radius: Any = None,
        footprints: Any = None,
        sites: Any = None,
        separation_angle: Any = None,
        role: Any = None,
        edges: Any = (),
        edge_angle: Any = None,
        edge_role: Any = None,
        triangles: Any = (),
        triangle_angle: Any = None,
        triangle_sheet: Any = None,
    ) -> None:
        positions = float_rows(vertices, "vertices")
        count = len(positions)
        lines = indices(edges, "edges", 2, count)
        faces = indices(triangles, "triangles", 3, count)
        feet = None if footprints is None else _footprint_rows(footprints, count)
        names = None if sites is None else site_ids(sites, "sites", 2)
        _check_length("sites", names, count)
        core = _core.Complex(
            positions,
            lines,
            faces,
            _given(
                radius=_numbers(radius, "radius", count),
                footprint_0=None if feet is None else feet[:, 0],
                footprint_1=None if feet is None else feet[:, 1],
                site_0=None if names is None else names[:, 0],
                site_1=None if names is None else names[:, 1],
                separation_angle=_numbers(separation_angle, "separation_angle", count),
                role=_numbers_below(len(ROLES), role, "role", count),
            ),
            _given(
                separation_angle=_numbers(edge_angle, "edge_angle", len(lines), np.float32),
                role=_numbers_below(len(ROLES), edge_role, "edge_role", len(lines)),
            ),
            _given(
                separation_angle=_numbers(triangle_angle, "triangle_angle", len(faces), np.float32),
                sheet=_numbers_below(len(faces), triangle_sheet, "triangle_sheet", len(faces)),
            ),
        )
        problem = _core.medial_problem(core)
        if problem:
            raise InvalidOption(problem)
        self._take(
            core,
            {
                "radii": radius is not None,
                "footprints": footprints is not None,
                "angles": separation_angle is not None,
                "sites": sites is not None,
                "labels": "role" in core.vertex_columns
                and "role" in core.edge_columns
                and "sheet" in core.triangle_columns,
            },
            Origin(),
        )

    @classmethod
    def _of(
        cls, core: _CoreComplex, has: dict[str, bool], origin: Origin, nested: NestedComplex | None = None
    ) -> MedialComplex:
        out = cls.__new__(cls)
        out._take(core, has, origin)
        out.nested = nested
        return out

    def _take(self, core: _CoreComplex, has: dict[str, bool], origin: Origin) -> None:
        self._core = core
        self._origin = origin
        #: Attributes that the complex has: radii, footprints, angles, sites, labels (roles and sheets).
        self.has = dict(has)
        #: Axes of all angles, if the axis was read from a file that holds them (:meth:`MedialAxis.write`).
        self.nested: NestedComplex | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (core_arguments(self), self.has, self._origin, self.nested)

    @property
    def counts(self) -> dict[str, Any]:
        """Numbers of vertices, triangles, sheets, curve edges, rim edges, seam edges and junctions.

        Without roles and sheets, `sheets`, `rim_edges`, `seam_edges` and `junctions` are None. `curve_edges` then
        counts the edges without triangles.
        """
        counts: dict[str, int | None] = dict(_core.medial_counts(self._core))
        if not self.has["labels"]:
            counts |= dict.fromkeys(("sheets", "rim_edges", "seam_edges", "junctions"))
        return counts

    @property
    def theta(self) -> float | None:
        """Threshold of the separation angle (theta), degrees. None if unknown."""
        return self._origin.theta

    @property
    def grid(self) -> Grid | None:
        """Grid of the voxel centres: of the first body of a mesh, or of the image. None if unknown."""
        return self._origin.grid

    @property
    def deviation(self) -> float | None:
        """Bound on the distance from the axis with all vertices, mesh units. None if no vertices were removed."""
        return self._origin.deviation

    @cached_property
    def certificate(self) -> Certificate:
        """Certificate against the shape that the axis was made from; see :func:`certify`."""
        shape = self._origin.shape
        if shape is None:
            raise InvalidOption(
                "the shape that this axis was made from is not known here: use blum.certify(axis, shape)"
            )
        verifier = ShapeVerifier(shape)
        return verifier.certified(claim_of(self), label=self._origin.label, threshold=self._origin.threshold)

    def prune_sheets(self, theta: Real, *, threads: int = 0, progress: Progress = False) -> MedialComplex:
        """Returns the axis without the sheets whose largest separation angle is at most theta.

        Sheets are removed as a whole, the smallest angle first. A sheet stays if its removal would change the topology.

        Parameters
        ----------
        theta : float
            Degrees.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box", size_x=2), resolution=16).simplify(20)
        >>> axis.sheet_count, axis.prune_sheets(90).sheet_count
        (13, 1)
        """
        with reporting(progress) as report:
            angle = number(theta, "theta")
            core = _core.prune_sheets(self._core, angle, integer(threads, "threads"), report)
        own = self._origin.theta
        return MedialComplex._of(core, self.has, replace(self._origin, theta=None if own is None else max(own, angle)))

    def decimate(self, tolerance: Real | None = None, *, threads: int = 0, progress: Progress = False) -> MedialComplex:
        """Returns the same axis with fewer vertices and triangles, as `blum medial` writes it.

        Sheets, seams, rims and curves move by at most the tolerance. Radii are interpolated linearly between vertices,
        and also change by at most the tolerance. :attr:`deviation` contains the resulting bound. Remaining vertices
        keep their positions and attributes. The topology and the connections of sheets, seams and curves stay the same.

        Parameters
        ----------
        tolerance : float, optional
            Mesh units, >= 0. Default: a quarter of a voxel.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=64).simplify(60)
        >>> lean = axis.decimate()
        >>> len(lean.triangles) < len(axis.triangles) / 20, lean.certificate.holds
        (True, True)
        """
        if tolerance is None:
            if self._origin.spacing is None:
                raise InvalidOption("the voxel size of this axis is not known: pass a tolerance, in mesh units")
            tolerance = 0.25 * self._origin.spacing
        with reporting(progress) as report:
            most = number(tolerance, "tolerance")
            core, deviation = _core.decimate(self._core, most, integer(threads, "threads"), report)
        before = self._origin.deviation or 0.0
        return MedialComplex._of(core, self.has, replace(self._origin, deviation=before + deviation))

    def with_patches(
        self,
        patch_angle: Real = 30.0,
        *,
        patch_fit: Real | None = None,
        mesh: MeshOrVertices | None = None,
        triangles: npt.ArrayLike | None = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> MedialComplex:
        """Returns this axis with the patches on both sides of each triangle, as columns `patch_a` and `patch_b`.

        Patches are numbered as by :meth:`VoronoiComplex.patches` for the same mesh and arguments. `patch_a` is the
        smaller number; inside a patch, both numbers are equal. The column `patch_sheet` contains the number of the
        sheet between the two patches, or -1 inside a patch. `graph(of_patches=True)` returns the graph of these sheets.

        Parameters
        ----------
        patch_angle, patch_fit
            As for :meth:`VoronoiComplex.patches`.
        mesh, triangles
            The mesh of the axis, which must be closed. Default: the mesh from which the axis was made. For an axis from
            a file, the mesh must be given.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60).with_patches()
        >>> [name for name in ("patch_a", "patch_b", "patch_sheet") if name in axis.triangle_columns]
        ['patch_a', 'patch_b', 'patch_sheet']
        """
        own = mesh_of(self, mesh, triangles)
        if own is None:
            raise InvalidOption("patches are those of a mesh, which is not known here: with_patches(mesh=...)")
        options = {"patch_angle": number(patch_angle, "patch_angle")}
        if patch_fit is not None:
            options["patch_fit"] = number(patch_fit, "patch_fit")
        with reporting(progress) as report:
            core = _core.with_axis_patches(self._core, own._arrays, options, integer(threads, "threads"), report)
        return MedialComplex._of(core, self.has, self._origin)

    @takes("ExtendOptions")
    def extend(
        self,
        mesh: MeshOrVertices | None = None,
        triangles: npt.ArrayLike | None = None,
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[ExtendOptions],
    ) -> ExtendedAxis:
        """Returns the sheets, extended from their rims to the surface, for shell elements; see :func:`extend_axis`.

        Parameters
        ----------
        mesh, triangles
            The mesh of the axis. Default: the mesh from which the axis was made. For an axis from a file, the mesh must
            be given.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
        >>> blum.medial_axis(plate, resolution=24).simplify(120).extend().report.not_reached
        0
        """
        return extend_axis(self, mesh, triangles, threads=threads, progress=progress, **options)

    def reconstruct(
        self,
        *,
        resolution: Integer | None = None,
        spacing: Real | None = None,
        padding: Real = 0.1,
        bounds: Any = None,
        grid: Grid | None = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> Field:
        """Returns the union of the medial balls as a signed field. Its `.zero_surface()` is the boundary of the union.

        For a decimated axis, balls between vertices are interpolated linearly, at the resolution of the grid.

        Parameters
        ----------
        resolution, spacing, padding, bounds, grid, threads, progress
            As for :func:`distance_field`, around the balls.

        Examples
        --------
        >>> import blum
        >>> ball = blum.medial_axis(blum.generate("sphere"), resolution=32).simplify(60).reconstruct(resolution=32)
        >>> blum.topology(ball.zero_surface()).betti
        (1, 0, 0)
        """
        box: Bounds | None = None
        if grid is None and bounds is None:
            if len(self.vertices) == 0:
                raise InvalidOption("the axis has no vertices, so it has no balls")
            lower = (self.vertices - self.radius[:, None]).min(axis=0)
            upper = (self.vertices + self.radius[:, None]).max(axis=0)
            box = (tuple(map(float, lower)), tuple(map(float, upper)))  # type: ignore[assignment]
        wanted = grid_for(box, grid, bounds, resolution, spacing, padding)
        centres, radii = self.vertices, self.radius
        if self.deviation is not None:
            centres, radii = _core.sample_axis(self._core, min(wanted.spacing))
        return ball_union_field(centres, radii, wanted, threads=threads, progress=progress)

    def write(self, path: PathLike) -> None:
        """Writes .vtp, .ply, .obj, .ma or .npz. The file appears under its name only when it is complete.

        .npz files also hold the axes of all angles, `nested`, if they exist.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     axis.write(pathlib.Path(folder) / "box.vtp")
        ...     (pathlib.Path(folder) / "box.vtp").stat().st_size > 1000
        True
        """
        is_npz = os.fspath(path).lower().endswith(".npz")
        write_complex(path, self, self.nested if is_npz else None)

    def to_trimesh(self) -> Any:
        """Returns a trimesh.Trimesh with vertex attributes; without trimesh, the pair (vertices, triangles).

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
        >>> type(axis.to_trimesh()).__name__ in ("Trimesh", "tuple")
        True
        """
        vertices, triangles = np.ascontiguousarray(self.vertices), np.ascontiguousarray(self.triangles)
        try:
            import trimesh
        except ImportError:
            return vertices, triangles
        return trimesh.Trimesh(
            vertices,
            triangles,
            process=False,
            vertex_attributes={
                name: np.array(self.vertex_columns[name])
                for name in ("radius", "separation_angle")
                if name in self.vertex_columns
            },
        )

    def to_pyvista(self) -> Any:
        """Returns a pyvista.PolyData of triangles and edges. Without PyVista, returns a dict of arrays.

        The result has all columns of vertices, and the angles, roles and sheets of its cells (edges and triangles).
        Cell data list the edges before the triangles, as PolyData does. `sheet` and `role` are -1 for cells without a
        sheet or role.

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
        >>> type(axis.to_pyvista()).__name__ in ("PolyData", "dict")
        True
        """
        try:
            import pyvista
        except ImportError:
            cells = {"vertices": self.vertices, "edges": self.edges, "triangles": self.triangles}
            named = {name: self.vertex_columns.get(name) for name in ("radius", "separation_angle", "role")}
            named["triangle_sheet"] = self.triangle_columns.get("sheet")
            return {**cells, **{name: column for name, column in named.items() if column is not None}}
        from ._mesh import _padded

        out = pyvista.PolyData(
            np.array(self.vertices),  # A copy, because VTK would hold the library's memory beyond Python's end.
            faces=_padded(np.ascontiguousarray(self.triangles)),
            lines=_padded(np.ascontiguousarray(self.edges)),
        )
        for name, column in self.vertex_columns.items():
            out.point_data[name] = np.array(column)
        lines, faces = len(self.edges), len(self.triangles)
        if "separation_angle" in self.edge_columns and "separation_angle" in self.triangle_columns:
            out.cell_data["separation_angle"] = np.concatenate([self.edge_angle, self.triangle_angle])
        if "role" in self.edge_columns:
            roles = self.edge_role.astype(np.int16)
            out.cell_data["role"] = np.concatenate([roles, np.full(faces, -1, dtype=np.int16)])
        if "sheet" in self.triangle_columns:
            out.cell_data["sheet"] = np.concatenate([np.full(lines, -1, dtype=np.int32), self.triangle_sheet])
        return out

    def __repr__(self) -> str:
        counts = self.counts
        stated = [name for name in ("vertices", "triangles", "sheets") if counts[name] is not None]
        parts = ", ".join(f"{counts[name]:,} {name}" for name in stated)
        return f"MedialComplex({parts}{'' if self.theta is None else f', theta={self.theta:g}'})"


def _restored(
    arguments: tuple[Any, ...], has: dict[str, bool], origin: Origin, nested: NestedComplex | None
) -> MedialComplex:
    return MedialComplex._of(_core.Complex(*arguments), has, origin, nested)


def claim_of(axis: MedialComplex) -> Claim:
    """Returns an axis in the form that certification needs."""
    if not isinstance(axis, MedialComplex):
        raise TypeError(f"axis must be a blum.MedialComplex, not {type(axis).__name__}")
    origin = axis._origin
    return Claim(
        axis,
        axis.has,
        axis.grid,
        origin.label,
        origin.threshold,
        origin.weld,
        origin.solid_rule,
        origin.site_ids,
        origin.version,
        origin.theta,
        origin.lambda_,
        origin.spacing,
        origin.deviation,
        origin.smooth,
        origin.fitted,
    )


def _given(**columns: npt.NDArray[Any] | None) -> dict[str, npt.NDArray[Any]]:
    """Returns the columns that exist."""
    return {name: np.ascontiguousarray(column) for name, column in columns.items() if column is not None}


def _check_length(name: str, array: npt.NDArray[Any] | None, wanted: int) -> None:
    """Raises InvalidOption if a column has another number of rows."""
    if array is not None and len(array) != wanted:
        raise InvalidOption(f"{name} has {len(array)} entries, but must have {wanted}")


def _numbers(value: Any, name: str, count: int, dtype: type = np.float64) -> npt.NDArray[Any] | None:
    """Returns a column of real numbers. Without a value: None, or an empty column for no rows."""
    if value is None:
        return None if count > 0 else np.zeros(0, dtype)
    array: npt.NDArray[Any] = float_list(value, name).astype(dtype, copy=False)
    _check_length(name, array, count)
    return array


def _numbers_below(limit: int, value: Any, name: str, count: int) -> IntArray | None:
    """Returns a column of integers below a limit. Without a value: None, or an empty column for no rows."""
    if value is None:
        return None if count > 0 else np.zeros(0, np.int32)
    array = indices(value, name, None, limit)
    _check_length(name, array, count)
    return array


def _footprint_rows(value: Any, count: int) -> FloatArray:
    """Returns footprints as (n, 2, 3)."""
    array = as_array(value, "footprints")
    if array.ndim != 3 or array.shape[1:] != (2, 3):
        raise ValueError(f"footprints has the shape {array.shape}, but must have (n, 2, 3)")
    _check_length("footprints", array, count)
    return float_rows(array.reshape(-1, 3), "footprints").reshape(-1, 2, 3)


@takes("CertificateOptions")
def certify(
    axis: MedialComplex,
    shape: MeshOrVertices | Image,
    triangles: npt.ArrayLike | None = None,
    *,
    label: Integer | None = None,
    threshold: Real | None = None,
    grid: Grid | None = None,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **checks: Unpack[CertificateOptions],
) -> Certificate:
    """Checks an axis against the mesh or image whose solid it claims to have, and returns a certificate.

    Betti numbers are compared body by body. For polyhedra, loops of the axis must run around the tunnels of their body,
    and closed surfaces around its voids. Linking and winding numbers decide this (``homology``). Vertices, radii,
    footprints, sites and angles are checked with exact searches. Edges must lie in the solid. Points of sheets and
    curves must be midway between two walls. Parts with angles well above theta must not be missing; see
    :class:`MedialCheck`. Roles and sheets must fit the triangles; see :class:`LabelCheck`. Angles of triangles and
    edges must fit their positions; see :class:`AngleCheck`.

    The claims of the axis, or of its file, are checked as `blum verify` does. These claims are the rule of the solid,
    the sides of the voxels, and the attributes of the axis.

    The checking code is independent of the construction, except for a list of shared parts
    (docs/decisions/0007-certificate.md).

    Parameters
    ----------
    axis : MedialComplex
    shape, triangles
        The mesh, as for :func:`distance_field`, or the image, as for :func:`distance_transform`.
    label, threshold
        Images: voxels of the solid. Default: the voxels that the axis records; without a record, the nonzero voxels.
    grid : Grid, optional
        Meshes that do not bound a polyhedron: grid of the centres of the solid's voxels. Default: the grid that the
        axis records.
    weld : float, optional
        Meshes: as for :func:`distance_field`. Default for a path: the value in the file of the axis.
    threads, progress
        As for :func:`distance_field`.
    **options
        By default, a check runs if the axis has the attribute that this check needs.

    :class:`AxisVerifier` reads the shape once for several axes.

    Examples
    --------
    >>> import blum
    >>> torus = blum.generate("torus")
    >>> axis = blum.medial_axis(torus, resolution=32)
    >>> print(blum.certify(axis.simplify(60), torus))
    certified against the polyhedron: components, tunnels, voids (1, 1, 0)
    """
    return ShapeVerifier(shape, triangles, weld).certified(
        claim_of(axis), label=label, threshold=threshold, grid=grid, threads=threads, progress=progress, **checks
    )


def ball_union_field(centres: Any, radii: Any, grid: Grid, *, threads: int = 0, progress: Progress = False) -> Field:
    """Returns the smallest signed distance to any of the balls at every node of a grid, negative inside.

    Outside the union, values are distances to the union. Inside, their magnitudes are lower bounds of the distance to
    its boundary.

    Parameters
    ----------
    centres : (n, 3) array
        At least one, mesh units.
    radii : (n,) array
        Mesh units, >= 0.
    grid : Grid
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> grid = blum.Grid((-1, -1, -1), 0.5, (5, 5, 5))
    >>> blum.ball_union_field([[0, 0, 0]], [0.5], grid).distance[2, 2].tolist()
    [0.5, 0.0, -0.5, 0.0, 0.5]
    """
    if not isinstance(grid, Grid):
        raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
    with reporting(progress) as report:
        return Field._of(
            _core.ball_union_field(
                float_rows(centres, "centres"),
                float_list(radii, "radii"),
                grid._spec,
                integer(threads, "threads"),
                report,
            )
        )


def write_complex(path: PathLike, complex: MedialComplex, nested: NestedComplex | None) -> None:
    """Writes a medial axis with its metadata, and with the axes of all angles if given."""
    stated = {name: value for name, value in vars(complex._origin).items() if name not in ("shape", "version")}
    inner, least = (None, 0.0) if nested is None else (nested._core, nested.least_theta)
    _core.write_medial(Path(os.fspath(path)), complex._core, inner, least, stated)


def read_medial(path: PathLike) -> MedialComplex:
    """Reads a medial axis from .vtp, .ply, .obj, .ma or .npz.

    `.has` lists the attributes that the file holds. `.nested` contains the axes of all angles if the file holds them.

    Raises
    ------
    FileNotFoundError, FileError, FormatError, InvalidOption

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     axis.write(pathlib.Path(folder) / "box.ma")
    ...     again = blum.read_medial(pathlib.Path(folder) / "box.ma")
    >>> again.has["radii"], again.has["footprints"]
    (True, False)
    """
    core, nested, least_theta, metadata, has = _core.read_medial(existing_file(path))
    inner = None if nested is None else NestedComplex(nested, least_theta)
    return MedialComplex._of(core, has, Origin(None, **metadata), inner)
