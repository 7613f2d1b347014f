# Proves that `blum medial` writes certified axes in every format, for each angle and label, and nothing uncertified.
# Bad usage and bad input give the documented exit status and message.
import json
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from tool import BLUM, FORMATS, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

COARSE = ["--resolution", 8, "--max-resolution", 8, "--decimate", 0]
WHY_NOT = "loops of the axis run around 0 of the 1 tunnel"  # the reason for the block with a needle


def block_with_needle(folder):
    """A cube with a slanted square hole, so narrow that the cellular model closes it and no axis runs around it."""
    path = folder / "needle.obj"
    width = 1e-9
    lines, faces = [], []
    for z in (0, 1):
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        lines += [f"v {x} {y} {z}" for x, y in corners]
        lines += [
            f"v {0.37 + 0.2 * z + width * (x - 0.5)!r} {0.41 + 0.3 * z + width * (y - 0.5)!r} {z}" for x, y in corners
        ]
    for k in range(4):
        n = (k + 1) % 4
        outside, hole = (k, n, 8 + n, 8 + k), (4 + n, 4 + k, 12 + k, 12 + n)
        bottom, top = (n, k, 4 + k, 4 + n), (8 + k, 8 + n, 12 + n, 12 + k)
        faces += [f"f {a + 1} {b + 1} {c + 1} {d + 1}" for a, b, c, d in (outside, hole, bottom, top)]
    path.write_text("\n".join(lines + faces) + "\n")
    return path


def axis_of(summary):
    """The only axis of a summary."""
    (solid,) = summary["solids"]
    (axis,) = solid["axes"]
    return axis


# ---- Output ----


def counts_in(path):
    """Numbers of vertices and triangles in a file, read without Blum."""
    data = path.read_bytes()
    if path.suffix == ".npz":
        arrays = np.load(path)
        return len(arrays["vertices"]), len(arrays["triangles"])
    if path.suffix == ".ma":
        vertices, _, triangles = (int(n) for n in data.split(b"\n", 1)[0].split())
        return vertices, triangles
    if path.suffix == ".obj":
        return sum(line[:2] == b"v " for line in data.splitlines()), sum(
            line[:2] == b"f " for line in data.splitlines()
        )
    if path.suffix == ".ply":
        return tuple(int(re.search(rb"element %s (\d+)" % name, data).group(1)) for name in (b"vertex", b"face"))
    return tuple(int(re.search(rb'%s="(\d+)"' % name, data).group(1)) for name in (b"NumberOfPoints", b"NumberOfPolys"))


@pytest.mark.parametrize("end", FORMATS)
def test_every_format_holds_the_axis_and_verifies(solids, axes, tmp_path, end):
    output = tmp_path / f"box.{end}"
    summary = run_json("medial", solids / "box.obj", "-o", output, "--resolution", 16)
    counts = axis_of(summary)["counts"]
    assert counts_in(output) == (counts["vertices"], counts["triangles"]) and counts["triangles"] > 10
    assert summary["outputs"] == [str(output)] and names(tmp_path) == [output.name]
    out, _ = run("verify", solids / "box.obj", output)
    assert "certified" in out and "NOT" not in out
    certificate = run_json("verify", solids / "box.obj", output)["certificate"]
    assert certificate["certified"] and certificate["axis_betti"] == [1, 0, 0]
    geometry = certificate["geometry"]
    assert ("radius_error" in geometry) == ("balls" in certificate) == (end != "obj")
    assert ("footprint_error" in geometry) == (end in ("vtp", "ply", "npz")) == ("not checked" not in out)
    checked = ["topology", "positions", "edges", "triangles"] + ["radii"] * (end != "obj")
    columns = ["footprints", "angles", "sites", "labels", "medial", "missing", "theta", "lambda", "spacing"]
    checked += columns * (end in ("vtp", "ply", "npz"))
    assert certificate["checked"] == checked
    lacking = ["radii"] * (end == "obj") + ["footprints", "separation angles", "sites", "roles and sheets"]
    lacking = [name + ": not in the file" for name in lacking] * (end in ("obj", "ma"))
    said = [name for name in certificate["not_checked"] if name not in lacking]
    assert certificate["not_checked"][: len(lacking)] == lacking
    assert said[-2:] == ["source: copied from the file", "version: copied from the file"]


