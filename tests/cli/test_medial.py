# Proves that `blum medial`, `blum verify` and `blum reconstruct` do what their help says: every format, angles and
# labels, exit status and message, nothing written that is not certified, and falsified axes found out.
import json
import re
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

FORMATS = ["vtp", "ply", "obj", "ma", "npz"]
COARSE = ["--resolution", 8, "--max-resolution", 8]  # too coarse for the holes of the plate


@pytest.fixture(scope="session")
def solids(shapes):
    """Beside the shapes, a box, one inside out, one that is open, and a plate with narrow holes."""
    run("make", "box", "-o", shapes / "box.obj")
    lines = (shapes / "box.obj").read_text().splitlines()
    turned = [re.sub(r"^f (\S+) (\S+) (\S+)$", r"f \1 \3 \2", line) for line in lines]
    (shapes / "inverted.obj").write_text("\n".join(turned) + "\n")
    (shapes / "open.obj").write_text("\n".join(lines[:-1]) + "\n")
    run("make", "plate", "-o", shapes / "plate.obj", "--hole-radius", 0.02)
    return shapes


@pytest.fixture(scope="session")
def axes(solids, tmp_path_factory):
    """Axes of the box in every format, of the torus, and of the open box."""
    folder = tmp_path_factory.mktemp("axes")
    for end in FORMATS:
        run("medial", solids / "box.obj", "-o", folder / f"box.{end}", "--resolution", 16)
    run("medial", solids / "torus.obj", "-o", folder / "torus.npz", "--resolution", 40)
    run("medial", solids / "open.obj", "-o", folder / "open.npz", "--resolution", 16, warns=True)
    return folder


def axis_of(summary):
    """The only axis of a summary."""
    (solid,) = summary["solids"]
    (axis,) = solid["axes"]
    return axis


def names(folder):
    return sorted(path.name for path in Path(folder).iterdir())


def falsified(axes, tmp_path, name, change):
    """A copy of an axis whose arrays were changed."""
    arrays = dict(np.load(axes / name))
    change(arrays)
    np.savez(tmp_path / "false.npz", **arrays)
    return tmp_path / "false.npz"


# ---- What is written ----


def counts_in(path):
    """Vertices and triangles that a file holds, by readers of our own."""
    data = path.read_bytes()
    if path.suffix == ".npz":
        arrays = np.load(path)
        return len(arrays["vertices"]), len(arrays["triangles"])
    if path.suffix == ".ma":
        vertices, _, triangles = (int(n) for n in data.split(b"\n", 1)[0].split())
        return vertices, triangles
    if path.suffix == ".obj":
        return sum(line[:2] == b"v " for line in data.splitlines()), sum(line[:2] == b"f " for line in data.splitlines())
    if path.suffix == ".ply":
        return tuple(int(re.search(rb"element %s (\d+)" % name, data).group(1)) for name in (b"vertex", b"face"))
    return tuple(int(re.search(rb'%s="(\d+)"' % name, data).group(1)) for name in (b"NumberOfPoints", b"NumberOfPolys"))


@pytest.mark.parametrize("end", FORMATS)
def test_every_format_holds_the_axis_and_verifies(solids, axes, tmp_path, end):
    output = tmp_path / f"box.{end}"
    summary = run_json("medial", solids / "box.obj", "-o", output, "--resolution", 16)
    counts = axis_of(summary)["counts"]
    assert counts_in(output) == (counts["vertices"], counts["triangles"]) and counts["triangles"] > 1000
    assert summary["outputs"] == [str(output)] and names(tmp_path) == [output.name]
    out, _ = run("verify", solids / "box.obj", output)
    assert "certified" in out and "NOT" not in out
    certificate = run_json("verify", solids / "box.obj", output)["certificate"]
    assert certificate["certified"] and certificate["axis_betti"] == [1, 0, 0]
    geometry = certificate.get("geometry", {})
    assert ("radius_error" in geometry) == (end != "obj") == ("not checked" not in out)
    assert ("footprint_error" in geometry) == (end in ("vtp", "ply", "npz"))


