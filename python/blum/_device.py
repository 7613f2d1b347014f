"""Fields on a CUDA device."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import device_name, integer
from ._errors import InvalidOption
from ._grid import Grid
from ._options import takes
from ._structs import CudaDevices, DistanceTransformOptions, FieldOptions

__all__ = ["DeviceArray", "DeviceDistanceTransform", "DeviceField", "DeviceFieldSolver", "cuda_devices"]

_CUDA = 2  # Number of the kind of device in DLPack.
_MANAGED = 13
_LEGACY = 1  # The legacy default stream, in CUDA and DLPack.


def cuda_devices() -> CudaDevices:
    """Returns the CUDA devices that the argument `device` accepts, or the reason why no device exists.

    Examples
    --------
    >>> import blum
    >>> found = blum.cuda_devices()
    >>> bool(found.devices) != bool(found.reason)
    True
    """
    found: CudaDevices = _core.cuda_devices()
    return found


class DeviceArray:
    """Array in a CUDA device's memory, for ``torch.from_dlpack``, ``cupy.from_dlpack`` and similar functions.

    Importing does not copy the array. The array has ``__dlpack__`` and ``__cuda_array_interface__``. The importing
    library waits on its own stream until the array is computed.

    Examples
    --------
    ::

        field = blum.DeviceFieldSolver(grid).compute(vertices, triangles)
        distance = torch.from_dlpack(field.distance)
    """

    def __init__(self, core: _core.DeviceArray, solver: _DeviceSolver, pieces: int) -> None:
        self._core = core
        self._solver = solver  # Keeps arrays alive that the device still reads.
        self._pieces = pieces  # Pieces of the solver's work up to this array's.

    def __repr__(self) -> str:
        return f"DeviceArray(shape={self.shape}, dtype={self.dtype}, device='cuda:{self._core.device}')"

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of the axes."""
        return tuple(self._core.shape)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of an element."""
        return np.dtype(self._core.type)

    @property
    def address(self) -> int:
        """Address of the first element on the device."""
        return int(self._core.address)

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        # The legacy default stream always exists; a caller's stream may have been destroyed.
        self._solver._solver.follow(self._pieces, _LEGACY)
        return {
            "shape": self.shape,
            "typestr": self._core.type,
            "data": (self.address, False),
            "strides": None,
            "stream": _LEGACY,
            "version": 3,
        }

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        raise TypeError(
            "the array is in a CUDA device's memory: copy it to the host first, for example with PyTorch or CuPy"
        )

    def __dlpack_device__(self) -> tuple[int, int]:
        return _CUDA, int(self._core.device)

    def __dlpack__(
        self,
        *,
        stream: int | None = None,
        max_version: tuple[int, int] | None = None,
        dl_device: tuple[int, int] | None = None,
        copy: bool | None = None,
    ) -> Any:
        if dl_device is not None and tuple(dl_device) != self.__dlpack_device__():
            raise BufferError(
                f"dl_device is {tuple(dl_device)}, but the array is on {self.__dlpack_device__()}: import "
                "it there, then copy it"
            )
        if copy:
            raise BufferError("copy=True is not supported: import the array without a copy, then copy the result")
        if stream != -1:
            self._solver._solver.follow(self._pieces, stream or _LEGACY)
        return self._core.capsule()


class DeviceField:
    """Distance and closest site at every node of a grid, in a CUDA device's memory.

    :class:`DeviceFieldSolver` and :class:`DeviceDistanceTransform` return it.

    Examples
    --------
    ::

        field = blum.DeviceFieldSolver(grid).compute(vertices, triangles)
        distance, site = torch.from_dlpack(field.distance), torch.from_dlpack(field.site)
    """

    def __init__(self, distance: Any, site: Any, solver: DeviceFieldSolver | DeviceDistanceTransform) -> None:
        self._distance = distance
        self._site = site
        self._grid = solver.grid
        self._band = solver.band
        self._site_ids = solver.site_ids
        self._sign_rule = solver.sign_rule
        self._device = solver.device

    def __repr__(self) -> str:
        return f"DeviceField({self._grid!r}, sign_rule={self._sign_rule!r}, device={self._device!r})"

    @property
    def distance(self) -> Any:
        """Distances, negative inside when signed: float32 (z, y, x), mesh units. A DeviceArray, or the `out` array."""
        return self._distance

    @property
    def site(self) -> Any:
        """Closest sites, -1 if none: int32 (z, y, x). None if no sites were requested."""
        return self._site

    @property
    def grid(self) -> Grid:
        """Grid of the nodes."""
        return self._grid

    @property
    def band(self) -> float | None:
        """Half-width of the band, mesh units. None without a band."""
        return self._band

    @property
    def site_ids(self) -> str:
        """Numbering of the sites: "features", "triangles" or "voxels"."""
        return self._site_ids

    @property
    def sign_rule(self) -> str:
        """Rule that decided the signs: "winding", "label" or "none"."""
        return self._sign_rule

    @property
    def device(self) -> str:
        """Device that holds the field: "cuda:K"."""
        return self._device


class _DeviceSolver:
    """Common part of the solvers of this module: exchange of arrays, and order between streams."""

    _instead = ""  # Functions for arrays in the host's memory.

    def __init__(self, grid: Grid, core: Any, site_ids: str) -> None:
        self._solver = core
        self._sites: bool = core.options.get("sites", True)
        self._grid = grid
        self._band: float | None = core.options["band"]
        self._site_ids = site_ids
        self._held: deque[tuple[int, tuple[_core.DeviceArray | None, ...]]] = deque()

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._grid!r}, device={self.device!r})"

    @property
    def grid(self) -> Grid:
        """Grid of the nodes."""
        return self._grid

    @property
    def band(self) -> float | None:
        """Half-width of the band, mesh units. None without a band."""
        return self._band

    @property
    def site_ids(self) -> str:
        """Numbering of the sites: "features", "triangles" or "voxels"."""
        return self._site_ids

    @property
    def device(self) -> str:
        """Device that computes the fields: "cuda:K"."""
        return str(self._solver.device)

    def __del__(self) -> None:
        self.__dict__.pop("_solver", None)  # Waits for the device before the arrays are freed.

    def _hold(self, arrays: tuple[_core.DeviceArray | None, ...]) -> None:
        """Keeps arrays alive while queued work uses them. Their owners may drop them at once."""
        self._held.append((self._solver.progress()[0], arrays))

    def _let_go(self) -> None:
        """Drops the arrays of work that the device has finished."""
        _, finished = self._solver.progress()
        while self._held and self._held[0][0] <= finished:
            self._held.popleft()

    def _outputs(self, out: tuple[Any, Any] | None, stream: int) -> tuple[_core.DeviceArray, _core.DeviceArray | None]:
        shape = self._grid.shape
        if out is None:
            size = list(shape)
            return (
                _core.DeviceArray.allocated(self.device, size, "<f4"),
                _core.DeviceArray.allocated(self.device, size, "<i4") if self._sites else None,
            )
        if not isinstance(out, (tuple, list)) or len(out) != 2:
            raise TypeError("out must be a pair of arrays on the device, (distance, site)")
        if (out[1] is not None) != self._sites:
            raise TypeError(f"out[1] must be {'an array' if self._sites else 'None'}, because sites={self._sites}")
        for place, value in enumerate(out):
            interface = getattr(value, "__cuda_array_interface__", None)
            if interface is not None and interface["data"][1]:
                raise ValueError(f"out[{place}] is read-only")
        distance = self._take(out[0], "out[0]", shape, ("<f4",), stream)
        if not self._sites:
            return distance, None
        return distance, self._take(out[1], "out[1]", shape, ("<i4", "<u4"), stream)

    def _results(
        self, distance: _core.DeviceArray, site: _core.DeviceArray | None, out: tuple[Any, Any] | None, pieces: int
    ) -> tuple[Any, Any]:
        if out is not None:
            return out[0], out[1]
        return DeviceArray(distance, self, pieces), None if site is None else DeviceArray(site, self, pieces)

    def _take(
        self, value: Any, name: str, shape: tuple[int | None, ...], types: tuple[str, ...], stream: int
    ) -> _core.DeviceArray:
        """Imports and checks an array. Work that is queued on the stream afterwards reads the array's content."""
        array = _imported(value, name, self._solver, stream, self._instead)
        if array.type not in types:
            raise TypeError(f"{name} must hold {' or '.join(np.dtype(kind).name for kind in types)}")
        if not array.is_contiguous:
            raise ValueError(f"{name} must be C-contiguous")
        found = tuple(array.shape)
        if len(found) != len(shape) or any(want not in (None, size) for want, size in zip(shape, found, strict=True)):
            wanted = ", ".join("n" if size is None else str(size) for size in shape)
            raise ValueError(f"{name} has the shape {found}, but must have ({wanted}{',' if len(shape) == 1 else ''})")
        if array.address % np.dtype(array.type).itemsize:
            raise ValueError(f"{name} must begin at a multiple of its elements' size")
        if array.device != _index(self._solver):
            raise InvalidOption(f"{name} is on cuda:{array.device}, but fields are computed on {self.device}")
        return array


