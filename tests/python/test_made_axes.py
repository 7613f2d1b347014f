"""Medial axes of made solids are certified: walls, gaps and holes far narrower than a voxel, on which axes once failed.

All 300 solids where the environment variable BLUM_MADE_SOLIDS is 300."""

import os

import blum
import pytest
from made import made_solid, names

#: Slanted pinholes split the model's cubes into millions of boxes: minutes.
TOO_SLOW = {("pinholes", 7)}
#: Holes that triangles spanned; thin walls in which no path was found; plates that graze each other; a thin bent wall
#: around a void, out of which flat triangles reach.
HARD = [
    ("drillings", 3),
    ("pinholes", 1),
    ("pinholes", 2),
    ("crossed_plates", 3),
    ("grazing", 4),
    ("thin_shells", 5),
]
CHOSEN = [name for name in names() if name not in TOO_SLOW] if os.environ.get("BLUM_MADE_SOLIDS") == "300" else HARD


@pytest.mark.parametrize("family, variant", CHOSEN, ids=[f"{family}-{variant}" for family, variant in CHOSEN])
def test_axes_of_made_solids_are_certified(family, variant):
    made = made_solid(family, variant)
    mesh = blum.Mesh(made.vertices, made.triangles)
    axis = blum.medial_axis(mesh, resolution=48)
    for complex_ in (axis.simplify(20.0), axis.simplify(60.0, fit=True)):
        found = blum.certify(complex_, mesh)
        assert found, found.mismatches
        assert found.homology.across == 0
