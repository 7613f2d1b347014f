"""The columns of medial axes as arrays, and the axes of all angles in one complex."""

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
from ._options import takes
from ._progress import Progress
from ._structs import AxisGraph, AxisGraphOptions

#: What the numbers in `MedialComplex.role` and `edge_role` stand for.
ROLES: tuple[str, ...] = _core.enums["MedialRole"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex


class MedialColumns(Complex):
    """What axes of one angle and of all have in common: the columns of a medial axis as properties. One that is
    missing, as in files that do not hold it, is an :class:`InvalidOption` that says so."""

    def _needed(self, kind: str, name: str) -> npt.NDArray[Any]:
        """A column of "vertices", "edges" or "triangles"."""
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
        """Its sheets, seams, curves and junctions, with areas, lengths and thicknesses; see :func:`axis_graph`. Of axes
        of all angles those at the least one.

        Parameters
        ----------
        mesh, triangles
            That the axis was made of. Default: the one that is known, where it was made here.
        threads, progress
            As for :func:`distance_field`.
        **options
        """
        return axis_graph(self, mesh, triangles, threads=threads, progress=progress, **options)

    @takes("AxisGraphOptions")
    def write_graph(
        self, path: PathLike, mesh: Any = None, triangles: Any = None, **options: Unpack[AxisGraphOptions]
    ) -> None:
        """Writes what :meth:`graph` tells as .json, or as .graphml; the file appears complete or not at all.

        Parameters
        ----------
        path : path
        mesh, triangles
            As for :meth:`graph`.
        **options
        """
        write_graph(path, self, mesh, triangles, options)

    @property
    def radius(self) -> FloatArray:
        """(n,): exact distance from each vertex to the surface, mesh units."""
        found: FloatArray = self._needed("vertices", "radius")
        return found

    @cached_property
    def footprints(self) -> FloatArray:
        """(n, 2, 3): the closest point of the surface, and that of the other wall; a copy of two columns."""
        return _stacked(self._needed("vertices", "footprint_0"), self._needed("vertices", "footprint_1"))

    @cached_property
    def sites(self) -> IntArray:
        """(n, 2): the sites that the footprints lie on: of the mesh (:class:`Sites`), or flat indices of voxels; a copy
        of two columns."""
        return _stacked(self._needed("vertices", "site_0"), self._needed("vertices", "site_1"))

    @property
    def separation_angle(self) -> FloatArray:
        """(n,): between the footprints as the vertex sees them, degrees."""
        found: FloatArray = self._needed("vertices", "separation_angle")
        return found

    @property
    def role(self) -> IntArray:
        """(n,): see ROLES."""
        found: IntArray = self._needed("vertices", "role")
        return found

    @property
    def edge_angle(self) -> npt.NDArray[np.float32]:
        """(e,): degrees; 0 where only homotopy keeps an edge."""
        found: npt.NDArray[np.float32] = self._needed("edges", "separation_angle")
        return found

    @property
    def edge_role(self) -> IntArray:
        """(e,): rim, seam or curve, see ROLES."""
        found: IntArray = self._needed("edges", "role")
        return found

    @property
    def triangle_angle(self) -> npt.NDArray[np.float32]:
        """(m,): degrees; 0 where only homotopy keeps a triangle."""
        found: npt.NDArray[np.float32] = self._needed("triangles", "separation_angle")
        return found

    @property
    def triangle_sheet(self) -> IntArray:
        """(m,): the sheet that each triangle is part of, 0 to sheet_count - 1.

        Of a mesh, the same sheet has the same number wherever the part lies and however fine the grid is, as long as
        that shows the same sheets: numbers follow from the faces that sheets lie between.
        """
        found: IntArray = self._needed("triangles", "sheet")
        return found

    @property
    def sheet_count(self) -> int:
        """How many sheets there are."""
        return int(_core.sheet_count(self._core))


@dataclass(frozen=True, eq=False)
class Present:
    """What of a :class:`NestedComplex` is there at an angle: True or False for each."""

    vertices: npt.NDArray[np.bool_]  #: (n,)
    edges: npt.NDArray[np.bool_]  #: (e,)
    triangles: npt.NDArray[np.bool_]  #: (m,)


class NestedComplex(MedialColumns):
    """The medial axes of one solid at all angles from `least_theta` on, as sets of points: to show, and to cut at any
    angle without computing anything again. Made by :meth:`MedialAxis.nested`.

    Vertices at the same place are one, and pieces without extent are left out: its topology need not be that of the
    solid. Roles and sheets are those at the least angle; an edge that has several roles is there several times.

    >>> import blum
    >>> nested = blum.medial_axis(blum.generate("box"), resolution=32).nested()
    >>> at = nested.at(80)
    >>> nested.triangles[at.triangles].shape[0] <= len(nested.triangles)
    True
    """

    def __init__(self, core: _CoreComplex, least_theta: float) -> None:
        self._core = core
        #: Degrees.
        self.least_theta = least_theta

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored_nested, (core_arguments(self), self.least_theta)

    @property
    def vertex_until(self) -> npt.NDArray[np.float32]:
        """(n,): degrees; a vertex is there where theta is less."""
        found: npt.NDArray[np.float32] = self.vertex_columns["until"]
        return found

    @property
    def edge_from(self) -> npt.NDArray[np.float32]:
        """(e,): degrees; an edge has its role where edge_from <= theta < edge_until."""
        found: npt.NDArray[np.float32] = self.edge_columns["from"]
        return found

    @property
    def edge_until(self) -> npt.NDArray[np.float32]:
        """(e,): degrees."""
        found: npt.NDArray[np.float32] = self.edge_columns["until"]
        return found

    @property
    def triangle_until(self) -> npt.NDArray[np.float32]:
        """(m,): degrees; a triangle is there where theta is less."""
        found: npt.NDArray[np.float32] = self.triangle_columns["until"]
        return found

    def at(self, theta: Real) -> Present:
        """What is there at an angle, degrees, `least_theta` to 180: it covers what simplify(theta) gives."""
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
    both = np.stack([a, b], axis=1)
    both.flags.writeable = False
    return both