def test_angles_give_a_file_each_and_nested_axes(solids, tmp_path):
    summary = run_json("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 16, "--theta",
                       "100,20,60.5")
    files = ["b-theta100.npz", "b-theta20.npz", "b-theta60.5.npz"]
    assert names(tmp_path) == sorted(files)
    assert [Path(name).name for name in summary["outputs"]] == files
    assert [axis["theta"] for axis in summary["solids"][0]["axes"]] == [100, 20, 60.5]
    cells = []
    for name in ["b-theta20.npz", "b-theta60.5.npz", "b-theta100.npz"]:
        arrays = np.load(tmp_path / name)
        points = [tuple(point) for point in arrays["vertices"]]
        cells.append((set(points), {frozenset(points[v] for v in corners) for corners in arrays["triangles"]}))
    for (points, triangles), (fewer_points, fewer_triangles) in zip(cells, cells[1:]):
        assert fewer_points <= points and fewer_triangles <= triangles
    assert len(cells[2][1]) < len(cells[0][1])


def test_several_labels_give_a_file_each(solids, tmp_path):
    summary = run_json("medial", solids / "balls.npy", "-o", tmp_path / "b.ply", "--label", "1,3", "--theta", "30,90")
    assert [solid["label"] for solid in summary["solids"]] == [1, 3]
    files = [f"b-label{label}-theta{theta}.ply" for label in (1, 3) for theta in (30, 90)]
    assert [Path(name).name for name in summary["outputs"]] == files and names(tmp_path) == sorted(files)
    for label in (1, 3):
        assert run_json("verify", solids / "balls.npy", tmp_path / f"b-label{label}-theta30.ply", "--label",
                        label)["certificate"]["against"] == "voxels"
    run("medial", solids / "balls.npy", "-o", tmp_path / "one.ply", "--label", 2)
    assert "one.ply" in names(tmp_path)


def test_images_by_threshold_and_by_what_is_not_zero(solids, tmp_path):
    for arguments, betti in [([], [3, 0, 0]), (["--threshold", 2], [2, 0, 0]), (["--label", 2], [1, 0, 0])]:
        summary = run_json("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", *arguments)
        assert summary["solids"][0]["rule"] == "voxels"
        assert axis_of(summary)["certificate"]["axis_betti"] == betti


