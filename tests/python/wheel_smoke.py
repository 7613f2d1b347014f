"""Proves that an installed wheel works with NumPy alone: python wheel_smoke.py torus.ply (tools/check_wheel.sh)."""

import pathlib
import sys

import blum
import numpy as np

package = pathlib.Path(blum.__file__).parent
assert "site-packages" in package.parts, package
mesh = blum.read_mesh(sys.argv[1])
field = blum.distance_field(mesh, resolution=32)
assert field.sign_rule == "normals"
assert field.distance.min() < 0 < field.distance.max()
axis = blum.medial_axis(mesh, resolution=32).simplify(60)
assert axis.certificate.axis_betti == (1, 1, 0)
# Conversions to packages that are not installed return arrays.
assert isinstance(mesh.to_trimesh(), tuple)
assert isinstance(field.to_pyvista(), dict)
assert isinstance(axis.to_pyvista()["vertices"], np.ndarray)
try:
    blum.distance_field(mesh, resolution=8, progress=True)
except ImportError as error:
    assert "tqdm" in str(error)
# The libraries that the package loads lie in the wheel.
for line in pathlib.Path("/proc/self/maps").read_text().splitlines():
    library = pathlib.Path(line.split(maxsplit=5)[-1])
    if any(name in library.name for name in ("libtbb", "libhwy")):
        assert package in library.parents, library
print(f"blum {blum.__version__} from {package}: {field}")
