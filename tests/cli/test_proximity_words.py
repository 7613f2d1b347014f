"""Proves the texts of `blum proximity`: results without a file, names of objects, and errors for differing frames.

Also proves --limit, --weld and --skip-changed."""

import json

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two boxes that cross, an open box, an unwelded box; frames of two boxes that collide, and frames that differ."""
    folder = tmp_path_factory.mktemp("words")
    box = blum.generate("box")
    crossing = blum.Mesh(box.vertices + [0.5, 0.25, 0.25], box.triangles)
    two = np.vstack([box.vertices, box.vertices + [2, 0.1, 0.1]])
    triangles = np.vstack([box.triangles, np.asarray(box.triangles) + 8])
    end = two - np.repeat([[0, 0, 0], [1.5, 0, 0]], 8, axis=0)
    corners = box.vertices[np.asarray(box.triangles).ravel()]
    for name, mesh in {
        "box.obj": box,
        "crossing.obj": crossing,
        "open.obj": blum.Mesh(box.vertices, np.asarray(box.triangles)[1:]),
        "loose.obj": blum.Mesh(corners, np.arange(36).reshape(-1, 3)),
        "frame0.obj": blum.Mesh(two, triangles),
        "frame1.obj": blum.Mesh(end, triangles),
        "order.obj": blum.Mesh(end, np.roll(triangles, 1, axis=0)),
        "short.obj": blum.Mesh(end, triangles[:-1]),
    }.items():
        mesh.write(folder / name)
    for one in ("first", "second"):
        (folder / one).mkdir()
        box.write(folder / one / "part.obj")
    return folder


def frames(folder, *files):
    return ["proximity", "continuous", *[folder / file for file in files], "--frames", "--self"]


@pytest.mark.parametrize(
    ("other", "what"), [("short.obj", "it has 23 triangles, not 24 like"), ("order.obj", "its triangles, segments or points have other corners")]
)
def test_frames_that_differ_are_an_error(folder, tmp_path, other, what):
    out = tmp_path / "pairs.json"
    err = run(*frames(folder, "frame0.obj", other), "-o", out, status=1)[1]
    assert f"'{folder / other}': {what}" in err and f"'{folder / 'frame0.obj'}'" in err and "--skip-changed" in err
    assert not out.exists()


def test_steps_that_change_are_skipped_and_reported(folder, tmp_path):
    files = "frame0.obj", "frame1.obj", "short.obj", "short.obj"
    out = tmp_path / "pairs.json"
    command = [*frames(folder, *files), "--skip-changed", "-o", out]
    reason = f"'{folder / 'short.obj'}': it has 23 triangles, not 24 like '{folder / 'frame1.obj'}'"
    assert f"skipped  {reason}\n" in run(*command)[0]
    answer = run_json(*command)
    assert answer["skipped"] == [{"frame": 1, "reason": reason}]
    told = json.loads(out.read_text())["frames"]
    assert [frame.get("skipped") for frame in told] == [None, reason, None, None]
    assert answer["pairs"][0] == len(told[0]["pairs"]) > 0
    run("view", *[folder / file for file in files], "--frames", "--pairs", out, "-o", tmp_path / "page.html")
    two = [folder / "box.obj", folder / "crossing.obj"]
    assert "--skip-changed needs --frames" in run("proximity", "continuous", *two, "--skip-changed", status=2)[1]


@pytest.mark.parametrize("query", ["closest", "collide"])
def test_pairs_are_counted_without_a_file(folder, query):
    two = [folder / "box.obj", folder / "crossing.obj"]
    answer = run_json("proximity", query, *two)
    assert answer["pairs"] > 0 and answer["outputs"] == [] and answer["limit"] is None
    out = run("proximity", query, *two)[0]
    assert f"{answer['pairs']} pairs" in out and "wrote" not in out


def test_first_time_is_reported_without_a_file(folder):
    start, end = folder / "frame0.obj", folder / "frame1.obj"
    for command in (
        ["proximity", "continuous", start, end, "--self"],
        ["proximity", "continuous", start, "--to", end, "--self"],
    ):
        answer = run_json(*command)
        assert answer["earliest"] == pytest.approx(2 / 3, abs=2e-6) and answer["outputs"] == []
        out = run(*command)[0]
        assert "; the first at time 0.66666" in out and "wrote" not in out
    command = frames(folder, "frame0.obj", "frame0.obj", "frame1.obj")
    answer = run_json(*command)
    assert answer["pairs"][:2] == [0, answer["pairs"][1]] and answer["pairs"][1] > 0 and answer["outputs"] == []
    assert answer["earliest"] == [None, pytest.approx(2 / 3, abs=2e-6), None]
    out = run(*command)[0]
    assert f"from '{folder / 'frame0.obj'}' to '{folder / 'frame1.obj'}', at time 0.66666" in out and "view" not in out


def test_limit_shortens_files_and_is_reported(folder, tmp_path):
    start, end = folder / "frame0.obj", folder / "frame1.obj"
    commands = {
        "collide": ["proximity", "collide", folder / "box.obj", folder / "crossing.obj"],
        "frames": ["proximity", "continuous", start, end, "--self"],
        "objects": ["proximity", "continuous", start, "--to", end, "--self"],
    }
    for name, command in commands.items():
        whole, short = tmp_path / f"{name}.csv", tmp_path / f"{name}5.csv"
        run(*command, "-o", whole)
        answer = run_json(*command, "-o", short, "--limit", 5)
        assert answer["limit"] == 5
        assert short.read_text().splitlines() == whole.read_text().splitlines()[:6], name
        assert "; only the first 5 pairs were written (--limit)" in run(*command, "-o", short, "--limit", 5)[0]
        assert "(--limit)" not in run(*command, "-o", short, "--limit", 10000)[0]
        assert whole.read_bytes() == short.read_bytes()
    out = tmp_path / "pairs.json"
    assert run_json(*frames(folder, "frame0.obj", "frame1.obj"), "-o", out, "--limit", 2)["pairs"][0] > 2
    assert [len(frame["pairs"]) for frame in json.loads(out.read_text())["frames"]] == [2, 0]
    assert "--limit '-1'" in run(*commands["collide"], "--limit", "-1", status=2)[1]


def test_to_without_files_is_rejected(folder, tmp_path):
    two = [folder / "box.obj", folder / "crossing.obj"]
    err = run("proximity", "continuous", *two, "--to", "-o", tmp_path / "z.csv", status=2)[1]
    assert "--to needs a file for each SCENE" in err
    assert names(tmp_path) == []


def test_objects_of_one_file_name_get_distinct_names(folder, tmp_path):
    two = [folder / "first" / "part.obj", folder / "second" / "part.obj"]
    assert "first/part.obj, second/part.obj  distance 0: they touch or overlap" in run("proximity", "separation", *two, "-o", tmp_path / "p.json")[0]
    metadata = json.loads((tmp_path / "p.json").read_text())["metadata"]
    assert [metadata["object_0"], metadata["object_1"]] == ["first/part.obj", "second/part.obj"]
    out = run("proximity", "separation", *two, folder / "box.obj", two[0])[0]
    assert "second/part.obj, box.obj" in out and "first/part.obj, first/part.obj" in out


def test_errors_of_solids_name_files_and_a_remedy(folder):
    box = folder / "box.obj"
    for file, word in (("open.obj", "is not closed, or its triangles"), ("loose.obj", "weld")):
        err = run("proximity", "penetration", folder / file, box, status=1)[1]
        assert f"'{folder / file}'" in err and word in err and "object" not in err and str(box) not in err
    frame = [folder / "frame0.obj", folder / "short.obj", "--frames", "--self"]
    err = run("proximity", "penetration", *frame, status=1)[1]
    assert f"'{folder / 'short.obj'}' is not closed" in err and "3 edges" in err


def test_weld_closes_meshes(folder):
    loose, crossing = folder / "loose.obj", folder / "crossing.obj"
    answer = run_json("proximity", "penetration", loose, crossing, "--weld")
    wanted = run_json("proximity", "penetration", folder / "box.obj", crossing)
    assert answer["penetrations"][0]["depth"] == wanted["penetrations"][0]["depth"] > 0
    assert answer["objects"][0]["vertices"] == 8
    out = run("proximity", "continuous", loose, "--to", loose, "--self", "--weld", "1e-6")[0]
    assert "1 object" in out


def test_rounding_errors_are_printed_as_zero(folder, tmp_path):
    torus, ball = tmp_path / "torus.ply", tmp_path / "ball.ply"
    blum.generate("torus").write(torus)
    blum.generate("sphere", radius=0.4).write(ball)
    assert "from (0.54077, 0.443896, 0) to (0.309156, 0.253816, 0)" in run("proximity", "separation", torus, ball)[0]


def test_frames_report_time_as_other_queries_do(folder):
    out = run(*frames(folder, "frame0.obj", "frame1.obj"))[0]
    assert " s, peak memory " in out and "phases" not in out
    assert "phases  boxes 0" in run(*frames(folder, "frame0.obj", "frame1.obj"), "--verbose")[0]