def test_lambda_leaves_out_what_is_thin(solids, axes, tmp_path):
    few = axis_of(run_json("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 16, "--lambda", 0.5))
    assert few["certificate"]["certified"]
    assert 0 < few["counts"]["vertices"] < len(np.load(axes / "box.npz")["vertices"])


def test_summary_has_its_keys(solids, tmp_path):
    summary = run_json("medial", solids / "torus.obj", "-o", tmp_path / "t.vtp", "--spacing", 0.08, "--threads", 2)
    assert {"blum_version", "command", "input", "certified", "mismatches", "lambda", "prune", "solids", "seconds",
            "total_seconds", "peak_memory_bytes", "threads", "thread_backend", "warnings", "outputs"} == set(summary)
    assert (summary["command"], summary["certified"], summary["threads"]) == ("medial", True, 2)
    assert summary["mismatches"] == [] and summary["warnings"] == [] and summary["lambda"] == 0
    assert summary["input"]["kind"] == "mesh" and summary["peak_memory_bytes"] > 1e6
    assert {"read", "write", "certificate", "collapse", "vertices"} <= set(summary["seconds"])
    assert summary["total_seconds"] == pytest.approx(sum(summary["seconds"].values()))
    (solid,) = summary["solids"]
    assert {"rule", "reason", "turned_shells", "grid", "bodies", "axes"} == set(solid)
    assert solid["rule"] == "polyhedron" and isinstance(solid["reason"], str) and solid["turned_shells"] == 0
    assert solid["grid"]["spacing"] == [0.08] * 3
    (body,) = solid["bodies"]
    assert body["solid_betti"] == body["voxel_betti"] == [1, 1, 0] and body["topology_reached"] is True
    assert body["spacing"] == 0.08 and body["voxels"] > 1000
    assert isinstance(body["voxels_left_out"], int) and isinstance(body["voxels_taken_in"], int)
    assert 0 <= body["deviation"] <= 0.08 * 3**0.5
    axis = axis_of(summary)
    assert axis["theta"] == 60 and axis["file"] == str(tmp_path / "t.vtp")
    assert set(axis["counts"]) == {"vertices", "triangles", "sheets", "curve_edges", "rim_edges", "seam_edges",
                                   "junctions"}
    assert all(isinstance(number, int) for number in axis["counts"].values())
    certificate = axis["certificate"]
    assert certificate["certified"] and certificate["topology_holds"] and certificate["mismatches"] == []
    assert certificate["against"] == "polyhedron"
    assert certificate["solid_betti"] == certificate["axis_betti"] == [1, 1, 0]
    geometry = certificate["geometry"]
    assert geometry["holds"] is True and geometry["vertices"] == axis["counts"]["vertices"]
    for error in ("radius_error", "footprint_off_surface", "footprint_error"):
        assert 0 <= geometry[error] <= geometry["tolerance"] < 1e-5
    balls = certificate["balls"]
    assert 0 <= balls["mean_solid_to_balls"] <= balls["solid_to_balls"] < 0.3 and balls["sample_step"] > 0


def test_summary_of_verify_has_its_keys(solids, axes):
    summary = run_json("verify", solids / "box.obj", axes / "box.npz")
    assert set(summary) == {"blum_version", "command", "input", "axis", "certificate", "warnings"}
    assert summary["command"] == "verify" and summary["axis"]["file"] == str(axes / "box.npz")
    assert summary["axis"]["counts"]["vertices"] == len(np.load(axes / "box.npz")["vertices"])


def test_json_goes_to_a_file_beside_the_text(solids, tmp_path):
    out, _ = run("medial", solids / "box.obj", "-o", tmp_path / "b.obj", "--resolution", 12, "--json",
                 tmp_path / "b.json")
    assert "certified" in out and "against the polyhedron" in out
    assert json.loads((tmp_path / "b.json").read_text())["outputs"] == [str(tmp_path / "b.obj")]


def test_quiet_is_silent(solids, axes, tmp_path):
    for name in ("box.obj", "inverted.obj", "open.obj"):
        assert run("medial", solids / name, "-o", tmp_path / "q.npz", "--resolution", 12, "--quiet") == ("", "")
    assert run("verify", solids / "box.obj", axes / "box.npz", "--quiet") == ("", "")


@pytest.mark.parametrize("end", FORMATS)
def test_threads_do_not_change_a_byte(solids, tmp_path, end):
    for threads in (1, 2):
        (tmp_path / str(threads)).mkdir()
        run("medial", solids / "torus.obj", "-o", tmp_path / str(threads) / f"t.{end}", "--resolution", 40, "--threads",
            threads)
    assert (tmp_path / "1" / f"t.{end}").read_bytes() == (tmp_path / "2" / f"t.{end}").read_bytes()


def test_old_output_is_replaced(solids, axes, tmp_path):
    (tmp_path / "b.npz").write_bytes(b"old")
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 16)
    assert (tmp_path / "b.npz").read_bytes() == (axes / "box.npz").read_bytes()


# ---- What solids are ----


def test_an_inverted_mesh_is_turned_and_warned_of(solids, tmp_path):
    command = ["medial", solids / "inverted.obj", "-o", tmp_path / "i.npz", "--resolution", 16]
    assert "1 shell faces the solid and was turned" in run(*command, warns=True)[1]
    summary = run_json(*command, warns=True)
    assert summary["solids"][0]["turned_shells"] == 1 and summary["certified"]
    assert len(summary["warnings"]) == 1
    run("verify", solids / "inverted.obj", tmp_path / "i.npz")


def test_an_open_mesh_is_certified_against_voxels(solids, axes, tmp_path):
    command = ["medial", solids / "open.obj", "-o", tmp_path / "o.npz", "--resolution", 16]
    out, err = run(*command, warns=True)
    assert "it is open (3 boundary edges)" in err and "winding number is above 1/2" in err
    assert "against voxels (of the winding number)" in out and "polyhedron:" not in out.split("certified")[1]
    summary = run_json(*command, warns=True)
    assert summary["solids"][0]["rule"] == "winding"
    assert axis_of(summary)["certificate"]["against"] == "winding"
    assert run_json("verify", solids / "open.obj", axes / "open.npz")["certificate"]["against"] == "winding"


# ---- Failures ----


def test_what_is_not_certified_is_not_written(solids, tmp_path):
    (tmp_path / "p.npz").write_bytes(b"old")
    _, err = run("medial", solids / "plate.obj", "-o", tmp_path / "p.npz", *COARSE, status=3)
    assert "NOT certified" in err and "6 tunnels" in err and "raise --max-resolution" in err
    assert "nothing was written" in err
    assert (tmp_path / "p.npz").read_bytes() == b"old" and names(tmp_path) == ["p.npz"]
    run("medial", solids / "plate.obj", "-o", tmp_path / "q.vtp", "--theta", "20,60", *COARSE, status=3)
    assert names(tmp_path) == ["p.npz"]


def test_what_is_not_certified_is_written_where_that_is_asked_for(solids, tmp_path):
    out, err = run("medial", solids / "plate.obj", "-o", tmp_path / "p.npz", *COARSE, "--allow-uncertified", "--json",
                   "-", status=3)
    assert "NOT certified" in err and "nothing was written" not in err
    summary = json.loads(out)
    assert summary["certified"] is False and summary["outputs"] == [str(tmp_path / "p.npz")]
    assert len(summary["mismatches"]) == 2
    body = summary["solids"][0]["bodies"][0]
    assert body["topology_reached"] is False and body["solid_betti"] == [1, 6, 0] != body["voxel_betti"]
    assert names(tmp_path) == ["p.npz"]
    assert "the solid has 6 tunnels" in run("verify", solids / "plate.obj", tmp_path / "p.npz", status=3)[1]


def test_summary_of_what_is_not_certified_lists_no_output(solids, tmp_path):
    out, _ = run("medial", solids / "plate.obj", "-o", tmp_path / "p.npz", *COARSE, "--json", "-", status=3)
    assert json.loads(out)["outputs"] == []


def test_output_that_cannot_be_written_is_1_and_leaves_nothing(solids, tmp_path):
    (tmp_path / "b-theta60.npz").mkdir()
    run("medial", solids / "box.obj", "-o", tmp_path / "none" / "b.npz", "--resolution", 12, status=1)
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 12, "--theta", "20,60", status=1)
    assert names(tmp_path) == ["b-theta60.npz"]


