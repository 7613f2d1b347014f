# Proves that `blum verify` rejects falsified axes and axes of other solids, and repeats the selections in files.
# Also proves `blum reconstruct` and `blum info` on files of medial axes.
import json
import re

import numpy as np
import pytest

from tool import BLUM, FORMATS, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


FOOTPRINTS = ("footprint_0", "footprint_1")
SITES = ("site_0", "site_1")


def falsified(axes, tmp_path, name, change):
    """A copy of an axis with changed arrays."""
    arrays = dict(np.load(axes / name))
    change(arrays)
    np.savez(tmp_path / "false.npz", **arrays)
    return tmp_path / "false.npz"


def test_summary_of_verify_has_its_keys(solids, axes):
    summary = run_json("verify", solids / "box.obj", axes / "box.npz")
    assert set(summary) == {"blum_version", "command", "input", "axis", "certificate", "warnings"}
    assert summary["command"] == "verify" and summary["axis"]["file"] == str(axes / "box.npz")
    assert summary["axis"]["counts"]["vertices"] == len(np.load(axes / "box.npz")["vertices"])


def move_a_vertex(arrays):
    arrays["vertices"][100] += [0.01, 0.02, 0.03]


def move_a_vertex_outside(arrays):
    arrays["vertices"][0] = [0.7, 0, 0]


def scale_radii(arrays):
    arrays["radius"] *= 1.001


def move_a_footprint(arrays):
    arrays["footprint_1"][7] *= 0.99


def drop_a_triangle(arrays):
    """Drops a triangle whose corners all lie inside a sheet, so that a hole remains."""
    inner = np.all(arrays["role"][arrays["triangles"]] == 0, axis=1)
    arrays["triangles"] = np.delete(arrays["triangles"], np.flatnonzero(inner)[0], axis=0)
    for name in ("triangle_separation_angle", "triangle_sheet"):
        arrays[name] = arrays[name][:-1]


def add_a_vertex(arrays):
    count = len(arrays["vertices"])
    of_cells = ("edge", "triangle", "metadata")
    for name in [name for name in arrays if not name.startswith(of_cells)]:
        assert len(arrays[name]) == count
        arrays[name] = np.concatenate([arrays[name], arrays[name][:1]])


def change_metadata(arrays, **changes):
    """Changes values of the metadata and drops values that become None."""
    pairs = json.loads(str(arrays["metadata"])) | changes
    arrays["metadata"] = np.array(json.dumps({key: value for key, value in pairs.items() if value is not None}))


def claim_winding(arrays):
    change_metadata(arrays, solid_rule="winding", grid_size="1 1 1")


def claim_nonsense(arrays):
    change_metadata(arrays, solid_rule="nonsense")


def drop_radii(arrays):
    del arrays["radius"]


def drop_footprints(arrays):
    for name in FOOTPRINTS:
        del arrays[name]


def drop_sites(arrays):
    del arrays["site_1"]


def drop_angles(arrays):
    del arrays["separation_angle"]


def change_sites(arrays):
    for name in SITES:
        arrays[name][:] = 0


def change_angles(arrays):
    arrays["separation_angle"][:] = 7


@pytest.mark.parametrize("change,reason", [
    (claim_winding, "its solid is 'winding', but it is 'polyhedron'"),
    (claim_nonsense, "its solid is 'nonsense', but it is 'polyhedron'"),
    (drop_radii, "contains no radii"),
    (drop_footprints, "contains no footprints"),
    (drop_sites, "contains no sites"),
    (drop_angles, "contains no separation angles"),
    (change_sites, "off its site"),
    (change_angles, "a separation angle differs"),
    (move_a_vertex, "a radius differs from the exact distance"),
    (move_a_vertex_outside, "outside the solid"),
    (scale_radii, "a radius differs from the exact distance"),
    (move_a_footprint, "a footprint lies off the surface"),
    (drop_a_triangle, "the solid has 0 tunnels, the axis has 1"),
    (add_a_vertex, "the solid has 1 component, the axis has 2"),
], ids=lambda value: getattr(value, "__name__", ""))
def test_a_falsified_axis_is_rejected(solids, axes, tmp_path, change, reason):
    false = falsified(axes, tmp_path, "box.npz", change)
    out, err = run("verify", solids / "box.obj", false, "--json", "-", status=3)
    assert "NOT certified" in err and reason in err
    certificate = json.loads(out)["certificate"]
    assert certificate["certified"] is False and any(reason in text for text in certificate["mismatches"])
    text, err = run("verify", solids / "box.obj", false, status=3)
    assert re.search(r"^certified +NO( at theta [0-9.]+)?: ", text, re.MULTILINE) and (text + err).count(reason) == 1, "once is enough"
    assert not re.search(r"[1-9]\d{6}", err), "six digits say enough"


