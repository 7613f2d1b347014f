# Proves that pages of `blum view --frames` hold frames and pairs exactly, and that wrong files are rejected.
import json
import signal
import subprocess

import numpy as np
import pytest

from scene import scene_of_page
from tool import BLUM, names, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
TWO = [[0, 1, 2], [0, 2, 3]]


def write_obj(path, vertices, triangles, more=""):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices).tolist()]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in triangles]
    path.write_text("\n".join(lines) + "\n" + more)
    return path


@pytest.fixture
def frames(tmp_path):
    """Frames of a square that rises, far from the origin, and has lost a triangle in its last frame."""
    moved = [SQUARE + [1000, 0, height] for height in (0.0, 0.1, 0.3)]
    paths = [write_obj(tmp_path / f"f{k}.obj", vertices, TWO) for k, vertices in enumerate(moved)]
    return [*paths, write_obj(tmp_path / "f3.obj", moved[2][:3], TWO[:1])]


def pair(**changes):
    return {"kind": "closest", "points": [[1000, 0, 0], [1000, 0, 0.25]], "distance": 0.25} | changes


def frames_item(tmp_path, *arguments):
    page = tmp_path / "page.html"
    out, _ = run("view", *arguments, "--frames", "-o", page)
    scene = scene_of_page(page)
    (item,) = scene.header["items"]
    return scene, item, out


def test_help_describes_frames_and_pairs():
    out, _ = run("view", "--help")
    for words in ("--frames", "--pairs", "moving scene"):
        assert words in out


def test_frames_are_held_exactly_and_share_triangles(tmp_path, frames):
    scene, item, out = frames_item(tmp_path, *frames)
    assert "f0.obj to f3.obj (4 frames)" in out
    assert item["kind"] == "frames" and item["name"] == "f0.obj to f3.obj"
    assert [frame["name"] for frame in item["frames"]] == [path.name for path in frames]
    assert [frame["mesh"] for frame in item["frames"]] == [0, 0, 0, 1]
    assert [scene.array(mesh).reshape(-1, 3).tolist() for mesh in item["meshes"]] == [TWO, TWO[:1]]
    assert item["bounds"] == {"lower": [1000, 0, 0], "upper": [1001, 1, 0.3]}
    assert item["origin"] == [1000.5, 0.5, 0.15]
    for frame, height, count in zip(item["frames"], (0, 0.1, 0.3, 0.3), (4, 4, 4, 3), strict=True):
        positions = scene.array(frame["positions"]).reshape(-1, 3)
        there = (SQUARE[:count] + [1000, 0, height]) - item["origin"]
        assert positions.dtype == np.float32 and np.abs(positions - there).max() <= 1e-7
    assert "pairs" not in item and "stages" not in item
    assert ["frames", "4"] in item["facts"] and ["triangles", "1 to 2"] in item["facts"]


def test_positions_are_compressed_as_differences(tmp_path):
    run("make", "sphere", "-o", tmp_path / "a.ply", "--frequency", 12)
    scene, item, _ = frames_item(tmp_path, *[tmp_path / "a.ply"] * 3)
    assert len(item["meshes"]) == 1
    for frame in item["frames"]:
        entry = frame["positions"]
        assert entry["type"] == "f4" and entry["coding"] == "delta" and entry["bytes"] < 4 * entry["count"]
        assert np.allclose(np.linalg.norm(scene.array(entry).reshape(-1, 3) + item["origin"], axis=1), 1, atol=1e-6)


