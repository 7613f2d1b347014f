# Puts the tool's test helpers (tests/cli) and the made solids (tests/made) on the import path.
import os
import pathlib
import sys

tests = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(tests / "cli"), str(tests)]

# The tests of on_device need a device whose memory NumPy can read. test_package_devices.py runs them.
collect_ignore = [] if "emulated" in os.environ.get("BLUM_CUDA_MODULE", "") else ["on_device"]
