"""Complexes with columns.

A complex has vertices, edges and triangles, and named columns of numbers.
"""

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

__all__ = ["Complex", "homology"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex

#: Named columns: arrays of shape (n,) or (n, components), of float64, float32, int64 or int32.
ColumnsOf = Mapping[str, npt.NDArray[Any]]


class Complex:
    """Vertices, edges and triangles in space, with named columns of numbers on each.

    Arrays are read-only views of the library's memory. As a space, a complex consists of its vertices, edges and
    triangles, and of the sides of the triangles.

    Parameters
    ----------
    vertices : (n, 3) array
        Positions, mesh units.
    edges : (e, 2) array of integers, optional
    triangles : (m, 3) array of integers, optional
    vertex_columns, edge_columns, triangle_columns : mapping of names to arrays, optional
        (n,) or (n, components) arrays of float64, float32, int64 or int32, with a row for each vertex, edge or
        triangle.

    Examples
    --------
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
        """Positions: (n, 3), mesh units."""
        found: FloatArray = self._core.vertices
        return found

    @property
    def edges(self) -> IntArray:
        """Vertices of the listed edges: (e, 2). Sides of triangles need not be listed."""
        found: IntArray = self._core.edges
        return found

    @property
    def triangles(self) -> IntArray:
        """Vertices of the triangles: (m, 3)."""
        found: IntArray = self._core.triangles
        return found

    @cached_property
    def vertex_columns(self) -> ColumnsOf:
        """Columns with a row for each vertex, by name."""
        return MappingProxyType(self._core.vertex_columns)

    @cached_property
    def edge_columns(self) -> ColumnsOf:
        """Columns with a row for each listed edge, by name."""
        return MappingProxyType(self._core.edge_columns)

    @cached_property
    def triangle_columns(self) -> ColumnsOf:
        """Columns with a row for each triangle, by name."""
        return MappingProxyType(self._core.triangle_columns)

    def homology(self, *, threads: int = 0, progress: Progress = False) -> Betti:
        """Returns the Betti numbers over Z/2: components, tunnels, voids.

        Examples
        --------
        >>> import blum
        >>> blum.Complex([[0, 0, 0], [1, 0, 0], [0, 1, 0]], edges=[[0, 1], [1, 2], [2, 0]]).homology()
        (1, 1, 0)
        """
        return homology(len(self.vertices), self.edges, self.triangles, threads=threads, progress=progress)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, core_arguments(self)

    def __repr__(self) -> str:
        counts = f"{len(self.vertices):,} vertices, {len(self.edges):,} edges, {len(self.triangles):,} triangles"
        return f"Complex({counts})"


def core_arguments(axis: Complex) -> tuple[Any, ...]:
    """Returns copies of the arrays, in the order of the library's constructor."""
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
    """Returns columns as the library takes them. Other types become float64 or int64."""
    out = {}
    for name, values in columns.items():
        array = as_array(values, f"{argument}[{name!r}]")
        if array.dtype not in (np.float64, np.float32, np.int64, np.int32):
            if array.dtype.kind not in "biuf":
                raise TypeError(f"{argument}[{name!r}] holds {array.dtype}, but must hold numbers")
            if array.dtype == np.uint64 and array.size > 0 and int(array.max()) > np.iinfo(np.int64).max:
                raise InvalidOption(
                    f"{argument}[{name!r}] holds {int(array.max())}, but numbers must be at most 2^63 - 1"
                )
            array = array.astype(np.float64 if array.dtype.kind == "f" else np.int64)
        out[text(str(name), f"a name of {argument}")] = np.ascontiguousarray(
            array.astype(array.dtype.newbyteorder("="), copy=False)
        )
    return out


def homology(
    vertex_count: int, edges: Any = (), triangles: Any = (), *, threads: int = 0, progress: Progress = False
) -> Betti:
    """Returns the Betti numbers over Z/2 of a complex: components, tunnels, voids.

    The complex consists of vertices, edges, triangles and sides of triangles.

    Parameters
    ----------
    vertex_count : int
        Number of vertices, at least 0.
    edges : (e, 2) array of integers, optional
    triangles : (m, 3) array of integers, optional
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
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
