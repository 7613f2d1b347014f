"""Proves that `blum match` reports the sheets that two axes share, and those that only one has."""

import json

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    """A box with its axis on the grid and its exact axis, both with patches, at theta 10."""
    folder = tmp_path_factory.mktemp("match")
    run("make", "box", "--size-x", 3, "--size-y", 2, "-o", folder / "box.ply")
    options = ["--theta", 10, "--patch-angle", 30]
    run("medial", folder / "box.ply", "-o", folder / "grid.npz", "--resolution", 48, *options)
    run("voronoi", folder / "box.ply", "-o", folder / "exact.npz", "--medial", *options)
    return folder


def test_the_grid_has_the_sheets_of_the_exact_axis(box):
    for options in ([], ["--of-patches"]):
        found = run_json("match", box / "grid.npz", box / "exact.npz", *options)
        assert found["same_large_sheets"] and found["same_sides"] == found["compared_sides"] == 13
        for axis in (found["first"], found["second"]):
            assert axis["matched"] == len(axis["sheets"]) == 13 and axis["matched_share"] > 0.97
        pairs = {tuple(sheet["sides"]) for sheet in found["first"]["sheets"]}
        assert len(pairs) == 13 and all(a < b < 6 for a, b in pairs)
    text = run("match", box / "grid.npz", box / "exact.npz")[0]
    assert "13 of 13 pairs have the same patches" in text and "sheet 12" in text


def test_files_have_the_patches_of_each_triangle(box):
    with np.load(box / "grid.npz") as file:
        low, high, sheets = (file[f"triangle_{name}"] for name in ("patch_a", "patch_b", "patch_sheet"))
    assert (low < high).all() and (sheets >= 0).all()
    for sheet in range(sheets.max() + 1):
        assert len({*zip(low[sheets == sheet].tolist(), high[sheets == sheet].tolist(), strict=True)}) == 1
    found = run_json("verify", box / "box.ply", box / "grid.npz")
    assert found["certificate"]["certified"]


def test_graphs_of_patches_have_their_sides(box, tmp_path):
    arguments = ["medial", box / "box.ply", "-o", tmp_path / "a.vtp", "--resolution", 24, "--theta", 60]
    found = run_json(*arguments, "--patch-angle", 30, "--patch-fit", 1e-6, "--graph", tmp_path / "g.json")
    graph = json.loads((tmp_path / "g.json").read_text())
    assert found["solids"][0]["axes"][0]["graph"]["sheets"] == len(graph["sheets"])
    assert all(len(sheet["sides"]) == 2 for sheet in graph["sheets"])
    assert {patch["shape"]["kind"] for patch in graph["patches"]} == {"plane"}


def test_other_solids_have_sheets_without_a_partner(box, tmp_path):
    run("make", "box", "--size-x", 3, "--size-y", 2, "--size-z", 1.6, "-o", tmp_path / "high.ply")
    run("voronoi", tmp_path / "high.ply", "-o", tmp_path / "high.vtp", "--medial", "--theta", 10)
    found = run_json("match", box / "exact.npz", tmp_path / "high.vtp")
    lone = [sheet for sheet in found["first"]["sheets"] if sheet["partner"] is None]
    assert lone and not found["same_large_sheets"] and found["compared_sides"] == 0
    assert all(sheet["sides"] is None for sheet in found["second"]["sheets"])
    text = run("match", box / "exact.npz", tmp_path / "high.vtp")[0]
    assert "no partner: area" in text and "only high.vtp" in text


def test_axes_of_images_and_curves_match_by_position(shapes, tmp_path):
    run("medial", shapes / "ball.nrrd", "-o", tmp_path / "ball.vtp", "--theta", 60)
    run("medial", shapes / "torus.obj", "-o", tmp_path / "ring.vtp", "--theta", 150, "--resolution", 24)
    same = run_json("match", tmp_path / "ball.vtp", tmp_path / "ball.vtp")
    assert same["same_large_sheets"] and same["first"]["matched"] == len(same["first"]["sheets"])
    curves = run_json("match", tmp_path / "ring.vtp", tmp_path / "ring.vtp")
    assert curves["first"]["sheets"] == [] and curves["same_large_sheets"] and curves["first"]["matched_share"] == 0


def test_impossible_requests_are_refused(box, axes, shapes, tmp_path):
    run("voronoi", box / "box.ply", "-o", tmp_path / "walls.vtp", "--walls")
    run("make", "soup", "-o", tmp_path / "open.ply")
    grid, output = box / "grid.npz", ["-o", tmp_path / "a.vtp"]
    for arguments, status, message in [
        (["match", grid, axes / "box.ma"], 2, "no column 'sheet' of triangles"),
        (["match", axes / "box.obj", grid], 2, "no column 'sheet' of triangles"),
        (["match", grid, axes / "box.vtp", "--of-patches"], 2, "'patch_sheet'"),
        (["match", grid, grid, "--tolerance", -1], 2, "--tolerance"),
        (["match", grid, grid, "--large-share", 2], 2, "--large-share"),
        (["match", grid, tmp_path / "walls.vtp"], 1, "not a medial axis"),
        (["match", grid, tmp_path / "none.vtp"], 1, "none.vtp"),
        (["match", grid, grid, "--json", grid], 2, "grid.npz"),
        (["medial", shapes / "ball.nrrd", *output, "--patch-angle", 30], 2, "--patch-angle"),
        (["medial", tmp_path / "open.ply", *output, "--patch-angle", 30], 1, "open.ply"),
        (["medial", box / "box.ply", *output, "--patch-angle", 200], 2, "--patch-angle"),
        (["medial", box / "box.ply", *output, "--patch-fit", 1], 2, "--patch-angle"),
    ]:
        assert message in run(*arguments, status=status)[1], arguments