def test_angles_give_a_file_each_and_nested_axes(solids, tmp_path):
    summary = run_json(
        "medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 16, "--theta", "100,20,60.5", "--decimate", 0
    )
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


def test_decimation_removes_vertices_within_its_tolerance(solids, tmp_path):
    triangles = {}
    for tolerance in (None, 0, 0.05):
        name = tmp_path / f"{tolerance}.npz"
        given = [] if tolerance is None else ["--decimate", tolerance]
        axis = axis_of(run_json("medial", solids / "box.obj", "-o", name, "--resolution", 32, *given))
        facts = run_json("info", name)
        run("verify", solids / "box.obj", name)
        assert (facts["deviation"] is None) == (tolerance == 0)
        assert axis["deviation"] <= (0.25 / 32 if tolerance is None else tolerance) + 1e-12
        assert axis["deviation"] == (facts["deviation"] or 0)
        triangles[tolerance] = axis["counts"]["triangles"]
        assert axis["vertices_before"] >= axis["counts"]["vertices"]
    assert triangles[0] > 10 * max(triangles[None], triangles[0.05])
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--nested", "--decimate", 1, status=2)
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--decimate", -1, status=2)


def test_several_labels_give_a_file_each(solids, tmp_path):
    summary = run_json("medial", solids / "balls.npy", "-o", tmp_path / "b.ply", "--label", "1,3", "--theta", "30,90")
    assert [solid["label"] for solid in summary["solids"]] == [1, 3]
    files = [f"b-label{label}-theta{theta}.ply" for label in (1, 3) for theta in (30, 90)]
    assert [Path(name).name for name in summary["outputs"]] == files and names(tmp_path) == sorted(files)
    for label in (1, 3):
        assert (
            run_json("verify", solids / "balls.npy", tmp_path / f"b-label{label}-theta30.ply", "--label", label)[
                "certificate"
            ]["against"]
            == "voxels"
        )
    run("medial", solids / "balls.npy", "-o", tmp_path / "one.ply", "--label", 2)
    assert "one.ply" in names(tmp_path)


def test_images_are_selected_by_threshold_label_or_nonzero(solids, tmp_path):
    for arguments, betti in [([], [3, 0, 0]), (["--threshold", 2], [2, 0, 0]), (["--label", 2], [1, 0, 0])]:
        summary = run_json("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", *arguments)
        assert summary["solids"][0]["rule"] == "voxels"
        assert axis_of(summary)["certificate"]["axis_betti"] == betti


def test_sites_of_images_are_voxels_that_are_not_selected(tmp_path):
    image = np.zeros((7, 8, 9), dtype=np.uint8)
    image[2:5, 2:6, 2:7] = 1
    image[:, 3:5, 3:5] = 1  # a bar whose two ends lie on the border of the image
    np.save(tmp_path / "i.npy", image)
    run("medial", tmp_path / "i.npy", "-o", tmp_path / "i.npz", "--theta", 20)
    arrays = np.load(tmp_path / "i.npz")
    sites = np.stack([arrays["site_0"], arrays["site_1"]], axis=1)
    footprints = np.stack([arrays["footprint_0"], arrays["footprint_1"]], axis=1)
    z, y, x = np.unravel_index(sites, image.shape)
    at_border = np.isin(z, (0, 6))
    assert (sites >= 0).all() and (image[z, y, x][~at_border] == 0).all() and (~at_border).sum() > 20
    off = np.abs(footprints - np.stack([x, y, z], axis=-1)).max(axis=-1)
    assert off[image[z, y, x] == 0].max() <= 0.5 + 1e-9
    assert "unselected" in json.loads(str(arrays["metadata"]))["sites"]


def test_lambda_removes_thin_parts(solids, axes, tmp_path):
    options = ["--resolution", 16, "--decimate", 0, "--lambda", 0.5]
    few = axis_of(run_json("medial", solids / "box.obj", "-o", tmp_path / "b.npz", *options))
    assert few["certificate"]["certified"]
    assert 0 < few["counts"]["vertices"] < len(np.load(axes / "box.npz")["vertices"])


