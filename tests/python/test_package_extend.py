"""Proves that the package extends axes with the library's options and writes the extended surface."""

import pickle

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def plate():
    return blum.extrusion([[0, 0], [20, 0], [20, 10], [0, 10]], [[[8, 4], [12, 4], [12, 6], [8, 6]]], thickness=1)


@pytest.fixture(scope="module")
def axis(plate):
    return blum.medial_axis(plate, resolution=60).certified(110)


def test_the_surface_spans_the_plate(plate, axis):
    shell = axis.extend()
    assert np.isclose(shell.report.area, 192, rtol=1e-3) and shell.report.axis_area < 170
    assert shell.homology() == axis.homology() == (1, 1, 0)
    corners = shell.vertices[shell.triangles]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    assert np.isclose(areas.sum(), shell.report.area)
    assert shell.triangle_extended.sum() == shell.report.triangles == len(shell.triangles) - len(axis.triangles)
    assert np.array_equal(shell.triangle_sheet[: len(axis.triangles)], axis.triangle_sheet)
    assert np.allclose(shell.thickness, 1) and len(shell.thickness) == len(shell.vertices)
    assert np.array_equal(shell.to_mesh().triangles, shell.triangles)
    by_function = blum.extend_axis(axis, plate, threads=2)
    assert np.array_equal(by_function.vertices, shell.vertices)
    assert np.array_equal(by_function.triangles, shell.triangles)


def test_sheets_of_a_profile_are_joined_in_the_middle_of_its_walls():
    outline = [[0, 0], [60, 0], [60, 3], [30, 3], [30, 40], [48, 40], [48, 41.5], [28, 41.5], [28, 3], [0, 3]]
    middles = np.array([[[0, 1.5], [60, 1.5]], [[29, 1.5], [29, 40.75]], [[29, 40.75], [48, 40.75]]])
    profile = blum.extrusion(outline, thickness=50)
    axis = blum.medial_axis(profile, resolution=192).certified(120)
    shell = axis.extend()
    assert shell.homology() == axis.homology() == (1, 0, 0)
    way = middles[:, 1] - middles[:, 0]
    from_start = shell.vertices[:, None, :2] - middles[:, 0]
    along = np.clip((from_start * way).sum(axis=2) / (way * way).sum(axis=1), 0, 1)
    off = np.linalg.norm(from_start - along[..., None] * way, axis=2).min(axis=1)
    assert off.max() < 0.25  # one vertex was 1.3 below the middle of the lower wall
    assert shell.report.seam_length > 45 and shell.report.unshared_length == 0
    sides = np.sort(shell.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    shared = edges[count > 2]
    lengths = np.linalg.norm(shell.vertices[shared[:, 1]] - shell.vertices[shared[:, 0]], axis=1)
    assert lengths.sum() > 45
    apart = axis.extend(join=False)
    assert apart.report.seam_length == 0
    assert np.array_equal(apart.vertices[: len(axis.vertices)], axis.vertices)
    assert np.array_equal(apart.triangles[: len(axis.triangles)], axis.triangles)


def test_options_apply_and_wrong_ones_are_rejected(axis):
    with pytest.warns(blum.InputWarning, match="^rims .* are not extended") as told:
        short = axis.extend(max_length=0.3)
    assert told[0].message.code == "not-extended"
    assert short.report.not_reached == short.report.rim_vertices > 0 == short.report.triangles
    with pytest.raises(blum.InvalidOption, match="max_length"):
        axis.extend(max_length=0)
    with pytest.raises(TypeError):
        axis.extend(length=3)
    with pytest.raises(TypeError, match="MedialComplex"):
        blum.extend_axis("axis")
    with pytest.raises(blum.InvalidOption, match="extend_axis"):
        blum.extend_axis(blum.Complex(axis.vertices, triangles=axis.triangles))


def test_files_hold_the_extended_surface(axis, tmp_path):
    shell = axis.extend()
    for extension in ("vtp", "ply", "obj", "npz", "stl"):
        shell.write(tmp_path / f"s.{extension}")
        assert (tmp_path / f"s.{extension}").stat().st_size > 100
    with np.load(tmp_path / "s.npz") as file:
        assert np.array_equal(file["triangles"], shell.triangles)
        assert np.array_equal(file["thickness"], shell.thickness)
        assert np.array_equal(file["triangle_extended"], shell.triangle_extended)
    assert len(blum.read_mesh(tmp_path / "s.ply").triangles) == len(shell.triangles)
    with pytest.raises(blum.InvalidOption, match="extended axes are written to"):
        shell.write(tmp_path / "s.ma")


def test_the_extended_surface_pickles(axis):
    shell = axis.extend()
    copy = pickle.loads(pickle.dumps(shell))
    assert copy.report == shell.report and np.array_equal(copy.triangle_sheet, shell.triangle_sheet)
    assert repr(copy) == repr(shell)
