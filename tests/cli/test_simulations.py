"""Proves that the example simulations write frames without crossings, complete results and clear errors."""

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from tool import BLUM, names, run_json

PROGRAM = Path(os.environ.get("BLUM_BIN_DIR", "")) / "simulations"
pytestmark = pytest.mark.skipif(
    not BLUM or "BLUM_BIN_DIR" not in os.environ or not PROGRAM.exists(), reason="simulations is not built"
)


def simulate(*arguments, folder):
    return subprocess.run(
        [PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, cwd=folder, timeout=60
    )


def test_help_and_bad_arguments(tmp_path):
    (tmp_path / "file").write_text("")
    done = simulate("--help", folder=tmp_path)
    assert done.returncode == 0 and "--frames N" in done.stdout
    for arguments, status, message in (
        (["cloth", "out", "--frames", "abc"], 2, "--frames 'abc': must be a whole number from 1 to 1000"),
        (["cloth", "out", "--frames", "-3"], 2, "--frames '-3': must be"),
        (["cloth", "out", "--frames"], 2, "--frames takes a number"),
        (["silk"], 2, "there is no simulation 'silk'"),
        (["cloth", "--fast"], 2, "there is no option --fast"),
        (["cloth", "file", "--frames", "2"], 1, "'file' is not a folder"),
        (["cloth", "/proc/out", "--frames", "2"], 1, "cannot write '/proc/out'"),
    ):
        done = simulate(*arguments, folder=tmp_path)
        assert done.returncode == status and message in done.stderr, arguments
    assert names(tmp_path) == ["file"]


def test_results_replace_earlier_ones(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "frame_007.ply").write_text("old")
    (out / "notes.txt").write_text("mine")
    done = simulate("cloth", "out", "--frames", "2", folder=tmp_path)
    assert done.returncode == 0 and done.stdout.startswith("cloth: 2 frames, ")
    assert names(out) == ["frame_000.ply", "frame_001.ply", "notes.txt", "pairs.json"]
    assert names(tmp_path) == ["out"]
    assert len(json.loads((out / "pairs.json").read_text())["frames"]) == 2


def test_a_stopped_run_leaves_complete_results(tmp_path):
    with subprocess.Popen([PROGRAM, "cloth", "out"], cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        while not (tmp_path / "out.part" / "frame_000.ply").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and out.startswith("cloth: ")
    count = len(json.loads((tmp_path / "out" / "pairs.json").read_text())["frames"])
    assert 1 <= count < 60 and len(names(tmp_path / "out")) == count + 1 and names(tmp_path) == ["out"]


def test_bodies_do_not_cross_themselves(tmp_path):
    """The first bodies meet the bowl at frame 6. Without contact handling they would soon cross themselves."""
    assert simulate("bodies", "out", "--frames", "16", folder=tmp_path).returncode == 0
    frames = sorted((tmp_path / "out").glob("frame_*.ply"))
    answer = run_json("proximity", "collide", *frames, "--frames", "--self")
    assert answer["pairs"] == [0] * 16
