"""Proves that fields from and to a CUDA device's memory equal those of meshes in the host's memory.

test_package_devices.py runs this file with a module whose device is the host (BLUM_CUDA_MODULE), so that NumPy can read
the device's memory.
"""

import ctypes
import gc
import weakref
from concurrent.futures import ThreadPoolExecutor

import blum
import numpy as np
import pytest


class OnDevice:
    """An array with __cuda_array_interface__ alone."""

    def __init__(self, values, stream=None, strides=None, read_only=False):
        self.values = np.array(values, order="C")
        self.stream = stream
        self.strides = strides
        self.read_only = read_only

    @property
    def __cuda_array_interface__(self):
        interface = {
            "shape": self.values.shape,
            "typestr": self.values.dtype.str,
            "data": (self.values.ctypes.data, self.read_only),
            "version": 3,
        }
        if self.stream is not None:
            interface["stream"] = self.stream
        if self.strides is not None:
            interface["strides"] = self.strides
        return interface


class ByDlpack:
    """An array with DLPack alone, like PyTorch's tensors; it records the streams of requests."""

    def __init__(self, values, index=0):
        self.values = np.array(values, order="C")
        self.index = index
        self.streams = []

    def __dlpack_device__(self):
        return 2, self.index

    def __dlpack__(self, *, stream=None):
        self.streams.append(stream)
        core = blum._core.DeviceArray.at_address(
            self.values.ctypes.data, list(self.values.shape), self.values.dtype.str, True, self.index, self.values
        )
        return core.capsule()


def on_host(array):
    """The content of a DeviceArray of the emulated device."""
    interface = array.__cuda_array_interface__
    count = int(np.prod(interface["shape"]))
    kind = np.dtype(interface["typestr"])
    memory = (ctypes.c_char * (count * kind.itemsize)).from_address(interface["data"][0])
    return np.frombuffer(bytes(memory), kind).reshape(interface["shape"])


@pytest.fixture(scope="module")
def mesh():
    return blum.generate("torus")


@pytest.fixture(scope="module")
def grid(mesh):
    return blum.Grid.around(mesh, resolution=20, padding=0.3)


def check(field, expected):
    assert np.array_equal(on_host(field.distance), expected.distance)
    assert np.array_equal(on_host(field.site), expected.site)


@pytest.mark.parametrize("kind", [OnDevice, ByDlpack])
@pytest.mark.parametrize("real", [np.float32, np.float64])
@pytest.mark.parametrize("index", [np.int32, np.uint32, np.int64])
def test_fields_are_those_of_the_host(mesh, grid, kind, real, index):
    solver = blum.DeviceFieldSolver(grid)
    vertices = mesh.vertices.astype(real)
    field = solver.compute(kind(vertices), kind(mesh.triangles.astype(index)))
    check(field, blum.distance_field(vertices.astype(float), mesh.triangles, grid=grid, device="cuda"))
    assert field.sign_rule == "winding"
    assert field.device == solver.device == "cuda:0"
    assert field.distance.dtype == np.float32
    assert field.site.dtype == np.int32
    assert field.distance.shape == field.grid.shape == grid.shape
    assert field.grid is grid


def test_options_are_those_of_fields(mesh, grid):
    arrays = OnDevice(mesh.vertices), OnDevice(mesh.triangles)
    for options in ({"sign": "none"}, {"band": 0.1}, {"site_ids": "triangles"}, {"sign": "winding", "band": 0.2}):
        field = blum.DeviceFieldSolver(grid, **options).compute(*arrays)
        check(field, blum.distance_field(mesh, grid=grid, device="cuda", **options))
        assert field.band == options.get("band")
        assert field.site_ids == options.get("site_ids", "features")


def test_fields_without_sites_have_the_same_distances(mesh, grid):
    arrays = OnDevice(mesh.vertices), OnDevice(mesh.triangles)
    expected = blum.distance_field(mesh, grid=grid, device="cuda").distance
    assert blum.distance_field(mesh, grid=grid, device="cuda", sites=False).site is None
    solver = blum.DeviceFieldSolver(grid, sites=False)
    field = solver.compute(*arrays)
    assert field.site is None and np.array_equal(on_host(field.distance), expected)
    out = OnDevice(np.zeros(grid.shape, np.float32))
    assert solver.compute(*arrays, out=(out, None)).distance is out
    assert np.array_equal(out.values, expected)
    with pytest.raises(TypeError, match="None"):
        solver.compute(*arrays, out=(out, OnDevice(np.zeros(grid.shape, np.int32))))
    with pytest.raises(TypeError, match="an array"):
        blum.DeviceFieldSolver(grid).compute(*arrays, out=(out, None))