@takes("FieldOptions")
class DeviceFieldSolver(_DeviceSolver):
    """Fields of deforming meshes in a CUDA device's memory, returned as arrays there, without copies.

    Arrays are imported through DLPack or ``__cuda_array_interface__`` (PyTorch, CuPy, JAX, Numba, Warp) and must be
    C-contiguous. Fields are returned with the same protocols. :class:`FieldSolver` takes meshes in the host's memory.

    Parameters
    ----------
    grid : Grid
    device : "cuda" or "cuda:K"
    **options
        For `sign`, "auto" and "winding" both use the winding number. For closed meshes that face outwards, the winding
        number gives the same signs as "normals". "normals" itself needs a mesh in the host's memory. `order` must be 1.

    Examples
    --------
    ::

        solver = blum.DeviceFieldSolver(blum.Grid((-1.3, -1.3, -1.3), 0.02, (128, 128, 128)))

        field = solver.compute(vertices, triangles)           # tensors of PyTorch on the device
        distance = torch.from_dlpack(field.distance)

        field = solver.compute(vertices + step)               # the same triangles
    """

    _instead = "distance_field and FieldSolver take meshes in the host's memory"

    def __init__(
        self,
        grid: Grid,
        *,
        device: str = "cuda",
        **options: Unpack[FieldOptions],
    ) -> None:
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        core = _core.DeviceFieldSolver(grid._spec, dict(options), device_name(device))
        super().__init__(grid, core, core.options["site_ids"])

    @property
    def sign_rule(self) -> str:
        """Rule for the signs of fields with the current triangles: "winding" or "none"."""
        return str(self._solver.sign_rule)

    def compute(
        self,
        vertices: Any,
        triangles: Any = None,
        *,
        segments: Any = None,
        points: Any = None,
        out: tuple[Any, Any] | None = None,
        stream: Any = None,
    ) -> DeviceField:
        """Queues the computation of a mesh's field, and returns the field without waiting for the device.

        There are two exceptions. Calls with new triangles, segments or points wait for the device. If 64 calls are not
        finished, a call waits for the oldest one.

        Parameters
        ----------
        vertices : (n, 3) of float32 or float64, on the device
            If a vertex is not finite, every distance becomes NaN. No error is raised, because the host does not wait
            for the device.
        triangles, segments, points : (m, 3), (m, 2), (m,) of int32, uint32 or int64, on the device
            If none of the three is given, the arrays of the last call are used. A call without new elements skips the
            search for edges, and does not wait for it.
        out : (distance, site), optional
            Arrays on the device to write to: float32, and int32 or uint32, of the grid's shape. Without sites, the
            second entry is None.
        stream : int, or a stream of PyTorch, CuPy or Warp
            Stream of the work. Default: the legacy default stream.

        Raises
        ------
        InvalidMesh, InvalidOption, InvalidGrid (all ValueError), TypeError, OutOfMemory, DeviceError

        Examples
        --------
        ::

            field = solver.compute(vertices, triangles, stream=torch.cuda.current_stream())
        """
        queue = _stream_address(stream)
        self._let_go()
        rows = self._take(vertices, "vertices", (None, 3), _REALS, queue)
        parts = {
            name: None if value is None else self._take(value, name, shape, _INTEGERS, queue)
            for name, value, shape in (
                ("triangles", triangles, (None, 3)),
                ("segments", segments, (None, 2)),
                ("points", points, (None,)),
            )
        }
        used = [part for part in parts.values() if part is not None]
        distance, site = self._outputs(out, queue)
        try:
            pieces = self._solver.compute(rows, **parts, distance=distance, site=site, stream=queue)
        finally:
            self._hold((rows, *used) if out is None else (rows, *used, distance, site))
        return DeviceField(*self._results(distance, site, out, pieces), self)


