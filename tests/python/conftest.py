# The package as the build made it, what the tests of the tool share, and the made solids (tests/made).
import os
import pathlib
import sys

tests = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(tests / "cli"), str(tests)]

# They want a device whose memory NumPy can read: test_package_devices.py runs them.
collect_ignore = [] if "emulated" in os.environ.get("BLUM_CUDA_MODULE", "") else ["on_device"]
