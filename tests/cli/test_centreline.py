"""Proves that `blum centreline` writes the graph of each label in every format and reports differences in homotopy."""

import json

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


def tube(shape, begin, end, radius):
    at = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), -1)[..., ::-1]  # x, y, z
    begin, along = np.array(begin), np.array(end) - begin
    share = np.clip((at - begin) @ along / (along @ along), 0, 1)
    return np.linalg.norm(at - begin - share[..., None] * along, axis=-1) <= radius


@pytest.fixture(scope="module")
def image(tmp_path_factory):
    """Label 1: a Y of three tubes; 5: a straight tube; 9: a hollow cube."""
    folder = tmp_path_factory.mktemp("centreline")
    shape = (40, 40, 60)
    values = np.zeros(shape, dtype=np.int16)
    for begin, end in [((15, 6, 20), (15, 20, 20)), ((15, 20, 20), (6, 33, 20)), ((15, 20, 20), (24, 33, 20))]:
        values[tube(shape, begin, end, 2.5)] = 1
    values[tube(shape, (40, 10, 8), (40, 30, 30), 3)] = 5
    values[30:37, 3:10, 50:57] = 9
    values[33, 6, 53] = 0
    np.save(folder / "image.npy", values)
    return folder / "image.npy"


def test_every_label_gets_a_graph(image, tmp_path):
    out = tmp_path / "g.json"
    summary = run_json("centreline", image, "-o", out, warns=True)
    assert summary["command"] == "centreline" and summary["outputs"] == [str(out)]
    assert [(each["label"], each["branches"], each["homotopy_kept"]) for each in summary["labels"]] == [
        (1, 3, True),
        (5, 1, True),
        (9, 0, False),
    ]
    graph = json.loads(out.read_text())
    assert graph["grid"]["size"] == [60, 40, 40]
    y, straight, hollow = graph["labels"]
    assert sorted(node["kind"] for node in y["nodes"]) == ["end", "end", "end", "junction"]
    for branch in y["branches"]:
        assert abs(branch["mean_radius"] - 2.5) < 0.1 and len(branch["points"]) == len(branch["radii"])
    (branch,) = straight["branches"]
    assert abs(branch["mean_radius"] - 3) < 0.1 and abs(branch["length"] - np.hypot(20, 22)) < 1
    assert hollow["label_betti"] == [1, 0, 1] and hollow["graph_betti"] == [1, 0, 0] and "void" in hollow["homotopy"]


@pytest.mark.parametrize("end", ["json", "csv", "swc", "vtp", "ply", "npz"])
def test_every_format_is_written(image, tmp_path, end):
    run("centreline", image, "-o", tmp_path / f"g.{end}", "--label", "1,5")
    assert names(tmp_path) == [f"g.{end}"]
    text = (tmp_path / f"g.{end}").read_bytes()
    if end == "csv":
        rows = text.decode().splitlines()
        assert len(rows) == 5 and rows[0].startswith("label,branch,") and rows[4].startswith("5,0,0,1,end,end,")
    if end == "swc":
        rows = [row.split() for row in text.decode().splitlines() if not row.startswith("#")]
        assert [int(row[0]) for row in rows] == list(range(1, len(rows) + 1))
        assert sum(row[6] == "-1" for row in rows) == 2 and all(int(row[6]) < int(row[0]) for row in rows)
    if end == "npz":
        arrays = np.load(tmp_path / "g.npz")
        assert set(arrays["edge_label"]) == {1, 5} and len(arrays["radius"]) == len(arrays["vertices"])


def test_labels_and_thresholds_are_chosen(image, tmp_path):
    out = tmp_path / "g.json"
    found = run_json("centreline", image, "-o", out, "--label", "1-7")["labels"]
    assert [each["label"] for each in found] == [1, 5]
    found = run_json("centreline", image, "-o", out, "--label", "5,4,1", warns=True)["labels"]
    assert [(each["label"], each["branches"]) for each in found] == [(5, 1), (4, 0), (1, 3)]
    (all_of_it,) = run_json("centreline", image, "-o", out, "--threshold", 1, warns=True)["labels"]
    assert all_of_it["label"] is None and all_of_it["graph_betti"] == [3, 0, 0]
    assert len(run_json("centreline", image, "-o", out, "--label", "all", warns=True)["labels"]) == 3
    for wrong in [
        ("--label", "x"),
        ("--label", "5-1"),
        ("--label", "1-"),
        ("--label", "1,1"),
        ("--label", "1", "--threshold", 2),
        ("--spur", "-1"),
        ("--label", "0-9999999"),
    ]:
        run("centreline", image, "-o", tmp_path / "h.json", *wrong, status=2)
    run("centreline", image, "-o", tmp_path / "h.obj", status=2)
    assert names(tmp_path) == ["g.json"]


def test_meshes_are_rejected_and_help_has_examples(tmp_path):
    run("make", "box", "-o", tmp_path / "box.ply")
    assert "not a voxel image" in run("centreline", tmp_path / "box.ply", "-o", tmp_path / "g.json", status=1)[1]
    assert "blum centreline vessels.nii.gz -o vessels.json" in run("centreline", "--help")[0]


def test_images_of_one_layer_cause_a_warning(tmp_path):
    np.save(tmp_path / "ring.npy", np.ones((1, 20, 30), dtype=np.uint8))
    lines = run_json("centreline", tmp_path / "ring.npy", "-o", tmp_path / "g.json", warns=True)
    assert any("single layer" in warning["text"] for warning in lines["warnings"])
