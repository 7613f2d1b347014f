"""Proves that `blum ccd` answers single queries exactly, and that `blum proximity continuous` finds all colliding pairs
of a deforming mesh in every format. Both reject wrong input."""

import csv
import json
import os
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

DATA = Path(os.environ.get("BLUM_DATA_DIR", Path(__file__).parents[3] / "shared" / "data")) / "ccd"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason=f"no data set in {DATA}")

FALLING = [(0.25, 0.25, 1), (0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0.25, 0.25, -1), (0, 0, 0), (1, 0, 0), (0, 1, 0)]
PASSING = [(2, 0.25, 1), (0, 0, 0), (1, 0, 0), (0, 1, 0)], [(2, 0.25, -1), (0, 0, 0), (1, 0, 0), (0, 1, 0)]


def write_queries(path, queries, truths):
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        for (start, end), truth in zip(queries, truths, strict=True):
            for point in (*start, *end):
                ratios = [Fraction(x).as_integer_ratio() for x in point]
                rows.writerow([n for ratio in ratios for n in ratio] + ([] if truth is None else [truth]))


def counts(answer):
    return [answer[name] for name in ("queries", "colliding", "false_negatives", "false_positives", "without_truth")]


def test_answers_are_compared_with_the_truth(tmp_path):
    folder = tmp_path / "vertex-face"
    folder.mkdir()
    write_queries(folder / "a.csv", [FALLING, PASSING], [1, 0])
    write_queries(tmp_path / "wrong-vf.csv", [FALLING, PASSING], [0, 1])
    write_queries(tmp_path / "open.csv", [FALLING], [None])
    assert counts(run_json("ccd", folder / "a.csv")) == [2, 1, 0, 0, 0]
    assert counts(run_json("ccd", tmp_path / "wrong-vf.csv")) == [2, 1, 1, 1, 0]
    assert counts(run_json("ccd", tmp_path / "open.csv", "--kind", "vertex-face")) == [1, 1, 0, 0, 1]
    both = run_json("ccd", folder / "a.csv", tmp_path / "wrong-vf.csv")
    assert counts(both) == [4, 2, 1, 1, 0]
    assert 0 < both["median_us"] <= both["p99_us"] and both["mean_us"] > 0
    assert "1 false negative, 1 false positive" in run("ccd", tmp_path / "wrong-vf.csv")[0]


def test_the_kind_of_queries_follows_from_name_or_option(tmp_path):
    cross = [(-1, 0, 0), (1, 0, 0), (0, -1, 1), (0, 1, 1)], [(-1, 0, 0), (1, 0, 0), (0, -1, -1), (0, 1, -1)]
    write_queries(tmp_path / "cloth_ee.csv", [cross], [1])
    assert counts(run_json("ccd", tmp_path / "cloth_ee.csv")) == [1, 1, 0, 0, 0]
    (tmp_path / "cloth_ee.csv").rename(tmp_path / "x.csv")
    assert "give --kind" in run("ccd", tmp_path / "x.csv", status=2)[1]
    assert counts(run_json("ccd", tmp_path / "x.csv", "--kind", "edge-edge")) == [1, 1, 0, 0, 0]
    for wrong in ("edges", "not-edge-edge", "ee"):
        assert "must be vertex-face or edge-edge" in run("ccd", tmp_path / "x.csv", "--kind", wrong, status=2)[1]
    text = (tmp_path / "x.csv").read_text().replace("1,1,", "0000000000000000000001,1,", 1)
    (tmp_path / "x.csv").write_text("\ufeff" + text.replace("\n", "\r\n"))
    assert counts(run_json("ccd", tmp_path / "x.csv", "--kind", "edge-edge")) == [1, 1, 0, 0, 0]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("1,1,2,1", "six or seven columns"),
        ("1,1,2,1,3,1,1,1", "more than seven columns"),
        ("1,3,2,1,3,1", "not a power of two"),
        ("1,0,2,1,3,1", "not a power of two"),
        ("1,-2,2,1,3,1", "not a power of two"),
        ("1.5,1,2,1,3,1", "not a whole number"),
        ("nan,1,2,1,3,1", "not a whole number"),
        ("9007199254740993,1,2,1,3,1", "not exactly a double"),
        ("9" * 400 + ",1,2,1,3,1", "not exactly a double"),
        ("1,1,2,1,3,1,2", "must be 0 or 1"),
        ("1,1,2,1,3,1,1", "within a query"),
    ],
)
def test_malformed_queries_are_rejected(tmp_path, line, message):
    (tmp_path / "vf.csv").write_text(line + "\n")
    error = run("ccd", tmp_path / "vf.csv", status=1)[1]
    assert message in error and "line 1" in error


