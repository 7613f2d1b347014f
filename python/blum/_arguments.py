"""Conversion of arguments to the types of the C++ library. Errors name the argument."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._errors import InvalidMesh, InvalidOption

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]
PathLike = str | os.PathLike[str]
#: Numbers of Python and NumPy.
Integer = int | np.integer[Any]
Real = float | np.floating[Any] | np.integer[Any]

_LARGEST_INDEX = np.iinfo(np.int32).max


def existing_file(path: PathLike) -> Path:
    """Returns the path of an existing file, or raises FileNotFoundError as open() does."""
    file = Path(os.fspath(path))
    if not file.exists():
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(file))
    return file


def text(value: Any, argument: str) -> str:
    """Returns a string as the library takes it: encodable in UTF-8, without null characters."""
    if not isinstance(value, str):
        raise TypeError(f"{argument} must be a string, not {type(value).__name__}")
    if "\0" in value or any("\ud800" <= character <= "\udfff" for character in value):
        raise InvalidOption(
            f"{argument} is {value!r}, but must be a string that UTF-8 can encode, without null characters"
        )
    return value


def is_on_device(value: Any) -> bool:
    """Returns True if an array states that its memory is on a CUDA device."""
    try:
        if hasattr(value, "__dlpack_device__"):
            return int(value.__dlpack_device__()[0]) in (2, 13)
    except Exception:
        return False
    return hasattr(value, "__cuda_array_interface__")


def as_array(value: Any, name: str) -> npt.NDArray[Any]:
    """Returns an array-like on the CPU as a NumPy array, without a copy if possible."""
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array, which Blum does not support: fill it first, with .filled(...)")
    if isinstance(value, np.ndarray):
        return np.asarray(value)  # Subclasses may override operators.
    if is_on_device(value):
        raise TypeError(
            f"{name} is in a CUDA device's memory: copy it to the host (.cpu(), .get()), or use DeviceFieldSolver or "
            "DeviceDistanceTransform, which leave it there"
        )
    try:
        if hasattr(value, "__dlpack__") and hasattr(value, "__dlpack_device__"):
            return np.from_dlpack(value)
        array = np.asarray(value)
    except Exception as error:
        raise TypeError(f"{name} cannot be used as an array: {error}") from error
    return array


def _check_real(array: npt.NDArray[Any], value: Any, name: str) -> None:
    """Raises TypeError unless an array holds real numbers. The message names the type of other objects."""
    if array.dtype.kind not in "fiu":
        is_object = array.dtype == object and array.ndim == 0
        raise TypeError(f"{name} must hold real numbers, not {type(value).__name__ if is_object else array.dtype}")


def float_rows(value: Any, name: str, width: int = 3) -> FloatArray:
    """Returns an (n, width) array of float64. A C-contiguous float64 array is not copied; others are copied once."""
    array = as_array(value, name)
    _check_real(array, value, name)
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n, {width})")
    return np.ascontiguousarray(array, dtype=np.float64)


def points_and_shape(value: Any, name: str) -> tuple[FloatArray, tuple[int, ...]]:
    """Returns points of shape (..., 3) as rows, and their shape without the last axis."""
    array = as_array(value, name)
    _check_real(array, value, name)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}, but must have (..., 3)")
    return np.ascontiguousarray(array.reshape(-1, 3), dtype=np.float64), array.shape[:-1]


def check_finite(rows: FloatArray, shape: tuple[int, ...], name: str) -> None:
    """Raises ValueError for the first of the points of the shape (..., 3) that is not finite."""
    bad = np.flatnonzero(~np.isfinite(rows).all(axis=1))
    if len(bad):
        where = ", ".join(str(int(place)) for place in np.unravel_index(int(bad[0]), shape)) if shape else ""
        raise ValueError(f"{name}[{where}] is {rows[bad[0]].tolist()}, but must be finite")


def float_list(value: Any, name: str) -> FloatArray:
    """Returns an (n,) array of float64. A C-contiguous float64 array is not copied."""
    array = as_array(value, name)
    _check_real(array, value, name)
    if array.ndim != 1:
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n,)")
    return np.ascontiguousarray(array, dtype=np.float64)


def indices(value: Any, name: str, width: int | None, count: int | None = None) -> IntArray:
    """Returns indices as int32, (n, width) or (n,). C-contiguous int32 and uint32 are not copied.

    Other types are copied once. With `count`, all indices must be below it. The error names the first one that is not.
    """
    array = as_array(value, name)
    wanted = "(n,)" if width is None else f"(n, {width})"
    if array.size == 0:
        return np.zeros((0,) if width is None else (0, width), dtype=np.int32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must hold integers, not {array.dtype}")
    if array.ndim != (1 if width is None else 2) or (width is not None and array.shape[1] != width):
        raise ValueError(f"{name} has the shape {array.shape}, but must have {wanted}")
    limit = _LARGEST_INDEX if count is None else count
    if int(array.min()) < 0 or int(array.max()) >= limit:
        wrong = np.argwhere((array < 0) | (array >= limit))[0]
        where = ", ".join(str(int(place)) for place in wrong)
        reason = f"must be 0 to {limit - 1}" if limit else "there are no vertices"
        raise InvalidMesh(f"{name}[{where}] is {int(array[tuple(wrong)])}, but {reason}")
    if array.dtype == np.uint32:
        array = array.view(np.int32)
    return np.ascontiguousarray(array, dtype=np.int32)


def triple(value: Any, name: str) -> tuple[float, float, float]:
    """Returns three numbers in x, y, z order. A single number stands for all three."""
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be numbers, not {type(value).__name__}")
    if array.shape == ():
        array = np.repeat(array, 3)
    if array.shape != (3,):
        raise ValueError(f"{name} has the shape {array.shape}, but must be three numbers (x, y, z)")
    return float(array[0]), float(array[1]), float(array[2])


def matrix(value: Any, name: str) -> FloatArray:
    """Returns a (3, 3) array of float64."""
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold numbers, not {array.dtype}")
    if array.shape != (3, 3):
        raise ValueError(f"{name} has the shape {array.shape}, but must have (3, 3)")
    return array.astype(np.float64)


def box(value: Any, name: str) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Returns a box as (lower, upper)."""
    if not isinstance(value, (Sequence, np.ndarray)) or isinstance(value, (str, bytes)) or len(value) != 2:
        raise ValueError(f"{name} must be a pair of corners, ((x0, y0, z0), (x1, y1, z1))")
    for place, corner in enumerate(value):
        if as_array(corner, f"{name}[{place}]").ndim != 1:
            raise ValueError(f"{name} must be a pair of corners, ((x0, y0, z0), (x1, y1, z1))")
    return triple(value[0], f"{name}[0]"), triple(value[1], f"{name}[1]")


