"""Rigid transforms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, as_array, matrix, triple
from ._errors import InvalidOption

__all__ = ["closest_rotation"]


def _real(value: Any, name: str) -> npt.NDArray[Any]:
    """Returns an array of real numbers."""
    rows = as_array(value, name)
    if rows.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {rows.dtype}")
    return rows


def closest_rotation(matrix: Any) -> FloatArray:
    """Returns the rotation closest to a matrix that is a rotation except for rounding, in double precision.

    :meth:`ProximityScene.update` needs it for poses in float32.

    Parameters
    ----------
    matrix : (3, 3), (3, 4) or (4, 4) array
        A rotation, or a transform, of which only the rotation changes. The columns of the rotation must have length 1
        and be perpendicular, to within 0.1.

    Examples
    --------
    >>> import blum, numpy as np
    >>> turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]], dtype=np.float32)
    >>> rotation = blum.closest_rotation(turn)
    >>> bool(np.abs(rotation.T @ rotation - np.eye(3)).max() < 1e-15)
    True
    """
    rows = _real(matrix, "matrix")
    if rows.shape not in ((3, 3), (3, 4), (4, 4)):
        raise ValueError(f"matrix has the shape {rows.shape}, but must have (3, 3), (3, 4) or (4, 4)")
    out: FloatArray = np.array(rows, dtype=np.float64)
    out[:3, :3] = np.reshape(_core.closest_rotation(np.ascontiguousarray(out[:3, :3])), (3, 3))
    return out


def as_place(transform: Any) -> FloatArray:
    """Returns a transform as (3, 4): a rotation and a translation."""
    if isinstance(transform, (tuple, list)) and len(transform) == 2:
        out: FloatArray = np.empty((3, 4))
        out[:, :3] = matrix(transform[0], "transform[0]")
        out[:, 3] = triple(transform[1], "transform[1]")
        return out
    rows = _real(transform, "transform")
    if rows.shape not in ((4, 4), (3, 4)):
        raise ValueError(
            f"transform has the shape {rows.shape}, but must have (4, 4) or (3, 4), or be a pair "
            "(rotation (3, 3), translation (3,))"
        )
    if len(rows) == 4 and rows[3].tolist() != [0, 0, 0, 1]:
        raise InvalidOption(f"the last row of transform is {rows[3].tolist()}, but must be [0, 0, 0, 1]")
    return np.ascontiguousarray(rows[:3], dtype=np.float64)


def as_places(transforms: Any) -> FloatArray:
    """Returns transforms as (n, 3, 4) or (n, 4, 4)."""
    rows = _real(transforms, "transforms")
    if rows.ndim != 3 or rows.shape[1:] not in ((4, 4), (3, 4)):
        raise ValueError(f"transforms has the shape {rows.shape}, but must have (n, 4, 4) or (n, 3, 4)")
    if rows.shape[1] == 4 and not (rows[:, 3] == [0, 0, 0, 1]).all():
        worst = int(np.argmax((rows[:, 3] != [0, 0, 0, 1]).any(axis=1)))
        raise InvalidOption(
            f"the last row of transforms[{worst}] is {rows[worst, 3].tolist()}, but must be [0, 0, 0, 1]"
        )
    return np.ascontiguousarray(rows, dtype=np.float64)


def rotation_of(w: float, x: float, y: float, z: float) -> tuple[tuple[float, float, float], ...]:
    """Returns the rows of the rotation matrix of a quaternion of any length above 0."""
    s = 2 / (w * w + x * x + y * y + z * z)
    return (
        (1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        (s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)),
        (s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)),
    )


def quaternion_of(rotation: FloatArray) -> tuple[float, float, float, float]:
    """Returns the unit quaternion (w, x, y, z) of a rotation matrix, with its largest entry positive."""
    (a, b, c), (d, e, f), (g, h, i) = rotation.tolist()
    squares = 1 + a + e + i, 1 + a - e - i, 1 - a + e - i, 1 - a - e + i
    products = (
        (squares[0], h - f, c - g, d - b),
        (h - f, squares[1], b + d, c + g),
        (c - g, b + d, squares[2], f + h),
        (d - b, c + g, f + h, squares[3]),
    )
    row = products[max(range(4), key=squares.__getitem__)]
    size = math.sqrt(sum(value * value for value in row))
    w, x, y, z = (value / size for value in row)
    return w, x, y, z


def as_pose(value: Any, name: str) -> FloatArray:
    """Returns a pose as (3, 4), with the closest rotation. It may also be given as x, y, z, qw, qx, qy, qz."""
    if not isinstance(value, (tuple, list)) or len(value) == 7:
        rows = _real(value, name)
        if rows.shape == (7,):
            return _pose_of_seven(rows.astype(np.float64), name)
    try:
        pose = as_place(value)
        pose[:, :3] = closest_rotation(pose[:, :3])
    except (TypeError, ValueError) as error:
        raise type(error)(f"{name}: {error}") from None
    if not np.isfinite(pose).all():
        raise InvalidOption(f"{name} is not finite")
    return pose


def is_seven(value: Any) -> bool:
    """Returns True for seven numbers: x, y, z and a quaternion."""
    return np.shape(value) == (7,) if not isinstance(value, (tuple, list)) else len(value) == 7


def numbers_of_pose(value: Any, name: str) -> list[float]:
    """Returns a pose as x, y, z, qw, qx, qy, qz. Seven numbers are returned as they are."""
    if is_seven(value):
        return [float(each) for each in _real(value, name)]
    pose = as_pose(value, name)
    return [*pose[:, 3].tolist(), *quaternion_of(pose[:, :3])]


def _pose_of_seven(row: FloatArray, name: str) -> FloatArray:
    """Returns the pose of x, y, z and a quaternion."""
    if not np.isfinite(row).all():
        raise InvalidOption(f"{name} is {row.tolist()}, but must be finite")
    length = float(np.linalg.norm(row[3:]))
    if abs(length - 1) > 1e-3:
        raise InvalidOption(f"{name}: the quaternion {row[3:].tolist()} has the length {length:.6g}, but must have 1")
    out: FloatArray = np.empty((3, 4))
    out[:, :3] = rotation_of(*(row[3:] / length).tolist())
    out[:, 3] = row[:3]
    return out
