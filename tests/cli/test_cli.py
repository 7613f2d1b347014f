# Proves the tool's basic verbs end to end on generated shapes: output, exit status, messages and JSON keys.
# Bad usage and hostile input leave existing output untouched.
import json
import math
import os
import shutil
import struct
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from tool import BLUM, names, png_rows, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


def read_nrrd(path):
    """Header fields, key/value pairs and array [z, y, x] of a raw NRRD file, read without Blum on purpose."""
    data = Path(path).read_bytes()
    header, body = data.split(b"\n\n", 1)
    fields = {}
    for line in header.decode().splitlines()[1:]:
        if not line.startswith("#"):
            key, value = line.split(":=" if ":=" in line else ": ", 1)
            fields[key] = value
    types = {"float": "f4", "int": "i4", "int32": "i4", "uint8": "u1", "unsigned char": "u1", "uint16": "u2",
             "unsigned short": "u2"}
    array = np.frombuffer(body, dtype="<" + types[fields["type"]])
    sizes = [int(n) for n in fields["sizes"].split()]
    assert fields["encoding"] == "raw"
    return fields, array.reshape(sizes[::-1])


# ---- Verbs ----


def test_version_and_help():
    out, _ = run("--version")
    assert out.startswith("blum ") and out.count(".") == 2
    for arguments in [["--help"], [], ["field", "--help"], ["slice", "-h"], ["make", "--help"], ["info", "--help"]]:
        out, _ = run(*arguments)
        assert "Examples:" in out and "blum " in out


def test_make_reports_the_written_mesh(tmp_path):
    facts = run_json("make", "torus", "-o", tmp_path / "t.off", "--ring-segments", 12, "--tube-segments", 8)
    assert (facts["shape"], facts["kind"], facts["vertices"], facts["triangles"]) == ("torus", "mesh", 96, 192)
    assert facts["betti"] == [1, 1, 0] and facts["parameters"]["ring_segments"] == 12
    counts = (tmp_path / "t.off").read_text().split()[1:3]
    assert counts == ["96", "192"]


def test_make_list_names_every_shape_and_makes_each(tmp_path):
    shapes = run_json("make", "--list")["shapes"]
    names = [shape["name"] for shape in shapes]
    assert names == sorted(names) and {"box", "sphere", "torus", "torus_knot", "ball_image"} <= set(names)
    text, _ = run("make", "--list")
    for shape in shapes:
        assert f"{shape['name']} ({shape['kind']}): " in text
        for parameter in shape["parameters"]:
            assert parameter["minimum"] <= parameter["default"] <= parameter["maximum"]
        output = tmp_path / (shape["name"] + (".obj" if shape["kind"] == "mesh" else ".nrrd"))
        run("make", shape["name"].replace("_", "-"), "-o", output, "--quiet")
        assert output.stat().st_size > 100
    alone, _ = run("make", "torus", "--list")
    assert "--tube-radius" in alone and "sphere" not in alone


def test_make_noise_moves_vertices_by_at_most_its_amount(tmp_path):
    run("make", "sphere", "-o", tmp_path / "a.obj", "--frequency", 3)
    run("make", "sphere", "-o", tmp_path / "b.obj", "--frequency", 3, "--noise", 0.05)

    def vertices(name):
        lines = (tmp_path / name).read_text().splitlines()
        return np.array([[float(n) for n in line.split()[1:]] for line in lines if line.startswith("v ")])

    moved = np.linalg.norm(vertices("a.obj") - vertices("b.obj"), axis=1)
    assert 0.02 < moved.max() <= 0.05 + 1e-12


def test_info_of_a_mesh(shapes):
    facts = run_json("info", shapes / "torus.obj")
    assert (facts["kind"], facts["format"], facts["closed"], facts["genus"]) == ("mesh", "OBJ", True, 1)
    assert facts["betti"] == [1, 1, 0] and facts["boundary_edges"] == 0 and facts["euler_characteristic"] == 0
    text, _ = run("info", shapes / "torus.obj")
    assert "1 tunnel, 0 voids" in text


