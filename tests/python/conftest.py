# The package as the build made it, and what the tests of the tool share.
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))

# They want a device whose memory NumPy can read: test_package_devices.py runs them.
collect_ignore = [] if "emulated" in os.environ.get("BLUM_CUDA_MODULE", "") else ["on_device"]
