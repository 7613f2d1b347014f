"""Checks paths of `blum plan` at many poses with SciPy and exact distances, and `blum verify` with false path files."""

import itertools
import json

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")
transform = pytest.importorskip("scipy.spatial.transform")

ABOVE, BELOW = "0,0,1,1,0,0,0", "0,0,-1,1,0,0,0"
BOUNDS = "--bounds=-0.6,-0.6,-1.5,0.6,0.6,1.5"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A bar above a plate with holes, and a path through a hole."""
    place = tmp_path_factory.mktemp("plan")
    run("make", "box", "-o", place / "bar.ply", "--size-x", 1.2, "--size-y", 0.3, "--size-z", 0.3)
    run("make", "plate", "-o", place / "plate.ply", "--hole-radius", 0.4)
    found = run_json(
        "plan", *meshes(place), *ends(), BOUNDS, "--clearance", 0.02, "--time", 60, "-o", place / "path.json"
    )
    assert found["found"] and found["proof"]["verdict"] == "free" and found["proof"]["at_least"] >= 0.02
    return place


def meshes(place):
    return place / "bar.ply", place / "plate.ply"


def ends(start=ABOVE, goal=BELOW):
    return "--start", start, "--goal", goal


def poses_of(path, samples):
    """Poses of the body along a path file, by SciPy's interpolation of rotations."""
    poses, centre = np.array(path["poses"])[:, 0], np.array(path["centres"][0])
    for first, second in itertools.pairwise(poses):
        turns = transform.Rotation.from_quat([np.roll(first[3:], -1), np.roll(second[3:], -1)])
        ends_of_centre = np.add(turns.apply(centre), [first[:3], second[:3]])
        times = np.linspace(0, 1, samples)
        for turn, t in zip(transform.Slerp([0, 1], turns)(times), times, strict=True):
            at = (1 - t) * ends_of_centre[0] + t * ends_of_centre[1]
            yield turn.as_matrix(), at - turn.apply(centre)


def test_paths_keep_their_clearance(folder):
    path = json.loads((folder / "path.json").read_text())
    scene = blum.ProximityScene()
    plate, bar = scene.add(str(folder / "plate.ply")), scene.add(str(folder / "bar.ply"))
    least = np.inf
    for rotation, translation in poses_of(path, 300):
        scene.update(bar, transform=(rotation, translation))
        least = min(least, scene.separation(plate, bar).distance)
    assert 0.02 <= path["clearance"] <= least <= 1.1 * path["clearance"] + 1e-6
    assert path["poses"][0][0] == [0, 0, 1, 1, 0, 0, 0] and path["poses"][-1][0] == [0, 0, -1, 1, 0, 0, 0]


def test_equal_seeds_give_equal_paths(folder):
    run("plan", *meshes(folder), *ends(), BOUNDS, "--clearance", 0.02, "--time", 60, "-o", folder / "again.json")
    assert (folder / "again.json").read_text() == (folder / "path.json").read_text()


def test_verify_certifies_the_path_and_refuses_lies(folder):
    answer = run_json("verify", folder / "path.json")
    assert answer["path"]["holds"] and answer["path"]["mismatches"] == []
    path = json.loads((folder / "path.json").read_text())

    def refused(change, reason):
        lie = json.loads(json.dumps(path))
        change(lie)
        (folder / "lie.json").write_text(json.dumps(lie))
        _, err = run("verify", folder / "lie.json", status=3)
        assert reason in err, err

    refused(lambda lie: lie["poses"][1][0].__setitem__(2, 0), "the distance of body 0 and obstacle 0 is")
    refused(lambda lie: lie.__setitem__("clearance", 0.5), "that of the path is 0.5")
    refused(lambda lie: lie["intervals"].pop(1), "do not cover its time")
    refused(lambda lie: lie["intervals"][2].__setitem__(3, 3.0), "the clearance must be 3")
    refused(lambda lie: lie["obstacles"][0].__setitem__("crc32", "00000000"), "is not the mesh of the path")
    refused(lambda lie: lie["obstacles"][0].__setitem__("file", "bar.ply"), "is not the mesh of the path")
    text = (folder / "path.json").read_text()
    (folder / "cut.json").write_text(text[: len(text) // 2])
    _, err = run("verify", folder / "cut.json", status=1)
    assert "this is not JSON" in err


def test_verify_judges_paths_of_other_programs(folder):
    rows = [pose[0] for pose in json.loads((folder / "path.json").read_text())["poses"]]
    (folder / "other.csv").write_text("x,y,z,qw,qx,qy,qz\n" + "".join(",".join(map(repr, row)) + "\n" for row in rows))
    assert run_json("verify", folder / "other.csv", *meshes(folder), "--clearance", 0.019)["path"]["holds"]
    _, err = run("verify", folder / "other.csv", *meshes(folder), "--clearance", 0.1, status=3)
    assert "but the clearance must be 0.1" in err
    (folder / "straight.csv").write_text("0,0,1,1,0,0,0\n0,0,-1,1,0,0,0\n")
    _, err = run("verify", folder / "straight.csv", *meshes(folder), status=3)
    assert "the distance of body 0 and obstacle 0 is 0" in err
    _, err = run("verify", folder / "other.csv", status=2)
    assert "does not name the meshes" in err
    _, err = run("verify", folder / "other.csv", *meshes(folder), "--weld", status=2)
    assert "--weld" in err
    _, err = run("verify", folder / "plate.ply", status=2)
    assert "AXIS is required" in err


def test_no_path_is_an_exit_status_of_its_own(folder):
    tight = "--bounds=-0.1,-0.1,-1.5,0.1,0.1,1.5"
    _, err = run("plan", *meshes(folder), *ends(), tight, "--time", 0.3, "-o", folder / "none.json", status=3)
    assert "no path was found in 0.3 s" in err and "does not prove" in err
    assert not (folder / "none.json").exists()


def test_errors_name_the_option_and_the_place(folder):
    for arguments, reason in (
        (ends(goal="0,0,0,1,0,0,0"), "at the goal, body 0 meets obstacle 0 at ("),
        (ends(start="0,0,1,1,0,0"), "--start is '0,0,1,1,0,0', but needs seven numbers"),
        (ends(start="0,0,1,2,0,0,0"), "the length of the quaternion is 2"),
        ((*ends(), "--start", ABOVE), "--start is given 2 times"),
        ((*ends(), "--bounds", "0,0,0,1,1,1"), "outside the bounds"),
        ((*ends(), "--clearance", -1), "--clearance"),
        ((*ends(), "-o", "path.csv"), "--output"),
    ):
        _, err = run("plan", *meshes(folder), *arguments, status=2)
        assert reason in err, err


def test_bodies_move_in_an_order_that_is_found(tmp_path):
    run("make", "box", "-o", tmp_path / "part.ply", "--size-x", 0.5, "--size-y", 0.5, "--size-z", 0.5)
    run("make", "box", "-o", tmp_path / "lid.ply", "--size-x", 1.6, "--size-y", 1.6, "--size-z", 0.2)
    out, _ = run(
        *("plan", tmp_path / "part.ply", "--body", tmp_path / "lid.ply", "-o", tmp_path / "path.json"),
        *(*ends("0,0,-0.4,1,0,0,0", "3,0,2,1,0,0,0"), *ends("0,0,0.5,1,0,0,0", "-4,0,2,1,0,0,0"), "--time", 30),
    )
    assert "order" in out and "then" in out
    assert run_json("verify", tmp_path / "path.json")["input"]["bodies"] == 2