def test_bad_input_is_1_and_leaves_old_output(solids, axes, tmp_path):
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "segment.obj").write_text("v 0 0 0\nv 1 0 0\nl 1 2\n")
    (tmp_path / "text.obj").write_text("hello\n")
    np.save(tmp_path / "zeros.npy", np.zeros((3, 4, 5), dtype=np.uint8))
    np.save(tmp_path / "nan.npy", np.full((3, 4, 5), np.nan))
    (tmp_path / "out.npz").write_bytes(b"old")
    before = names(tmp_path)
    reasons = {"flat.obj": "no interior", "segment.obj": "no triangles", "text.obj": "text.obj", "zeros.npy": "selected",
               "nan.npy": "NaN", "none.obj": "none.obj"}
    for name, reason in reasons.items():
        assert reason in run("medial", tmp_path / name, "-o", tmp_path / "out.npz", status=1)[1]
    assert "is a field" in run("medial", solids / "sphere.nrrd", "-o", tmp_path / "out.npz", status=1)[1]
    assert names(tmp_path) == before and (tmp_path / "out.npz").read_bytes() == b"old"


USAGE = [
    ("medial", "required"),
    ("medial box.obj", "--output"),
    ("medial box.obj -o out.stl", "extension"),
    ("medial box.obj -o box.obj", "is the input"),
    ("medial box.obj -o out.obj --json out.obj", "two outputs"),
    ("medial box.obj -o out.vtp --theta 181", "0 to 180"),
    ("medial box.obj -o out.vtp --theta=-1", "negative"),
    ("medial box.obj -o out.vtp --theta nan", "finite"),
    ("medial box.obj -o out.vtp --theta 20,,60", "not a number"),
    ("medial box.obj -o out.vtp --theta 20,20", "twice"),
    ("medial box.obj -o out.vtp --theta 20,20.0000001", "two outputs"),
    ("medial box.obj -o out.vtp --theta 20 --theta 60", "--theta"),
    ("medial box.obj -o out.vtp --lambda=-1", "negative"),
    ("medial box.obj -o out.vtp --resolution 7", "8"),
    ("medial box.obj -o out.vtp --resolution 801", "800"),
    ("medial box.obj -o out.vtp --resolution 12.5", "--resolution"),
    ("medial box.obj -o out.vtp --max-resolution 7", "8"),
    ("medial box.obj -o out.vtp --spacing 0", "--spacing"),
    ("medial box.obj -o out.vtp --spacing 0.1 --resolution 16", "--resolution"),
    ("medial box.obj -o out.vtp --threads 0", "--threads"),
    ("medial box.obj -o out.vtp --label 1", "images"),
    ("medial box.obj -o out.vtp --threshold 1", "images"),
    ("medial box.obj -o out.vtp --thetta 20", "--theta"),
    ("medial ball.nrrd -o out.vtp --resolution 16", "meshes"),
    ("medial ball.nrrd -o out.vtp --spacing 1", "meshes"),
    ("medial ball.nrrd -o out.vtp --max-resolution 16", "meshes"),
    ("medial ball.nrrd -o out.vtp --weld", "meshes"),
    ("medial ball.nrrd -o out.vtp --label 1 --threshold 1", "--threshold"),
    ("medial ball.nrrd -o out.vtp --label 1,1", "1"),
    ("medial ball.nrrd -o out.vtp --label 1.5", "1.5"),
    ("verify box.obj", "required"),
    ("verify box.obj box.stl", "extension"),
    ("verify box.obj box.npz --label 1", "images"),
    ("verify box.obj box.npz --threshold 1", "images"),
    ("verify ball.nrrd box.npz --weld", "meshes"),
    ("verify ball.nrrd box.npz --label 1,2", "one label"),
    ("verify ball.nrrd box.npz --label 1 --threshold 1", "--threshold"),
    ("verify box.obj box.npz --json box.obj", "is the input"),
]


