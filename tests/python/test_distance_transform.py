"""Proves that the distance transform of images equals SciPy's, and that its sites lie at these distances.

Runs the program distance_transform_sample (tests/support), from BLUM_DISTANCE_TRANSFORM_SAMPLE or below build/. Skips
with a reason if the program, NumPy or SciPy is missing.
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

try:
    import numpy
    from scipy import ndimage
except ImportError as error:
    numpy = None
    MISSING = str(error)

ROOT = pathlib.Path(__file__).resolve().parents[2]


def sample_program():
    named = os.environ.get("BLUM_DISTANCE_TRANSFORM_SAMPLE")
    if named:
        return named
    found = sorted(ROOT.glob("build/*/bin/distance_transform_sample"), key=os.path.getmtime)
    return str(found[-1]) if found else None


def transform(mask, spacing, signed, threads=0):
    """Distances and sites of a [z, y, x] mask; spacing is in x, y, z order."""
    with tempfile.TemporaryDirectory() as folder:
        source, result = os.path.join(folder, "in"), os.path.join(folder, "out")
        mask.astype(numpy.uint8).tofile(source)
        size = [str(n) for n in mask.shape[::-1]]
        command = [sample_program(), source, *size, *[repr(float(h)) for h in spacing]]
        subprocess.run(
            [*command, "signed" if signed else "unsigned", str(threads), result], check=True, stdout=subprocess.DEVNULL
        )
        distance = numpy.fromfile(result, numpy.float32, mask.size).reshape(mask.shape)
        site = numpy.fromfile(result, numpy.int32, offset=4 * mask.size).reshape(mask.shape)
    return distance, site


def site_distance(site, spacing):
    """Distance from each voxel to its site."""
    z, y, x = numpy.indices(site.shape)
    sz, sy, sx = numpy.unravel_index(site, site.shape)
    return numpy.sqrt(
        ((x - sx) * spacing[0]) ** 2 + ((y - sy) * spacing[1]) ** 2 + ((z - sz) * spacing[2]) ** 2
    )


@unittest.skipIf(numpy is None, "needs NumPy and SciPy")
@unittest.skipIf(sample_program() is None, "needs distance_transform_sample; build it or set the variable")
class DistanceTransform(unittest.TestCase):
    def compare(self, mask, spacing):
        sampling = spacing[::-1]
        outside = ndimage.distance_transform_edt(~mask, sampling=sampling)
        inside = ndimage.distance_transform_edt(mask, sampling=sampling)
        for signed, expected in ((False, outside), (True, outside - inside)):
            distance, site = transform(mask, spacing, signed)
            numpy.testing.assert_allclose(distance, expected, rtol=1.2e-7)
            self.assertTrue(numpy.all((site >= 0) & (site < mask.size)))
            target = mask.ravel()[site]
            wanted = ~mask if signed else True
            self.assertTrue(numpy.all(target == wanted), "sites are voxels of the other kind, or selected")
            numpy.testing.assert_allclose(site_distance(site, spacing), numpy.abs(expected), rtol=1e-12)

    def test_random_images(self):
        random = numpy.random.default_rng(1)
        for shape in ((40, 50, 67), (1, 90, 71), (33, 1, 130), (64, 64, 64), (5, 200, 17)):
            for density in (0.0007, 0.02, 0.5, 0.995):
                mask = random.random(shape) < density
                mask.flat[0], mask.flat[-1] = True, False
                for spacing in ((1, 1, 1), (1, 1, 3), (0.3, 0.7, 1.1), (0.488281, 0.488281, 1.25)):
                    with self.subTest(shape=shape, density=density, spacing=spacing):
                        self.compare(mask, spacing)

    def test_ball(self):
        z, y, x = numpy.indices((90, 100, 110))
        mask = (x - 50) ** 2 + (y - 47) ** 2 + (z - 44) ** 2 < 38**2
        self.compare(mask, (1, 1, 1))
        self.compare(mask, (0.7, 0.7, 2.5))


if __name__ == "__main__":
    unittest.main()
