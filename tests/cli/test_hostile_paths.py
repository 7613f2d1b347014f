"""Proves that `blum verify` certifies true statements about paths, and refuses false ones."""

import json
import zlib

import numpy as np
import pytest
from tool import BLUM, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")

TRI = np.array([[0, 1, 2]])


def box(size=(1, 1, 1), centre=(0, 0, 0)):
    unit = blum.generate("box")
    return unit.vertices * size + centre, unit.triangles


def write(name, mesh):
    v, t = mesh
    rows = [" ".join(repr(float(x)) for x in p) for p in v] + [f"3 {a} {b} {c}" for a, b, c in t]
    name.write_text(f"OFF\n{len(v)} {len(t)} 0\n" + "\n".join(rows) + "\n")
    data = name.read_bytes()
    return {"file": name.name, "bytes": len(data), "crc32": f"{zlib.crc32(data):08x}"}


def path_file(folder, poses, clearance, centre=(0, 0, 0), intervals=None, obstacles=None):
    rest = [box()] if obstacles is None else obstacles
    path = {
        "format": "blum-path",
        "version": 1,
        "bodies": [write(folder / "b.off", box())],
        "obstacles": [write(folder / f"o{k}.off", o) for k, o in enumerate(rest)],
        "centres": [list(centre)],
        "poses": [[p] for p in poses],
        "clearance": clearance,
    }
    if intervals:
        path["intervals"] = intervals
    (folder / "p.json").write_text(json.dumps(path))
    return folder / "p.json"


SIDE = [[-3, 1.13, 0, 1, 0, 0, 0], [3, 1.13, 0, 1, 0, 0, 0]]  # distance 0.13
THROUGH = [[-3, 0.5, 0, 1, 0, 0, 0], [3, 0.5, 0, 1, 0, 0, 0]]


@pytest.mark.parametrize(
    ("expected", "given"),
    [
        (True, {"poses": SIDE, "clearance": 0.13}),
        (True, {"poses": [SIDE[0], SIDE[0], [3, 1.13, 0, -1.0009, 0, 0, 0]], "clearance": 0.129}),
        (True, {"poses": SIDE, "clearance": 0.129, "intervals": [[0, 0, 0.7, 0.129], [0, 0.3, 1, 0.13]]}),
        (False, {"poses": SIDE, "clearance": 0.13 + 1e-9}),
        (False, {"poses": SIDE, "clearance": 0.5, "centre": (0, 0, 6e11)}),
        (False, {"poses": SIDE, "clearance": 0.14, "centre": (0, 0, 1e10)}),
        (False, {"poses": THROUGH, "clearance": 0, "intervals": [[0, 0, 0.3, 0], [0, 0.1, 0.2, 0], [0, 0.7, 1, 0]]}),
        (False, {"poses": [THROUGH[0], [1e60, 0.5, 0, 1, 0, 0, 0]], "clearance": 0}),
        (False, {"poses": [[-3, 1.9, 0, 1, 0, 0, 0], [3, 1.9, 0, 0, 0, 0, 1]], "clearance": 0}),
        (
            False,
            {
                "poses": [[-3e5, 0, 0, 1, 0, 0, 0], [2.9e5, 0, 0, 1, 0, 0, 0]],
                "clearance": 0,
                "obstacles": [(np.array([[0, -9, -9], [0, 9, -9], [0, 0, 9.0]]), TRI)],
            },
        ),
    ],
)
def test_statements_about_paths(tmp_path, expected, given):
    run("verify", path_file(tmp_path, **given), status=0 if expected else 3)


def test_a_path_without_obstacles_is_an_error(tmp_path):
    _, err = run("verify", path_file(tmp_path, poses=THROUGH, clearance=5.0, obstacles=()), status=2)
    assert "there is one body, but no obstacle" in err