@takes("DistanceTransformOptions")
class DeviceDistanceTransform(_DeviceSolver):
    """Distance transforms of images in a CUDA device's memory, returned as arrays there, without copies.

    Arrays are exchanged as with :class:`DeviceFieldSolver`. :func:`distance_transform` takes images in the host's
    memory.

    Parameters
    ----------
    grid : Grid
        Grid of the images' voxel centres.
    device : "cuda" or "cuda:K"
    **options

    Examples
    --------
    ::

        transform = blum.DeviceDistanceTransform(blum.Grid((0, 0, 0), 1, mask.shape[::-1]), signed=False)
        distance = cupy.from_dlpack(transform.compute(mask).distance)     # mask: (z, y, x) on the device
    """

    _instead = "distance_transform takes images in the host's memory"

    def __init__(
        self,
        grid: Grid,
        *,
        device: str = "cuda",
        **options: Unpack[DistanceTransformOptions],
    ) -> None:
        if not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        core = _core.DeviceDistanceTransform(grid._spec, dict(options), device_name(device))
        super().__init__(grid, core, "voxels")
        self._sign_rule = "label" if core.options["signed"] else "none"

    @property
    def sign_rule(self) -> str:
        """Rule for signs: "label" or "none"."""
        return self._sign_rule

    def compute(self, values: Any, *, out: tuple[Any, Any] | None = None, stream: Any = None) -> DeviceField:
        """Queues the transform of an image, and returns the transform without waiting for the device.

        There is one exception: if 64 calls are not finished, a call waits for the oldest one.

        Parameters
        ----------
        values : (z, y, x) of booleans or numbers, on the device
            If no voxel is selected, distances are infinite (with a band: its half-width), and no voxel has a site. A
            signed transform has the same result if every voxel is selected. No error is raised, because the host does
            not wait for the device.
        out : (distance, site), optional
            Arrays on the device to write to: float32, and int32 or uint32, of the grid's shape. Without sites, the
            second one is None.
        stream : int, or a stream of PyTorch, CuPy or Warp
            Stream of the work. Default: the legacy default stream.

        Raises
        ------
        InvalidOption (a ValueError), ValueError, TypeError, OutOfMemory, DeviceError

        Examples
        --------
        ::

            field = transform.compute(mask, stream=cupy.cuda.get_current_stream())
        """
        queue = _stream_address(stream)
        self._let_go()
        voxels = self._take(values, "values", self._grid.shape, _NUMBERS, queue)
        distance, site = self._outputs(out, queue)
        try:
            pieces = self._solver.compute(voxels, distance, site, queue)
        finally:
            self._hold((voxels,) if out is None else (voxels, distance, site))
        return DeviceField(*self._results(distance, site, out, pieces), self)