def test_a_deforming_mesh_keeps_its_triangles(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)
    with pytest.raises(blum.InvalidOption, match="triangles"):
        solver.compute(OnDevice(mesh.vertices))
    solver.compute(OnDevice(mesh.vertices), OnDevice(mesh.triangles))
    field = solver.compute(OnDevice(mesh.vertices * 0.9))
    check(field, blum.distance_field(mesh.vertices * 0.9, mesh.triangles, grid=grid, device="cuda"))
    with pytest.raises(blum.InvalidMesh, match="vertices"):
        solver.compute(OnDevice(mesh.vertices[1:]))


def test_segments_and_points(grid):
    vertices = np.array([[0.0, 0, 0], [0.5, 0, 0], [0, 0.5, 0.1]])
    field = blum.DeviceFieldSolver(grid).compute(
        OnDevice(vertices), segments=OnDevice([[0, 1]]), points=OnDevice(np.array([2], np.int32))
    )
    expected = blum.distance_field(blum.Mesh(vertices, segments=[[0, 1]], points=[2]), grid=grid, device="cuda")
    check(field, expected)
    assert field.sign_rule == "none"


def test_out_is_written_to(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)
    for integer in (np.int32, np.uint32):
        out = OnDevice(np.zeros(grid.shape, np.float32)), OnDevice(np.zeros(grid.shape, integer))
        field = solver.compute(OnDevice(mesh.vertices), OnDevice(mesh.triangles), out=out)
        assert (field.distance, field.site) == out
        expected = blum.distance_field(mesh, grid=grid, device="cuda")
        assert np.array_equal(out[0].values, expected.distance)
        assert np.array_equal(out[1].values.view(np.int32), expected.site)


def test_streams_reach_the_arrays(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)

    class OfTorch:
        cuda_stream = 0

    class OfCupy:
        ptr = 4096

    class OfProtocol:
        def __cuda_stream__(self):
            return 0, 77

    for stream, address in ((None, 1), (OfProtocol(), 77), (2, 2), (7, 7), (OfTorch(), 1), (OfCupy(), 4096), (np.int64(9), 9)):
        vertices = ByDlpack(mesh.vertices)
        field = solver.compute(vertices, OnDevice(mesh.triangles, stream=5), stream=stream)
        assert vertices.streams == [address]
        assert field.distance.__cuda_array_interface__["stream"] == 1
    for wrong in (-1, 1.5, "default"):
        with pytest.raises((TypeError, blum.InvalidOption), match="stream"):
            solver.compute(OnDevice(mesh.vertices), stream=wrong)


def test_fields_are_exported_by_dlpack(mesh, grid):
    field = blum.DeviceFieldSolver(grid).compute(OnDevice(mesh.vertices), OnDevice(mesh.triangles))
    expected = blum.distance_field(mesh, grid=grid, device="cuda")
    distance = field.distance
    assert distance.__dlpack_device__() == (2, 0)
    for stream in (None, 1, 2, -1):
        shared = blum._core.DeviceArray.of_capsule(distance.__dlpack__(stream=stream))
        assert (shared.address, tuple(shared.shape), shared.type) == (distance.address, grid.shape, "<f4")
    with pytest.raises(BufferError):
        distance.__dlpack__(copy=True)
    with pytest.raises(BufferError):
        distance.__dlpack__(dl_device=(1, 0))
    # An array that shares the memory keeps the memory.
    address = distance.address
    del field, distance
    gc.collect()
    memory = (ctypes.c_float * expected.distance.size).from_address(address)
    assert np.array_equal(np.frombuffer(bytes(memory), np.float32), expected.distance.ravel())
    assert shared.address == address


def test_arrays_that_the_device_may_still_read_are_kept(mesh, grid):
    class Vertices(OnDevice):
        pass

    vertices, out = Vertices(mesh.vertices), OnDevice(np.zeros(grid.shape, np.float32))
    gone = weakref.ref(vertices)
    field = blum.DeviceFieldSolver(grid).compute(vertices, OnDevice(mesh.triangles))
    distance = field.distance
    del vertices, field
    gc.collect()
    assert gone() is not None  # the array keeps the solver, which keeps the vertices
    del distance
    gc.collect()
    assert gone() is None
    # A failed call may have queued work, too.
    solver = blum.DeviceFieldSolver(grid)
    vertices = Vertices(mesh.vertices)
    gone = weakref.ref(vertices)
    with pytest.raises(blum.InvalidMesh):
        solver.compute(vertices, OnDevice(mesh.triangles + 1), out=(out, OnDevice(np.zeros(grid.shape, np.int32))))
    del vertices
    gc.collect()
    assert gone() is not None
    solver.compute(OnDevice(mesh.vertices), OnDevice(mesh.triangles))
    gc.collect()
    assert gone() is None


