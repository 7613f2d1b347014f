"""Grids of nodes."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, Integer, Real, as_array, box, integer, matrix, number, triple
from ._errors import InvalidOption
from ._mesh import MeshLike, as_mesh
from ._structs import Bounds

__all__ = ["Grid"]

_RESOLUTION = 256  # Nodes along the longest side by default.


class Grid:
    """Regular grid of nodes. Node (i, j, k) lies at ``origin + direction @ ((i, j, k) * spacing)``.

    Arrays on a grid are C-ordered and indexed [z, y, x]. The shape of these arrays is ``shape``, the reverse of
    ``size``.

    Parameters
    ----------
    origin, spacing : three numbers
        Position of node (0, 0, 0), and distance between neighbouring nodes, in x, y, z order and mesh units. A single
        number stands for all three.
    size : three integers
        Number of nodes along x, y, z.
    direction : (3, 3) array, optional
        Orthonormal. Column a is the direction of index axis a.

    Examples
    --------
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
            raise ValueError("size must be three integers, the numbers of nodes along x, y, z")
        columns = np.eye(3) if direction is None else matrix(direction, "direction")
        self._spec = _core.GridSpec(
            triple(origin, "origin"), triple(spacing, "spacing"), [int(count) for count in counts], columns.T.tolist()
        )

    @classmethod
    def around(
        cls,
        shape: MeshLike | Bounds,
        *,
        resolution: Integer | None = None,
        spacing: Real | None = None,
        padding: Real = 0.1,
    ) -> Grid:
        """Returns the default grid around a mesh or a box.

        Parameters
        ----------
        shape : mesh, or ((x0, y0, z0), (x1, y1, z1))
            Mesh as for :func:`distance_field`, or the corners of a box.
        resolution : int, optional
            Nodes along the longest padded side, 2 to 65536. Default: 256.
        spacing : float, optional
            Distance between nodes, mesh units. Excludes `resolution`.
        padding : float
            Padding on each side, as a fraction of the longest side.

        Examples
        --------
        >>> import blum
        >>> blum.Grid.around(((0, 0, 0), (1, 1, 2)), resolution=9, padding=0.5).size
        (7, 7, 9)
        """
        nodes = _nodes(resolution, spacing)
        lower, upper = bounds_of(shape)
        margin = number(padding, "padding")
        if spacing is None:
            return cls._of(_core.grid_around(lower, upper, nodes, margin))
        return cls._of(_core.grid_around_with_spacing(lower, upper, number(spacing, "spacing"), margin))

    @classmethod
    def within(cls, bounds: Any, *, resolution: Integer | None = None, spacing: Real | None = None) -> Grid:
        """Returns a grid over a box, without padding.

        If a side of the box is not a whole multiple of the spacing, the grid is longer than that side. The grid extends
        beyond the box by the same length at both ends, less than half a spacing.

        Parameters
        ----------
        bounds : ((x0, y0, z0), (x1, y1, z1))
        resolution : int, optional
            Nodes along the longest side, 2 to 65536. Default: 256.
        spacing : float, optional
            Distance between nodes, mesh units. Excludes `resolution`.

        Examples
        --------
        >>> import blum
        >>> blum.Grid.within(((0, 0, 0), (1, 1, 2)), spacing=0.5)
        Grid(origin=(0, 0, 0), spacing=(0.5, 0.5, 0.5), size=(3, 3, 5))
        """
        nodes = _nodes(resolution, spacing)
        lower, upper = box(bounds, "bounds")
        if spacing is None:
            return cls._of(_core.grid_in(lower, upper, nodes))
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
        """Position of node (0, 0, 0): x, y, z, mesh units."""
        x, y, z = self._spec.origin
        return x, y, z

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Distance between neighbouring nodes along the index axes x, y, z, mesh units."""
        x, y, z = self._spec.spacing
        return x, y, z

    @property
    def size(self) -> tuple[int, int, int]:
        """Number of nodes along x, y, z."""
        x, y, z = self._spec.size
        return x, y, z

    @property
    def shape(self) -> tuple[int, int, int]:
        """Shape of arrays on the grid: (z, y, x)."""
        x, y, z = self.size
        return z, y, x

    @property
    def direction(self) -> FloatArray:
        """Directions of the index axes: (3, 3). Column a is the direction of index axis a (0: x)."""
        return np.array(self._spec.columns).T

    @property
    def bounds(self) -> Bounds:
        """Box around the nodes as (lower, upper), aligned with the axes of the world."""
        ends = np.array(self.size) - 1
        corners = self.positions_of(np.array(np.meshgrid(*([0, end] for end in ends))).reshape(3, -1).T)
        lower, upper = corners.min(axis=0), corners.max(axis=0)
        return (float(lower[0]), float(lower[1]), float(lower[2])), (float(upper[0]), float(upper[1]), float(upper[2]))

    def positions_of(self, nodes: Any) -> FloatArray:
        """Returns the positions of nodes (i, j, k) as (..., 3), in x, y, z order. Fractions lie between nodes.

        Examples
        --------
        >>> import blum
        >>> blum.Grid((1, 0, 0), 0.5, (3, 3, 3)).positions_of([2, 0, 0.5]).tolist()
        [2.0, 0.0, 0.25]
        """
        steps = np.asarray(nodes, dtype=np.float64) * self.spacing
        found: FloatArray = steps @ self.direction.T + self.origin
        return found

    def positions(self) -> FloatArray:
        """Returns the positions of all nodes: (z, y, x, 3).

        Examples
        --------
        >>> import blum
        >>> blum.Grid((0, 0, 0), 1, (4, 3, 2)).positions().shape
        (2, 3, 4, 3)
        """
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


def check_one(resolution: Any, spacing: Any, what: str) -> None:
    """Raises InvalidOption if both are given."""
    if resolution is not None and spacing is not None:
        raise InvalidOption(f"resolution and spacing exclude each other: each sets the {what}")


def _nodes(resolution: Integer | None, spacing: Real | None) -> int:
    """Returns the number of nodes along the longest side, which is not used with a spacing."""
    check_one(resolution, spacing, "spacing")
    return _RESOLUTION if resolution is None else integer(resolution, "resolution")


def bounds_of(shape: MeshLike | Bounds) -> Bounds:
    """Returns the box of a mesh, or the given box."""
    if isinstance(shape, (tuple, list)) and len(shape) == 2 and np.asarray(shape[0], dtype=object).ndim == 1:
        return box(shape, "bounds")
    return as_mesh(shape).bounds


def grid_for(
    shape: MeshLike | Bounds | None,
    grid: Grid | None,
    bounds: Any,
    resolution: Integer | None,
    spacing: Real | None,
    padding: Real,
) -> Grid:
    """Returns the grid that a field's arguments request. With `grid` or `bounds`, no shape is needed."""
    if grid is not None:
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        if bounds is not None or spacing is not None or resolution is not None:
            raise InvalidOption("grid excludes bounds, spacing and resolution: it defines all nodes")
        return grid
    if bounds is not None:
        return Grid.within(bounds, resolution=resolution, spacing=spacing)
    return Grid.around(cast(MeshLike | Bounds, shape), resolution=resolution, spacing=spacing, padding=padding)


def image_grid(shape: tuple[int, ...], spacing: Any, origin: Any, direction: Any) -> Grid:
    """Returns the grid of an image's voxel centres. `shape` is (z, y, x)."""
    return Grid(origin, spacing, tuple(reversed(shape)), direction)


def mask_array(value: Any, name: str) -> npt.NDArray[np.uint8]:
    """Returns a mask [z, y, x] as bytes, without a copy if it has one byte per voxel."""
    array = as_array(value, name)
    if array.dtype.kind not in "biu":
        raise TypeError(f"{name} must hold booleans or integers, not {array.dtype}")
    if array.ndim != 3:
        raise ValueError(f"{name} has {array.ndim} axes, but must have 3: [z, y, x]")
    if array.dtype not in (np.bool_, np.uint8):
        array = array != 0
    return np.ascontiguousarray(array).view(np.uint8)
