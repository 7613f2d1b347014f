# Proves that the JSON of all verbs begins with Blum's version and the command.
import pytest

from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.mark.parametrize("arguments", [
    ["info", "sphere.ply"], ["info", "ball.nrrd"], ["info", "sphere.nrrd"], ["info", "axis.npz"], ["info", "--devices"],
    ["make", "--list"], ["make", "box", "-o", "made.ply"], ["formats"], ["verify", "sphere.ply", "axis.npz"],
    ["surface", "sphere.nrrd", "-o", "made.ply"], ["reconstruct", "axis.npz", "-o", "made.ply", "--resolution", "16"],
], ids=" ".join)
def test_json_of_every_verb_begins_alike(shapes, tmp_path, arguments):
    run("medial", shapes / "sphere.ply", "-o", tmp_path / "axis.npz", "--resolution", 12)
    words = [shapes / word if (shapes / word).exists() else tmp_path / word if "." in word else word for word in arguments]
    summary = run_json(*words)
    assert list(summary)[:2] == ["blum_version", "command"]
    assert run("--version")[0].split() == ["blum", summary["blum_version"]] and summary["command"] == arguments[0]
