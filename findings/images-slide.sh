#!/usr/bin/env bash
# PyVista 0.49.1, VTK 9.7.2: resample() moves images whose axes are not the world axes.
#
# Versions: pyvista 0.49.1, vtk 9.7.2, SimpleITK 2.5.7 for comparison.
# The documentation of resample() states that the resampled image "fits the bounds of the input". By default it extends
# the border by half a voxel. So the origin moves by half the difference of the voxels, along the axes of the image.
# vtkImageResize, which computes it, moves the origin along the world axes instead.
#
# Expected: outer edges of the first and last voxels, and the centre of an object, stay where they are in the world.
# Seen: for identity directions they stay. For the directions diag(-1, -1, 1), which convert between the frames LPS and
# RAS, a quarter of the resolution moves a box by 3 mm along x and along y: 0.75 of the new voxels.
# After a quarter turn about z, with voxels of 1, 2 and 3 mm, the error is (4.5, 1.5, 0) mm.
# Point data and cell data move alike, and up-sampling moves them in the other direction.
#
# Affected: users of medical images, who reduce an image or a mask before they extract a surface or compute distances.
# The surface is out of place with respect to the full image; its shape and size are right, and nothing warns.
# Workaround: correct the origin as corrected() below does. For point data, extend_border=False keeps the place.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check pyvista==0.49.1 vtk==9.7.2 SimpleITK==2.5.7 numpy==2.4.6
cat >look.py <<'END'
import numpy as np
import pyvista as pv
import SimpleITK as sitk

print("pyvista", pv.__version__, "vtk", pv.vtk_version_info, "SimpleITK", sitk.Version.VersionString())
DIRECTIONS = {
    "identity": np.eye(3),
    "diag(-1, -1, 1)": np.diag([-1.0, -1, 1]),
    "quarter turn about z": np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]),
}


def image(direction, spacing, cells):
    """64^3 voxels; those of a box are 1."""
    result = pv.ImageData(dimensions=(64, 64, 64), spacing=spacing, origin=(5, 6, 7))
    result.direction_matrix = direction
    box = np.zeros((64, 64, 64))
    box[16:32, 24:48, 20:40] = 1
    result["box"] = box.ravel(order="F")
    return result.points_to_cells() if cells else result


def centre(image):
    points = image if image.point_data else image.cells_to_points()
    return (points.points * points["box"][:, None]).sum(0) / points["box"].sum()


def edges(image):
    """The bounds of the voxels, not of their centres."""
    voxels = image if image.cell_data else image.points_to_cells()
    return np.array(voxels.bounds)


def corrected(small, large):
    """The resampled image with the origin that keeps the outer edges."""
    direction = large.direction_matrix
    half = (np.array(small.spacing) - large.spacing) / 2 * (not large.cell_data)
    result = small.copy()
    result.origin = large.origin + direction @ half
    return result


def centre_by_itk(direction, spacing, rate):
    """The centre after the same steps in SimpleITK."""
    large = image(direction, spacing, False)
    source = sitk.GetImageFromArray(large["box"].reshape(64, 64, 64))
    source.SetSpacing(spacing)
    source.SetOrigin(large.origin)
    source.SetDirection(direction.ravel())
    new = np.array(spacing) / rate
    origin = np.array(large.origin) + direction @ ((new - spacing) / 2)
    size = [int(64 * rate)] * 3
    small = sitk.Resample(source, size, sitk.Transform(), sitk.sitkLinear, origin, new, direction.ravel())
    values = sitk.GetArrayFromImage(small)
    index = np.argwhere(values)[:, ::-1]
    weight = values[values != 0]
    places = origin + (index * new) @ direction.T
    return (places * weight[:, None]).sum(0) / weight.sum()


for name, direction in DIRECTIONS.items():
    for spacing in ((1.0, 1.0, 1.0), (1.0, 2.0, 3.0)):
        for rate in (0.25, 2.0):
            half = (np.array(spacing) / rate - spacing) / 2
            for cells in (False, True):
                large = image(direction, spacing, cells)
                small = large.resample(sample_rate=rate, interpolation="linear")
                moved = centre(small) - centre(large)
                assert np.allclose(small.direction_matrix, direction)
                assert np.allclose(moved, half - direction @ half), "changed: the origin"
                assert np.allclose(centre(corrected(small, large)), centre(large)), "changed: the workaround"
                assert np.allclose(edges(corrected(small, large)), edges(large)), "changed: the workaround"
            by_itk = centre_by_itk(direction, spacing, rate) - centre(large)
            assert np.allclose(by_itk, 0, atol=1e-6)
            print(f"{name}, voxels {spacing}, rate {rate}: moved by {np.round(moved, 6) + 0.0}, "
                  f"in SimpleITK by {np.round(by_itk, 6) + 0.0}")
kept = image(DIRECTIONS["diag(-1, -1, 1)"], (1.0, 1.0, 1.0), False)
moved = edges(kept.resample(sample_rate=0.25)) - edges(kept)
print("edges of the voxels for diag(-1, -1, 1), rate 0.25: moved by", moved)
assert np.allclose(moved, [3, 3, 3, 3, 0, 0]), "changed: edges"
END
env/bin/python look.py