def test_pruned_sheets_are_certified_nested_and_no_smaller_than_cut_ones(solids, tmp_path):
    for way, options in (("whole", ["--prune", "sheets"]), ("cut", [])):
        run(
            "medial",
            solids / "plate.obj",
            "-o",
            tmp_path / f"{way}.npz",
            "--theta",
            "120,60",
            "--resolution",
            48,
            *options,
        )
    sizes = {path.name: len(np.load(path)["triangles"]) for path in tmp_path.iterdir()}
    assert sizes["whole-theta120.npz"] <= sizes["whole-theta60.npz"]
    assert sizes["whole-theta120.npz"] >= sizes["cut-theta120.npz"]
    assert sizes["cut-theta120.npz"] > 0
    _, error = run("medial", solids / "box.obj", "-o", tmp_path / "x.vtp", "--prune", "leaves", status=2)
    assert "must be sheets" in error


def test_summary_has_its_keys(solids, tmp_path):
    summary = run_json("medial", solids / "torus.obj", "-o", tmp_path / "t.vtp", "--spacing", 0.08, "--threads", 2)
    assert {
        "blum_version",
        "command",
        "input",
        "certified",
        "mismatches",
        "lambda",
        "prune",
        "solids",
        "seconds",
        "total_seconds",
        "peak_memory_bytes",
        "threads",
        "thread_backend",
        "warnings",
        "outputs",
    } == set(summary)
    assert (summary["command"], summary["certified"], summary["threads"]) == ("medial", True, 2)
    assert summary["mismatches"] == [] and summary["warnings"] == [] and summary["lambda"] == 0
    assert summary["input"]["kind"] == "mesh" and summary["peak_memory_bytes"] > 1e6
    assert {"read", "write", "certificate", "collapse", "vertices"} <= set(summary["seconds"])
    assert summary["total_seconds"] == pytest.approx(sum(summary["seconds"].values()))
    (solid,) = summary["solids"]
    assert {
        "smooth",
        "rule",
        "reason",
        "reversed_shells",
        "solid_betti",
        "topology_matches",
        "asked_spacing",
        "grid_shift",
        "grid",
        "bodies",
        "axes",
    } == set(solid)
    assert solid["solid_betti"] == [1, 1, 0] and solid["topology_matches"] is True
    assert solid["asked_spacing"] == 0.08
    assert solid["rule"] == "polyhedron" and isinstance(solid["reason"], str) and solid["reversed_shells"] == 0
    assert solid["grid"]["spacing"] == [0.08] * 3
    (body,) = solid["bodies"]
    assert body["solid_betti"] == [1, 1, 0] and body["topology_matches"] is True
    assert body["spacing"] == 0.08 and body["voxels"] > 1000
    assert isinstance(body["extra_cells"], int) and body["failures"] == []
    axis = axis_of(summary)
    assert axis["theta"] == 60 and axis["file"] == str(tmp_path / "t.vtp")
    assert set(axis["counts"]) == {
        "vertices",
        "triangles",
        "sheets",
        "curve_edges",
        "rim_edges",
        "seam_edges",
        "junctions",
    }
    assert all(isinstance(number, int) for number in axis["counts"].values())
    certificate = axis["certificate"]
    assert certificate["certified"] and certificate["topology_holds"] and certificate["mismatches"] == []
    assert certificate["against"] == "polyhedron"
    assert certificate["solid_betti"] == certificate["axis_betti"] == [1, 1, 0]
    geometry = certificate["geometry"]
    assert geometry["holds"] is True and geometry["vertices"] == axis["counts"]["vertices"]
    for error in ("radius_error", "footprint_off_surface", "footprint_error", "site_error"):
        assert 0 <= geometry[error] <= geometry["tolerance"] < 1e-5
    assert geometry["outside"] == geometry["outside_by"] == geometry["not_finite"] == 0
    assert 0 <= geometry["angle_error"] < 1e-4
    edges = certificate["edges"]
    assert edges["holds"] is True and edges["edges"] >= geometry["vertices"] and edges["outside"] == 0
    assert edges["pushed"] == 0 and edges["pushed_by"] == edges["outside_by"] == 0 and edges["tolerance"] > 0
    assert certificate["bodies"] == {"count": 1, "wrong": 0}
    balls = certificate["balls"]
    assert 0 <= balls["mean_solid_to_balls"] <= balls["solid_to_balls"] < 0.3 and balls["sample_step"] > 0