_REALS = ("<f4", "<f8")
_INTEGERS = ("<i4", "<u4", "<i8")
_NUMBERS = ("|b1", "|u1", "|i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f4", "<f8")


def _index(solver: Any) -> int:
    return int(solver.device.partition(":")[2])


def _stream_address(stream: Any) -> int:
    """Returns a stream's address, as the CUDA runtime and DLPack use it."""
    if stream is None:
        return _LEGACY
    protocol = getattr(stream, "__cuda_stream__", None)
    if protocol is not None:
        stream = protocol()[1] if callable(protocol) else protocol[1]
    for attribute in ("cuda_stream", "ptr"):  # PyTorch and Warp; CuPy.
        stream = getattr(stream, attribute, stream)
    if not isinstance(stream, (int, np.integer)):
        raise TypeError(f"stream must be an integer, or a stream of PyTorch, CuPy or Warp, not {type(stream).__name__}")
    address = integer(stream, "stream", bits=65)
    if address < 0:
        raise InvalidOption(f"stream is {address}, but must be 0 or more")
    return address or _LEGACY


def _imported(value: Any, name: str, solver: Any, stream: int, instead: str) -> _core.DeviceArray:
    try:
        if hasattr(value, "__dlpack__") and hasattr(value, "__dlpack_device__"):
            kind, _ = value.__dlpack_device__()
            if int(kind) in (_CUDA, _MANAGED):
                return _core.DeviceArray.of_capsule(value.__dlpack__(stream=stream))
        interface = getattr(value, "__cuda_array_interface__", None)
        if interface is not None:
            return _of_interface(value, interface, solver, stream)
    except Exception as error:
        raise TypeError(f"{name} cannot be used as an array on a device: {error}") from error
    raise TypeError(f"{name} must be in a CUDA device's memory; {instead}")


def _of_interface(value: Any, interface: dict[str, Any], solver: Any, stream: int) -> _core.DeviceArray:
    if interface.get("mask") is not None:
        raise ValueError("it has a mask, which Blum does not support")
    kind = np.dtype(interface["typestr"])
    shape = [int(size) for size in interface["shape"]]
    address = int(interface["data"][0])
    device = _index(solver)
    if 0 not in shape:
        owner = solver.device_of(address)
        if owner is None:
            raise ValueError("its memory is not on a CUDA device")
        device = owner
    before = interface.get("stream")
    if before is not None and int(before) != stream:
        solver.order(int(before), stream)
    is_contiguous = _is_contiguous(shape, interface.get("strides"), kind.itemsize)
    return _core.DeviceArray.at_address(address, shape, kind.str, is_contiguous, device, value)


def _is_contiguous(shape: Sequence[int], strides: Sequence[int] | None, item: int) -> bool:
    if strides is None or 0 in shape:
        return True
    step = item
    for size, stride in zip(reversed(shape), reversed(strides), strict=True):
        if size != 1 and stride != step:
            return False
        step *= size
    return True