def test_pairs_and_stages_are_held_exactly(tmp_path, frames):
    hit = pair(kind="collision", distance=0, time=0.5)
    deep = pair(kind="penetration", points=[[1000.25, 0, 0], [1000.25, 0.5, 0]], distance=-0.5)
    content = {
        "made_by": "a test",  # unknown keys are ignored
        "frames": [
            {"pairs": [pair(), deep | {"first": 7}], "stages": {"objects": 0.25, "diagram": 1e-3}},
            {},
            {"pairs": [hit]},
            {"stages": {"exact tests": 2, "objects": 0.5}},
        ],
    }
    (tmp_path / "pairs.json").write_text(json.dumps(content))
    scene, item, _ = frames_item(tmp_path, *frames, "--pairs", tmp_path / "pairs.json")
    pairs, stages = item["pairs"], item["stages"]
    assert pairs["kind_names"] == ["closest", "collision", "penetration"]
    assert scene.array(pairs["first"]).tolist() == [0, 2, 2, 3, 3]
    assert scene.array(pairs["kinds"]).tolist() == [0, 2, 1]
    assert scene.array(pairs["distances"]).tolist() == [0.25, -0.5, 0] and pairs["range"] == [-0.5, 0.25]
    points = scene.array(pairs["points"]).reshape(3, 2, 3) + item["origin"]
    assert np.allclose(points, [pair()["points"], deep["points"], hit["points"]], atol=1e-6, rtol=0)
    times = scene.array(pairs["times"])
    assert np.isnan(times[:2]).all() and times[2] == 0.5
    assert stages["names"] == ["objects", "diagram", "exact tests"]
    nan = np.nan
    there = [[0.25, 1e-3, nan], [nan] * 3, [nan] * 3, [0.5, nan, 2]]
    assert np.array_equal(scene.array(stages["seconds"]).reshape(4, 3), there, equal_nan=True)
    for kind in ("closest", "collision", "penetration"):
        assert [f"pairs: {kind}", "1"] in item["facts"]


def test_free_segments_and_points_are_reported_as_not_shown(tmp_path, frames):
    write_obj(frames[1], SQUARE, TWO, "l 1 2\np 3\n")
    _, item, _ = frames_item(tmp_path, *frames)
    assert ["not shown", "2 free segments and points"] in item["facts"]


@pytest.mark.parametrize(("content", "words"), [
    ("", ["not JSON"]),
    ('{"frames": [', ["not JSON", "line 1"]),
    ("[]", ["the file must be an object"]),
    ("{}", ['has no "frames"']),
    ({"frames": {}}, ["frames must be an array"]),
    ({"frames": [{}, {}]}, ["frames has 2 entries", "4 meshes"]),
    ({"frames": [{}, {}, {}, {}]}, ["no pairs and no stages"]),
    ([{}, 3, {}, {}], ["frames[1] must be an object"]),
    ([{"pairs": {}}], ["frames[0].pairs must be an array"]),
    ([{"pairs": [pair(), 1]}], ["frames[0].pairs[1] must be an object"]),
    ([{}, {"pairs": [pair(kind="touch")]}], ["frames[1].pairs[0].kind is 'touch'", "closest, collision or"]),
    ([{"pairs": [pair(kind=1)]}], ["frames[0].pairs[0].kind must be a string"]),
    ([{"pairs": [{"kind": "closest", "distance": 1}]}], ['frames[0].pairs[0] has no "points"']),
    ([{"pairs": [pair(points=[[0, 0, 0]])]}], ["frames[0].pairs[0].points must be two points"]),
    ([{"pairs": [pair(points=[[0, 0, 0], [0, 0]])]}], ["frames[0].pairs[0].points[1] must be three numbers"]),
    ([{"pairs": [pair(points=[[0, 0, 0], [0, 1e31, 0]])]}], ["frames[0].pairs[0].points[1][1]", "1e30"]),
    ([{"pairs": [pair(distance="1")]}], ["frames[0].pairs[0].distance must be a number"]),
    ([{"pairs": [pair(time=1.5)]}], ["frames[0].pairs[0].time is 1.5", "from 0 to 1"]),
    ([{"stages": [1]}], ["frames[0].stages must be an object"]),
    ([{"stages": {"diagram": -1}}], ["frames[0].stages.diagram is -1", "negative"]),
    ([{"stages": {"diagram": None}}], ["frames[0].stages.diagram must be a number"]),
    ([{"stages": {"": 1}}], ["frames[0].stages"]),
    ([{"stages": {f"s{k}": 1 for k in range(8)}}, {"stages": {"s8": 1}}], ["frames[1].stages.s8", "at most 8"]),
    ('{"frames": [{"stages": {"a": 1e999}}, {}, {}, {}]}', ["pairs.json"]),
    ('{"frames": [{"stages": {"a": NaN}}, {}, {}, {}]}', ["not JSON"]),
])
def test_wrong_pairs_are_reported_with_their_place(tmp_path, frames, content, words):
    if isinstance(content, list):
        content = {"frames": content + [{}] * (4 - len(content))}
    text = content if isinstance(content, str) else json.dumps(content)
    (tmp_path / "pairs.json").write_text(text)
    before = names(tmp_path)
    page = tmp_path / "page.html"
    _, err = run("view", *frames, "--frames", "--pairs", tmp_path / "pairs.json", "-o", page, status=1)
    assert all(word in err for word in ["pairs.json", *words]), err
    assert names(tmp_path) == before