def test_arrays_with_wrong_interfaces_are_rejected(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)
    triangles = OnDevice(mesh.triangles)

    class Lying(OnDevice):
        def __init__(self, values, **entries):
            super().__init__(values)
            self.entries = entries

        @property
        def __cuda_array_interface__(self):
            return {**super().__cuda_array_interface__, **self.entries}

    class OfTheHost(ByDlpack):
        def __dlpack__(self, *, stream=None):
            return self.values.__dlpack__()

    class Failing(ByDlpack):
        def __dlpack__(self, *, stream=None):
            raise RuntimeError("no more")

    odd = Lying(mesh.vertices)
    odd.entries["data"] = (odd.values.ctypes.data + 4, False)
    for wrong, error, text in (
        (odd, ValueError, "multiple"),
        (Lying(mesh.vertices, mask=OnDevice(mesh.vertices)), TypeError, "mask"),
        (Lying(mesh.vertices, typestr="nonsense"), TypeError, "vertices cannot be used"),
        (Lying(mesh.vertices, shape=("a", 3)), TypeError, "vertices cannot be used"),
        (Lying(mesh.vertices, data=None), TypeError, "vertices cannot be used"),
        (OfTheHost(mesh.vertices), TypeError, "not for a CUDA device"),
        (Failing(mesh.vertices), TypeError, "no more"),
    ):
        with pytest.raises(error, match=text):
            solver.compute(wrong, triangles)
    with pytest.raises(TypeError, match="CUDA device's memory"):
        np.asarray(solver.compute(OnDevice(mesh.vertices), triangles).distance)


def test_threads_share_a_solver(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)
    expected = blum.distance_field(mesh, grid=grid, device="cuda")
    with ThreadPoolExecutor(4) as pool:
        fields = list(pool.map(lambda _: solver.compute(OnDevice(mesh.vertices), OnDevice(mesh.triangles)), range(8)))
    for field in fields:
        check(field, expected)


def test_wrong_arrays_are_rejected(mesh, grid):
    solver = blum.DeviceFieldSolver(grid)
    vertices, triangles = OnDevice(mesh.vertices), OnDevice(mesh.triangles)
    for wrong, error, text in (
        ((mesh.vertices, triangles), TypeError, "vertices must be in a CUDA device's memory"),
        ((mesh.vertices.tolist(), triangles), TypeError, "vertices"),
        ((vertices, mesh.triangles), TypeError, "triangles"),
        ((OnDevice(mesh.vertices.astype(np.float16)), triangles), TypeError, "float32 or float64"),
        ((OnDevice(mesh.vertices.astype(">f8")), triangles), TypeError, "vertices"),
        ((vertices, OnDevice(mesh.vertices)), TypeError, "triangles must hold int32"),
        ((OnDevice(mesh.vertices[:, :2]), triangles), ValueError, r"\(n, 3\)"),
        ((OnDevice(mesh.vertices[0]), triangles), ValueError, "shape"),
        ((OnDevice(mesh.vertices, strides=(8, 8)), triangles), ValueError, "C-contiguous"),
        ((ByDlpack(mesh.vertices, 1), triangles), blum.InvalidOption, "cuda:1"),
        ((vertices, OnDevice(mesh.triangles + 1)), blum.InvalidMesh, "index"),
        ((vertices, OnDevice(mesh.triangles - 1)), blum.InvalidMesh, "index"),
        ((vertices, OnDevice(np.zeros((0, 3), np.int32))), blum.InvalidMesh, "no triangles"),
    ):
        with pytest.raises(error, match=text):
            solver.compute(*wrong)
    good = OnDevice(np.zeros(grid.shape, np.float32)), OnDevice(np.zeros(grid.shape, np.int32))
    for out, error, text in (
        (good[0], TypeError, "pair"),
        ((good[1], good[0]), TypeError, "float32"),
        ((OnDevice(np.zeros((2, 2, 2), np.float32)), good[1]), ValueError, "shape"),
        ((OnDevice(np.zeros(grid.shape, np.float32), read_only=True), good[1]), ValueError, "read-only"),
    ):
        with pytest.raises(error, match=text):
            solver.compute(vertices, triangles, out=out)
    for options in ({"sign": "normals"}, {"band": 0}, {"site_ids": "voxels"}, {"device": "cpu"}):
        with pytest.raises(blum.InvalidOption):
            blum.DeviceFieldSolver(grid, **options)
    with pytest.raises(blum.DeviceError, match="no CUDA device 3"):
        blum.DeviceFieldSolver(grid, device="cuda:3")
    with pytest.raises(TypeError, match="grid"):
        blum.DeviceFieldSolver(grid.shape)
    check(solver.compute(vertices, triangles), blum.distance_field(mesh, grid=grid, device="cuda"))


