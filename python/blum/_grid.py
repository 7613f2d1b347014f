"""Grids: where the nodes of a field lie."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, Integer, Real, as_array, box, integer, matrix, number, triple
from ._errors import InvalidOption
from ._mesh import MeshLike, as_mesh
from ._structs import Bounds


class Grid:
    """A regular grid. Node (i, j, k) lies at ``origin + direction @ ((i, j, k) * spacing)``.

    Arrays on a grid are indexed [z, y, x], C order: their shape is ``shape``, the reverse of ``size``.

    Parameters
    ----------
    origin, spacing : three numbers
        Position of node (0, 0, 0), and the distance between neighbours, both in x, y, z order and mesh units. A single
        number stands for all three.
    size : three integers
        Nodes along x, y, z.
    direction : (3, 3) array, optional
        Orthonormal; column a is the direction of index axis a.

    >>> import blum
    >>> grid = blum.Grid(origin=(0, 0, 0), spacing=0.5, size=(5, 3, 2))
    >>> grid.shape
    (2, 3, 5)
    >>> grid.positions()[1, 2, 4].tolist()
    [2.0, 1.0, 0.5]
    """

    def __init__(self, origin: Any, spacing: Any, size: Any, direction: Any = None) -> None:
        counts = as_array(size, "size")
        if counts.ndim != 1 or counts.size != 3 or counts.dtype.kind not in "iu":
            raise ValueError("size must be three integers, the nodes along x, y, z")
        columns = np.eye(3) if direction is None else matrix(direction, "direction")
        self._spec = _core.GridSpec(
            triple(origin, "origin"), triple(spacing, "spacing"), [int(count) for count in counts], columns.T.tolist()
        )

    @classmethod
    def around(
        cls, shape: MeshLike | Bounds, *, resolution: Integer = 256, spacing: Real | None = None, padding: Real = 0.1
    ) -> Grid:
        """The default grid around a mesh, or a pair of corners of a box.

        Parameters
        ----------
        resolution : int
            Nodes along the longest padded side, 2 to 65536.
        spacing : float, optional
            Distance between nodes, mesh units; instead of `resolution`.
        padding : float
            Added on each side, as a fraction of the longest side.
        """
        lower, upper = bounds_of(shape)
        margin = number(padding, "padding")
        if spacing is None:
            return cls._of(_core.grid_around(lower, upper, integer(resolution, "resolution"), margin))
        return cls._of(_core.grid_around_with_spacing(lower, upper, number(spacing, "spacing"), margin))

    @classmethod
    def within(cls, bounds: Any, *, resolution: Integer = 256, spacing: Real | None = None) -> Grid:
        """A grid over exactly a box, given as a pair of corners, without padding."""
        lower, upper = box(bounds, "bounds")
        if spacing is None:
            return cls._of(_core.grid_in(lower, upper, integer(resolution, "resolution")))
        return cls._of(_core.grid_in_with_spacing(lower, upper, number(spacing, "spacing")))

    @classmethod
    def _of(cls, spec: _core.GridSpec) -> Grid:
        grid = cls.__new__(cls)
        grid._spec = spec
        return grid

    def __reduce__(self) -> tuple[Any, ...]:
        return Grid, (self.origin, self.spacing, self.size, self.direction)

    @property
    def origin(self) -> tuple[float, float, float]:
        """Position of node (0, 0, 0): x, y, z."""
        x, y, z = self._spec.origin
        return x, y, z

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Between neighbours along the index axes x, y, z."""
        x, y, z = self._spec.spacing
        return x, y, z

    @property
    def size(self) -> tuple[int, int, int]:
        """Nodes along x, y, z."""
        x, y, z = self._spec.size
        return x, y, z

    @property
    def shape(self) -> tuple[int, int, int]:
        """The shape of arrays on the grid: (z, y, x)."""
        x, y, z = self.size
        return z, y, x

    @property
    def direction(self) -> FloatArray:
        """(3, 3): column a is the direction of index axis a (0: x)."""
        return np.array(self._spec.columns).T

    @property
    def bounds(self) -> Bounds:
        """The box around the nodes, along the axes of the world."""
        ends = np.array(self.size) - 1
        corners = self.positions_of(np.array(np.meshgrid(*([0, end] for end in ends))).reshape(3, -1).T)
        lower, upper = corners.min(axis=0), corners.max(axis=0)
        return (float(lower[0]), float(lower[1]), float(lower[2])), (float(upper[0]), float(upper[1]), float(upper[2]))

    def positions_of(self, nodes: Any) -> FloatArray:
        """(..., 3): where nodes (i, j, k) lie, in x, y, z order; fractions lie between nodes."""
        steps = np.asarray(nodes, dtype=np.float64) * self.spacing
        found: FloatArray = steps @ self.direction.T + self.origin
        return found

    def positions(self) -> FloatArray:
        """(z, y, x, 3): where all nodes lie."""
        i, j, k = (np.arange(count, dtype=np.float64) for count in self.size)
        z, y, x = np.meshgrid(k, j, i, indexing="ij")
        return self.positions_of(np.stack([x, y, z], axis=-1))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Grid) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        return self.origin, self.spacing, self.size, tuple(map(tuple, self._spec.columns))

    def __repr__(self) -> str:
        axes = self.direction
        turned = "" if np.array_equal(axes, np.eye(3)) else f", direction={axes.round(6).tolist()}"
        return f"Grid(origin={_short(self.origin)}, spacing={_short(self.spacing)}, size={self.size}{turned})"


def _short(values: tuple[float, float, float]) -> str:
    return f"({', '.join(f'{value:.6g}' for value in values)})"


def bounds_of(shape: MeshLike | Bounds) -> Bounds:
    """The box of a mesh, or the box that a pair of corners is."""
    if isinstance(shape, (tuple, list)) and len(shape) == 2 and np.asarray(shape[0], dtype=object).ndim == 1:
        return box(shape, "bounds")
    return as_mesh(shape).bounds


def grid_for(
    shape: MeshLike | Bounds | None,
    grid: Grid | None,
    bounds: Any,
    resolution: Integer,
    spacing: Real | None,
    padding: Real,
) -> Grid:
    """The grid that the arguments of a field ask for; with `grid` or `bounds` there need not be a shape."""
    if grid is not None:
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        if bounds is not None or spacing is not None:
            raise InvalidOption("grid excludes bounds and spacing: it says where all nodes lie")
        return grid
    if bounds is not None:
        return Grid.within(bounds, resolution=resolution, spacing=spacing)
    return Grid.around(cast(MeshLike | Bounds, shape), resolution=resolution, spacing=spacing, padding=padding)


def image_grid(shape: tuple[int, ...], spacing: Any, origin: Any, direction: Any) -> Grid:
    """The grid of an image's voxel centres. @param shape  (z, y, x)."""
    return Grid(origin, spacing, tuple(reversed(shape)), direction)


def mask_array(value: Any, name: str) -> npt.NDArray[np.uint8]:
    """A mask [z, y, x] as bytes, without a copy where it is one already."""
    array = as_array(value, name)
    if array.dtype.kind not in "biu":
        raise TypeError(f"{name} must hold booleans, not {array.dtype}")
    if array.ndim != 3:
        raise ValueError(f"{name} has {array.ndim} axes, but must have 3: [z, y, x]")
    if array.dtype not in (np.bool_, np.uint8):
        array = array != 0
    return np.ascontiguousarray(array).view(np.uint8)