@pytest.mark.parametrize("command,word", USAGE, ids=[command for command, _ in USAGE])
def test_bad_usage_is_2_and_writes_nothing(solids, command, word):
    files = {path: path.read_bytes() for path in solids.iterdir()}
    done = subprocess.run([BLUM, *command.split()], capture_output=True, timeout=60, check=False, cwd=solids)
    assert done.returncode == 2 and done.stdout == b"", done
    assert done.stderr.startswith(b"blum: error: ") and word.encode() in done.stderr, done
    assert {path: path.read_bytes() for path in solids.iterdir()} == files


def test_interrupted_work_is_1_and_leaves_nothing(tmp_path):
    run("make", "torus_knot", "-o", tmp_path / "knot.ply")
    (tmp_path / "out.npz").write_bytes(b"old")
    with subprocess.Popen([BLUM, "medial", tmp_path / "knot.ply", "-o", tmp_path / "out.npz", "--resolution", "700"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(0.5)
        assert process.poll() is None, "the work was done before it could be interrupted"
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, err = process.communicate(timeout=30)
    assert process.returncode == 1 and b"blum: error: cancelled" in err
    assert time.monotonic() - start < 3
    assert (tmp_path / "out.npz").read_bytes() == b"old" and names(tmp_path) == ["knot.ply", "out.npz"]


# ---- What verify finds ----


def move_a_vertex(arrays):
    arrays["vertices"][100] += [0.01, 0.02, 0.03]


def move_a_vertex_outside(arrays):
    arrays["vertices"][0] = [0.7, 0, 0]


def scale_radii(arrays):
    arrays["radius"] *= 1.001


def move_a_footprint(arrays):
    arrays["footprints"][7, 1] *= 0.99


def drop_a_triangle(arrays):
    """One whose corners lie inside a sheet, so that a hole remains."""
    inner = np.all(arrays["role"][arrays["triangles"]] == 0, axis=1)
    arrays["triangles"] = np.delete(arrays["triangles"], np.flatnonzero(inner)[0], axis=0)
    for name in ("triangle_angle", "triangle_sheet"):
        arrays[name] = arrays[name][:-1]


def add_a_vertex(arrays):
    for name in ("vertices", "radius", "separation_angle", "role", "footprints", "sites"):
        arrays[name] = np.concatenate([arrays[name], arrays[name][:1]])


@pytest.mark.parametrize("change,reason", [
    (move_a_vertex, "a radius differs from the exact distance"),
    (move_a_vertex_outside, "outside of the solid"),
    (scale_radii, "a radius differs from the exact distance"),
    (move_a_footprint, "a footprint lies off the surface"),
    (drop_a_triangle, "the solid has 0 tunnels, the axis 1"),
    (add_a_vertex, "the solid has 1 component, the axis 2"),
], ids=lambda value: getattr(value, "__name__", ""))
def test_a_falsified_axis_is_found_out(solids, axes, tmp_path, change, reason):
    false = falsified(axes, tmp_path, "box.npz", change)
    out, err = run("verify", solids / "box.obj", false, "--json", "-", status=3)
    assert "NOT certified" in err and reason in err
    certificate = json.loads(out)["certificate"]
    assert certificate["certified"] is False and any(reason in text for text in certificate["mismatches"])
    text, err = run("verify", solids / "box.obj", false, status=3)
    assert "NOT certified" in text and (text + err).count(reason) == 1, "once is enough"
    assert not re.search(r"\d{8}", err), "six digits say enough"


def test_an_axis_that_was_not_falsified_is_not_found_out(solids, axes, tmp_path):
    run("verify", solids / "box.obj", falsified(axes, tmp_path, "box.npz", lambda arrays: None))


def test_the_axis_of_another_solid_is_found_out(solids, axes):
    assert "NOT certified" in run("verify", solids / "sphere.ply", axes / "torus.npz", status=3)[1]
    assert "1 tunnel" in run("verify", solids / "torus.obj", axes / "box.npz", status=3)[1]


def test_the_axis_of_another_label_is_found_out(solids, tmp_path):
    run("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", "--label", 1)
    run("verify", solids / "balls.npy", tmp_path / "b.npz", "--label", 1)
    _, err = run("verify", solids / "balls.npy", tmp_path / "b.npz", "--label", 2, status=3, warns=True)
    assert f"'{tmp_path / 'b.npz'}' was made with --label 1; --label 2 is used, as it was given" in err


@pytest.mark.parametrize("selection", [("--label", 2), ("--threshold", 2.5)], ids=lambda s: s[0])
@pytest.mark.parametrize("end", ["vtp", "ply", "npz"])
def test_the_file_tells_which_voxels_it_is_of(solids, tmp_path, end, selection):
    axis = tmp_path / f"b.{end}"
    run("medial", solids / "balls.npy", "-o", axis, *selection)
    assert run_json("verify", solids / "balls.npy", axis)["certificate"]["certified"]
    distance = [run_json("reconstruct", axis, "-o", tmp_path / "r.ply", "--input", solids / "balls.npy", "--resolution",
                         20, *options)["distance"] for options in ((), selection)]
    assert distance[0] == distance[1]
    _, err = run("verify", solids / "balls.npy", axis, "--label", 1, status=3, warns=True)
    assert f"was made with {selection[0]} {selection[1]}; --label 1 is used" in err


def test_a_file_that_does_not_tell_which_voxels_asks_for_the_option(solids, tmp_path):
    for end in ("obj", "ma"):
        run("medial", solids / "balls.npy", "-o", tmp_path / f"b.{end}", "--label", 2)
        assert "if --label or --threshold was given" in run("verify", solids / "balls.npy", tmp_path / f"b.{end}",
                                                            status=3)[1]
        run("verify", solids / "balls.npy", tmp_path / f"b.{end}", "--label", 2)
        assert "--threshold" not in run("verify", solids / "balls.npy", tmp_path / f"b.{end}", "--label", 1,
                                        status=3)[1]


def test_the_file_tells_how_the_mesh_was_welded(solids, tmp_path):
    lines = (solids / "box.obj").read_text().splitlines()
    points = [line for line in lines if line.startswith("v ")]
    soup = [points[int(word.split("/")[0]) - 1] for line in lines if line.startswith("f ") for word in line.split()[1:]]
    soup += [f"f {k + 1} {k + 2} {k + 3}" for k in range(0, len(soup), 3)]
    (tmp_path / "soup.obj").write_text("\n".join(soup) + "\n")
    for weld in (["--weld"], ["--weld", "1e-6"]):
        for end in ("vtp", "ply", "npz", "obj"):
            summary = run_json("medial", tmp_path / "soup.obj", "-o", tmp_path / f"s.{end}", "--resolution", 12, *weld)
            assert summary["solids"][0]["rule"] == "polyhedron"
        for end in ("vtp", "ply", "npz"):
            verified = run_json("verify", tmp_path / "soup.obj", tmp_path / f"s.{end}")
            assert verified["certificate"]["against"] == "polyhedron" and verified["warnings"] == []
        run("verify", tmp_path / "soup.obj", tmp_path / "s.obj", *weld)
        assert "--weld" in run("verify", tmp_path / "soup.obj", tmp_path / "s.obj", status=1)[1]
    _, err = run("verify", tmp_path / "soup.obj", tmp_path / "s.npz", "--weld", warns=True)
    assert "was made with --weld 1e-06; --weld is used" in err


def test_files_of_before_that_tell_no_selection_are_read(solids, tmp_path):
    run("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", "--label", 2)
    arrays = dict(np.load(tmp_path / "b.npz"))
    metadata = json.loads(str(arrays["metadata"]))
    assert metadata.pop("label") == "2"
    np.savez(tmp_path / "old.npz", **(arrays | {"metadata": np.array(json.dumps(metadata))}))
    run("verify", solids / "balls.npy", tmp_path / "old.npz", "--label", 2)
    run("verify", solids / "balls.npy", tmp_path / "old.npz", status=3)


def test_the_topology_of_files_without_geometry_is_verified(solids, axes, tmp_path):
    for end in ("obj", "ma"):
        lines = (axes / f"box.{end}").read_text().splitlines()
        faces = [k for k, line in enumerate(lines) if line.startswith("f ")]
        del lines[faces[len(faces) // 2]]
        if end == "ma":
            vertices, edges, triangles = lines[0].split()
            lines[0] = f"{vertices} {edges} {int(triangles) - 1}"
        (tmp_path / f"hole.{end}").write_text("\n".join(lines) + "\n")
        assert "tunnel" in run("verify", solids / "box.obj", tmp_path / f"hole.{end}", status=3)[1]


@pytest.mark.parametrize("end", ["obj", "ma"])
def test_what_files_without_labels_do_not_tell_is_not_told(solids, axes, end):
    out, _ = run("verify", solids / "box.obj", axes / f"box.{end}")
    assert "0 edges of curves (the file tells no sheets)" in out and "rims" not in out and "1 sheet" not in out
    counts = run_json("verify", solids / "box.obj", axes / f"box.{end}")["axis"]["counts"]
    assert counts["sheets"] is counts["rim_edges"] is counts["seam_edges"] is counts["junctions"] is None
    assert counts["triangles"] == len(np.load(axes / "box.npz")["triangles"]) and counts["curve_edges"] == 0


def test_radii_of_files_without_footprints_are_verified(solids, axes, tmp_path):
    text = (axes / "box.ma").read_text()
    (tmp_path / "false.ma").write_text(re.sub(r"^(v .* )(\S+)$", lambda m: m[1] + str(1.01 * float(m[2])), text,
                                              count=1, flags=re.M))
    assert "a radius differs" in run("verify", solids / "box.obj", tmp_path / "false.ma", status=3)[1]


def test_a_field_is_no_axis_and_an_axis_no_field(solids, axes, tmp_path):
    for arguments in (["verify", solids / "sphere.ply", solids / "sphere.npz"],
                      ["reconstruct", solids / "sphere.npz", "-o", tmp_path / "x.ply"]):
        assert "it holds a distance field" in run(*arguments, status=1)[1]
    assert "a medial axis, not a field" in run("slice", axes / "box.npz", "-o", tmp_path / "x.png", status=1)[1]
    assert "is a medial axis; a mesh" in run("field", axes / "box.vtp", "-o", tmp_path / "x.npz", status=1)[1]
    np.savez(tmp_path / "else.npz", vertices=np.zeros((2, 3)), metadata=np.array('{"content": "a sonnet"}'))
    assert "call it 'a sonnet', not a medial axis" in run("info", tmp_path / "else.npz", status=1)[1]


@pytest.mark.parametrize("end", ["vtp", "ply", "npz", "ma"])
def test_info_of_an_axis(axes, end):
    path = axes / f"box.{end}"
    facts = run_json("info", path)
    known = np.load(axes / "box.npz")
    assert (facts["kind"], facts["betti"]) == ("medial axis", [1, 0, 0])
    assert facts["radius"] == [known["radius"].min(), known["radius"].max()]
    assert facts["bounds"]["lower"] == known["vertices"].min(axis=0).tolist()
    assert (facts["counts"]["vertices"], facts["counts"]["triangles"]) == (len(known["vertices"]),
                                                                           len(known["triangles"]))
    out, _ = run("info", path)
    assert f"{path}: medial axis" in out and "1 component, 0 tunnels, 0 voids" in out
    if end == "ma":
        assert facts["theta"] is facts["counts"]["sheets"] is facts["source"] is None
        return
    assert (facts["theta"], facts["source"], facts["solid_rule"]) == (60, "box.obj", "polyhedron")
    assert "theta 60, lambda 0" in out and facts["counts"]["sheets"] == len(set(known["triangle_sheet"]))
    run("info", path, "--weld", status=2)


def test_several_axes_are_verified_at_once(solids, axes, tmp_path):
    files = [axes / f"box.{end}" for end in FORMATS]
    summaries = run_json("verify", solids / "box.obj", *files)
    assert [summary["axis"]["file"] for summary in summaries] == [str(path) for path in files]
    assert all(summary["certificate"]["certified"] for summary in summaries)
    run("medial", solids / "balls.npy", "-o", tmp_path / "b.vtp", "--label", "1,2")
    out, _ = run("verify", solids / "balls.npy", tmp_path / "b-label1.vtp", tmp_path / "b-label2.vtp")
    assert out.count("certified") == 2 and out.count("input") == 1
    false = falsified(axes, tmp_path, "box.npz", scale_radii)
    out, err = run("verify", solids / "box.obj", files[0], false, files[1], "--json", "-", status=3)
    assert [summary["certificate"]["certified"] for summary in json.loads(out)] == [True, False, True]
    assert f"{false}: a radius differs" in err and str(files[0]) not in err
    assert run("verify", solids / "box.obj", files[0], tmp_path / "none.vtp", status=1)[0] == ""


def test_an_axis_of_voxels_needs_a_file_that_says_which(solids, tmp_path):
    for end in ("obj", "ma"):
        run("medial", solids / "open.obj", "-o", tmp_path / f"o.{end}", "--resolution", 12, warns=True)
        _, err = run("verify", solids / "open.obj", tmp_path / f"o.{end}", status=1)
        assert "not closed and manifold" in err and ".obj and .ma name neither rule nor grid" in err
        assert "verify the .vtp, .ply or .npz of the same run" in err


def test_an_open_mesh_that_faces_inwards_is_told_of(solids, tmp_path):
    lines = (solids / "inverted.obj").read_text().splitlines()
    (tmp_path / "in.obj").write_text("\n".join(lines[:-1]) + "\n")
    _, err = run("medial", tmp_path / "in.obj", "-o", tmp_path / "o.vtp", "--resolution", 12, status=1)
    assert "no interior" in err and "its triangles face inwards: flip them" in err


def test_files_that_are_no_axis_are_refused(solids, axes, tmp_path):
    (tmp_path / "cut.npz").write_bytes((axes / "box.npz").read_bytes()[:5000])
    (tmp_path / "empty.vtp").write_bytes(b"")
    for name in ("cut.npz", "empty.vtp", "none.ply"):
        assert name in run("verify", solids / "box.obj", tmp_path / name, status=1)[1]
    arrays = dict(np.load(axes / "box.npz"))
    arrays["radius"][3] = np.nan
    np.savez(tmp_path / "nan.npz", **arrays)
    assert "vertex 3" in run("verify", solids / "box.obj", tmp_path / "nan.npz", status=1)[1]


def test_pruned_sheets_are_certified_nested_and_no_smaller_than_cut_ones(solids, tmp_path):
    for way, options in (("whole", ["--prune", "sheets"]), ("cut", [])):
        run("medial", solids / "plate.obj", "-o", tmp_path / f"{way}.npz", "--theta", "120,60", "--resolution", 48,
            *options)
    sizes = {path.name: len(np.load(path)["triangles"]) for path in tmp_path.iterdir()}
    assert sizes["whole-theta120.npz"] <= sizes["whole-theta60.npz"]
    assert sizes["whole-theta120.npz"] >= sizes["cut-theta120.npz"]
    assert sizes["cut-theta120.npz"] > 0
    _, error = run("medial", solids / "box.obj", "-o", tmp_path / "x.vtp", "--prune", "leaves", status=2)
    assert "must be sheets" in error


def test_balls_of_an_axis_become_a_field_and_a_mesh_near_the_solid(solids, axes, tmp_path):
    summary = run_json("reconstruct", axes / "box.vtp", "-o", tmp_path / "box.ply", "--input", solids / "box.obj",
                       "--resolution", 40)  # finer grids see between the balls
    assert summary["surface"]["triangles"] > 1000
    distance = summary["distance"]
    assert 0 < distance["mean_solid_to_balls"] < distance["solid_to_balls"] < 0.1, "voxels are 1/16 long"
    assert abs(distance["balls_beyond_solid"]) < 1e-9
    assert run_json("info", tmp_path / "box.ply")["betti"] == [1, 0, 0]
    run("reconstruct", axes / "box.ma", "-o", tmp_path / "box.npz", "--resolution", 40)
    field = np.load(tmp_path / "box.npz")["distance"]
    assert max(field.shape) == 40
    assert field.min() < -0.4 and field[0, 0, 0] > 0, "negative in the balls, of which the largest has radius 1/2"


def test_reconstruct_refuses_what_has_no_balls(solids, axes, tmp_path):
    assert "AXIS" in run("reconstruct", axes / "box.obj", "-o", tmp_path / "x.ply", status=2)[1]
    assert "--output" in run("reconstruct", axes / "box.vtp", "-o", tmp_path / "x.png", status=2)[1]
    assert names(tmp_path) == []