def test_vertices_of_nan_give_a_field_of_nan(mesh, grid):
    vertices = mesh.vertices.copy()
    vertices[3] = np.nan
    field = blum.DeviceFieldSolver(grid).compute(OnDevice(vertices), OnDevice(mesh.triangles))
    assert np.isnan(on_host(field.distance)).all()
    assert (on_host(field.site) == -1).all()


@pytest.mark.parametrize("kind", [OnDevice, ByDlpack])
@pytest.mark.parametrize("number", [np.bool_, np.uint8, np.int8, np.uint16, np.int16, np.uint32, np.int32, np.uint64,
                                    np.int64, np.float32, np.float64])
def test_images_are_those_of_the_host(kind, number):
    values = np.random.default_rng(3).integers(0, 4, (7, 12, 9)).astype(number)
    grid = blum.Grid((0, 0, 0), (1, 0.5, 2), (9, 12, 7))
    for options in ({}, {"signed": False}, {"label": 1}, {"threshold": 1, "band": 1.5}):
        transform = blum.DeviceDistanceTransform(grid, **options)
        field = transform.compute(kind(values))
        check(field, blum.distance_transform(values, spacing=(1, 0.5, 2), **options))
        assert field.site_ids == "voxels"
        assert field.sign_rule == transform.sign_rule == ("label" if options.get("signed", True) else "none")
        assert field.band == options.get("band")
        half = blum.DeviceDistanceTransform(grid, sites=False, **options)
        without = half.compute(kind(values))
        assert without.site is None and np.array_equal(on_host(without.distance), on_host(field.distance))
        out = OnDevice(np.zeros(grid.shape, np.float32))
        half.compute(kind(values), out=(out, None))
        assert np.array_equal(out.values, on_host(field.distance))
        host = blum.distance_transform(values, spacing=(1, 0.5, 2), device="cuda", sites=False, **options)
        assert host.site is None and np.array_equal(host.distance, on_host(field.distance))


def test_images_without_selected_voxels_are_infinitely_far():
    grid = blum.Grid((0, 0, 0), 1, (5, 6, 7))
    for fill, options in ((0, {}), (1, {}), (0, {"signed": False})):
        field = blum.DeviceDistanceTransform(grid, **options).compute(OnDevice(np.full(grid.shape, fill)))
        assert np.isinf(on_host(field.distance)).all()
        assert (on_host(field.site) == -1).all()


def test_wrong_images_are_rejected():
    grid = blum.Grid((0, 0, 0), 1, (5, 6, 7))
    transform = blum.DeviceDistanceTransform(grid)
    for wrong, error, text in (
        (np.zeros(grid.shape), TypeError, "CUDA device's memory"),
        (OnDevice(np.zeros((5, 6, 7))), ValueError, "shape"),
        (OnDevice(np.zeros(grid.shape, complex)), TypeError, "values must hold"),
    ):
        with pytest.raises(error, match=text):
            transform.compute(wrong)
    for options in ({"label": 1, "threshold": 2}, {"threshold": np.nan}, {"band": -1}, {"device": "cpu"}):
        with pytest.raises(blum.InvalidOption):
            blum.DeviceDistanceTransform(grid, **options)
    for wrong in (blum.Grid((0, 0, 0), 1, (1 << 11, 1 << 11, 1 << 11)), blum.Grid((0, 0, 0), 1e37, (2, 2, 2))):
        with pytest.raises((blum.InvalidImage, blum.InvalidGrid)):
            blum.DeviceDistanceTransform(wrong)
    out = OnDevice(np.zeros(grid.shape, np.float32)), OnDevice(np.zeros(grid.shape, np.int32))
    values = np.zeros(grid.shape, np.uint8)
    values[2, 3, 1] = 1
    assert transform.compute(OnDevice(values), out=out, stream=2).distance is out[0]
    assert np.array_equal(out[0].values, blum.distance_transform(values).distance)