def test_an_unchanged_copy_of_an_axis_is_certified(solids, axes, tmp_path):
    run("verify", solids / "box.obj", falsified(axes, tmp_path, "box.npz", lambda arrays: None))


def test_the_axis_of_another_solid_is_rejected(solids, axes):
    assert "NOT certified" in run("verify", solids / "sphere.ply", axes / "torus.npz", status=3)[1]
    assert "1 tunnel" in run("verify", solids / "torus.obj", axes / "box.npz", status=3)[1]


def test_an_error_first_names_the_solid_of_the_file_if_another_is_given(solids, axes, tmp_path):
    said = "blum: error: NOT certified: the file of the axis states that the solid is 'box.obj'; "
    assert run("verify", solids / "torus.obj", axes / "box.npz", status=3)[1].startswith(said)
    false = falsified(axes, tmp_path, "box.npz", scale_radii)
    assert "states that the solid is" not in run("verify", solids / "box.obj", false, status=3)[1]


def test_a_mesh_without_inside_has_no_solid(axes, tmp_path):
    triangle = tmp_path / "triangle.obj"
    triangle.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert "so there is no solid" in run("verify", triangle, axes / "box.npz", status=1)[1]


def test_the_axis_of_another_label_is_rejected(solids, tmp_path):
    run("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", "--label", 1)
    run("verify", solids / "balls.npy", tmp_path / "b.npz", "--label", 1)
    _, err = run("verify", solids / "balls.npy", tmp_path / "b.npz", "--label", 2, status=3, warns=True)
    assert f"'{tmp_path / 'b.npz'}' was computed with --label 1; --label 2 is used, because it was given" in err


@pytest.mark.parametrize("selection", [("--label", 2), ("--threshold", 2.5)], ids=lambda s: s[0])
@pytest.mark.parametrize("end", ["vtp", "ply", "npz"])
def test_the_file_records_its_selection_of_voxels(solids, tmp_path, end, selection):
    axis = tmp_path / f"b.{end}"
    run("medial", solids / "balls.npy", "-o", axis, *selection)
    assert run_json("verify", solids / "balls.npy", axis)["certificate"]["certified"]
    distance = [run_json("reconstruct", axis, "-o", tmp_path / "r.ply", "--input", solids / "balls.npy", "--resolution",
                         20, *options)["distance"] for options in ((), selection)]
    assert distance[0] == distance[1]
    _, err = run("verify", solids / "balls.npy", axis, "--label", 1, status=3, warns=True)
    assert f"was computed with {selection[0]} {selection[1]}; --label 1 is used" in err


def test_a_file_without_a_selection_needs_the_option(solids, tmp_path):
    for end in ("obj", "ma"):
        run("medial", solids / "balls.npy", "-o", tmp_path / f"b.{end}", "--label", 2)
        assert "--threshold or --smooth, repeat it" in run("verify", solids / "balls.npy", tmp_path / f"b.{end}",
                                                            status=3)[1]
        run("verify", solids / "balls.npy", tmp_path / f"b.{end}", "--label", 2)
    assert "--threshold" not in run("verify", solids / "balls.npy", tmp_path / "b.ma", "--label", 1, status=3)[1]


def test_the_file_records_the_weld_tolerance(solids, tmp_path):
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
    assert "was computed with --weld 1e-06; --weld is used" in err


