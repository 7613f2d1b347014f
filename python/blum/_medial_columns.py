"""Columns of medial axes.

Columns are arrays. A nested complex holds the axes of all thresholds theta.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, PathLike, Real, number
from ._axis_graph import axis_graph, write_graph
from ._complex import Complex, core_arguments
from ._errors import InvalidOption
from ._methods import Shown
from ._options import takes
from ._progress import Progress
from ._structs import AxisGraph, AxisGraphOptions

__all__ = ["ROLES", "NestedComplex", "Present"]

#: Names of the roles. `MedialComplex.role` and `edge_role` hold indices into them.
ROLES: tuple[str, ...] = _core.enums["MedialRole"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex


class MedialColumns(Complex):
    """Columns of a medial axis as properties, for axes of one angle and of all angles.

    A property raises :class:`InvalidOption` if the axis lacks its column, for example because the file of the axis does
    not hold that column.

    Examples
    --------
    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
    >>> axis.radius.shape == axis.role.shape == (len(axis.vertices),)
    True
    """

    def _needed(self, kind: str, name: str) -> npt.NDArray[Any]:
        """Returns a column of "vertices", "edges" or "triangles"."""
        of_kind = {"vertices": self.vertex_columns, "edges": self.edge_columns, "triangles": self.triangle_columns}
        column = of_kind[kind].get(name)
        if column is None:
            raise InvalidOption(_core.missing_medial_column(kind, name))
        return column

    @takes("AxisGraphOptions")
    def graph(
        self,
        mesh: Any = None,
        triangles: Any = None,
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[AxisGraphOptions],
    ) -> AxisGraph:
        """Returns the sheets, seams, curves and junctions, with areas, lengths and thicknesses; see :func:`axis_graph`.

        For axes of all theta, the graph is that of the axis at `least_theta`.

        Parameters
        ----------
        mesh, triangles
            The mesh of the axis. Default: the mesh from which the axis was made. For an axis from a file, no mesh is
            known.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
        >>> len(blum.medial_axis(plate, resolution=24).simplify(120).graph().sheets)
        1
        """
        return axis_graph(self, mesh, triangles, threads=threads, progress=progress, **options)

    @takes("AxisGraphOptions")
    def write_graph(
        self, path: PathLike, mesh: Any = None, triangles: Any = None, **options: Unpack[AxisGraphOptions]
    ) -> None:
        """Writes the result of :meth:`graph` as .json or .graphml.

        The file appears under its name only when it is complete.

        Parameters
        ----------
        path : path
        mesh, triangles
            As for :meth:`graph`.
        **options

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     axis.write_graph(pathlib.Path(folder) / "box.json")
        ...     "sheets" in (pathlib.Path(folder) / "box.json").read_text()
        True
        """
        write_graph(path, self, mesh, triangles, options)

    @property
    def radius(self) -> FloatArray:
        """Exact distance from each vertex to the surface: (n,), mesh units."""
        found: FloatArray = self._needed("vertices", "radius")
        return found

    @cached_property
    def footprints(self) -> FloatArray:
        """Closest point of the surface, and closest point of the opposite wall: (n, 2, 3). A copy of two columns."""
        return _stacked(self._needed("vertices", "footprint_0"), self._needed("vertices", "footprint_1"))

    @cached_property
    def sites(self) -> IntArray:
        """Sites of the mesh (:class:`Sites`), or flat indices of voxels, that contain the footprints: (n, 2).

        The array is a copy of two columns.
        """
        return _stacked(self._needed("vertices", "site_0"), self._needed("vertices", "site_1"))

    @property
    def separation_angle(self) -> FloatArray:
        """Angle between the footprints, seen from the vertex: (n,), degrees."""
        found: FloatArray = self._needed("vertices", "separation_angle")
        return found

    @property
    def role(self) -> IntArray:
        """Role of each vertex, an index into ROLES: (n,)."""
        found: IntArray = self._needed("vertices", "role")
        return found

    @property
    def edge_angle(self) -> npt.NDArray[np.float32]:
        """Separation angle of each edge: (e,), degrees. 0 if the edge exists only to keep the homotopy type."""
        found: npt.NDArray[np.float32] = self._needed("edges", "separation_angle")
        return found

    @property
    def edge_role(self) -> IntArray:
        """Role of each edge (rim, seam or curve), an index into ROLES: (e,)."""
        found: IntArray = self._needed("edges", "role")
        return found

    @property
    def triangle_angle(self) -> npt.NDArray[np.float32]:
        """Separation angle of each triangle: (m,), degrees. 0 if the triangle exists only to keep the homotopy type."""
        found: npt.NDArray[np.float32] = self._needed("triangles", "separation_angle")
        return found

    @property
    def triangle_sheet(self) -> IntArray:
        """Sheet of each triangle: (m,), 0 to sheet_count - 1.

        For a mesh, the faces on both sides of a sheet determine its number. The position of the mesh does not change
        the number. All grids that show the same sheets give the same numbers.
        """
        found: IntArray = self._needed("triangles", "sheet")
        return found

    @property
    def sheet_count(self) -> int:
        """Number of sheets."""
        return int(_core.sheet_count(self._core))


@dataclass(frozen=True, eq=False, repr=False)
class Present(Shown):
    """Masks of the vertices, edges and triangles of a :class:`NestedComplex`: True if the element exists at one theta.

    Examples
    --------
    >>> import blum
    >>> nested = blum.medial_axis(blum.generate("box"), resolution=16).nested()
    >>> present = nested.at(80)
    >>> present.triangles.shape == (len(nested.triangles),)
    True
    """

    vertices: npt.NDArray[np.bool_]  #: Shape (n,).
    edges: npt.NDArray[np.bool_]  #: Shape (e,).
    triangles: npt.NDArray[np.bool_]  #: Shape (m,).


class NestedComplex(MedialColumns):
    """Medial axes of one solid for all theta from `least_theta` to 180 degrees, as sets of points.

    :meth:`MedialAxis.nested` returns it. Use it to show the axis of any theta without further computation. Vertices
    with the same position are merged, and parts without extent are left out. So the topology of this complex may differ
    from that of the solid. Roles of vertices and sheets are those at `least_theta`. An edge with several roles is
    listed several times.

    Examples
    --------
    >>> import blum
    >>> nested = blum.medial_axis(blum.generate("box"), resolution=32).nested()
    >>> at = nested.at(80)
    >>> nested.triangles[at.triangles].shape[0] <= len(nested.triangles)
    True
    """

    def __init__(self, core: _CoreComplex, least_theta: float) -> None:
        self._core = core
        #: Least angle, degrees.
        self.least_theta = least_theta

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored_nested, (core_arguments(self), self.least_theta)

    @property
    def vertex_until(self) -> npt.NDArray[np.float32]:
        """Upper limit of theta for each vertex: (n,), degrees. A vertex exists if theta is below its limit."""
        found: npt.NDArray[np.float32] = self.vertex_columns["until"]
        return found

    @property
    def edge_from(self) -> npt.NDArray[np.float32]:
        """Least theta for the role of each edge: (e,), degrees. The role exists if edge_from <= theta < edge_until."""
        found: npt.NDArray[np.float32] = self.edge_columns["from"]
        return found

    @property
    def edge_until(self) -> npt.NDArray[np.float32]:
        """Upper limit of theta for the role of each edge: (e,), degrees. See edge_from."""
        found: npt.NDArray[np.float32] = self.edge_columns["until"]
        return found

    @property
    def triangle_until(self) -> npt.NDArray[np.float32]:
        """Upper limit of theta for each triangle: (m,), degrees. A triangle exists if theta is below its limit."""
        found: npt.NDArray[np.float32] = self.triangle_columns["until"]
        return found

    def at(self, theta: Real) -> Present:
        """Returns the parts that exist at one theta. These parts cover the result of simplify(theta).

        Parameters
        ----------
        theta : float
            Degrees, `least_theta` to 180.

        Examples
        --------
        >>> import blum
        >>> nested = blum.medial_axis(blum.generate("box"), resolution=16).nested()
        >>> bool(nested.at(60).triangles.sum() >= nested.at(120).triangles.sum())
        True
        """
        angle = number(theta, "theta")
        if not self.least_theta <= angle <= 180:
            raise InvalidOption(f"theta is {angle:g}, but must be {self.least_theta:g} to 180")
        return Present(
            self.vertex_until > angle,
            (self.edge_from <= angle) & (self.edge_until > angle),
            self.triangle_until > angle,
        )

    def __repr__(self) -> str:
        return (
            f"NestedComplex({len(self.vertices):,} vertices, {len(self.triangles):,} triangles, "
            f"theta >= {self.least_theta:g})"
        )


def _restored_nested(arguments: tuple[Any, ...], least_theta: float) -> NestedComplex:
    return NestedComplex(_core.Complex(*arguments), least_theta)


def _stacked(a: npt.NDArray[Any], b: npt.NDArray[Any]) -> npt.NDArray[Any]:
    """Returns two columns as one read-only array."""
    both = np.stack([a, b], axis=1)
    both.flags.writeable = False
    return both