def test_info_reports_no_solid_for_parts_that_cross(tmp_path):
    run("make", "box", "-o", tmp_path / "box.obj")
    lines = (tmp_path / "box.obj").read_text().splitlines()
    corners = [line.split()[1:] for line in lines if line.startswith("v ")]
    faces = [line.split()[1:] for line in lines if line.startswith("f ")]
    n, step = len(corners), 0.3
    moved = [" ".join(["v"] + [str(float(c) + step) for c in corner]) for corner in corners]
    shifted = ["f " + " ".join(str(int(v.split("/")[0]) + n) for v in face) for face in faces]
    (tmp_path / "two.obj").write_text("\n".join(lines + moved + shifted) + "\n")
    facts = run_json("info", tmp_path / "two.obj")
    assert facts["self_intersections"]["crossing"] > 0 and facts["betti"] is None
    assert "solid     no: triangles cross each other" in run("info", tmp_path / "two.obj")[0]
    assert run_json("info", tmp_path / "box.obj")["betti"] == [1, 0, 0]


def test_info_counts_self_intersections(shapes, tmp_path):
    assert run_json("info", shapes / "torus.obj")["self_intersections"] == {
        "crossing": 0, "touching": 0, "complete": True, "pairs": []}
    assert "defects  none" in run("info", shapes / "torus.obj")[0]
    assert "crossings       none" in run("info", shapes / "torus.obj", "--verbose")[0]
    mesh = tmp_path / "cross.obj"
    # The second triangle crosses the first. A corner of the third touches the first.
    mesh.write_text("v 0 0 0\nv 3 0 0\nv 0 3 0\nv 1 1 -1\nv 1 1 1\nv 5 5 1\nv 1 0.5 0\nv 1 0.25 3\nv 2 0.25 3\n"
                    "f 1 2 3\nf 4 5 6\nf 7 8 9\n")
    assert run_json("info", mesh)["self_intersections"] == {
        "crossing": 1, "touching": 1, "complete": True,
        "pairs": [{"triangles": [0, 1], "crosses": True}, {"triangles": [0, 2], "crosses": False}]}
    assert "1 pair of triangles crosses, 1 touches or overlaps" in run("info", mesh)[0]


def test_info_of_an_open_mesh_and_weld(tmp_path):
    corners = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 1 0 1e-7", "v 1 1 0", "v 0 1 0", "f 1 2 3", "f 4 5 6"]
    mesh = tmp_path / "two.obj"
    mesh.write_text("\n".join(corners) + "\n")
    assert run_json("info", mesh)["components"] == 2
    assert run_json("info", mesh, "--weld")["vertices"] == 5
    assert run_json("info", "--weld", mesh)["merged_vertices"] == 1
    welded = run_json("info", mesh, "--weld", "1e-6")
    assert (welded["components"], welded["boundary_edges"], welded["betti"]) == (1, 4, None)


def test_info_of_images_and_fields(shapes):
    ball = run_json("info", shapes / "ball.nrrd")
    assert (ball["kind"], ball["type"], ball["range"]) == ("image", "uint8", [0, 1])
    assert sum(label["voxels"] for label in ball["labels"]) == 24**3
    balls = run_json("info", shapes / "balls.npy")
    assert balls["distinct"] == 4 and {label["label"] for label in balls["labels"]} == {0, 1, 2, 3}
    field = run_json("info", shapes / "sphere.nrrd")
    assert field["kind"] == "field" and field["sign"]["rule"] == "normals" and field["distance"]["minimum"] < 0
    band = run_json("info", shapes / "sphere.npz")
    assert band["band"] > 0 and band["sites"]["nodes_without"] > 0


def test_field_of_a_sphere_is_its_distance(shapes):
    fields, distance = read_nrrd(shapes / "sphere.nrrd")
    assert distance.shape == (24, 24, 24)
    h = 2 * 1.2 / 23
    axis = -1.2 + h * np.arange(24)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij")
    # The polyhedron of 720 triangles lies within 0.02 of the sphere.
    assert np.abs(distance - (np.sqrt(x * x + y * y + z * z) - 1)).max() < 0.02
    _, site = read_nrrd(shapes / "sphere.site.nrrd")
    assert site.shape == distance.shape and site.min() >= 0
    assert fields["blum_version"]