def test_voxels_finer_than_requested_are_reported(solids, tmp_path):
    run("make", "box", "-o", tmp_path / "p.obj", "--size-z", 0.02)
    lines = (tmp_path / "p.obj").read_text().splitlines()
    (tmp_path / "p.obj").write_text("\n".join(lines[:-1]))  # open, so that voxels define the solid
    command = ["medial", tmp_path / "p.obj", "-o", tmp_path / "p.vtp", "--resolution", 16]
    out, _ = run(*command, warns=True)
    (solid,) = run_json(*command, warns=True)["solids"]
    spacing = solid["bodies"][0]["spacing"]
    longest = max(upper - lower for lower, upper in zip(*run_json("info", tmp_path / "p.obj")["bounds"].values()))
    assert solid["asked_spacing"] == pytest.approx(longest / 16) and spacing < 0.6 * longest / 16
    (line,) = [line for line in out.splitlines() if line.startswith("refined")]
    assert f"voxels from side {longest / 16:.6g} to {spacing:.6g}: no larger voxel has its centre inside" in line
    assert "refined" not in run("medial", solids / "box.obj", "-o", tmp_path / "b.vtp", "--resolution", 12)[0]


def test_voxels_that_are_not_cubes_are_reported_by_all_sides(tmp_path):
    data = "type: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: ascii\nspace dimension: 3\n"
    vectors = "space directions: (0.5,0,0) (0,1,0) (0,0,2.5)\n\n"
    (tmp_path / "i.nrrd").write_text("NRRD0004\n" + data + vectors + "1 " * 24 + "\n")
    assert "24 of sides (0.5, 1, 2.5)" in run("medial", tmp_path / "i.nrrd", "-o", tmp_path / "i.vtp", "--verbose")[0]
    assert run_json("medial", tmp_path / "i.nrrd", "-o", tmp_path / "i.vtp")["solids"][0]["asked_spacing"] is None


def test_json_goes_to_a_file_beside_the_text(solids, tmp_path):
    out, _ = run(
        "medial", solids / "box.obj", "-o", tmp_path / "b.obj", "--resolution", 12, "--json", tmp_path / "b.json"
    )
    assert "yes at theta 60: the axis has the topology of the solid (1 component, 0 tunnels, 0 voids) and lies inside the solid" in out
    assert json.loads((tmp_path / "b.json").read_text())["outputs"] == [str(tmp_path / "b.obj")]


def test_quiet_is_silent(solids, axes, tmp_path):
    for name in ("box.obj", "inverted.obj", "open.obj"):
        assert run("medial", solids / name, "-o", tmp_path / "q.npz", "--resolution", 12, "--quiet") == ("", "")
    assert run("verify", solids / "box.obj", axes / "box.npz", "--quiet") == ("", "")


@pytest.mark.parametrize("end", FORMATS)
def test_threads_do_not_change_a_byte(solids, tmp_path, end):
    for threads in (1, 2):
        (tmp_path / str(threads)).mkdir()
        run(
            "medial",
            solids / "torus.obj",
            "-o",
            tmp_path / str(threads) / f"t.{end}",
            "--resolution",
            40,
            "--threads",
            threads,
        )
    assert (tmp_path / "1" / f"t.{end}").read_bytes() == (tmp_path / "2" / f"t.{end}").read_bytes()


def test_old_output_is_replaced(solids, axes, tmp_path):
    (tmp_path / "b.npz").write_bytes(b"old")
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 16, "--decimate", 0)
    assert (tmp_path / "b.npz").read_bytes() == (axes / "box.npz").read_bytes()


# ---- Solids ----


def test_an_inverted_mesh_is_reversed_with_a_warning(solids, tmp_path):
    command = ["medial", solids / "inverted.obj", "-o", tmp_path / "i.npz", "--resolution", 16]
    assert "1 shell faces the wrong way and was reversed" in run(*command, warns=True)[1]
    summary = run_json(*command, warns=True)
    assert summary["solids"][0]["reversed_shells"] == 1 and summary["certified"]
    assert [warning["code"] for warning in summary["warnings"]] == ["reversed-shells"]
    run("verify", solids / "inverted.obj", tmp_path / "i.npz")


