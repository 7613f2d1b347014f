"""Proves that fields are computed on the requested device, or fail if this device does not exist."""

import os
import pathlib
import subprocess
import sys

import blum
import numpy as np
import pytest


def has_cuda():
    try:
        blum.distance_field(blum.generate("box"), resolution=4, device="cuda")
    except blum.DeviceError:
        return False
    return True


CUDA = has_cuda()


@pytest.fixture(scope="module")
def gear():
    return blum.generate("gear")


def test_fields_say_where_they_were_computed(gear):
    assert blum.distance_field(gear, resolution=16).device == "cpu"
    automatic = blum.distance_field(gear, resolution=16, device="auto")
    assert automatic.device == ("cuda:0" if CUDA else "cpu")
    if not CUDA:
        assert np.array_equal(automatic.distance, blum.distance_field(gear, resolution=16).distance)


@pytest.mark.skipif(CUDA, reason="there is a CUDA device")
def test_a_missing_device_is_an_error(gear):
    mask = np.zeros((3, 3, 3), bool)
    mask[1] = True
    grid = blum.Grid.around(gear, resolution=8)
    for call in (
        lambda: blum.distance_field(gear, resolution=8, device="cuda"),
        lambda: blum.distance_transform(mask, device="cuda:0"),
        lambda: blum.FieldSolver(grid, device="cuda:1"),
    ):
        with pytest.raises(RuntimeError, match="CUDA") as caught:
            call()
        assert isinstance(caught.value, blum.DeviceError)
    assert blum.distance_transform(mask, device="auto").device == "cpu"


@pytest.mark.parametrize("wrong", ["gpu", "cuda:", "cuda:-1", "cuda:x", "cuda:1 ", "CUDA", ""])
def test_wrong_names_of_devices_are_rejected(gear, wrong):
    with pytest.raises(blum.InvalidOption, match="device"):
        blum.distance_field(gear, resolution=8, device=wrong)


def test_a_device_is_a_string(gear):
    for wrong in (0, None, b"cpu"):
        with pytest.raises(TypeError, match="device"):
            blum.distance_field(gear, resolution=8, device=wrong)
        with pytest.raises(TypeError, match="device"):
            blum.FieldSolver(blum.Grid.around(gear, resolution=8), device=wrong)


@pytest.mark.skipif(not CUDA, reason="no CUDA device")
def test_a_cuda_device_agrees_with_the_cpu(gear):
    for sign in ("auto", "winding", "none"):
        cpu = blum.distance_field(gear, resolution=96, sign=sign)
        cuda = blum.distance_field(gear, resolution=96, sign=sign, device="cuda")
        assert (cuda.device, cuda.sign_rule, cuda.sign_reason) == ("cuda:0", cpu.sign_rule, cpu.sign_reason)
        assert np.abs(cuda.distance - cpu.distance).max() < 4e-6
    mask = np.random.default_rng(1).random((40, 50, 60)) < 0.1
    cpu, cuda = (blum.distance_transform(mask, spacing=(1, 2, 3), device=device) for device in ("cpu", "cuda"))
    assert np.array_equal(cpu.distance, cuda.distance)
    assert np.array_equal(cpu.site, cuda.site)


def test_memory_of_a_device():
    """Runs tests/python/on_device with a module whose device is the host."""
    here = pathlib.Path(__file__).resolve().parent
    module = pathlib.Path(os.environ["BLUM_BIN_DIR"]) / "libblum_emulated_cuda.so"
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(here / "on_device")]
    done = subprocess.run(
        command, env={**os.environ, "BLUM_CUDA_MODULE": str(module)}, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert " passed" in done.stdout
    assert "skipped" not in done.stdout


def test_arrays_on_a_device_get_a_hint_for_the_device_solver(gear):
    class OnDevice:
        @property
        def __cuda_array_interface__(self):
            return {"shape": (3, 3), "typestr": "<f8", "data": (4096, False), "version": 3}

    class OfPyTorch:
        def __dlpack_device__(self):
            return 2, 0

        def __dlpack__(self, **_):
            raise AssertionError("it must not be asked for")

    for array in (OnDevice(), OfPyTorch()):
        for call in (
            lambda array=array: blum.distance_field(array, gear.triangles, resolution=8),
            lambda array=array: blum.closest_points(gear, array),
            lambda array=array: blum.distance_transform(array),
        ):
            with pytest.raises(TypeError, match="DeviceFieldSolver"):
                call()


def test_devices_of_pytorch_are_names(gear):
    class Device:
        def __init__(self, kind, index=None):
            self.type, self.index = kind, index

    assert blum.distance_field(gear, resolution=8, device=Device("cpu")).device == "cpu"
    with pytest.raises(blum.DeviceError, match="CUDA"):
        blum.distance_field(gear, resolution=8, device=Device("cuda", 99))