def test_field_summary_has_its_keys(shapes, tmp_path):
    summary = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "s.npz", "--resolution", 16)
    assert {"blum_version", "command", "input", "grid", "sign_asked", "fields", "seconds", "field_seconds",
            "total_seconds", "nodes_per_second", "peak_memory_bytes", "threads", "outputs"} <= set(summary)
    assert summary["grid"]["size"] == [16, 16, 16] and summary["grid"]["nodes"] == 4096
    assert {"read", "field", "sign", "write"} <= set(summary["seconds"])
    facts = summary["input"]
    assert (facts["format"], facts["triangles"], facts["components"], facts["closed"]) == ("PLY", 720, 1, True)
    (field,) = summary["fields"]
    assert field["sign"]["rule"] == "normals" and field["sign"]["reason"] and field["band"] is None
    data = np.load(tmp_path / "s.npz")
    assert field["distance"]["minimum"] == pytest.approx(float(data["distance"].min()))
    assert field["distance"]["maximum"] == pytest.approx(float(data["distance"].max()))
    assert field["distance"]["inside_nodes"] == int((data["distance"] < 0).sum())
    sites, site = field["sites"], data["site"]
    assert sites["distinct"] == len(np.unique(site))
    borders = [0, facts["vertices"], facts["vertices"] + facts["edges"], len(data["site_vertices"])]
    for kind, low, high in zip(["vertices", "edges", "faces"], borders, borders[1:]):
        of_kind = site[(site >= low) & (site < high)]
        assert sites[kind] == {"nodes": of_kind.size, "sites": len(np.unique(of_kind))}
    assert summary["peak_memory_bytes"] > 1e6 and summary["nodes_per_second"] > 0


def test_json_goes_to_a_file_beside_the_text(shapes, tmp_path):
    out, _ = run("field", shapes / "sphere.ply", "-o", tmp_path / "s.vti", "--resolution", 8, "--json",
                 tmp_path / "s.json")
    assert "normals" in out and json.loads((tmp_path / "s.json").read_text())["outputs"] == [str(tmp_path / "s.vti")]


def test_quiet_is_silent(shapes, tmp_path):
    for arguments in [["field", shapes / "sphere.ply", "-o", tmp_path / "q.nrrd", "--resolution", 8],
                      ["slice", shapes / "sphere.nrrd", "-o", tmp_path / "q.png"],
                      ["make", "box", "-o", tmp_path / "q.stl"], ["info", shapes / "sphere.ply"]]:
        assert run(*arguments, "--quiet") == ("", "")
        if arguments[0] != "slice":  # slice has no --verbose
            assert run(*arguments, "--quiet", "--verbose") == ("", "")


def test_band_in_units_and_in_voxels(shapes, tmp_path):
    voxels = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "v.npz", "--resolution", 24, "--band", "3v")
    h = voxels["grid"]["spacing"][0]
    assert voxels["fields"][0]["band"] == pytest.approx(3 * h)
    units = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "u.npz", "--resolution", 24, "--band", 3 * h)
    assert units["fields"][0]["sites"] == voxels["fields"][0]["sites"]
    full = read_nrrd(shapes / "sphere.nrrd")[1]
    distance, site = np.load(tmp_path / "v.npz")["distance"], np.load(tmp_path / "v.npz")["site"]
    beyond = np.abs(full) > 3 * h * (1 + 1e-6)
    assert np.all(site[beyond] == -1) and np.allclose(np.abs(distance[beyond]), 3 * h)
    within = np.abs(full) < 3 * h * (1 - 1e-6)
    assert np.all(site[within] >= 0) and np.allclose(distance[within], full[within], atol=1e-6)


def test_a_slice_by_position_is_that_of_the_nearest_layer(shapes, tmp_path):
    grid = run_json("info", shapes / "sphere.nrrd")["grid"]
    place = grid["origin"][0] + 7.4 * grid["spacing"][0]
    run("slice", shapes / "sphere.nrrd", "-o", tmp_path / "a.png", "--axis", "x", "--position", place)
    run("slice", shapes / "sphere.nrrd", "-o", tmp_path / "b.png", "--axis", "x", "--index", "7")
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()