def test_files_without_queries_are_rejected(tmp_path):
    (tmp_path / "vf.csv").write_text("\n\n")
    assert "no queries" in run("ccd", tmp_path / "vf.csv", status=1)[1]
    assert "absent-vf.csv" in run("ccd", tmp_path / "absent-vf.csv", status=1)[1]
    (tmp_path / "folder-vf.csv").mkdir()
    assert "folder-vf.csv" in run("ccd", tmp_path / "folder-vf.csv", status=1)[1]
    assert "/dev/zero" in run("ccd", "--kind", "vertex-face", "/dev/zero", status=1)[1]
    write_queries(tmp_path / "a-vf.csv", [FALLING], [1])
    rows = (tmp_path / "a-vf.csv").read_text().splitlines()
    rows[3] = rows[3][:-1] + "0"
    (tmp_path / "a-vf.csv").write_text("\n".join(rows))
    assert "line 4: the answer differs from the answer in" in run("ccd", tmp_path / "a-vf.csv", status=1)[1]
    write_queries(tmp_path / "b-vf.csv", [FALLING], [1])
    assert "tolerance" in run("ccd", tmp_path / "b-vf.csv", "--tolerance", "0", status=2)[1]


def write_obj(path, vertices, triangles):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    path.write_text("\n".join(lines) + "\n")


@pytest.fixture
def frames(tmp_path):
    """Two frames in which a triangle falls through another one."""
    triangles = [(0, 1, 2), (3, 4, 5)]
    floor = [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 4.0, 0.0)]
    falling = np.array([(0.5, 0.5, 1.0), (1.0, 0.5, 1.5), (9.0, 0.5, 1.5)])
    write_obj(tmp_path / "start.obj", floor + falling.tolist(), triangles)
    write_obj(tmp_path / "end.obj", floor + (falling - [0, 0, 4]).tolist(), triangles)
    return tmp_path


CONTINUOUS = "proximity", "continuous"


def proximity(frames, output):
    return run_json(*CONTINUOUS, frames / "start.obj", frames / "end.obj", "--self", "-o", frames / output)


def test_pairs_are_the_same_in_every_format(frames):
    answer = proximity(frames, "p.npz")
    arrays = np.load(frames / "p.npz")
    assert arrays["vertex_face"].tolist() == [[3, 0, 1, 2], [4, 0, 1, 2]] and arrays["face"].tolist() == [0, 0]
    assert np.allclose(arrays["vertex_face_time"], [0.25, 0.375], atol=1e-6)
    assert arrays["edge_edge"].shape[1] == 4 and len(arrays["edge_edge"]) == len(arrays["edge_edge_time"]) == 2
    assert [answer["vertex_face"], answer["edge_edge"]] == [2, 2]
    assert answer["earliest"] == arrays["vertex_face_time"][0] and answer["exact_tests"] <= answer["box_pairs"]
    proximity(frames, "p.csv")
    with (frames / "p.csv").open() as file:
        rows = list(csv.DictReader(file))
    proximity(frames, "p.json")
    text = json.loads((frames / "p.json").read_text())
    assert text["metadata"]["start"] == "start.obj"
    for kind in ("vertex_face", "edge_edge"):
        own = [row for row in rows if row["kind"] == kind]
        assert [[int(row[x]) for x in "abcd"] for row in own] == text[kind] == arrays[kind].tolist()
        assert [float(row["time"]) for row in own] == text[f"{kind}_time"] == arrays[f"{kind}_time"].tolist()


