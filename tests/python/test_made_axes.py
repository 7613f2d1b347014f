"""Proves that medial axes of made solids with walls, gaps and holes far narrower than a voxel are certified.

All 300 solids if the environment variable BLUM_MADE_SOLIDS is 300, else the hard ones."""

import os
import warnings

import blum
import pytest
from amount import some
from made import made_solid, names

#: Holes so thin and slanted that the model would need millions of boxes. Their axes are reported as not certified.
TOO_THIN = {("pinholes", 7)}
#: Solids on which earlier versions failed, each with the resolution of the failure. They have thin holes, walls or
#: folds, plates that graze, a void in a bent wall, or parts that connect within a voxel around corners.
HARD = [
    ("drillings", 3, 48),
    ("pinholes", 1, 48),
    ("pinholes", 2, 48),
    ("crossed_plates", 3, 48),
    ("grazing", 4, 48),
    ("thin_shells", 5, 48),
    ("bellows", 4, 64),
    ("crossing_rods", 7, 64),
    ("crossed_plates", 5, 64),
    ("drillings", 5, 64),
]
#: Solids whose last bits decide whether this grid and these borders are certified. NumPy computes other bits on other
#: processors. A void is so thin that its tip may cross a face of the grid, or borders that moved miss an end of a plate.
#: The tool then moves the grid, or leaves borders at the cells of the grid, and warns.
LAST_BITS_DECIDE = {("crossed_plates", 3), ("crossed_plates", 5)}
ALL = [(*name, 48) for name in names() if name not in TOO_THIN]
CHOSEN = ALL if os.environ.get("BLUM_MADE_SOLIDS") == "300" else HARD


@pytest.mark.parametrize("family, variant, resolution", CHOSEN, ids=[f"{c[0]}-{c[1]}" for c in CHOSEN])
def test_axes_of_made_solids_are_certified(family, variant, resolution):
    made = made_solid(family, variant)
    mesh = blum.Mesh(made.vertices, made.triangles)
    axis = blum.medial_axis(mesh, resolution=resolution)
    if (family, variant) in LAST_BITS_DECIDE:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", blum.InputWarning)
            certificates = [axis.certified(60.0).certificate]
    else:
        thetas = some((60.0, 20.0), 1 if family == "crossing_rods" else 2)  # this one takes half a minute
        certificates = [blum.certify(axis.simplify(theta, fit=theta > 20), mesh) for theta in thetas]
    for found in certificates:
        assert found, found.mismatches
        assert found.homology.across == 0


def test_discs_that_close_tubes_end_at_the_rim_of_their_wall():
    """The middle sheet of a wall far thinner than a voxel ends at the tube's side."""
    made = made_solid("membranes", 6)
    mesh = blum.Mesh(made.vertices, made.triangles)
    axis = blum.medial_axis(mesh, resolution=64)
    for theta in (120.0, 170.0):
        complex_ = axis.simplify(theta, fit=True)
        found = blum.certify(complex_, mesh)
        assert found, found.mismatches
    # Triangles at about 180 degrees have no corner with a much smaller angle.
    angles = complex_.separation_angle[complex_.triangles].min(axis=1)
    assert (angles[complex_.triangle_angle > 179] > 170).all()


def test_the_grid_is_moved_if_a_thin_void_crosses_a_face():
    """The tip of a void, a tenth of a voxel wide, crosses a face of the grid, so no axis on that grid surrounds it."""
    made = made_solid("crossed_plates", 4)
    mesh = blum.Mesh(made.vertices, made.triangles)
    axis = blum.medial_axis(mesh, resolution=64)
    with pytest.warns(blum.InputWarning, match=r"grid was moved by 0\.3 voxels; before the move: at theta 60: .*voids"):
        found = axis.certified(60)
    assert found.certificate.holds and found.homology() == (1, 0, 6)
