#!/usr/bin/env bash
# SciPy 1.17.1, scikit-image 0.26.0, SimpleITK 2.5.7: distances in an image without background are those to a voxel
# that does not exist, and differ between functions of one module.
#
# Versions: scipy 1.17.1, scikit-image 0.26.0, SimpleITK 2.5.7, edt 3.1.2, numpy 2.4.6.
# A label that fills its crop has no background voxel. Such crops are common where code cuts out each label by its
# bounding box. No documentation limits the functions to images with background.
#
# Expected: infinity, or an error, and the same from all three transforms of scipy.ndimage.
# Seen: distance_transform_edt() returns distances to the index (-1, 0, 0), outside the array, and this index as the
# closest background voxel. As a NumPy index, -1 reads the last row. distance_transform_cdt() returns -1 everywhere.
# distance_transform_bf() returns 1.3e154 or 4294967295, by metric.
# So skimage.morphology.medial_axis() of a full frame is not symmetric, with radii that grow from one corner.
# SimpleITK: SignedMaurerDistanceMap() returns 1.8e19, DanielssonDistanceMap() of no object finite distances that no
# object has. Only edt returns infinity.
#
# Affected: thickness, erosion by a distance, and peaks of distances per label. Distances look plausible: 1 to 7.5 here.
# Workaround: pad the crop with a layer of background if the border counts as background; else test mask.all() first.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check scipy==1.17.1 scikit-image==0.26.0 SimpleITK==2.5.7 \
  edt==3.1.2 numpy==2.4.6
cat >look.py <<'END_OF_PYTHON'
import warnings

import edt
import numpy as np
import SimpleITK as sitk
from scipy import ndimage
from skimage.morphology import medial_axis

warnings.simplefilter("ignore")
full = np.ones((4, 5, 6), np.uint8)

distance, index = ndimage.distance_transform_edt(full, return_indices=True)
print("scipy edt:", distance.min(), "to", distance.max(), "closest voxel of [3, 4, 5]:", index[:, 3, 4, 5])
at = np.indices(full.shape)
assert np.array_equal(distance, np.sqrt((at[0] + 1) ** 2 + at[1] ** 2 + at[2] ** 2)), "changed: distances"
assert (index[0] == -1).all() and (index[1:] == 0).all(), "changed: indices"

chamfer = ndimage.distance_transform_cdt(full)
brute = [float(ndimage.distance_transform_bf(full, metric=metric).max()) for metric in ("euclidean", "taxicab")]
print("scipy cdt:", np.unique(chamfer), "scipy bf:", brute)
assert (chamfer == -1).all() and brute[0] > 1e100 and brute[1] == 4294967295, "changed: the other transforms"

skeleton, radius = medial_axis(np.ones((7, 9), bool), return_distance=True)
print("skimage medial_axis: radius", radius.min(), "to", round(radius.max(), 2), "symmetric:",
      np.array_equal(skeleton, skeleton[::-1]), np.array_equal(radius, radius[::-1]))
assert not np.array_equal(radius, radius[::-1]) and radius[6, 8] == radius.max(), "changed: medial_axis"

image = sitk.GetImageFromArray(full)
maurer = sitk.GetArrayFromImage(sitk.SignedMaurerDistanceMap(image, squaredDistance=False, useImageSpacing=True))
nothing = sitk.GetArrayFromImage(sitk.DanielssonDistanceMap(image == 0, inputIsBinary=True))
print("SimpleITK Maurer:", abs(maurer).min(), "Danielsson of no object:", nothing.min(), "to", nothing.max())
assert abs(maurer).min() > 1e18 and nothing.max() < 100, "changed: SimpleITK"
assert np.isinf(edt.edt(full)).all(), "changed: edt"
END_OF_PYTHON
env/bin/python look.py