def device_name(value: Any) -> str:
    """Returns a device's name, which the library parses. PyTorch devices are accepted."""
    if isinstance(value, str):
        return value
    kind = getattr(value, "type", None)  # A torch.device.
    if isinstance(kind, str) and hasattr(value, "index"):
        return kind if value.index is None else f"{kind}:{value.index}"
    raise TypeError(f"device must be a string, not {type(value).__name__}")


def integer(value: Any, name: str, bits: int = 32) -> int:
    """Returns an integer of Python or NumPy as int. It must fit the library's bits, at least 32."""
    if type(value) is int and -0x80000000 <= value <= 0x7FFFFFFF:  # First, because small queries check several.
        return value
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise TypeError(f"{name} must be an integer, not {type(value).__name__}")
    if not -(2 ** (bits - 1)) <= int(value) < 2 ** (bits - 1):
        raise InvalidOption(f"{name} is {int(value)}, but must be -2^{bits - 1} to 2^{bits - 1} - 1")
    return int(value)


def thread_number(value: Any) -> int:
    """Returns a number of threads, for the functions of the library that do not check it themselves."""
    count = integer(value, "threads")
    _core.thread_count(count)
    return count


def natural(value: Any, name: str, bits: int = 32) -> int:
    """Returns an integer of at least 0 that fits the library's bits. With 64 bits, it is at most 2^63 - 1."""
    if isinstance(value, (int, np.integer)) and int(value) < 0:
        raise InvalidOption(f"{name} is {int(value)}, but must be 0 or more")
    return integer(value, name, min(bits + 1, 64))


def truth(value: Any, name: str) -> bool:
    """Returns a bool of Python or NumPy as bool. Other types are rejected, because 'no' would count as True."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not {type(value).__name__}")
    return bool(value)


def number(value: Any, name: str) -> float:
    """Returns a real number of Python or NumPy as float."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}")
    try:
        return float(value)
    except OverflowError:
        raise InvalidOption(f"{name} is too large for a 64-bit float") from None


def label_of(value: Any, name: str) -> int:
    """Returns the value of voxels of an image."""
    return integer(value, name, bits=64)


def site_ids(value: Any, name: str, width: int) -> IntArray:
    """Returns site ids as files contain them: (n, width), -1 if there is none."""
    array = as_array(value, name)
    if array.dtype.kind not in "iu" or array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} holds {array.dtype} of the shape {array.shape}, but must hold integers (n, {width})")
    if array.size and (int(array.min()) < -1 or int(array.max()) >= _LARGEST_INDEX):
        found = f"{int(array.min())} to {int(array.max())}"
        raise ValueError(f"{name} holds numbers from {found}, but they must be -1 to {_LARGEST_INDEX - 1}")
    return np.ascontiguousarray(array, dtype=np.int32)


def source_name(path: PathLike) -> str:
    """Returns a file's name for metadata. Metadata are UTF-8; names of files need not be."""
    return os.fsencode(Path(os.fspath(path)).name).decode("utf-8", "replace")


def optional_number(value: Any, name: str) -> float | None:
    """Returns None, or a real number as float."""
    return None if value is None else number(value, name)