def test_pairs_do_not_depend_on_threads(frames):
    files = []
    for threads in (1, 2, 7):
        output = frames / f"{threads}.npz"
        run(*CONTINUOUS, frames / "start.obj", frames / "end.obj", "--self", "-o", output, "--threads", threads)
        files.append((frames / f"{threads}.npz").read_bytes())
    assert files[0] == files[1] == files[2]


def test_frames_without_a_common_motion_are_rejected(frames):
    start, end, out = frames / "start.obj", frames / "end.obj", frames / "p.npz"
    write_obj(frames / "less.obj", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    vertices = [(float(k), 0.0, 0.0) for k in range(6)]
    write_obj(frames / "other.obj", vertices, [(0, 1, 2), (3, 5, 4)])
    for arguments, status, message in [
        ([start, frames / "less.obj", "--self", "-o", out], 1, "it has 3 vertices, not 6"),
        ([start, frames / "other.obj", "--self", "-o", out], 1, "have other corners"),
        ([start, end, "-o", out], 2, "add --self"),
        ([start, "--self", "-o", out], 2, "takes two files"),
        ([start, end, "--self", "-o", frames / "p.txt"], 2, "the extension must be .npz"),
        ([start, end, "--self", "-o", frames / "p.obj"], 2, "the extension must be .npz"),
        ([start, end, "--self", "-o", start], 2, ""),
        ([start, end, "--self", "-o", out, "--tolerance", "2"], 2, "tolerance"),
        ([start, end, "--self", "-o", out, "--max-distance", "2"], 2, "there is no option --max-distance"),
        ([start, frames / "absent.obj", "--self", "-o", out], 1, "absent.obj"),
    ]:
        assert message in run("proximity", "continuous", *arguments, status=status)[1]
    assert not out.exists() and names(frames) == ["end.obj", "less.obj", "other.obj", "start.obj"]


@needs_data
def test_no_query_of_the_data_set_is_wrong():
    answer = run_json("ccd", *sorted((DATA / "queries").rglob("*.csv")))
    assert counts(answer) == [2824, 320, 0, 0, 0]


@needs_data
def test_every_colliding_pair_of_the_cloth_is_found(tmp_path):
    frames = [DATA / "cloth-ball" / f"cloth_ball{n}.ply" for n in (92, 93)]
    run("proximity", "continuous", *frames, "--self", "-o", tmp_path / "p.npz")
    found = np.load(tmp_path / "p.npz")
    triangles = ply_triangles(frames[0])
    edges = np.unique(np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    edges = edges[np.lexsort((edges[:, 0], edges[:, 1]))]  # the data set's order: by larger, then smaller vertex
    vertices = 46598

    def colliding(kind):
        pairs = np.array(json.loads((DATA / "cloth-ball" / f"92{kind}.json").read_text()))
        return pairs[np.array(json.loads((DATA / "cloth-ball" / f"92{kind}_mma_bool.json").read_text()), dtype=bool)]

    edge_pairs = colliding("ee") - vertices
    truth = {frozenset(map(tuple, (edges[a], edges[b]))) for a, b in edge_pairs}
    assert truth == {frozenset((tuple(sorted(row[:2])), tuple(sorted(row[2:])))) for row in found["edge_edge"].tolist()}
    assert len(truth) == 94822
    face_pairs = np.sort(colliding("vf"), axis=1)
    truth = {(v, *sorted(triangles[f - vertices - len(edges)])) for v, f in face_pairs.tolist()}
    assert truth == {(row[0], *sorted(row[1:])) for row in found["vertex_face"].tolist()} and len(truth) == 19032


def ply_triangles(path):
    """Triangles of a big-endian PLY file whose faces have a one-byte count and four-byte indices."""
    data = path.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    sizes = {line.split()[1]: int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")}
    rows = np.frombuffer(body[-13 * sizes["face"]:], dtype=[("count", "u1"), ("corners", ">i4", 3)])
    assert (rows["count"] == 3).all()
    return rows["corners"].astype(np.int64)
