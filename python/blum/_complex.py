"""Complexes of vertices, edges and triangles, with named columns of numbers on each."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, as_array, float_rows, indices, integer, text
from ._errors import InvalidOption
from ._mesh import Betti, betti_of
from ._progress import Progress, reporting

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex

#: Named columns: (n,) or (n, components) arrays of float64, float32, int64 or int32.
ColumnsOf = Mapping[str, npt.NDArray[Any]]


class Complex:
    """Vertices, edges and triangles in space, with named columns on each. Arrays are read-only views of the library's
    memory. As a space it is made of its vertices, edges and triangles, and of the triangles' own edges.

    Parameters
    ----------
    vertices : (n, 3) array
    edges : (e, 2) array, optional
    triangles : (m, 3) array, optional
    vertex_columns, edge_columns, triangle_columns : mapping of names to arrays, optional
        (n,) or (n, components) arrays, a row for each vertex, edge or triangle; float64, float32, int64 or int32.

    >>> import blum
    >>> path = blum.Complex([[0, 0, 0], [1, 0, 0], [1, 1, 0]], edges=[[0, 1], [1, 2]], edge_columns={"cost": [1, 2.5]})
    >>> path.edge_columns["cost"]
    array([1. , 2.5])
    >>> path.homology()
    (1, 0, 0)
    """

    _core: _CoreComplex

    def __init__(
        self,
        vertices: Any,
        *,
        edges: Any = (),
        triangles: Any = (),
        vertex_columns: Mapping[str, Any] = MappingProxyType({}),
        edge_columns: Mapping[str, Any] = MappingProxyType({}),
        triangle_columns: Mapping[str, Any] = MappingProxyType({}),
    ) -> None:
        positions = float_rows(vertices, "vertices")
        core = _core.Complex(
            positions,
            indices(edges, "edges", 2, len(positions)),
            indices(triangles, "triangles", 3, len(positions)),
            _arrays_of(vertex_columns, "vertex_columns"),
            _arrays_of(edge_columns, "edge_columns"),
            _arrays_of(triangle_columns, "triangle_columns"),
        )
        problem = core.problem()
        if problem:
            raise InvalidOption(problem)
        self._core = core

    @staticmethod
    def _from_core(core: _CoreComplex) -> Complex:
        made = Complex.__new__(Complex)
        made._core = core
        return made

    @property
    def vertices(self) -> FloatArray:
        """(n, 3): positions, mesh units."""
        found: FloatArray = self._core.vertices
        return found

    @property
    def edges(self) -> IntArray:
        """(e, 2): those that are listed; not the sides of triangles."""
        found: IntArray = self._core.edges
        return found

    @property
    def triangles(self) -> IntArray:
        """(m, 3)."""
        found: IntArray = self._core.triangles
        return found

    @cached_property
    def vertex_columns(self) -> ColumnsOf:
        """Columns with a row for each vertex, by name."""
        return MappingProxyType(self._core.vertex_columns)

    @cached_property
    def edge_columns(self) -> ColumnsOf:
        """Columns with a row for each of `edges`, by name."""
        return MappingProxyType(self._core.edge_columns)

    @cached_property
    def triangle_columns(self) -> ColumnsOf:
        """Columns with a row for each triangle, by name."""
        return MappingProxyType(self._core.triangle_columns)

    def homology(self, *, threads: int = 0, progress: Progress = False) -> Betti:
        """Betti numbers over Z/2: components, tunnels, voids."""
        return homology(len(self.vertices), self.edges, self.triangles, threads=threads, progress=progress)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, core_arguments(self)

    def __repr__(self) -> str:
        counts = f"{len(self.vertices):,} vertices, {len(self.edges):,} edges, {len(self.triangles):,} triangles"
        return f"Complex({counts})"


def core_arguments(axis: Complex) -> tuple[Any, ...]:
    """Copies of the arrays, in the order of the library's constructor."""
    columns = (axis.vertex_columns, axis.edge_columns, axis.triangle_columns)
    return (
        np.array(axis.vertices),
        np.array(axis.edges),
        np.array(axis.triangles),
        *({name: np.array(column) for name, column in of_cells.items()} for of_cells in columns),
    )


def _restored(
    vertices: FloatArray,
    edges: IntArray,
    triangles: IntArray,
    vertex_columns: ColumnsOf,
    edge_columns: ColumnsOf,
    triangle_columns: ColumnsOf,
) -> Complex:
    return Complex(
        vertices,
        edges=edges,
        triangles=triangles,
        vertex_columns=vertex_columns,
        edge_columns=edge_columns,
        triangle_columns=triangle_columns,
    )


def _arrays_of(columns: Mapping[str, Any], argument: str) -> dict[str, npt.NDArray[Any]]:
    """Columns as the library takes them: other numbers become the type that holds all of them."""
    out = {}
    for name, values in columns.items():
        array = as_array(values, f"{argument}[{name!r}]")
        if array.dtype not in (np.float64, np.float32, np.int64, np.int32):
            if array.dtype.kind not in "biuf":
                raise TypeError(f"{argument}[{name!r}] holds {array.dtype}, but must hold numbers")
            if array.dtype == np.uint64 and array.size > 0 and int(array.max()) > np.iinfo(np.int64).max:
                raise InvalidOption(f"{argument}[{name!r}] holds numbers above 2^63 - 1")
            array = array.astype(np.float64 if array.dtype.kind == "f" else np.int64)
        out[text(str(name), f"a name of {argument}")] = np.ascontiguousarray(
            array.astype(array.dtype.newbyteorder("="), copy=False)
        )
    return out


def homology(
    vertex_count: int, edges: Any = (), triangles: Any = (), *, threads: int = 0, progress: Progress = False
) -> Betti:
    """Betti numbers over Z/2 of a complex of vertices, edges, and triangles with their edges.

    >>> import blum
    >>> blum.homology(4, edges=[[0, 1], [1, 2], [2, 0]])
    (2, 1, 0)
    """
    count = integer(vertex_count, "vertex_count")
    if count < 0:
        raise ValueError(f"vertex_count is {count}, but must be at least 0")
    with reporting(progress) as report:
        return betti_of(
            _core.homology(
                count,
                indices(edges, "edges", 2, count),
                indices(triangles, "triangles", 3, count),
                integer(threads, "threads"),
                report,
            )
        )
