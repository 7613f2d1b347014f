"""Proves that `blum query` writes exact distances of points, and that `blum sample` draws points of surfaces."""

import csv

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def box(tmp_path_factory):
    path = tmp_path_factory.mktemp("points") / "box.ply"
    run("make", "box", "-o", path)
    return path


def box_distance(points):
    """Signed distance to the box [-1/2, 1/2]^3, negative inside."""
    beyond = np.abs(points) - 0.5
    return np.linalg.norm(np.maximum(beyond, 0), axis=-1) + np.minimum(beyond.max(-1), 0)


def test_distances_of_points_in_every_format(box, tmp_path):
    points = np.random.default_rng(1).uniform(-2, 2, (5000, 3))
    np.save(tmp_path / "p.npy", points)
    np.savez(tmp_path / "p.npz", points=points)
    rows = [",".join(map(repr, row)) for row in points.tolist()]
    (tmp_path / "p.csv").write_text("x,y,z\n" + "\n".join(rows) + "\n")
    (tmp_path / "p.xyz").write_text("# points\n\n" + "\r\n".join(row.replace(",", "\t ") + " 7" for row in rows))
    (tmp_path / "p.txt").write_text("\n".join(row.replace(",", " ; ") for row in rows))
    (tmp_path / "p.obj").write_text("".join("v " + row.replace(",", " ") + "\n" for row in rows))
    summary = run_json("query", box, tmp_path / "p.npy", "-o", tmp_path / "d.npz")
    found = dict(np.load(tmp_path / "d.npz"))
    assert np.array_equal(found["points"], points)
    assert np.allclose(found["distance"], box_distance(points), atol=1e-12)
    assert np.allclose(np.linalg.norm(found["gradient"], axis=1), 1)
    assert np.allclose(found["closest"] + found["gradient"] * found["distance"][:, None], points)
    assert summary["inside"] == (found["distance"] < 0).sum() > 0 and summary["points"] == 5000
    assert summary["distance"]["largest"] == found["distance"].max() and summary["sign_rule"] == "normals"
    for name in ("p.npz", "p.csv", "p.xyz", "p.txt", "p.obj"):
        run("query", box, tmp_path / name, "-o", tmp_path / "again.npz")
        again = np.load(tmp_path / "again.npz")
        assert all(np.array_equal(found[key], again[key]) for key in ("distance", "closest", "site", "triangle")), name