@pytest.mark.parametrize("name", ["gone.json", "."])
def test_pairs_that_cannot_be_read_are_named(tmp_path, frames, name):
    _, err = run("view", *frames, "--frames", "--pairs", tmp_path / name, "-o", tmp_path / "page.html", status=1)
    assert "cannot read" in err


@pytest.mark.parametrize(("text", "words"), [
    ("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", ["bad.obj"]),
    ("v 0 0 0\nv 1 0 0\nv 0 1e200 0\nf 1 2 3\n", ["bad.obj", "1e150"]),
    ("v 0 0 0\nv 1 0 0\nv 0 1e40 0\nf 1 2 3\n", ["f0.obj to bad.obj", "1e30"]),
    ("v 0 0 0\nv 1 0 0\nl 1 2\n", ["bad.obj", "no triangles"]),
    ("f 1 2 3\n", ["bad.obj"]),
])
def test_frames_that_cannot_be_shown_are_named(tmp_path, frames, text, words):
    (tmp_path / "bad.obj").write_text(text)
    page = tmp_path / "page.html"
    page.write_text("before")
    _, err = run("view", frames[0], tmp_path / "bad.obj", "--frames", "-o", page, status=1)
    assert all(word in err for word in words), err
    assert page.read_text() == "before"


def test_frames_must_be_meshes(tmp_path, frames, shapes, axes):
    for other in (shapes / "ball.nrrd", shapes / "sphere.npz", axes / "box.npz"):
        _, err = run("view", frames[0], other, "--frames", "-o", tmp_path / "page.html", status=1)
        assert other.name in err and "not a mesh" in err


@pytest.mark.parametrize(("arguments", "words"), [
    (("f0.obj", "--frames"), "two meshes"),
    (("f0.obj", "f1.obj", "--pairs", "pairs.json"), "--frames"),
    (("f0.obj", "f1.obj", "--frames", "--pairs", "p.html", "-o", "p.html"), "is also the input"),
    (("f0.obj", "f1.obj", "--frames", "-o", "page.txt"), ".html"),
])
def test_bad_usage(tmp_path, frames, arguments, words):
    assert len(frames) == 4
    (tmp_path / "p.html").write_text("{}")
    arguments = [word if word.startswith("-") else tmp_path / word for word in arguments]
    _, err = run("view", *arguments, status=2)
    assert words in err


def test_frames_are_served(frames):
    process = subprocess.Popen([BLUM, "view", *frames, "--frames"], stdout=subprocess.PIPE, text=True)
    assert "serving f0.obj to f3.obj (4 frames)" in process.stdout.readline()
    assert "http://127.0.0.1:" in process.stdout.readline()
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 0
