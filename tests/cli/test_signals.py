# Proves that Ctrl-C and SIGTERM end the tool as shells expect, and that no half-written file remains.
import signal
import subprocess
import time

import pytest

from tool import BLUM, names, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_work_on_a_field_ends_by_the_signal_and_leaves_nothing(tmp_path, number):
    (tmp_path / "out.nrrd").write_bytes(b"old")
    run("make", "soup", "-o", tmp_path / "soup.ply", "--triangles", 20000)
    with subprocess.Popen([BLUM, "field", tmp_path / "soup.ply", "-o", tmp_path / "out.nrrd", "--resolution", "500"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(0.7)
        assert process.poll() is None, "the work was done before it could be interrupted"
        process.send_signal(number)
        start = time.monotonic()
        _, err = process.communicate(timeout=30)
    assert process.returncode == -number and err.endswith(b"blum: error: cancelled\n")
    assert time.monotonic() - start < 3
    assert (tmp_path / "out.nrrd").read_bytes() == b"old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.nrrd", "soup.ply"]


def test_interrupted_work_on_an_axis_ends_by_the_signal_and_leaves_nothing(tmp_path):
    run("make", "torus_knot", "-o", tmp_path / "knot.ply")
    (tmp_path / "out.npz").write_bytes(b"old")
    with subprocess.Popen([BLUM, "medial", tmp_path / "knot.ply", "-o", tmp_path / "out.npz", "--resolution", "700"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(0.5)
        assert process.poll() is None, "the work was done before it could be interrupted"
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, err = process.communicate(timeout=30)
    assert process.returncode == -signal.SIGINT and err.endswith(b"blum: error: cancelled\n")
    assert time.monotonic() - start < 3
    assert (tmp_path / "out.npz").read_bytes() == b"old" and names(tmp_path) == ["knot.ply", "out.npz"]


def test_an_ignored_signal_stays_ignored(tmp_path):
    run("make", "soup", "-o", tmp_path / "soup.ply", "--triangles", 20000)
    with subprocess.Popen([BLUM, "field", tmp_path / "soup.ply", "-o", tmp_path / "out.nrrd", "--resolution", "500"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)) as process:
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        time.sleep(0.5)
        assert process.poll() is None, "scripts start what runs in their background so"
        process.send_signal(signal.SIGTERM)
        _, err = process.communicate(timeout=30)
    assert process.returncode == -signal.SIGTERM and err.endswith(b"blum: error: cancelled\n")