def test_welding_all_triangles_away_causes_a_warning(shapes, tmp_path):
    err = run("field", shapes / "sphere.ply", "-o", tmp_path / "w.nrrd", "--resolution", 8, "--sign", "none",
              "--bounds", "-1,-1,-1,1,1,1", "--weld", "1e9", warns=True)[1]
    assert "welding removed all triangles" in err


def test_fields_without_sites(shapes, tmp_path):
    given = (shapes / "sphere.ply", "--resolution", 24, "--band", "3v")
    run_json("field", *given, "-o", tmp_path / "with.npz")
    with np.load(tmp_path / "with.npz") as file:
        expected = file["distance"]
    for name in ("a.npz", "a.nrrd", "a.vti"):
        summary = run_json("field", *given, "--no-sites", "-o", tmp_path / name)
        assert summary["outputs"] == summary["fields"][0]["files"] == [str(tmp_path / name)]
        assert summary["fields"][0]["sites"] is None
        assert run_json("info", tmp_path / name)["sites"] is None
    with np.load(tmp_path / "a.npz") as file:
        assert np.array_equal(file["distance"], expected)
        assert not {"site", "site_vertices"} & set(file)
    assert not (tmp_path / "a.site.nrrd").exists()
    run("field", *given, "-o", tmp_path / "a.nrrd")
    assert (tmp_path / "a.site.nrrd").exists()
    assert f"removed   {tmp_path / 'a.site.nrrd'}" in run("field", *given, "--no-sites", "-o", tmp_path / "a.nrrd")[0]
    assert not (tmp_path / "a.site.nrrd").exists()
    _, err = run("slice", tmp_path / "a.nrrd", "-o", tmp_path / "a.png", "--show", "sites", status=1)
    assert "written without them" in err


def test_flat_bounds_give_a_2d_field_and_picture(shapes, tmp_path):
    summary = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "cut.nrrd", "--bounds",
                       "-1.5,0.25,-2,1.5,0.25,2", "--spacing", "0.1")
    assert summary["grid"]["size"] == [31, 1, 41] and summary["grid"]["origin"][1] == pytest.approx(0.25)
    run("slice", tmp_path / "cut.nrrd", "-o", tmp_path / "cut.png")  # slice chooses the axis
    width, height, _ = png_rows(tmp_path / "cut.png")
    assert height > width > 600


def test_spacing_and_padding(shapes, tmp_path):
    grid = run_json("field", shapes / "sphere.ply", "-o", tmp_path / "p.nrrd", "--spacing", "0.25", "--padding", "0.5")
    box = run_json("info", shapes / "sphere.ply")["bounds"]
    longest = max(high - low for low, high in zip(box["lower"], box["upper"]))
    assert grid["grid"]["spacing"] == [0.25] * 3
    assert 0 <= max(grid["grid"]["size"]) - 1 - 2 * longest / 0.25 < 2


@pytest.mark.parametrize("end", ["nrrd", "npz", "vti"])
def test_threads_do_not_change_a_byte(shapes, tmp_path, end):
    for threads in (1, 2):
        (tmp_path / str(threads)).mkdir()
        run("field", shapes / "torus.obj", "-o", tmp_path / str(threads) / f"t.{end}", "--resolution", 40, "--threads",
            threads)
    names = sorted(path.name for path in (tmp_path / "1").iterdir())
    assert names == (["t.nrrd", "t.site.nrrd"] if end == "nrrd" else [f"t.{end}"])
    for name in names:
        assert (tmp_path / "1" / name).read_bytes() == (tmp_path / "2" / name).read_bytes()


