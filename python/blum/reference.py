"""Brute force in double precision: slow, obvious, for tests and for trust."""

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
    """Distance and closest site of each point of the shape (..., 3), over all sites: O(points * sites).

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
    """The sum of all solid angles at each point of the shape (..., 3): O(points * triangles)."""
    rows, shape = points_and_shape(points, "points")
    with reporting(progress) as report:
        values: FloatArray = _core.reference_winding_number(
            as_mesh(mesh, weld=weld)._arrays, rows, integer(threads, "threads"), report
        )
    return values.reshape(shape)


def nearest_voxel(
    mask: Any, voxels: Any, *, grid: Grid | None = None, threads: int = 0, progress: Progress = False
) -> tuple[FloatArray, IntArray]:
    """Squared distance and flat index of the closest true voxel of a mask [z, y, x], for flat indices of voxels."""
    targets = mask_array(mask, "mask")
    nodes = Grid((0, 0, 0), 1, tuple(reversed(targets.shape))) if grid is None else grid
    asked = indices(voxels, "voxels", None, targets.size)
    if nodes.shape != targets.shape:
        raise ValueError(f"mask has the shape {targets.shape}, but the grid's is {nodes.shape}")
    with reporting(progress) as report:
        squared, site = _core.reference_nearest_voxel(targets, nodes._spec, asked, integer(threads, "threads"), report)
    return squared, site