def test_an_open_mesh_is_certified_against_voxels(solids, axes, tmp_path):
    command = ["medial", solids / "open.obj", "-o", tmp_path / "o.npz", "--resolution", 16]
    out, err = run(*command, warns=True)
    assert "it is open (3 boundary edges)" in err and "winding number is above 1/2" in err
    assert "topology of the voxels inside by winding number, side 0.0625 (" in out
    summary = run_json(*command, warns=True)
    assert summary["solids"][0]["rule"] == "winding"
    assert axis_of(summary)["certificate"]["against"] == "winding"
    assert run_json("verify", solids / "open.obj", axes / "open.npz")["certificate"]["against"] == "winding"


# ---- Failures ----


def test_an_uncertified_axis_is_not_written(solids, tmp_path):
    (tmp_path / "p.npz").write_bytes(b"old")
    _, err = run("medial", block_with_needle(tmp_path.parent), "-o", tmp_path / "p.npz", *COARSE, status=3)
    assert "NOT certified" in err and WHY_NOT in err
    assert "nothing was written" in err
    assert (tmp_path / "p.npz").read_bytes() == b"old" and names(tmp_path) == ["p.npz"]
    run("medial", block_with_needle(tmp_path.parent), "-o", tmp_path / "q.vtp", "--theta", "20,60", *COARSE, status=3)
    assert names(tmp_path) == ["p.npz"]


def test_an_uncertified_axis_is_written_on_request(solids, tmp_path):
    out, err = run(
        "medial",
        block_with_needle(tmp_path.parent),
        "-o",
        tmp_path / "p.npz",
        *COARSE,
        "--allow-uncertified",
        "--json",
        "-",
        status=3,
    )
    assert "NOT certified" in err and "nothing was written" not in err
    summary = json.loads(out)
    assert summary["certified"] is False and summary["outputs"] == [str(tmp_path / "p.npz")]
    assert len(summary["mismatches"]) == 3
    assert any(WHY_NOT in mismatch for mismatch in summary["mismatches"])
    assert names(tmp_path) == ["p.npz"]
    assert WHY_NOT in run("verify", block_with_needle(tmp_path.parent), tmp_path / "p.npz", status=3)[1]


def test_drafts_leave_existing_files_alone(solids, tmp_path):
    mine = tmp_path / ".b.draft.npz"
    mine.write_bytes(b"mine")
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 12)
    assert mine.read_bytes() == b"mine" and names(tmp_path) == [".b.draft.npz", "b.npz"]
    run("medial", block_with_needle(tmp_path.parent), "-o", tmp_path / "b.npz", *COARSE, status=3)
    assert mine.read_bytes() == b"mine" and names(tmp_path) == [".b.draft.npz", "b.npz"]
    (tmp_path / ".p.draft.ply").write_bytes((solids / "sphere.ply").read_bytes())
    run("medial", tmp_path / ".p.draft.ply", "-o", tmp_path / "p.ply", "--resolution", 12)
    assert (tmp_path / ".p.draft.ply").exists()


def test_an_output_keeps_its_link_and_permissions(solids, tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "b.npz").write_bytes(b"old")
    (tmp_path / "real" / "b.npz").chmod(0o600)
    (tmp_path / "b.npz").symlink_to(tmp_path / "real" / "b.npz")
    run("medial", solids / "box.obj", "-o", tmp_path / "b.npz", "--resolution", 12)
    assert (tmp_path / "b.npz").is_symlink() and names(tmp_path / "real") == ["b.npz"]
    assert (tmp_path / "real" / "b.npz").stat().st_mode & 0o777 == 0o600
    assert len(np.load(tmp_path / "b.npz")["vertices"]) > 8


def test_the_summary_of_an_uncertified_axis_lists_no_output(solids, tmp_path):
    out, _ = run("medial", block_with_needle(tmp_path.parent), "-o", tmp_path / "p.npz", *COARSE, "--json", "-", status=3)
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
    reasons = {
        "flat.obj": "no interior",
        "segment.obj": "no triangles",
        "text.obj": "text.obj",
        "zeros.npy": "selected",
        "nan.npy": "NaN",
        "none.obj": "none.obj",
    }
    for name, reason in reasons.items():
        assert reason in run("medial", tmp_path / name, "-o", tmp_path / "out.npz", status=1)[1]
    assert "is a field" in run("medial", solids / "sphere.nrrd", "-o", tmp_path / "out.npz", status=1)[1]
    assert names(tmp_path) == before and (tmp_path / "out.npz").read_bytes() == b"old"


