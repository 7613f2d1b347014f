#!/usr/bin/env bash
# PyVista 0.49.1: select_interior_points swaps inside and outside of mirrored parts.
#
# Versions: pyvista 0.49.1, vtk 9.7.2.
# reflect() keeps the order of the corners, so the faces of a mirrored part point inwards.
# select_interior_points replaces select_enclosed_points, which is deprecated. The default method takes
# the sign of compute_implicit_distance; the documentation calls this method more reliable.
#
# Expected: the inside of a closed surface does not depend on the order of its corners, as in the old
# filter. Or the default check of the surface rejects a surface that faces inwards.
# Seen: a cube and its mirror image have the same volume and both pass the check.
# For the mirror image, points inside are False and points outside are True.
# The old filter, and method="cell_locator", select the same points for both.
#
# Affected: users of symmetric parts, half models and images with a left-handed frame, who follow the
# deprecation warning. The result has the right type and shape, and there is no warning.
# Workaround: call mesh.compute_normals(auto_orient_normals=True) first, or method="cell_locator".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check pyvista==0.49.1 vtk==9.7.2 numpy==2.4.6
cat >look.py <<'END'
import warnings

import numpy as np
import pyvista as pv

warnings.simplefilter("ignore")
part = pv.Cube().triangulate().clean()
points = pv.PolyData(np.array([[0.0, 0, 0], [0.4, 0.3, 0.2], [3, 0, 0], [0, -2, 0]]))
truth = [True, True, False, False]


def inside(mesh, **options):
    return points.select_interior_points(mesh, **options)["selected_points"].tolist()


mirrored = part.reflect((1, 0, 0))
turned = mirrored.compute_normals(auto_orient_normals=True)
for name, mesh in (("part", part), ("mirrored", mirrored), ("mirrored, oriented", turned)):
    old = points.select_enclosed_points(mesh)["SelectedPoints"].astype(bool).tolist()
    print(f"{name}: volume {mesh.volume:.6g}, default {inside(mesh)}, "
          f"cell_locator {inside(mesh, method='cell_locator')}, select_enclosed_points {old}")
    assert old == inside(mesh, method="cell_locator") == truth, name
assert part.is_manifold and mirrored.is_manifold and abs(mirrored.volume - 1) < 1e-6
assert inside(part) == inside(turned) == truth
assert inside(mirrored) == [not value for value in truth], "changed: mirrored parts keep their inside"
END
env/bin/python look.py
