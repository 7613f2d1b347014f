"""Proves that the axis of the grid has the large sheets of the exact axis, between the same patches.

Both are compared at the same theta. An axis that is cut or moved has sheets without a partner.
"""

import warnings

import nonconvex_families as families
import numpy as np
import pytest
from nonconvex_families import extruded

blum = pytest.importorskip("blum")

THETA = 10


def exact(mesh, theta=THETA):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = blum.voronoi_complex(mesh, part="medial", method="traced")
    assert found.report.traced or found.report.exact, found.report.trace_problem
    return found.with_patches().medial_axis(theta)


def grid(mesh, theta=THETA, resolution=64):
    return blum.medial_axis(mesh, resolution=resolution).simplify(theta, fit=True).with_patches()


def profile(make):
    solid = extruded(make(), 1.0)
    return blum.Mesh(solid.vertices, solid.triangles)


SOLIDS = {
    "box": lambda: blum.generate("box", size_x=3, size_y=2, size_z=1),
    "bracket": lambda: blum.generate("bracket"),
    "gear": lambda: blum.generate("gear"),
    "L": lambda: profile(families.angle),
    "T": lambda: profile(families.tee),
    "U": lambda: profile(families.channel),
    "H": lambda: profile(families.aitch),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_large_sheets_of_the_grid_are_those_of_the_exact_axis(name):
    mesh = SOLIDS[name]()
    found = blum.match_sheets(grid(mesh), exact(mesh), of_patches=True)
    for axis in (found.first, found.second):
        lone = [(each.sheet, each.sides, each.overlaps) for each in axis.sheets if each.large and each.partner is None]
        assert lone == [] and axis.large_matched == axis.large > 0
        assert axis.matched_share > 0.95
        for sheet in axis.sheets:
            assert sheet.sides is not None and sheet.sides[0] < sheet.sides[1] and sheet.sides_share == 1
            assert abs(sum(part.area for part in sheet.overlaps) - sheet.on_other) <= 1e-9 * axis.area
            assert sheet.on_other <= sheet.area * (1 + 1e-9)
    assert found.same_sides == found.compared_sides == found.first.matched == found.second.matched
    assert found.same_large_sheets


def test_patches_of_files_need_the_mesh(tmp_path):
    mesh = SOLIDS["box"]()
    axis = blum.medial_axis(mesh, resolution=24).simplify(60)
    axis.write(tmp_path / "axis.vtp")
    read = blum.read_medial(tmp_path / "axis.vtp")
    with pytest.raises(blum.InvalidOption, match="with_patches"):
        read.with_patches()
    ours, theirs = axis.with_patches(), read.with_patches(mesh=mesh)
    for name in ("patch_a", "patch_b", "patch_sheet"):
        assert np.array_equal(ours.triangle_columns[name], theirs.triangle_columns[name])
    assert "patch_a" not in axis.triangle_columns
    with pytest.raises(blum.InvalidOption, match="patch_angle"):
        axis.with_patches(200)
    image = blum.medial_axis(blum.generate("ball_image")).simplify(60)
    with pytest.raises(blum.InvalidOption, match="with_patches"):
        image.with_patches()


def test_an_axis_that_is_cut_or_moved_has_sheets_without_a_partner():
    axis = exact(SOLIDS["box"](), 10)
    sheets = axis.triangle_sheet
    largest = max(axis.graph().sheets, key=lambda sheet: sheet.area).sheet
    kept = sheets != largest
    cut = blum.MedialComplex(
        axis.vertices, radius=axis.radius, triangles=axis.triangles[kept], triangle_sheet=_dense(sheets[kept])
    )
    found = blum.match_sheets(axis, cut)
    assert [sheet.sheet for sheet in found.first.sheets if sheet.partner is None] == [largest]
    assert found.second.matched == len(found.second.sheets) == 12 and not found.same_large_sheets
    assert found.compared_sides == 0 and found.second.sheets[0].sides is None
    moved = blum.MedialComplex(
        axis.vertices + np.array([0.3, 0.2, 0.1]), radius=axis.radius, triangles=axis.triangles, triangle_sheet=sheets
    )
    found = blum.match_sheets(axis, moved)
    assert not found.same_large_sheets and found.first.matched_share < 0.5
    with pytest.raises(TypeError, match="MedialComplex"):
        blum.match_sheets(axis, "axis.vtp")


def _dense(numbers):
    """Numbers from 0 without gaps, in the same order."""
    return np.unique(numbers, return_inverse=True)[1]