USAGE = [
    ("medial", "required"),
    ("medial box.obj", "--output"),
    ("medial box.obj -o out.stl", "extension"),
    ("medial box.obj -o box.obj", "is also the input"),
    ("medial box.obj -o out.obj --json out.obj", "two outputs"),
    ("medial box.obj -o out.vtp --theta 181", "0 to 180"),
    ("medial box.obj -o out.vtp --theta=-1", "negative"),
    ("medial box.obj -o out.vtp --theta nan", "finite"),
    ("medial box.obj -o out.vtp --theta 20,,60", "not a number"),
    ("medial box.obj -o out.vtp --theta 20,20", "twice"),
    ("medial box.obj -o out.vtp --theta 20,20.0000001", "two outputs"),
    ("medial box.obj -o out.vtp --theta 20 --theta 60", "--theta"),
    ("medial box.obj -o out.vtp --theta 20 60", "for several angles, use --theta 20,60"),
    ("medial box.obj -o out.vtp --spacing 0.00001", "--spacing 1e-05 is too small"),
    ("reconstruct axis.ma -o out.ply --spacing 0.00001", "--spacing 1e-05 is too small"),
    ("medial box.obj -o out.vtp --lambda=-1", "negative"),
    ("medial box.obj -o out.vtp --resolution 7", "8"),
    ("medial box.obj -o out.vtp --resolution 801", "800"),
    ("medial box.obj -o out.vtp --resolution 12.5", "--resolution"),
    ("medial box.obj -o out.vtp --max-resolution 7", "8"),
    ("medial box.obj -o out.vtp --spacing 0", "--spacing"),
    ("medial box.obj -o out.vtp --spacing 0.1 --resolution 16", "--resolution"),
    ("medial box.obj -o out.vtp --threads -1", "--threads"),
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
    ("verify box.obj box.npz --json box.obj", "is also the input"),
]


@pytest.mark.parametrize("command,word", USAGE, ids=[command for command, _ in USAGE])
def test_bad_usage_is_2_and_writes_nothing(solids, command, word):
    files = {path: path.read_bytes() for path in solids.iterdir()}
    done = subprocess.run([BLUM, *command.split()], capture_output=True, timeout=60, check=False, cwd=solids)
    assert done.returncode == 2 and done.stdout == b"", done
    assert done.stderr.startswith(b"blum: error: ") and word.encode() in done.stderr, done
    assert {path: path.read_bytes() for path in solids.iterdir()} == files


def test_large_errors_are_also_shares_of_the_size(tmp_path):
    """The size of the box, its diagonal, is 10 * sqrt(3). At theta 120 its balls do not reach the edges."""
    sides = ("--size-x", 10, "--size-y", 10, "--size-z", 10)
    run("make", "box", *sides, "-o", tmp_path / "box.ply")
    text, _ = run("medial", tmp_path / "box.ply", "--theta", 120, "--resolution", 24, "-o", tmp_path / "axis.vtp")
    report = run_json("verify", tmp_path / "box.ply", tmp_path / "axis.vtp")["certificate"]["balls"]
    worst = report["solid_to_balls"]
    share = re.search(r"at most ([0-9.]+) \(([0-9.]+) % of the size\), mean", text)
    assert share is not None, text
    assert float(share[1]) == pytest.approx(worst, rel=1e-4)
    assert float(share[2]) == pytest.approx(100 * worst / (10 * 3**0.5), abs=0.51)
    run("field", tmp_path / "box.ply", "--resolution", 64, "-o", tmp_path / "f.npz")
    assert re.search(r"diagonal, [0-9.]+ \([0-9.]+ % of the size\), in", run(
        "surface", tmp_path / "f.npz", "-o", tmp_path / "s.ply")[0])  # fmt: skip
    # Errors below a thousandth of the size have no share.
    done = run("clean", tmp_path / "box.ply", "--tolerance", 1e-3, "-o", tmp_path / "c.ply")[0]
    assert "of the size" not in done