def frame(path, window):
    """A plate with a square window: a closed surface of genus 1."""
    corners = [(x, y, z) for half in (0.5, window / 2) for z in (0, 0.2)
               for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    quads = []
    for k in range(4):
        j = (k + 1) % 4
        quads += [(k, j, 4 + j, 4 + k), (8 + j, 8 + k, 12 + k, 12 + j), (4 + k, 4 + j, 12 + j, 12 + k),
                  (j, k, 8 + k, 8 + j)]
    faces = [f"f {a + 1} {b + 1} {c + 1}" for q in quads for a, b, c in (q[:3], (q[0], q[2], q[3]))]
    path.write_text("\n".join([*(f"v {x} {y} {z}" for x, y, z in corners), *faces]) + "\n")


def test_a_weld_tolerance_that_changes_the_solid_causes_a_warning(tmp_path):
    part = tmp_path / "part.obj"
    frame(part, 0.02)
    told = "welding within 0.03 removed 6 of 16 vertices: the surface now has 1 component and the Euler number"
    _, err = run("medial", part, "-o", tmp_path / "p.npz", "--resolution", 16, "--weld", 0.03, "--allow-uncertified",
                 warns=True)
    assert told in err and "instead of 1 component and the Euler number 0" in err
    _, err = run("verify", part, tmp_path / "p.npz", warns=True)
    assert f"as '{tmp_path / 'p.npz'}' records, {told}" in err
    summary = run_json("verify", part, tmp_path / "p.npz", "--weld", 0.03, warns=True)
    assert len(summary["warnings"]) == 1 and summary["input"]["weld"]["lost"] == 6
    assert summary["input"]["weld"]["before"]["euler_number"] == 0
    run("medial", part, "-o", tmp_path / "q.npz", "--resolution", 16, "--weld", 1e-6)
    assert run_json("verify", part, tmp_path / "q.npz")["warnings"] == []


def test_older_files_without_a_selection_are_read(solids, tmp_path):
    run("medial", solids / "balls.npy", "-o", tmp_path / "b.npz", "--label", 2)
    arrays = dict(np.load(tmp_path / "b.npz"))
    metadata = json.loads(str(arrays["metadata"]))
    assert metadata.pop("label") == "2"
    np.savez(tmp_path / "old.npz", **(arrays | {"metadata": np.array(json.dumps(metadata))}))
    run("verify", solids / "balls.npy", tmp_path / "old.npz", "--label", 2)
    run("verify", solids / "balls.npy", tmp_path / "old.npz", status=3)


def test_files_of_other_programs_are_checked_by_their_columns(solids, axes, tmp_path):
    def foreign(*names):
        def change(arrays):
            for name in ("metadata", *names):
                del arrays[name]
        return falsified(axes, tmp_path, "box.npz", change)

    out, _ = run("verify", solids / "box.obj", foreign("radius", *SITES, *FOOTPRINTS, "separation_angle"))
    assert "not in the file: radii, footprints, separation angles, sites" in out
    certificate = run_json("verify", solids / "box.obj", foreign(*SITES))["certificate"]
    parts = ["topology", "positions", "edges", "triangles", "radii", "footprints", "angles", "labels", "medial"]
    assert certificate["checked"] == parts
    assert "sites: not in the file" in certificate["not_checked"]


def test_the_claims_of_a_file_are_reported(solids, axes):
    out, _ = run("verify", solids / "box.obj", axes / "box.npz", "--verbose")
    assert "theta 60 degrees, lambda 0, voxels of 0.0625" in out
    certificate = run_json("verify", solids / "box.obj", axes / "box.npz")["certificate"]
    assert certificate["claims"] == {"theta": 60, "lambda": 0, "spacing": 0.0625, "deviation": None}
    assert "missing" in certificate["checked"] and certificate["voxel"] is None
    assert "claims" not in run("verify", solids / "box.obj", axes / "box.obj", "--verbose")[0]


def test_the_voxels_of_an_open_mesh_are_reported(solids, axes, tmp_path):
    out, _ = run("verify", solids / "open.obj", axes / "open.npz")
    assert "topology of the voxels inside by winding number, side 0.0625 (" in out
    false = falsified(axes, tmp_path, "open.npz", lambda arrays: change_metadata(arrays, spacing="0.03125"))
    assert "its spacing is 0.03125, but its grid has a spacing of 0.0625" in run("verify", solids / "open.obj", false,
                                                                            status=3)[1]


def test_missing_parts_are_not_checked_if_random_points_show_nothing(solids, axes, tmp_path):
    false = falsified(axes, tmp_path, "box.npz", lambda arrays: change_metadata(arrays, **{"lambda": "1.7"}))
    out, _ = run("verify", solids / "box.obj", false, "--verbose")
    assert "lambda 1.7" in out and "points of the solid show no medial ball with an angle above 90 degrees" in out
    assert "missing parts not checked" in out
    certificate = run_json("verify", solids / "box.obj", false)["certificate"]
    assert "missing" not in certificate["checked"]
    reason = "random points of the solid show no medial ball with an angle above 90 degrees"
    assert f"missing parts: {reason}" in certificate["not_checked"]


def test_nested_axes_are_reported_as_not_checked(solids, tmp_path):
    run("medial", solids / "box.obj", "-o", tmp_path / "nested.npz", "--resolution", 16, "--nested")
    out, _ = run("verify", solids / "box.obj", tmp_path / "nested.npz")
    assert "nested columns: the axes of other angles" in out
    certificate = run_json("verify", solids / "box.obj", tmp_path / "nested.npz")["certificate"]
    assert "nested columns: the axes of other angles" in certificate["not_checked"]


def test_positions_of_obj_files_are_verified(solids, axes, tmp_path):
    (tmp_path / "out.obj").write_text("v 0.7 0 0\np 1\n")
    assert "outside the solid" in run("verify", solids / "box.obj", tmp_path / "out.obj", status=3)[1]
    (tmp_path / "chords.obj").write_text("v 1 0 0\nv -0.5 0.866 0\nv -0.5 -0.866 0\nl 1 2\nl 2 3\nl 3 1\n")
    assert "3 leave the solid between" in run("verify", solids / "torus.obj", tmp_path / "chords.obj", status=3)[1]


def test_bodies_are_compared_one_by_one(solids, tmp_path):
    run("make", "bodies", "-o", tmp_path / "two.ply", "--count", 2)
    centres = run_json("info", tmp_path / "two.ply")
    assert centres["betti"] == [2, 0, 0]
    run("medial", tmp_path / "two.ply", "-o", tmp_path / "two.npz", "--resolution", 24)
    vertices = np.load(tmp_path / "two.npz")["vertices"]
    first = vertices[np.argsort(vertices[:, 0])[:2]]
    (tmp_path / "one.obj").write_text("".join("v {} {} {}\n".format(*v) for v in first) + "p 1\np 2\n")
    _, err = run("verify", tmp_path / "two.ply", tmp_path / "one.obj", status=3)
    assert "body 1 of 2" in err and "body 2 of 2" in err


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
def test_counts_that_a_file_lacks_are_not_reported(solids, axes, end):
    out, _ = run("verify", solids / "box.obj", axes / f"box.{end}")
    assert "0 line segments on curves (no sheets in the file)" in out and "rims" not in out and "1 sheet" not in out
    counts = run_json("verify", solids / "box.obj", axes / f"box.{end}")["axis"]["counts"]
    assert counts["sheets"] is counts["rim_edges"] is counts["seam_edges"] is counts["junctions"] is None
    assert counts["triangles"] == len(np.load(axes / "box.npz")["triangles"]) and counts["curve_edges"] == 0


def test_radii_of_files_without_footprints_are_verified(solids, axes, tmp_path):
    text = (axes / "box.ma").read_text()
    (tmp_path / "false.ma").write_text(re.sub(r"^(v .* )(\S+)$", lambda m: m[1] + str(1.01 * float(m[2])), text,
                                              count=1, flags=re.M))
    assert "a radius differs" in run("verify", solids / "box.obj", tmp_path / "false.ma", status=3)[1]


def test_fields_and_axes_are_not_confused(solids, axes, tmp_path):
    assert "it holds a distance field" in run("verify", solids / "sphere.ply", solids / "sphere.npz", status=1)[1]
    assert "blum surface" in run("reconstruct", solids / "sphere.npz", "-o", tmp_path / "x.ply", status=2)[1]
    assert "is a medial axis; a mesh" in run("slice", axes / "box.npz", "-o", tmp_path / "x.png", status=1)[1]
    assert "is a medial axis; a mesh" in run("field", axes / "box.vtp", "-o", tmp_path / "x.npz", status=1)[1]
    np.savez(tmp_path / "else.npz", vertices=np.zeros((2, 3)), metadata=np.array('{"content": "a sonnet"}'))
    assert "state the content 'a sonnet', not a medial axis" in run("info", tmp_path / "else.npz", status=1)[1]


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


def test_an_axis_of_voxels_needs_a_file_that_records_them(solids, tmp_path):
    for end in ("obj", "ma"):
        run("medial", solids / "open.obj", "-o", tmp_path / f"o.{end}", "--resolution", 12, warns=True)
        _, err = run("verify", solids / "open.obj", tmp_path / f"o.{end}", status=1)
        assert "not closed and manifold" in err and ".obj and .ma store neither rule nor grid" in err
        assert "Verify the .vtp, .ply or .npz file of the same axis" in err


def test_an_open_mesh_that_faces_inwards_is_reported(solids, tmp_path):
    lines = (solids / "inverted.obj").read_text().splitlines()
    (tmp_path / "in.obj").write_text("\n".join(lines[:-1]) + "\n")
    _, err = run("medial", tmp_path / "in.obj", "-o", tmp_path / "o.vtp", "--resolution", 12, status=1)
    assert "no interior" in err and "its triangles face inwards: flip them" in err


def several_boxes(solids, path, places):
    """Writes the box of `solids` at several places; a place is a factor and an offset in sides of the box."""
    lines = (solids / "box.obj").read_text().splitlines()
    corners = np.array([[float(x) for x in line.split()[1:]] for line in lines if line.startswith("v ")])
    faces = np.array([[int(v) for v in line.split()[1:]] for line in lines if line.startswith("f ")])
    side = np.ptp(corners, axis=0)
    text = [f"v {x} {y} {z}" for factor, offset in places for x, y, z in (corners * factor + side * offset).tolist()]
    text += [f"f {a} {b} {c}" for n in range(len(places)) for a, b, c in (faces + n * len(corners)).tolist()]
    path.write_text("\n".join(text) + "\n")


def test_a_mesh_that_crosses_itself_is_resolved(solids, tmp_path):
    two = tmp_path / "two.obj"
    several_boxes(solids, two, [(1, (0, 0, 0)), (1, (0.3, 0.3, 0.3))])
    repaired = run_json("info", two)["repaired"]
    assert (repaired["rule"], repaired["betti"]) == ("polyhedron", [1, 0, 0])
    assert repaired["resolved"]["crossing"] > 0 and repaired["resolved"]["new_vertices"] > 0
    assert "repaired  1 component, 0 tunnels" in run("info", two)[0]
    run("medial", two, "-o", tmp_path / "t.npz", "--resolution", 16)
    certificate = run_json("verify", two, tmp_path / "t.npz")["certificate"]
    assert certificate["against"] == "polyhedron" and certificate["solid_betti"] == [1, 0, 0]
    false = falsified(tmp_path, tmp_path, "t.npz", claim_winding)
    assert "it is 'polyhedron'" in run("verify", two, false, status=3)[1]


def test_an_unresolved_self_crossing_mesh_is_not_a_polyhedron(solids, tmp_path):
    two = tmp_path / "two.obj"
    several_boxes(solids, two, [(1, (0, 0, 0)), (1, (0.3, 0.3, 0.3))])
    lines = two.read_text().splitlines()
    lines[0] = " ".join(["v", "1e-200", *lines[0].split()[2:]])
    two.write_text("\n".join(lines) + "\n")
    assert "orders of magnitude" in run_json("info", two)["repaired"]["reason"]
    (tmp_path / "axis.obj").write_text("v 0 0 0\nv 0.3 0.3 0.3\np 1\np 2\n")
    (tmp_path / "axis.ma").write_text("2 0 0\nv 0 0 0 0.5\nv 0.3 0.3 0.3 0.5\n")
    for end in ("obj", "ma"):
        _, err = run("verify", two, tmp_path / f"axis.{end}", status=1)
        assert "crosses itself" in err and "Verify the .vtp, .ply or .npz" in err
    run("medial", two, "-o", tmp_path / "t.npz", "--resolution", 16, warns=True)
    run("verify", two, tmp_path / "t.npz")
    false = falsified(tmp_path, tmp_path, "t.npz", lambda arrays: change_metadata(arrays, solid_rule="polyhedron"))
    assert "it is 'winding'" in run("verify", two, false, status=3)[1]
    for grid, reason in [({"grid_size": "8 8 8"}, "does not cover the mesh"),
                         ({"grid_size": "9000 9000 9000"}, "of memory")]:
        false = falsified(tmp_path, tmp_path, "t.npz", lambda arrays, grid=grid: change_metadata(arrays, **grid))
        assert reason in run("verify", two, false, status=1)[1]


def test_files_without_an_axis_are_rejected(solids, axes, tmp_path):
    (tmp_path / "cut.npz").write_bytes((axes / "box.npz").read_bytes()[:5000])
    (tmp_path / "empty.vtp").write_bytes(b"")
    for name in ("cut.npz", "empty.vtp", "none.ply"):
        assert name in run("verify", solids / "box.obj", tmp_path / name, status=1)[1]
    arrays = dict(np.load(axes / "box.npz"))
    arrays["radius"][3] = np.nan
    np.savez(tmp_path / "nan.npz", **arrays)
    assert "vertex 3" in run("verify", solids / "box.obj", tmp_path / "nan.npz", status=1)[1]


def test_balls_of_an_axis_become_a_field_and_a_mesh_near_the_solid(solids, axes, tmp_path):
    summary = run_json("reconstruct", axes / "box.vtp", "-o", tmp_path / "box.ply", "--input", solids / "box.obj",
                       "--resolution", 40)  # a finer grid resolves gaps between the balls
    assert summary["surface"]["triangles"] > 1000
    distance = summary["distance"]
    assert 0 < distance["mean_solid_to_balls"] < distance["solid_to_balls"] < 0.1, "voxels are 1/16 long"
    assert abs(distance["balls_beyond_solid"]) < 1e-9
    assert run_json("info", tmp_path / "box.ply")["betti"] == [1, 0, 0]
    run("reconstruct", axes / "box.ma", "-o", tmp_path / "box.npz", "--resolution", 40)
    field = np.load(tmp_path / "box.npz")["distance"]
    assert max(field.shape) == 40
    assert field.min() < -0.4 and field[0, 0, 0] > 0, "negative in the balls, of which the largest has radius 1/2"


def test_reconstruct_rejects_files_without_radii(solids, axes, tmp_path):
    assert "AXIS" in run("reconstruct", axes / "box.obj", "-o", tmp_path / "x.ply", status=2)[1]
    assert "--output" in run("reconstruct", axes / "box.vtp", "-o", tmp_path / "x.png", status=2)[1]
    assert names(tmp_path) == []


def test_reconstruct_writes_nothing_if_its_input_is_useless(solids, axes, tmp_path):
    (tmp_path / "x.ply").write_bytes(b"old")
    (tmp_path / "text.obj").write_text("hello\n")
    for name in ("text.obj", "none.obj"):
        assert name in run("reconstruct", axes / "box.vtp", "-o", tmp_path / "x.ply", "--input", tmp_path / name,
                           "--resolution", 20, status=1)[1]
    run("reconstruct", axes / "box.ma", "-o", tmp_path / "x.ply", "--input", solids / "open.obj", "--resolution", 20,
        status=1)
    assert (tmp_path / "x.ply").read_bytes() == b"old" and names(tmp_path) == ["text.obj", "x.ply"]
