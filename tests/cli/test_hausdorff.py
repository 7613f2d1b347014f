"""Proves that `blum hausdorff` reports an interval, witnesses, and means weighted by area."""

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def boxes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("boxes")
    run("make", "box", "-o", folder / "small.ply")
    run("make", "box", "--size-x", 2, "--size-y", 2, "--size-z", 2, "-o", folder / "large.ply")
    return folder / "small.ply", folder / "large.ply"


def test_the_interval_and_both_directions_are_reported(boxes):
    found = run_json("hausdorff", *boxes, "--tolerance", "1e-5")
    assert found["lower"] <= 3**0.5 / 2 <= found["upper"] <= found["lower"] + 1e-5
    assert found["forward"]["lower"] <= 0.5 <= found["forward"]["upper"]
    assert found["backward"]["upper"] == found["upper"]
    assert np.isclose(np.linalg.norm(np.subtract(*found["points"])), found["lower"])
    deviation = found["forward"]["deviation"]
    assert np.isclose(deviation["mean"], 0.5) and np.isclose(deviation["area"], 6)
    assert all(np.isclose(value, 0.5) for value in deviation["percentiles"])


def test_one_direction_has_a_witness(boxes, tmp_path):
    out = tmp_path / "where.vtp"
    found = run_json("hausdorff", *boxes, "--one-sided", "--only-distance", "-o", out)
    assert "backward" not in found and "deviation" not in found["forward"] and found["one_sided"]
    assert found["lower"] <= 0.5 <= found["upper"] and found["outputs"] == [str(out)]
    assert out.read_bytes().startswith(b"<?xml")


def test_text_reports_both_directions(boxes):
    text, _ = run("hausdorff", *boxes, "--pieces", "1000")
    assert "small.ply to large.ply" in text and "large.ply to small.ply" in text and "mean 0.5 (error at most " in text


def test_clouds_of_points_are_compared(boxes, tmp_path):
    points = np.array([[2.0, 0, 0], [0, 0.5, 0.25]])
    np.save(tmp_path / "cloud.npy", points)
    np.savetxt(tmp_path / "cloud.XYZ", points)
    for name in ("cloud.npy", "cloud.XYZ"):
        found = run_json("hausdorff", tmp_path / name, boxes[0], "--one-sided", "--tolerance", "1e-6")
        assert found["lower"] <= 1.5 <= found["upper"] and found["points"][0] == [2, 0, 0]
    text, _ = run("hausdorff", tmp_path / "cloud.npy", boxes[0])
    assert "2 points" in text and "has no area" in text
    np.save(tmp_path / "none.npy", points[:0])
    _, error = run("hausdorff", tmp_path / "none.npy", boxes[0], status=1)
    assert error.startswith("blum: error: ")


def test_wrong_arguments_are_rejected(boxes, tmp_path):
    assert "tolerance" in run("hausdorff", *boxes, "--tolerance", "0", status=2)[1]
    assert "none.ply" in run("hausdorff", boxes[0], tmp_path / "none.ply", status=1)[1]
    assert "--output" in run("hausdorff", *boxes, "-o", tmp_path / "a.xyz", status=2)[1]
