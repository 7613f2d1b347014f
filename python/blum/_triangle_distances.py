"""Distances of pairs of triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._arguments import FloatArray, IntArray, as_array, integer
from ._errors import InvalidMesh
from ._methods import Shown
from ._progress import Progress, reporting

__all__ = ["TriangleDistances", "triangle_distances"]


@dataclass(frozen=True, eq=False, repr=False)
class TriangleDistances(Shown):
    """Distances of pairs of triangles; the result of :func:`triangle_distances`.

    Examples
    --------
    >>> import blum
    >>> triangle = [[0, 0, 0], [4, 0, 0], [0, 4, 0]]
    >>> found = blum.triangle_distances([triangle], [triangle])
    >>> found.distance.tolist(), found.closest.shape, found.feature.shape
    ([0.0], (1, 2, 3), (1, 2, 3))
    """

    distance: FloatArray  #: Distances: (n,). 0 if and only if the triangles have a point in common.
    closest: FloatArray  #: Closest points of both: (n, 2, 3). If they meet, a point near both.
    #: The one, two or three corners (0 to 2) of the feature that contains each: (n, 2, 3), padded with -1.
    feature: IntArray


def triangle_distances(a: Any, b: Any, *, threads: int = 0, progress: Progress = False) -> TriangleDistances:
    """Returns the closest points of pairs of triangles. Contacts are exact. Triangles without area are valid.

    Parameters
    ----------
    a, b : (n, 3, 3) arrays
        Corners of the first and the second triangle of each pair.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> floor, above = [[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 2], [9, 0, 3], [0, 9, 3]]
    >>> found = blum.triangle_distances([floor], [above])
    >>> found.distance.tolist(), found.closest.round(9).tolist()
    ([2.0], [[[1.0, 1.0, 0.0], [1.0, 1.0, 2.0]]])
    >>> found.feature.tolist()
    [[[0, 1, 2], [0, -1, -1]]]
    """
    first, second = _triangles(a, "a"), _triangles(b, "b")
    if len(first) != len(second):
        raise InvalidMesh(f"a has {len(first)} triangles, but b has {len(second)}: give equal numbers")
    with reporting(progress) as report:
        return TriangleDistances(*_core.triangle_distances(first, second, integer(threads, "threads"), report))


def _triangles(value: Any, name: str) -> FloatArray:
    """Returns an (n, 3, 3) array of float64."""
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}")
    if array.ndim != 3 or array.shape[1:] != (3, 3):
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n, 3, 3)")
    return np.ascontiguousarray(array, dtype=np.float64)
