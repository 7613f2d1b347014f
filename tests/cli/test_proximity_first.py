"""Proves that `blum proximity continuous --first` finds the first of all collisions, and nothing else.

The beams come from the folder of real shapes, BLUM_DATA_DIR. Their faces are aligned and parallel. So 306,112 pairs of
features meet, many of them at one time."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")

DATA = Path(os.environ.get("BLUM_DATA_DIR", Path(__file__).parents[3] / "shared" / "data")) / "reported"
needs_data = pytest.mark.skipif(not (DATA / "beams-start-upper.ply").is_file(), reason=f"no beams in {DATA}")
BEAMS = [DATA / f"beams-{time}-{who}.ply" for time in ("start", "end") for who in ("lower", "upper")]


def first_of(path):
    """The first collision of a file: by time, then in the order of the file, faces before edges."""
    all_pairs = json.loads(path.read_text())
    rows = [
        (time, kind, owners, vertices)
        for kind in ("vertex_face", "edge_edge")
        for time, owners, vertices in zip(
            all_pairs[f"{kind}_time"], all_pairs[f"{kind}_object"], all_pairs[kind], strict=True
        )
    ]
    return min(rows, key=lambda row: row[0])  # the first of equal ones


def expect_first_of_all(tmp_path, start, end, *options):
    files = [*start, "--to", *end, *options]
    run("proximity", "continuous", *files, "-o", tmp_path / "all.json")
    answers = []
    for threads in (1, 2):
        output = tmp_path / f"first{threads}.json"
        answer = run_json("proximity", "continuous", *files, "--first", "--threads", threads, "-o", output)
        answers.append(answer["first_contact"])
        assert answer["vertex_face"] + answer["edge_edge"] == 1
        assert answer["earliest"] == answer["first_contact"]["time"]
        assert answer["box_pairs"] is None and answer["exact_tests"] is None
        assert first_of(output) == first_of(tmp_path / "all.json")
    assert answers[0] == answers[1]
    return answers[0]


def test_a_ball_meets_a_plate(tmp_path):
    ball, plate = blum.generate("sphere", radius=0.5), blum.generate("box", size_x=4, size_y=4, size_z=0.2)
    plate.write(tmp_path / "plate.ply")
    for name, height in (("ball1.ply", 2), ("ball2.ply", -2)):
        blum.Mesh(ball.vertices + np.array([0, 0, height]), ball.triangles).write(tmp_path / name)
    start, end = [[tmp_path / name, tmp_path / "plate.ply"] for name in ("ball1.ply", "ball2.ply")]
    first = expect_first_of_all(tmp_path, start, end)
    assert first["time"] == pytest.approx(0.35, abs=1e-6) and first["object"] == [0, 1]
    out, _ = run("proximity", "continuous", *start, "--to", *end, "--first")
    assert "first contact  at time 0.349999: vertex " in out and "collisions" not in out
    # A ball that rests meets nothing.
    answer = run_json("proximity", "continuous", *start, "--to", *start, "--first")
    assert answer["first_contact"] is None and answer["earliest"] is None
    out, _ = run("proximity", "continuous", *start, "--to", *start, "--first")
    assert "first contact  none" in out


def test_one_mesh_and_frames(tmp_path):
    ring = blum.generate("torus", ring_segments=16, tube_segments=8)
    frames = [tmp_path / f"{k}.ply" for k in range(3)]
    for k, path in enumerate(frames):
        blum.Mesh(ring.vertices * [1 - k, 1, 0.8], ring.triangles).write(path)
    every = run_json("proximity", "continuous", *frames[1:], "--self", warns=True)  # the flat ring
    one = run_json("proximity", "continuous", *frames[1:], "--self", "--first", "-o", tmp_path / "one.npz", warns=True)
    assert one["earliest"] == every["earliest"] is not None
    assert every["first_contact"] is None and one["first_contact"]["object"] == [0, 0]
    with np.load(tmp_path / "one.npz") as file:
        assert len(file["vertex_face"]) + len(file["edge_edge"]) == 1
    steps = run_json("proximity", "continuous", *frames, "--frames", "--self")
    few = run_json("proximity", "continuous", *frames, "--frames", "--self", "--first")
    assert few["earliest"] == steps["earliest"]
    assert few["pairs"] == [min(count, 1) for count in steps["pairs"]]


@needs_data
def test_aligned_beams_meet_at_a_third(tmp_path):
    first = expect_first_of_all(tmp_path, BEAMS[:2], BEAMS[2:])
    assert 1 / 3 - 1e-6 <= first["time"] <= 1 / 3
    everything = run_json("proximity", "continuous", *BEAMS[:2], "--to", *BEAMS[2:])
    assert (everything["vertex_face"], everything["edge_edge"]) == (81_320, 224_792)


@needs_data
@pytest.mark.parametrize("scale", [0.1, 1 / 3])
def test_beams_of_inexact_coordinates_meet_at_a_third(tmp_path, scale):
    meshes = [blum.read_mesh(path) for path in BEAMS]
    files = [tmp_path / path.name for path in BEAMS]
    for mesh, path in zip(meshes, files, strict=True):
        blum.Mesh(mesh.vertices * scale, mesh.triangles).write(path)
    first = run_json("proximity", "continuous", *files[:2], "--to", *files[2:], "--first")["first_contact"]
    assert 1 / 3 - 2e-6 <= first["time"] <= 1 / 3 + 1e-12
