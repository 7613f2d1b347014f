"""Proves that `blum proximity penetration` and `signed` report the overlaps of solids as the package does.

`--frames` writes the pairs of each frame for `blum view`. Wrong input is rejected."""

import json

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A box from -1/2 to 1/2, a ball that reaches 0.1 into the box from above, and frames of the sinking ball."""
    folder = tmp_path_factory.mktemp("penetration")
    run("make", "box", "-o", folder / "box.ply")
    ball = blum.generate("sphere", radius=0.5, frequency=6)
    blum.Mesh(ball.vertices + [0, 0, 0.9], ball.triangles).write(folder / "ball.ply")
    box = blum.read_mesh(folder / "box.ply")
    for k in range(4):
        vertices = np.vstack([box.vertices, ball.vertices + [0, 0, 1.3 - 0.2 * k]])
        triangles = np.vstack([box.triangles, np.asarray(ball.triangles) + len(box.vertices)])
        blum.Mesh(vertices, triangles).write(folder / f"frame{k}.ply")
    return folder


def frames(folder):
    return [folder / f"frame{k}.ply" for k in range(4)]


def test_the_overlap_of_two_solids_is_reported(folder):
    answer = run_json(
        "proximity", "penetration", folder / "box.ply", folder / "ball.ply", "-o", folder / "parts.npz"
    )
    (part,) = answer["penetrations"]
    assert answer["pairs"] == 1
    assert answer["min_distance"] == -part["depth"]
    assert part["depth"] == pytest.approx(0.1, abs=2e-3)
    assert part["depth"] <= part["depth_bound"] <= part["depth"] * 1.01 + 1e-12
    assert part["direction"] == pytest.approx([0, 0, -1], abs=1e-9)
    assert part["volume"] == pytest.approx(np.pi * 0.1**2 * (0.5 - 0.1 / 3), rel=0.1)
    (curve,) = part["curves"]
    assert curve[0] == curve[-1]
    assert np.allclose(np.array(curve)[:, 2], 0.5)
    with np.load(folder / "parts.npz") as file:
        assert file["distance"].tolist() == [-part["depth"]]
        assert np.linalg.norm(file["closest"][0, 0] - file["closest"][0, 1]) == pytest.approx(part["depth"])
        for name in ("depth_bound", "direction", "area", "volume", "deep_object"):
            assert file[name].tolist() == [part[name]]
    scene = blum.ProximityScene()
    scene.add(folder / "box.ply")
    scene.add(folder / "ball.ply")
    assert scene.penetration(0, 1)[0].depth == part["depth"]


def test_finer_tolerance_brings_the_bound_closer(folder):
    def part(*more):
        return run_json(
            "proximity", "penetration", folder / "box.ply", folder / "ball.ply", *more
        )["penetrations"][0]

    fine = part("--depth-tolerance", "1e-6")
    assert fine["depth_bound"] <= fine["depth"] * (1 + 1e-6) + 1e-12
    assert part("--depth-tolerance", "1")["depth_bound"] <= 2 * fine["depth"] + 1e-12


def test_wrong_solids_and_options_are_rejected(folder, tmp_path):
    open_mesh = blum.generate("box")
    blum.Mesh(open_mesh.vertices, np.asarray(open_mesh.triangles)[1:]).write(tmp_path / "open.ply")
    files = folder / "ball.ply", tmp_path / "open.ply"
    assert "is not closed" in run("proximity", "penetration", *files, status=1)[1]
    two = folder / "box.ply", folder / "ball.ply"
    for more, status, word in (
        (["--max-distance", "1"], 2, "--max-distance"),
        (["--culling", "bvh"], 2, "--culling"),
        (["--depth-tolerance", "0"], 2, "--depth-tolerance"),
        (["--tolerance", "0.1"], 2, "--tolerance"),
    ):
        assert word in run("proximity", "penetration", *two, *more, status=status)[1]
    assert "--depth-tolerance" in run("proximity", "separation", *two, "--depth-tolerance", "0.1", status=2)[1]


def test_messages_name_objects_by_their_files(folder, tmp_path):
    box = blum.generate("box")
    open_mesh = blum.Mesh(box.vertices + [0.2, 0.1, 0.1], np.asarray(box.triangles)[1:])
    open_mesh.write(tmp_path / "object 0.ply")  # a name that looks like the number of an object
    blum.Mesh(box.vertices, np.asarray(box.triangles)[:, ::-1]).write(tmp_path / "inward.ply")
    blum.Mesh(box.vertices, np.repeat(np.asarray(box.triangles)[:1], 40000, axis=0)).write(tmp_path / "heap.ply")
    first, odd, inward, heap = folder / "box.ply", *(tmp_path / f"{name}.ply" for name in ("object 0", "inward", "heap"))
    for arguments, wanted in (
        (["penetration", first, odd], f"'{odd}' is not closed"),
        (["signed", first, odd], f"'{odd}' is not closed"),
        (["penetration", first, inward], f"'{inward}' faces inwards"),
        (["separation", first, heap, "--self"], f"'{heap}': 40000 primitives share vertex"),
        (["penetration", first, odd, "--frames", "--self"], f"'{odd}' is not closed"),
    ):
        assert run("proximity", *arguments, status=1)[1].startswith(f"blum: error: {wanted}"), arguments


def test_all_pairs_are_those_of_the_library(folder, tmp_path):
    box = blum.read_mesh(folder / "box.ply")
    blum.Mesh(box.vertices + [0.25, 0.5, 0.125], box.triangles).write(tmp_path / "beside.ply")
    files = [folder / "box.ply", folder / "ball.ply", tmp_path / "beside.ply", folder / "frame3.ply"]
    scene = blum.ProximityScene()
    for file in files:
        scene.add(blum.read_mesh(file), compare_self=True)
    told = run_json("proximity", "penetration", *files, "--self")["penetrations"]
    found = scene.penetrations()
    assert len(told) == len(found) > 5
    for one, part in zip(told, found, strict=True):
        assert tuple(one["object"]) == part.object and one["depth"] == part.depth and one["volume"] == part.volume
        assert one["deep_object"] == part.object[0 if part.is_first_deep else 1]
        assert one["deep_point"] == part.deep_point.tolist() and one["deep_triangle"] == part.deep_triangle
        assert one["curves"] == [curve.tolist() for curve in part.curves]
    run("proximity", "signed", *files, "--self", "-o", tmp_path / "pairs.npz")
    signed = scene.signed_separations()
    with np.load(tmp_path / "pairs.npz") as file:
        for name in ("object", "primitive", "distance", "closest", "feature"):
            column = getattr(signed, name)
            assert file[name].tolist() == column.tolist(), name


def test_signed_returns_one_number_for_each_pair_of_solids(folder, tmp_path):
    ball = blum.read_mesh(folder / "ball.ply")
    blum.Mesh(ball.vertices + [5, 0, 0], ball.triangles).write(tmp_path / "far.ply")
    blum.Mesh(ball.vertices * 0.1, ball.triangles).write(tmp_path / "swallowed.ply")
    files = [folder / "box.ply", folder / "ball.ply", tmp_path / "far.ply", tmp_path / "swallowed.ply"]
    out = tmp_path / "pairs.npz"
    answer = run_json("proximity", "signed", *files, "-o", out)
    scene = blum.ProximityScene()
    for file in files:
        scene.add(blum.read_mesh(file))
    with np.load(out) as held:
        assert held["object"].tolist() == [[a, b] for a in range(4) for b in range(a + 1, 4)]
        for (a, b), distance, (p, q) in zip(held["object"], held["distance"], held["closest"], strict=True):
            assert distance == scene.signed_separation(int(a), int(b)), (a, b)
            assert np.isclose(np.linalg.norm(p - q), abs(distance))
        overlapping = {tuple(pair) for pair in held["object"][held["distance"] < 0].tolist()}
    assert overlapping == {(0, 1), (0, 3)}
    assert answer["min_distance"] == answer["closest"]["distance"] < 0 and answer["pairs"] == 6
    text, _ = run("proximity", "signed", *files)
    assert text.count("they overlap, from") == 2
    for more in (["--max-distance", 1], ["--frames", "--self"], ["--to", *files]):
        assert more[0] in run("proximity", "signed", *files, *more, status=2)[1]


@pytest.mark.parametrize("query", ["separation", "closest", "collide", "continuous", "penetration"])
def test_pairs_of_each_frame_are_written_for_the_viewer(folder, query):
    out = folder / f"{query}.json"
    answer = run_json("proximity", query, *frames(folder), "--frames", "--self", "-o", out)
    told = json.loads(out.read_text())["frames"]
    assert answer["frames"] == len(told) == 4
    assert answer["pairs"] == [len(frame["pairs"]) for frame in told]
    # The distances are 0.3, 0.1, -0.1 and -0.3: contact is between the second frame and the third.
    has_pairs = {
        "separation": [1, 1, 1, 1],
        "closest": [1, 1, 1, 1],
        "collide": [0, 0, 1, 1],
        "continuous": [0, 1, 1, 0],
        "penetration": [0, 0, 1, 1],
    }[query]
    assert [int(bool(frame["pairs"])) for frame in told] == has_pairs
    assert all("boxes" in frame["stages"] for frame in told)
    if query == "continuous":
        assert min(pair["time"] for pair in told[1]["pairs"]) == pytest.approx(0.5, abs=0.02)
    if query == "penetration":
        assert told[2]["pairs"][0]["distance"] == pytest.approx(0.1, abs=5e-3)
    run("view", *frames(folder), "--frames", "--pairs", out, "-o", folder / f"{query}.html")


def test_wrong_options_with_frames_are_rejected(folder):
    out = folder / "bad.json"
    for arguments, word in (
        ([*frames(folder), "--frames", "-o", out], "--self"),
        ([frames(folder)[0], "--frames", "--self", "-o", out], "two files"),
        ([*frames(folder), "--frames", "--self", "-o", folder / "bad.npz"], ".json"),
    ):
        assert word in run("proximity", "separation", *arguments, status=2)[1]
    assert not out.exists()
