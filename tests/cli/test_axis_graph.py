# Proves that --graph writes one graph for each axis that is written, and that the graph matches the axis.
import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

XML = "{http://graphml.graphdrawing.org/xmlns}"


def areas(path):
    """Areas of the sheets of an axis, computed without Blum."""
    with np.load(path) as file:
        corners, sheet = file["vertices"][file["triangles"]], file["triangle_sheet"]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return np.bincount(sheet, weights=area)


def test_the_graph_has_the_sheets_of_the_axis(solids, tmp_path):
    summary = run_json(
        "medial", solids / "box.obj", "-o", tmp_path / "a.npz", "--resolution", 16, "--graph", tmp_path / "g.json"
    )
    assert names(tmp_path) == ["a.npz", "g.json"] == [Path(name).name for name in summary["outputs"]]
    graph = json.loads((tmp_path / "g.json").read_text())
    assert (graph["content"], graph["source"], graph["theta"]) == ("graph of a medial axis", "box.obj", 60)
    assert np.allclose([sheet["area"] for sheet in graph["sheets"]], areas(tmp_path / "a.npz"), rtol=1e-12)
    told = summary["solids"][0]["axes"][0]["graph"]
    assert told["file"] == str(tmp_path / "g.json") and told["sheets"] == len(graph["sheets"])
    assert len(graph["patches"]) == 6 and all(sheet["patch_pairs"] for sheet in graph["sheets"])
    assert all(len(line["vertices"]) == len(line["points"]) for line in graph["seams"] + graph["curves"])


def test_patches_of_the_graph_are_fitted_on_request(tmp_path):
    run("make", "cylinder", "-o", tmp_path / "c.ply")
    output = ("-o", tmp_path / "a.npz", "--resolution", 16)
    run("medial", tmp_path / "c.ply", *output, "--graph", tmp_path / "g.json", "--patch-fit", 1e-6)
    shapes = [patch["shape"] for patch in json.loads((tmp_path / "g.json").read_text())["patches"]]
    assert sorted(shape["kind"] for shape in shapes) == ["cylinder", "plane", "plane"]
    assert "--graph" in run("medial", tmp_path / "c.ply", *output, "--patch-fit", 1e-6, status=2)[1]


def test_every_angle_and_label_has_its_own_graph(solids, tmp_path):
    output = ["-o", tmp_path / "b.ply", "--graph", tmp_path / "g.graphml"]
    out, _ = run("medial", solids / "balls.npy", *output, "--label", "1,3", "--theta", "30,90")
    files = [f"{name}-label{label}-theta{theta}{end}" for name, end in (("b", ".ply"), ("g", ".graphml"))
             for label in (1, 3) for theta in (30, 90)]  # fmt: skip
    assert names(tmp_path) == sorted(files) and out.count("\ngraph ") == 4
    for name in files[4:]:
        root = ElementTree.parse(tmp_path / name).getroot()
        nodes = {node.get("id") for node in root.iter(f"{XML}node")}
        ends = {edge.get(end) for edge in root.iter(f"{XML}edge") for end in ("source", "target")}
        assert nodes and ends <= nodes


def test_info_writes_the_graph_of_a_file(axes, tmp_path):
    for end in ("vtp", "ply", "npz"):
        facts = run_json("info", axes / f"box.{end}", "--graph", tmp_path / "g.json")
        graph = json.loads((tmp_path / "g.json").read_text())
        assert facts["graph"]["sheets"] == len(graph["sheets"]) == facts["counts"]["sheets"]
        assert np.allclose([sheet["area"] for sheet in graph["sheets"]], areas(axes / "box.npz"), rtol=1e-9)
        assert graph["patches"] == [] and "thinnest large wall" not in run("info", axes / f"box.{end}")[0]
    assert run_json("info", axes / "box.npz")["graph"] is None


def test_the_thinnest_wall_is_reported(tmp_path):
    run("make", "bracket", "-o", tmp_path / "b.ply")
    arguments = ["medial", tmp_path / "b.ply", "-o", tmp_path / "b.vtp", "--resolution", 48, "--theta", 120]
    wall = run_json(*arguments, "--graph", tmp_path / "g.json")["solids"][0]["axes"][0]["graph"]["thinnest_wall"]
    assert abs(wall["thickness"]["median"] - 0.24) < 0.01  # the thickness of a rib


def test_sheets_that_end_at_edges_do_not_count_as_thin_walls(tmp_path):
    run("make", "plate", "-o", tmp_path / "p.ply")
    arguments = ["medial", tmp_path / "p.ply", "-o", tmp_path / "p.vtp", "--resolution", 64, "--theta", 60]
    wall = run_json(*arguments, "--graph", tmp_path / "g.json")["solids"][0]["axes"][0]["graph"]["thinnest_wall"]
    sheets = json.loads((tmp_path / "g.json").read_text())["sheets"]
    assert wall["thickness"]["low"] > 0.95 * wall["thickness"]["maximum"]
    assert min(sheet["thickness"]["low"] for sheet in sheets) < 0.5 * wall["thickness"]["low"]


def test_impossible_requests_are_rejected_before_any_work(solids, axes, tmp_path):
    box = solids / "box.obj"
    for arguments, status, message in [
        (["medial", box, "-o", tmp_path / "a.ply", "--graph", "g.gml"], 2, "'g.gml': the extension must be .json"),
        (["medial", box, "-o", tmp_path / "a.ply", "--graph", tmp_path / "no" / "g.json"], 1, "there is no folder"),
        (["info", box, "--graph", tmp_path / "g.json"], 2, "--graph is for medial axes"),
        (["info", axes / "box.obj", "--graph", tmp_path / "g.json"], 2, "--graph is for medial axes"),
        (["info", axes / "box.ma", "--graph", tmp_path / "g.json"], 2, "no column 'sheet' of triangles"),
        (["info", "--devices", "--graph", tmp_path / "g.json"], 2, "--devices and --graph exclude each other"),
    ]:
        assert message in run(*arguments, status=status)[1]
    assert names(tmp_path) == []
    same = ["-o", tmp_path / "a.ply", "--graph", tmp_path / "a.json", "--json", tmp_path / "a.json"]
    run("medial", box, *same, status=2)


def test_no_graph_without_a_certified_axis(tmp_path):
    from test_medial import COARSE, block_with_needle

    output = ["-o", tmp_path / "p.ply", "--graph", tmp_path / "g.json"]
    run("medial", block_with_needle(tmp_path), *output, *COARSE, status=3)
    assert names(tmp_path) == ["needle.obj"]
