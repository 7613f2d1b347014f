# Proves that pictures of fields are the right way up, with one colour for each region and lines only at levels.
import math

import numpy as np
import pytest

from tool import BLUM, png_rows, read_png, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


def test_a_distance_picture_is_right_way_up(tmp_path, shapes):
    # The field grows with y alone. The inside (warm) must be at the bottom, the outside (blue) at the top.
    ramp = np.broadcast_to(np.linspace(-1, 2, 40, dtype="<f4")[None, :, None], (2, 40, 40))
    header = "NRRD0004\ntype: float\ndimension: 3\nsizes: 40 40 2\nencoding: raw\nendian: little\nspacings: 0.0769231 0.0769231 0.0769231\n\n"
    (tmp_path / "ramp.nrrd").write_bytes(header.encode() + ramp.tobytes())
    run("slice", tmp_path / "ramp.nrrd", "-o", tmp_path / "ramp.png", "--scale", "10")
    width, height, pixels = read_png(tmp_path / "ramp.png")
    assert width > 440 and height > 420
    top, bottom = pixels[40, 200].astype(int), pixels[400, 200].astype(int)
    assert top[2] > top[0] + 30 and bottom[0] > bottom[2] + 30


def test_a_sites_picture_has_one_colour_for_each_region(tmp_path, shapes):
    site = np.zeros((1, 8, 8), dtype="<i4")
    site[:, :, 4:] = 7
    distance = np.full((1, 8, 8), 1, dtype="<f4")
    np.savez(tmp_path / "two.npz", distance=distance, site=site, origin=np.zeros(3), spacing=np.ones(3))
    run("slice", tmp_path / "two.npz", "-o", tmp_path / "two.png", "--show", "sites", "--scale", "20")
    _, _, pixels = read_png(tmp_path / "two.png")
    left, right = pixels[30:170, 30:90].reshape(-1, 3), pixels[30:170, 110:170].reshape(-1, 3)
    assert len(np.unique(left, axis=0)) == 1 and len(np.unique(right, axis=0)) == 1
    assert np.abs(left[0].astype(int) - right[0].astype(int)).max() > 20


def layer_picture(folder, values):
    """Pixels of the slice of one layer [y, x] of distances, 10 pixels for each node."""
    header = (f"NRRD0004\ntype: float\ndimension: 3\nsizes: {values.shape[1]} {values.shape[0]} 1\nencoding: raw\n"
              "endian: little\nspacings: 1 1 1\n\n")
    (folder / "layer.nrrd").write_bytes(header.encode() + values.astype("<f4").tobytes())
    run("slice", folder / "layer.nrrd", "-o", folder / "layer.png", "--scale", "10")
    height, width = 10 * values.shape[0], 10 * values.shape[1]
    return read_png(folder / "layer.png")[2][20:20 + height, 20:20 + width].astype(int)  # without margins of 20


def test_a_plateau_at_a_contour_level_draws_no_line(tmp_path):
    y, x = np.mgrid[0:40, 0:40]
    radius = np.hypot(x - 19.7, y - 19.3) / 10
    # The plateau is the highest value in both pictures, so it has one colour. 1 is a level, 0.99 is not.
    at_level, beside = (layer_picture(tmp_path, np.minimum(radius, top))
                        for top in (1.0, 0.99))
    corner = (slice(0, 60), slice(0, 60))
    assert np.ptp(at_level[corner].reshape(-1, 3), axis=0).max() == 0
    assert np.array_equal(at_level[corner], beside[corner])
    # Rounding of the plateau's values draws no line.
    noise = np.where((x + y) % 2 == 0, 1, 1 + 1e-7)
    assert np.ptp(layer_picture(tmp_path, np.minimum(radius, 1) * noise)[corner].reshape(-1, 3), axis=0).max() <= 1


def test_contours_do_not_repeat_along_an_oblique_ridge(tmp_path):
    """Along a ridge oblique to the grid, each contour appears once, where the field passes its level."""
    y, x = np.mgrid[0:40, 0:40]
    across, along = (x - y + 0.3) / math.sqrt(2), (x + y) / math.sqrt(2)
    pixels = layer_picture(tmp_path, 39.5 - np.abs(across) + 0.02 * along)
    # The ridge runs from bottom left to top right, 0.3 nodes beside the diagonal of the picture.
    columns = np.arange(30, 370)
    ridge = pixels[394 - columns, columns].sum(axis=1)
    rises = np.diff(ridge)
    assert (rises > 12).sum() <= 3, "dark spots follow one another along the ridge"


def test_pictures_of_every_axis_and_format(shapes, tmp_path):
    for axis in "xyz":
        run("slice", shapes / "sphere.npz", "-o", tmp_path / f"{axis}.png", "--axis", axis, "--index", 0)
        run("slice", shapes / "sphere.nrrd", "-o", tmp_path / f"{axis}s.png", "--axis", axis, "--show", "sites")
        width, height, _ = png_rows(tmp_path / f"{axis}.png")
        assert width >= 800 and 800 <= height < 1000