def test_site_ids_and_sign(shapes, tmp_path):
    triangles = run_json("field", shapes / "torus.obj", "-o", tmp_path / "t.npz", "--resolution", 12, "--site-ids",
                         "triangles", "--sign", "none")
    field = triangles["fields"][0]
    assert field["sign"]["rule"] == "none" and field["sites"]["count"] == "triangles"
    data = np.load(tmp_path / "t.npz")
    assert data["distance"].min() >= 0 and data["site"].max() < triangles["input"]["triangles"]
    for rule in ("normals", "winding"):
        run("field", shapes / "torus.obj", "-o", tmp_path / f"{rule}.npz", "--resolution", 12, "--sign", rule)
    by_normals, by_winding = (np.load(tmp_path / f"{rule}.npz")["distance"] for rule in ("normals", "winding"))
    assert np.array_equal(np.signbit(by_normals), np.signbit(by_winding)) and by_normals.min() < 0


def test_an_open_mesh_is_signed_by_winding_numbers(shapes, tmp_path):
    (tmp_path / "open.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    summary = run_json("field", tmp_path / "open.obj", "-o", tmp_path / "open.nrrd", "--resolution", 8, warns=True)
    assert summary["fields"][0]["sign"]["rule"] == "winding" and not summary["input"]["closed"]


def test_fields_of_images(shapes, tmp_path):
    summary = run_json("field", shapes / "ball.nrrd", "-o", tmp_path / "ball.npz")
    assert summary["input"]["kind"] == "image" and summary["fields"][0]["sign"]["rule"] == "label"
    signed = np.load(tmp_path / "ball.npz")["distance"]
    _, image = read_nrrd(shapes / "ball.nrrd")
    assert np.array_equal(signed < 0, image > 0) and signed[12, 12, 12] == signed.min()
    run("field", shapes / "ball.nrrd", "-o", tmp_path / "u.npz", "--sign", "none", "--threshold", 1)
    unsigned = np.load(tmp_path / "u.npz")["distance"]
    assert np.array_equal(unsigned, np.where(image > 0, 0, signed))


def test_several_labels_give_a_file_each(shapes, tmp_path):
    summary = run_json("field", shapes / "balls.npy", "-o", tmp_path / "b.nrrd", "--label", "1,3", "--label", "2")
    assert [field["label"] for field in summary["fields"]] == [1, 3, 2]
    image = np.load(shapes / "balls.npy")
    for label in (1, 2, 3):
        assert np.array_equal(read_nrrd(tmp_path / f"b-label{label}.nrrd")[1] < 0, image == label)
        assert (tmp_path / f"b-label{label}.site.nrrd").exists()
    assert not (tmp_path / "b.nrrd").exists()
    run("field", shapes / "balls.npy", "-o", tmp_path / "one.nrrd", "--label", "2")
    assert np.array_equal(read_nrrd(tmp_path / "one.nrrd")[1], read_nrrd(tmp_path / "b-label2.nrrd")[1])


def test_content_decides_the_format_of_unknown_extensions(shapes, tmp_path):
    for name in ("sphere.ply", "torus.obj", "ball.nrrd", "balls.npy"):
        (tmp_path / "shape.dat").write_bytes((shapes / name).read_bytes())
        assert run_json("info", tmp_path / "shape.dat")["format"] == Path(name).suffix[1:].upper()


# ---- Failures ----

USAGE = [
    ["frobnicate"],
    ["field"],
    ["field", "sphere.ply"],
    ["field", "sphere.ply", "-o", "out.txt"],
    ["field", "sphere.ply", "-o", ""],
    ["field", "sphere.ply", "-o", "out.nrrd", "--frobnicate"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "-5"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "12.5"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "99999999999999999999"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "64", "--spacing", "0.1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--resolution", "64", "--resolution", "32"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--spacing", "0"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--spacing", "0.00001"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--spacing", "nan"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--spacing", "1e999"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--spacing", "0,5"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--padding", "-0.1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--padding", "inf"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--bounds", "0,0,0,1,1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--bounds", "0,0,0,1,1,x"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--bounds", "1,0,0,0,1,1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--bounds", "1,1,1,1,1,1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--bounds", "0,0,0,1,1,1", "--padding", "0.1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--sign", "maybe"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--band", "0"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--no-sites", "--site-ids", "features"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--band", "v"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--band", "-3v"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--site-ids", "corners"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--threads", "-1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--threads", "many"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--weld", "-1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--label", "1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--threshold", "1"],
    ["field", "sphere.ply", "-o", "out.nrrd", "--json", "out.nrrd"],
    ["field", "ball.nrrd", "-o", "ball.nrrd"],
    ["field", "ball.nrrd", "-o", "./ball.nrrd"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--resolution", "64"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--weld"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--sign", "winding"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--site-ids", "features"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--label", "1,1"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--label", "1.5"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--label", "1", "--threshold", "1"],
    ["field", "ball.nrrd", "-o", "out.nrrd", "--threshold", "nan"],
    ["slice", "sphere.nrrd"],
    ["slice", "sphere.nrrd", "-o", "out.jpg"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--axis", "w"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--index", "24"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--index", "-1"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--position", "9"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--position", "nan"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--position", "0", "--index", "3"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--show", "nothing"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--scale", "0"],
    ["slice", "sphere.nrrd", "-o", "out.png", "--scale", "1e9"],
    ["make"],
    ["make", "sphere"],
    ["make", "sphere", "-o", "out.nrrd"],
    ["make", "ball", "-o", "out.ply"],
    ["make", "dodecahedron", "-o", "out.ply"],
    ["make", "sphere", "-o", "out.ply", "--frequency", "0"],
    ["make", "sphere", "-o", "out.ply", "--frequency", "2.5"],
    ["make", "sphere", "-o", "out.ply", "--frequency", "x"],
    ["make", "sphere", "-o", "out.ply", "--frequency"],
    ["make", "sphere", "-o", "out.ply", "--radius", "1", "--radius", "2"],
    ["make", "sphere", "-o", "out.ply", "--bumps", "3"],
    ["make", "torus", "-o", "out.ply", "--tube-radius", "5"],
    ["make", "sphere", "--list", "-o", "out.ply"],
    ["info"],
    ["info", "ball.nrrd", "--weld"],
    ["info", "sphere.ply", "--json", "sphere.ply"],
]


@pytest.mark.parametrize("arguments", USAGE, ids=" ".join)
def test_bad_usage_is_2_and_writes_nothing(shapes, arguments):
    files = {path: path.read_bytes() for path in shapes.iterdir()}
    done = subprocess.run([BLUM, *arguments], capture_output=True, timeout=60, check=False, cwd=shapes)
    assert done.returncode == 2, done
    assert done.stdout == b"" and done.stderr.startswith(b"blum: error: "), done
    assert {path: path.read_bytes() for path in shapes.iterdir()} == files


def test_a_one_letter_option_gets_a_hint_for_its_first_letter(shapes):
    assert "no option -q (did you mean --quiet?)" in run("info", shapes / "sphere.ply", "-q", status=2)[1]
    assert "no option -x;" in run("info", shapes / "sphere.ply", "-x", status=2)[1]


def hostile_inputs():
    yield "empty.ply", b""
    yield "text.obj", b"hello\n"
    yield "bomb.ply", (b"ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                       b"property float y\nproperty float z\nend_header\n")
    yield "nan.obj", b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    yield "index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"
    yield "short.stl", b"\0" * 80 + struct.pack("<I", 1000000) + b"\0" * 50
    yield "cut.off", b"OFF\n8 6 0\n0 0 0\n"
    yield "bomb.nrrd", b"NRRD0004\ntype: float\ndimension: 3\nsizes: 100000 100000 100000\nencoding: raw\n\n\0\0"
    yield "bad.npy", b"\x93NUMPY\x01\x00\xff\xff{"
    yield "bad.nii.gz", b"\x1f\x8b\x08\0\0\0\0\0\0\0\0\0"
    yield "zeros.npy", b"\x93NUMPY\x01\x00\x46\x00" + (
        b"{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 2), }".ljust(69) + b"\n") + b"\0" * 8
    yield "point.obj", b"v 1 2 3\np 1\n"
    yield "what.bin", bytes(range(256))
    yield "field.npz", b"PK\x05\x06" + b"\0" * 18


@pytest.mark.parametrize("name,content", list(hostile_inputs()), ids=lambda value: value if isinstance(value, str) else "")
def test_hostile_input_is_1_and_leaves_old_output(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    (tmp_path / "out.nrrd").write_bytes(b"old")
    _, err = run("field", tmp_path / name, "-o", tmp_path / "out.nrrd", status=1)
    assert len(err) > 40
    assert (tmp_path / "out.nrrd").read_bytes() == b"old" and len(list(tmp_path.iterdir())) == 2


def test_missing_and_unreadable_files_are_1(shapes, tmp_path):
    run("info", tmp_path / "none.ply", status=1)
    run("info", tmp_path, status=1)
    run("field", tmp_path / "none.ply", "-o", tmp_path / "out.nrrd", status=1)
    run("field", shapes / "sphere.ply", "-o", tmp_path / "none" / "out.nrrd", status=1)
    (tmp_path / "folder.nrrd").mkdir()
    run("field", shapes / "sphere.ply", "-o", tmp_path / "folder.nrrd", "--resolution", 8, status=1)
    run("slice", shapes / "sphere.ply", "-o", tmp_path / "out.png", status=1)
    run("field", shapes / "ball.nrrd", "-o", tmp_path / "out.nrrd", "--label", "9", status=1)
    assert [path.name for path in tmp_path.iterdir()] == ["folder.nrrd"]


def test_a_grid_beyond_memory_is_rejected_at_once(shapes, tmp_path):
    start = time.monotonic()
    _, err = run("field", shapes / "sphere.ply", "-o", tmp_path / "out.nrrd", "--resolution", 10000, status=1)
    assert "memory" in err and time.monotonic() - start < 5 and not any(tmp_path.iterdir())


def test_misspelt_commands_and_options_get_a_hint(shapes, tmp_path):
    assert "did you mean field" in run("fild", shapes / "sphere.ply", status=2)[1]
    assert "slice" in run("frobnicate", status=2)[1]
    # The message names the unknown word before the option that is missing because of it.
    err = run("field", shapes / "sphere.ply", "--outptu", tmp_path / "out.nrrd", status=2)[1]
    assert err.index("no option --outptu (did you mean --output?)") < err.index("required")
    err = run("slice", shapes / "sphere.nrrd", "out.png", status=2)[1]
    assert err.index("'out.png' was not expected") < err.index("required")


def test_slice_rejects_files_without_distances(shapes, tmp_path):
    """A field's file of sites, images and meshes hold numbers that are not distances."""
    out = tmp_path / "out.png"
    for command in (["slice", shapes / "sphere.site.nrrd", "-o", out], ["info", shapes / "sphere.site.nrrd"]):
        assert "'sphere.nrrd'" in run(*command, status=1)[1]
    for name, kind in [("ball.nrrd", "an image"), ("balls.npy", "an image"), ("sphere.ply", "a mesh")]:
        err = run("slice", shapes / name, "-o", out, status=1)[1]
        assert f"is {kind}, not a field" in err and "`blum field`" in err
    assert not out.exists()


def test_an_image_of_nan_is_rejected_by_that_name(tmp_path):
    np.save(tmp_path / "nan.npy", np.full((2, 3, 4), np.nan))
    assert "every voxel is NaN" in run("field", tmp_path / "nan.npy", "-o", tmp_path / "out.nrrd", status=1)[1]


def test_numbers_in_messages_are_short(shapes, tmp_path):
    err = run("field", shapes / "sphere.ply", "-o", tmp_path / "out.nrrd", "--padding", "1e300", status=2)[1]
    assert "padding is 1e+300" in err


def test_misspelt_shapes_get_a_hint():
    assert "did you mean torus" in run("make", "trous", "-o", "x.ply", status=2)[1]
    assert "torus_knot" in run("make", "knot", "-o", "x.ply", status=2)[1]


def test_full_disk_is_1(shapes):
    if not os.path.exists("/dev/full"):
        pytest.skip("no /dev/full here")
    with open("/dev/full", "w", encoding="ascii") as full:
        done = subprocess.run([BLUM, "info", shapes / "sphere.ply"], stdout=full, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 1 and done.stderr.startswith(b"blum: error: ")


def test_numbers_do_not_depend_on_the_locale(shapes, tmp_path):
    environment = {**os.environ, "LC_ALL": "de_DE.UTF-8"}
    done = subprocess.run([BLUM, "field", shapes / "sphere.ply", "-o", tmp_path / "l.nrrd", "--spacing", "0.5", "--json",
                           "-"], capture_output=True, check=True, env=environment)
    assert json.loads(done.stdout)["grid"]["spacing"] == [0.5, 0.5, 0.5]


def test_real_meshes_when_there(tmp_path):
    folder = Path(os.environ.get("BLUM_DATA_DIR", Path(__file__).parents[3] / "shared" / "data")) / "meshes"
    if not folder.is_dir():
        pytest.skip("no folder of real meshes")
    expected = {"rocker-arm.obj": 1, "3holes.off": 3, "eight.off": 2, "torus.STL": 1}
    for name, genus in expected.items():
        facts = run_json("info", folder / name)
        assert facts["closed"] and facts["genus"] == genus, name
    summary = run_json("field", folder / "spot.obj", "-o", tmp_path / "spot.nrrd", "--resolution", 48)
    low, high = summary["fields"][0]["distance"]["minimum"], summary["fields"][0]["distance"]["maximum"]
    assert low < 0 < high and math.isfinite(high)


def test_field_on_a_device(shapes, tmp_path):
    out = tmp_path / "out.npz"
    told = run_json("field", shapes / "sphere.ply", "-o", out, "--resolution", 16, "--device", "auto")
    device = told["fields"][0]["device"]
    assert device in ("cpu", "cuda:0")
    for source in ("sphere.ply", "ball.nrrd"):
        _, err = run("field", shapes / source, "-o", tmp_path / "none.npz", "--device", "cuda:99", status=1)
        assert "CUDA" in err
    assert "none.npz" not in names(tmp_path)
    assert "cuda:K" in run("field", shapes / "sphere.ply", "-o", out, "--device", "gpu", status=2)[1]


@pytest.fixture(scope="module")
def emulated_module():
    """The module that runs CUDA kernels on the host."""
    path = Path(os.environ["BLUM_BIN_DIR"]) / "libblum_emulated_cuda.so"
    assert path.is_file(), "build the target blum_emulated_cuda first"
    return path


def test_field_on_the_host_as_a_device(shapes, tmp_path, monkeypatch, emulated_module):
    monkeypatch.setenv("BLUM_CUDA_MODULE", str(emulated_module))
    for source in ("sphere.ply", "ball.nrrd"):
        grid = ["--resolution", 16] if source.endswith("ply") else []
        found = []
        for device in ("cpu", "cuda", "auto"):
            out = tmp_path / f"{device}.npz"
            told = run_json("field", shapes / source, "-o", out, *grid, "--device", device)
            assert told["fields"][0]["device"] == ("cpu" if device == "cpu" else "cuda:0")
            found.append(np.load(out)["distance"])
        assert np.abs(found[0] - found[1]).max() < 1e-6
        assert np.array_equal(found[1], found[2])


def test_a_tool_found_through_path_loads_the_module_beside_it(shapes, tmp_path, monkeypatch, emulated_module):
    place = tmp_path / "bin"
    place.mkdir()
    shutil.copy(BLUM, place / "blum")
    monkeypatch.delenv("BLUM_CUDA_MODULE", raising=False)
    environment = {**os.environ, "PATH": f"{place}{os.pathsep}{os.environ['PATH']}"}
    command = ["blum", "field", str(shapes / "sphere.ply"), "-o", "out.npz", "--resolution", "8", "--device", "auto"]

    def device(module):
        shutil.copy(emulated_module, module)
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=True)
        module.unlink()
        return next(line.split()[-1] for line in done.stdout.splitlines() if line.startswith("device"))

    (tmp_path / "lib").mkdir()
    assert device(place / "libblum_cuda.so") == "cuda:0"
    assert device(tmp_path / "lib" / "libblum_cuda.so") == "cuda:0"
    assert device(tmp_path / "lib" / "another.so") in ("cpu", "cuda:0")
    (tmp_path / "blum").write_text("a file of the tool's name, which is not the tool")
    assert device(place / "libblum_cuda.so") == "cuda:0"
