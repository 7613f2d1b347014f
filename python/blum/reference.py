"""Brute force for tests.

The functions search exhaustively in double precision. They are slow and simple.
"""

from __future__ import annotations

from typing import Any

from . import _core
from ._arguments import FloatArray, IntArray, Real, indices, integer, points_and_shape
from ._grid import Grid, mask_array
from ._mesh import MeshLike, as_mesh
from ._progress import Progress, reporting

__all__ = ["nearest", "nearest_voxel", "winding_number"]


def nearest(
    mesh: MeshLike, points: Any, *, weld: Real | None = None, threads: int = 0, progress: Progress = False
) -> tuple[FloatArray, IntArray]:
    """Returns the distance and the closest site of each of the points (..., 3), by a search of all sites.

    The cost is O(points * sites).

    Examples
    --------
    >>> import blum
    >>> distance, site = blum.reference.nearest(blum.generate("box"), [0, 0, 1])
    >>> round(float(distance), 6)
    0.5
    """
    rows, shape = points_and_shape(points, "points")
    with reporting(progress) as report:
        distance, site = _core.reference_nearest(
            as_mesh(mesh, weld=weld)._arrays, rows, integer(threads, "threads"), report
        )
    return distance.reshape(shape), site.reshape(shape)


def winding_number(
    mesh: MeshLike, points: Any, *, weld: Real | None = None, threads: int = 0, progress: Progress = False
) -> FloatArray:
    """Returns the generalized winding number at each of the points (..., 3), by a sum over all triangles.

    The cost is O(points * triangles).

    Examples
    --------
    >>> import blum
    >>> round(float(blum.reference.winding_number(blum.generate("box"), [0, 0, 0])), 6)
    1.0
    """
    rows, shape = points_and_shape(points, "points")
    with reporting(progress) as report:
        values: FloatArray = _core.reference_winding_number(
            as_mesh(mesh, weld=weld)._arrays, rows, integer(threads, "threads"), report
        )
    return values.reshape(shape)


def nearest_voxel(
    mask: Any, voxels: Any, *, grid: Grid | None = None, threads: int = 0, progress: Progress = False
) -> tuple[FloatArray, IntArray]:
    """Returns the squared distance to the closest true voxel, and its flat index, for each query voxel.

    The cost is O(queries * voxels). Squared distances have squared units of the spacing.

    Parameters
    ----------
    mask : (z, y, x) array
        Booleans or integers.
    voxels : (n,) array of integers
        Flat indices of the query voxels.
    grid : Grid, optional
        Grid of the voxel centres. Default: spacing 1.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> squared, voxel = blum.reference.nearest_voxel([[[True, False, False]]], [2])
    >>> squared.tolist(), voxel.tolist()
    ([4.0], [0])
    """
    targets = mask_array(mask, "mask")
    nodes = Grid((0, 0, 0), 1, tuple(reversed(targets.shape))) if grid is None else grid
    asked = indices(voxels, "voxels", None, targets.size)
    if nodes.shape != targets.shape:
        raise ValueError(f"mask has the shape {targets.shape}, but the grid's is {nodes.shape}")
    with reporting(progress) as report:
        squared, site = _core.reference_nearest_voxel(targets, nodes._spec, asked, integer(threads, "threads"), report)
    return squared, site