def test_written_distances_read_back_as_points(box, tmp_path):
    points = np.random.default_rng(2).uniform(-1, 1, (300, 3))
    np.save(tmp_path / "p.npy", points)
    run("query", box, tmp_path / "p.npy", "-o", tmp_path / "d.npz", "--max-distance", "0.3", "--sign", "none")
    distance = np.load(tmp_path / "d.npz")["distance"]
    assert np.isinf(distance).any() and (distance[np.isfinite(distance)] <= 0.3).all()
    for extension in ("csv", "ply", "vtp"):
        out = tmp_path / f"d.{extension}"
        run("query", box, tmp_path / "p.npy", "-o", out, "--max-distance", "0.3", "--sign", "none")
        run("query", box, out, "-o", tmp_path / "again.npz", "--max-distance", "0.3", "--sign", "none")
        assert np.array_equal(np.load(tmp_path / "again.npz")["distance"], distance), extension
    with (tmp_path / "d.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert np.array_equal([float(row["distance"]) for row in rows], distance)
    assert {int(row["site"]) == -1 for row in rows if row["distance"] == "inf"} == {True}


def test_several_files_of_points_give_an_output_each(box, tmp_path):
    random = np.random.default_rng(3)
    for name, count in (("a", 30), ("b", 500), ("c", 4)):
        np.save(tmp_path / f"{name}.npy", random.uniform(-1, 1, (count, 3)))
    files = [tmp_path / f"{name}.npy" for name in "abc"]
    summary = run_json("query", box, *files, "-o", tmp_path / "d.npz")
    assert names(tmp_path) == ["a.npy", "b.npy", "c.npy", "d-a.npz", "d-b.npz", "d-c.npz"]
    assert summary["points"] == 534 and [one["points"] for one in summary["files"]] == [30, 500, 4]
    assert summary["outputs"] == [one["output"] for one in summary["files"]]
    for file, one in zip(files, summary["files"], strict=True):
        alone = run_json("query", box, file, "-o", tmp_path / "alone.npz")
        assert one["distance"] == alone["distance"] and one["inside"] == alone["inside"]
        first, second = np.load(one["output"]), np.load(tmp_path / "alone.npz")
        for key in ("points", "distance", "gradient", "closest", "site", "triangle"):
            assert np.array_equal(first[key], second[key], equal_nan=True)
    assert summary["distance"]["largest"] == max(one["distance"]["largest"] for one in summary["files"])
    (tmp_path / "other").mkdir()
    np.save(tmp_path / "other" / "a.npy", np.zeros((1, 3)))
    _, error = run("query", box, files[0], tmp_path / "other" / "a.npy", "-o", tmp_path / "e.npz", status=2)
    assert "e-a.npz" in error
    _, error = run("query", box, files[0], tmp_path / "missing.npy", "-o", tmp_path / "e.npz", status=1)
    assert "missing.npy" in error and not [name for name in names(tmp_path) if name.startswith("e")]


def test_samples_of_the_surface(box, tmp_path):
    summary = run_json("sample", box, "-n", "4000", "-o", tmp_path / "s.npz", "--seed", "5")
    found = np.load(tmp_path / "s.npz")
    assert summary["points"] == 4000 and summary["seed"] == 5
    assert np.abs(box_distance(found["points"])).max() < 1e-15
    assert np.allclose(np.abs(found["normal"]).max(1), 1) and found["triangle"].max() == 11
    run("sample", box, "-n", "4000", "-o", tmp_path / "s.ply", "--seed", "5", "--threads", "1")
    head = (tmp_path / "s.ply").read_bytes()[:600].decode("latin-1")
    assert "property double nx" in head and "element vertex 4000" in head
    run("query", box, tmp_path / "s.ply", "-o", tmp_path / "d.npz")
    again = np.load(tmp_path / "d.npz")
    assert np.array_equal(again["points"], found["points"])
    assert np.allclose(again["gradient"], found["normal"])  # the points lie on the faces
    run("sample", box, "-n", "100", "-o", tmp_path / "on.npz", "--near", "--sigma", "1e-18")
    on = np.load(tmp_path / "on.npz")
    assert np.allclose(np.abs(on["gradient"]).max(1), 1) and np.abs(on["distance"]).max() < 1e-15
    assert run_json("sample", box, "-n", "+2.5e3", "-o", tmp_path / "many.npz")["points"] == 2500
    run("sample", box, "-n", "400", "-o", tmp_path / "even.npz", "--blue-noise")
    even = np.load(tmp_path / "even.npz")["points"]
    apart = np.linalg.norm(even[:, None] - even[None], axis=2) + 9 * np.eye(400)
    assert apart.min() > 0.06  # a triangular lattice has 0.13


def test_samples_near_the_surface(box, tmp_path):
    run("sample", box, "-n", "3000", "-o", tmp_path / "n.npz", "--near", "--sigma", "0.1", "--in-box", "0.5")
    found = np.load(tmp_path / "n.npz")
    assert np.allclose(found["distance"], box_distance(found["points"]), atol=1e-12)
    assert np.abs(found["points"][1500:]).max() <= 0.55


def test_wrong_points_and_options_are_rejected(box, tmp_path):
    (tmp_path / "short.csv").write_text("x,y,z\n1,2,3\n4,5\n")
    (tmp_path / "word.xyz").write_text("1 2 3\n4 five 6\n")
    (tmp_path / "nan.csv").write_text("nan,2,3\n")
    np.save(tmp_path / "flat.npy", np.zeros((4, 2)))
    np.savez(tmp_path / "none.npz", values=np.zeros((4, 3)))
    np.save(tmp_path / "nan.npy", np.full((1, 3), np.nan))
    (tmp_path / "empty.csv").write_text("")
    for name, word in (
        ("short.csv", "line 3: there is no z"),
        ("word.xyz", "line 2: y is not a number: 'five'"),
        ("nan.csv", "not finite"),
        ("flat.npy", "[n, 3]"),
        ("none.npz", "no array 'points'"),
        ("nan.npy", "point 0"),
        ("missing.npy", "No such file"),
        ("p.png", "extension"),
    ):
        error = run("query", box, tmp_path / name, "-o", tmp_path / "o.npz", status=2 if name == "p.png" else 1)[1]
        assert word in error, (name, error)
    run("query", box, tmp_path / "empty.csv", "-o", tmp_path / "empty.npz")
    assert np.load(tmp_path / "empty.npz")["distance"].shape == (0,)
    for options, word in (
        (("-n", "5", "--sigma", "1"), "--near"),
        (("-n", "5", "--near", "--blue-noise"), "--blue-noise"),
        (("-n", "-1"), "-n"),
        (("-n", "1.5e0"), "not a whole number"),
        (("-n", "1e30"), "-n"),
        (("-n", "1e10"), "must be between"),
        (("-n", "1e"), "not a whole number"),
        (("-n", "5", "--near", "--in-box", "2"), "in-box"),
    ):
        error = run("sample", box, *options, "-o", tmp_path / "o.npz", status=2)[1]
        assert word in error, (options, error)
    assert "o.npz" not in names(tmp_path)
