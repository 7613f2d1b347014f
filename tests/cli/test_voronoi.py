"""Proves that `blum voronoi` writes walls, surface and medial axes in every format, and only if certified."""

import json
import re

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

SITES = 6  # number of sites of a box
CERTIFIED = "certified  yes"
TYPES = {"double": "<f8", "float": "<f4", "int": "<i4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8"}


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """A folder with a box as PLY and STL, a bracket and a gear."""
    folder = tmp_path_factory.mktemp("parts")
    for name in ("box.ply", "box.stl", "bracket.ply", "gear.ply"):
        run("make", name.split(".")[0], "-o", folder / name)
    return folder


# ---- Readers without Blum ----


def read_npz(path):
    file = np.load(path)
    return {
        "vertices": file["vertices"],
        "triangles": file["triangles"],
        "radius": file["radius"],
        "site_a": file["triangle_site_a"],
        "site_b": file["triangle_site_b"],
        "metadata": json.loads(str(file["metadata"])),
    }


def rough_box():
    """A rotated unit box in 32 bits with 6 x 6 squares on each side; each square of the upper side has a needle."""
    n, vertices, triangles = 6, {}, []

    def vertex(p):
        return vertices.setdefault(tuple(p), len(vertices))

    steps = np.arange(n + 1) / n
    for axis in range(3):
        for side in (0.0, 1.0):
            for i in range(n):
                for j in range(n):
                    square = []
                    for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        p = np.zeros(3)
                        p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3] = side, steps[i + a], steps[j + b]
                        square.append(p)
                    if side == 0.0:
                        square.reverse()
                    p, q, r, s = square
                    if axis == 2 and side == 1.0:
                        middle = (p + q) / 2 + (s - p) * 5e-6
                        triangles += [(p, q, middle), (q, r, middle), (r, s, middle), (s, p, middle)]
                    else:
                        triangles += [(p, q, r), (p, r, s)]
    triangles = [[vertex(p) for p in corners] for corners in triangles]
    c, d = np.cos(0.4), np.sin(0.4)
    turn = np.array([[c, -d, 0], [d, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -d], [0, d, c]])
    places = (np.array(list(vertices)) @ turn.T).astype(np.float32)
    lines = ["OFF", f"{len(places)} {len(triangles)} 0"]
    lines += [" ".join(f"{float(x):.9g}" for x in p) for p in places]
    lines += ["3 " + " ".join(map(str, corners)) for corners in triangles]
    return "\n".join(lines) + "\n"


def read_ply(path):
    head, body = path.read_bytes().split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    elements, metadata, at, tables = [], {}, 0, {}
    for line in lines:
        words = line.split()
        if line.startswith("comment blum {"):
            metadata.update(json.loads(line[len("comment blum ") :]))
        if words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        elif words[:2] == ["property", "list"]:
            elements[-1][2].append((words[4], [("count", "u1"), ("of", TYPES[words[3]], 3)]))
        elif words[0] == "property":
            elements[-1][2].append((words[2], TYPES[words[1]]))
    for name, count, fields in elements:
        kind = np.dtype(fields)
        tables[name] = np.frombuffer(body, kind, count, at)
        at += count * kind.itemsize
    assert at == len(body)
    vertex, face = tables["vertex"], tables["face"]
    (corners,) = (name for name in face.dtype.names if name.startswith("vertex_ind"))
    return {
        "vertices": np.stack([vertex[axis] for axis in "xyz"], axis=1),
        "triangles": face[corners]["of"],
        "radius": vertex["radius"],
        "site_a": face["site_a"],
        "site_b": face["site_b"],
        "metadata": metadata,
    }


def read_vtp(path):
    head, body = path.read_bytes().split(b'<AppendedData encoding="raw">', 1)
    start = body.index(b"_") + 1

    def array(name):
        # Lines come before polys, so the last match belongs to the polys.
        tag = re.findall(rb'<DataArray type="(\w+)" Name="%s"[^>]* offset="(\d+)"/>' % name.encode(), head)[-1]
        at = start + int(tag[1])
        size = int(np.frombuffer(body, "<u8", 1, at)[0])
        return np.frombuffer(body[at + 8 : at + 8 + size], TYPES[tag[0].decode()])

    (points,) = re.findall(rb'<Points>\s*<DataArray type="Float64" Name="(\w+)"', head)
    (codes,) = re.findall(rb'Name="metadata"[^>]*>([\d\s]+)<', head)
    return {
        "vertices": array(points.decode()).reshape(-1, 3),
        "triangles": array("connectivity").reshape(-1, 3),
        "radius": array("radius"),
        "site_a": array("site_a"),
        "site_b": array("site_b"),
        "metadata": json.loads(bytes(int(code) for code in codes.split()).rstrip(b"\0")),
    }


def read_obj(path):
    rows = [line.split() for line in path.read_text().splitlines()]
    return {
        "vertices": np.array([row[1:] for row in rows if row[0] == "v"], dtype=float),
        "triangles": np.array([row[1:] for row in rows if row[0] == "f"], dtype=int) - 1,
    }


READERS = {"npz": read_npz, "ply": read_ply, "vtp": read_vtp, "obj": read_obj}


# ---- Output ----


def test_a_box_is_certified(parts, tmp_path):
    out = tmp_path / "box.npz"
    found = run_json("voronoi", parts / "box.ply", "-o", out)
    assert found["certified"] and found["exact"] and found["mismatches"] == [] and found["failing"] == []
    assert found["faces"] == SITES and found["reflex_edges"] == found["reflex_vertices"] == 0
    assert found["expected_betti"] == found["found_betti"] == [1, 0, SITES]
    assert found["outputs"] == [str(out)] and names(tmp_path) == ["box.npz"]
    assert {"read", "planes", "complex", "homology", "write"} <= set(found["seconds"])
    assert found["options"]["depth"] == 24 and found["options"]["part"] == "all"
    counts = found["complex"]
    assert counts["triangles"] == counts["wall_triangles"] + counts["surface_triangles"]
    assert min(counts.values()) > 0


def test_a_bracket_as_text(parts, tmp_path):
    text, _ = run("voronoi", parts / "bracket.ply", "-o", tmp_path / "b.vtp", "--verbose")
    assert CERTIFIED in text and "144 reflex edges, 4 reflex vertices" in text and f"wrote      {tmp_path}" in text
    rows = dict(re.findall(r"^(\w+)  +(.*)$", text, re.MULTILINE))
    assert rows["topology"] == (
        "Voronoi walls and the solid's surface together: 1 component, 12 tunnels, 291 voids (each is the region of one "
        "site)"
    )
    assert {"sites", "traced", "complex", "certified", "time"} <= set(rows)
    assert rows["proven"] == "314 of 314 junctions, 919 of 919 seams"
    assert rows["certified"] == "yes: each wall, seam and junction is that of the exact diagram"
    text, _ = run("voronoi", parts / "bracket.ply", "--method", "cubes", "-o", tmp_path / "b.vtp", "--verbose")
    rows = dict(re.findall(r"^(\w+)  +(.*)$", text, re.MULTILINE))
    assert {"sites", "cubes", "lines", "complex", "certified", "time"} <= set(rows)


@pytest.mark.parametrize("end", READERS)
def test_every_format_holds_the_complex(parts, tmp_path, end):
    run("voronoi", parts / "box.ply", "-o", tmp_path / "all.npz", "--quiet")
    counts = run_json("voronoi", parts / "box.ply", "-o", tmp_path / f"box.{end}")["complex"]
    expected, found = read_npz(tmp_path / "all.npz"), READERS[end](tmp_path / f"box.{end}")
    for key in found:
        assert key == "metadata" or np.array_equal(found[key], expected[key]), key
    assert found.get("metadata", expected["metadata"]) == expected["metadata"]
    assert (len(found["vertices"]), len(found["triangles"])) == (counts["vertices"], counts["triangles"])


def test_columns_and_metadata_describe_the_diagram(parts, tmp_path):
    run("voronoi", parts / "box.ply", "-o", tmp_path / "box.npz", "--quiet")
    found = read_npz(tmp_path / "box.npz")
    on_surface = found["site_a"] == -1
    assert (found["site_a"] < found["site_b"]).all() and found["site_a"].min() == -1
    assert set(found["site_b"][on_surface]) == set(range(SITES)) and found["site_b"].max() == SITES - 1
    assert set(found["site_a"][~on_surface]) | set(found["site_b"][~on_surface]) == set(range(SITES))
    assert (np.abs(found["vertices"]) <= 0.5).all() and (found["radius"] >= 0).all()
    assert (found["radius"][found["triangles"][on_surface]] == 0).all()
    metadata = found["metadata"]
    assert metadata["content"] == "Voronoi diagram" and metadata["certified"] == "true"
    assert metadata["source"] == "box.ply" and "weld" not in metadata


def test_walls_leave_out_the_surface(parts, tmp_path):
    run("voronoi", parts / "box.ply", "-o", tmp_path / "all.npz")
    found = run_json("voronoi", parts / "box.ply", "-o", tmp_path / "walls.npz", "--walls")
    full, walls = read_npz(tmp_path / "all.npz"), read_npz(tmp_path / "walls.npz")
    assert found["options"]["part"] == "walls"
    assert found["certified"]
    assert found["found_betti"] == [1, 0, 0]
    assert found["complex"]["surface_triangles"] == 0
    assert found["complex"]["wall_triangles"] == len(walls["triangles"])
    between = {tuple(pair) for pair in np.stack([full["site_a"], full["site_b"]], axis=1) if pair[0] >= 0}
    assert between == {tuple(pair) for pair in np.stack([walls["site_a"], walls["site_b"]], axis=1)}
    assert np.array_equal(np.unique(walls["triangles"]), np.arange(len(walls["vertices"])))
    assert walls["metadata"]["content"] == "walls of a Voronoi diagram"


def test_a_medial_axis_has_the_topology_of_the_solid(parts, tmp_path):
    found = run_json("voronoi", parts / "bracket.ply", "-o", tmp_path / "axis.npz", "--medial")
    assert found["certified"]
    assert found["found_betti"] == [1, 4, 0]
    assert found["axis"]["certificate"]["certified"]
    assert found["axis"]["theta"] == 1
    file = np.load(tmp_path / "axis.npz")
    site_a, site_b = file["triangle_site_a"], file["triangle_site_b"]
    assert len(site_a) == found["axis"]["counts"]["triangles"]
    assert 0 <= site_a.min()
    # A wall between a face and an edge stays if the edge is not an edge of the face.
    is_face_and_edge = (site_a < found["faces"]) & (site_b >= found["faces"])
    assert 0 < is_face_and_edge.sum() < len(site_a)
    run("verify", parts / "bracket.ply", tmp_path / "axis.npz")


@pytest.mark.parametrize("extension", ["vtp", "ply", "obj", "ma", "npz"])
def test_medial_axes_of_angles_in_every_format(parts, tmp_path, extension):
    mesh, triangles = parts / "bracket.ply", []
    for theta in (0, 60, 120):
        name = tmp_path / f"axis{theta}.{extension}"
        options = ("--theta", theta, "--decimate", 0.02, "--resolution", 4, "--graph", tmp_path / f"axis{theta}.json")
        axis = run_json("voronoi", mesh, "-o", name, "--medial", *options)["axis"]
        assert axis["theta"] == theta and 0 < axis["deviation"] <= 0.02
        assert axis["vertices_before"] > axis["counts"]["vertices"]
        assert json.loads((tmp_path / f"axis{theta}.json").read_text())["theta"] == theta
        triangles.append(axis["counts"]["triangles"])
        run("verify", mesh, name)
    assert triangles[0] > triangles[1] > triangles[2]


def test_wrong_options_of_medial_axes_are_rejected(parts, tmp_path):
    box, out = parts / "box.ply", tmp_path / "out.vtp"
    assert "--medial" in run("voronoi", box, "-o", out, "--theta", 60, status=2)[1]
    assert "--output" in run("voronoi", box, "--medial", "--theta", 60, status=2)[1]
    for bad in ("-1", "181", "nan", "x"):
        run("voronoi", box, "-o", out, "--medial", "--theta", bad, status=2)
    for bad in ("-1", "nan", "inf"):
        run("voronoi", box, "-o", out, "--medial", "--decimate", bad, status=2)
    run("voronoi", box, "-o", tmp_path / "out.glb", "--medial", status=2)
    run("voronoi", box, "-o", out, "--medial", "--graph", out, status=2)
    assert not out.exists()


def test_stl_is_welded_and_a_tolerance_recorded(parts, tmp_path):
    assert run_json("voronoi", parts / "box.stl")["expected_betti"] == [1, 0, SITES]
    run("voronoi", parts / "box.stl", "-o", tmp_path / "b.npz", "--weld", "0.001")
    assert read_npz(tmp_path / "b.npz")["metadata"]["weld"] == "0.001"


def test_a_finer_complex_has_more_cubes(parts):
    coarse, fine = (
        run_json("voronoi", parts / "box.ply", "--method", "cubes", "--resolution", n) for n in (1, 16)
    )
    assert coarse["cubes"] < 1000 < fine["cubes"] and fine["certified"]


def test_rotated_solids_have_the_graph_of_the_original(tmp_path):
    run("make", "box", "-o", tmp_path / "box.obj")
    lines = (tmp_path / "box.obj").read_text().splitlines()
    box = np.array([line.split()[1:] for line in lines if line.startswith("v ")])
    turn = np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3
    corners = (box.astype(float) @ turn.T * 0.7).astype(np.float32)
    faces = [line for line in lines if line.startswith("f ")]
    turned = tmp_path / "turned.obj"
    turned.write_text("\n".join([*(f"v {x} {y} {z}" for x, y, z in corners.tolist()), *faces]))
    found = run_json("voronoi", turned, "--walls", "--graph", tmp_path / "g.json")
    graph = json.loads((tmp_path / "g.json").read_text())
    assert found["exact"] and found["faces"] == SITES
    assert [len(site["triangles"]) for site in graph["sites"]].count(2) == SITES
    assert (len(graph["walls"]), len(graph["seams"]), len(graph["junctions"])) == (12, 8, 9)
    as_given = run_json("voronoi", turned, "--walls", "--flatness", 0, "--allow-uncertified", "-o", tmp_path / "o.npz")
    assert as_given["faces"] > SITES


def test_threads_do_not_change_a_byte(parts, tmp_path):
    for threads in (1, 2):
        run("voronoi", parts / "bracket.ply", "-o", tmp_path / f"{threads}.vtp", "--threads", threads)
    assert (tmp_path / "1.vtp").read_bytes() == (tmp_path / "2.vtp").read_bytes()


def test_json_goes_to_a_file_beside_the_text(parts, tmp_path):
    text, _ = run("voronoi", parts / "box.ply", "--json", tmp_path / "facts.json")
    assert CERTIFIED in text and names(tmp_path) == ["facts.json"]
    found = json.loads((tmp_path / "facts.json").read_text())
    assert found["command"] == "voronoi" and found["certified"] and found["outputs"] == []
    assert run("voronoi", parts / "box.ply", "--quiet") == ("", "")


# ---- Failed certificates ----

COARSE = ["--method", "cubes", "--depth", 3]


def test_an_uncertified_diagram_is_not_written(parts, tmp_path):
    (tmp_path / "gear.vtp").write_bytes(b"old")
    out, err = run("voronoi", parts / "gear.ply", "-o", tmp_path / "gear.vtp", *COARSE, "--json", "-", status=3)
    assert "NOT certified" in err and "nothing was written" in err and "--depth" in err
    assert re.search(r"\d+ cubes do not pass the local test, the first one from \(.*\) to \(.*\) \(\w+( \w+)?\)", err)
    assert "but Voronoi walls and the solid's surface together have 1 component, 18 tunnels, 546 voids" in err
    assert (tmp_path / "gear.vtp").read_bytes() == b"old" and names(tmp_path) == ["gear.vtp"]
    found = json.loads(out)
    assert not found["certified"] and found["outputs"] == [] and found["found_betti"] != found["expected_betti"]
    assert len(found["mismatches"]) >= 2 and set(found["failing"][0]) == {"low", "high", "obstacle"}
    assert f"{len(found['failing'])} cubes" in found["mismatches"][0]


def test_an_uncertified_diagram_is_written_on_request(parts, tmp_path):
    out = tmp_path / "gear.npz"
    text, err = run("voronoi", parts / "gear.ply", "-o", out, *COARSE, "--allow-uncertified", status=3)
    assert "certified  NO" in text and "NOT certified" in err and "nothing was written" not in err
    written = read_npz(out)
    assert written["metadata"]["certified"] == "false"
    count = int(written["metadata"]["failing_cubes"])
    assert f"NO: {count} cubes" in run("info", out)[0]
    columns = np.load(out)
    edges, sites = columns["edges"], columns["site_0"]
    assert count > 0 and edges.shape == (12 * count, 2) and set(columns["edge_obstacle"]) <= set(range(1, 8))
    assert (sites[edges] == -1).all() and (sites[written["triangles"]] >= 0).all()
    lengths = np.linalg.norm(written["vertices"][edges[:, 0]] - written["vertices"][edges[:, 1]], axis=1)
    assert np.ptp(lengths) < 1e-9 * lengths.max()


def test_parts_that_face_the_wrong_way_are_reversed(solids, tmp_path):
    found = run_json("voronoi", solids / "inverted.obj", warns=True)
    assert found["certified"] and found["reversed_shells"] == 1 and found["reversed_triangles"] == 0
    assert found["warnings"] == [
        {"code": "reversed-shells", "text": "1 shell faces the wrong way and was reversed"}
    ]
    run("make", "box", "-o", tmp_path / "box.obj")
    text = (tmp_path / "box.obj").read_text()
    first = re.search(r"^f (\d+) (\d+) (\d+)$", text, re.MULTILINE)
    wrong = tmp_path / "wrong.obj"
    wrong.write_text(text.replace(first[0], f"f {first[1]} {first[3]} {first[2]}", 1))
    found = run_json("voronoi", wrong, warns=True)
    assert found["certified"] and found["reversed_triangles"] == 1 and found["expected_betti"] == [1, 0, SITES]
    cleaned = run_json("voronoi", wrong, "--clean", 0.001, warns=True)
    assert cleaned["certified"] and cleaned["cleaning"]["reversed_triangles"] == cleaned["reversed_triangles"] == 1
    assert cleaned["warnings"] == found["warnings"]


# ---- Errors ----


def test_meshes_that_bound_no_solid_are_rejected(solids, tmp_path):
    _, err = run("voronoi", solids / "open.obj", "-o", tmp_path / "o.vtp", status=1)
    assert "open.obj" in err and "bounds no solid" in err and "closed" in err
    _, err = run("voronoi", solids / "ball.nrrd", "-o", tmp_path / "o.vtp", status=1)
    assert "ball.nrrd" in err and "is not a mesh" in err
    assert names(tmp_path) == []


def test_bad_options_are_rejected(parts, tmp_path):
    box, out = parts / "box.ply", tmp_path / "o.vtp"
    for option, value in (("--depth", 0), ("--depth", 25), ("--resolution", 0), ("--max-cubes", 10), ("--weld", -1)):
        assert option in run("voronoi", box, "-o", out, option, value, status=2)[1]
    for option, value in (("--resolution", 1000), ("--tolerance", 0.002)):
        given = ("--method", "cubes", option, value)
        assert "raise --max-cubes" in run("voronoi", box, "-o", out, *given, status=2)[1]
    assert "--output" in run("voronoi", box, "-o", tmp_path / "o.xyz", status=2)[1]
    assert "give one" in run("voronoi", box, "--walls", "--medial", status=2)[1]
    assert "--allow-uncertified" in run("voronoi", box, "--allow-uncertified", status=2)[1]
    assert "--depth" in run("voronoi", box, "--dept", 3, status=2)[1]
    assert "INPUT" in run("voronoi", status=2)[1]
    run("voronoi", box, "-o", box, status=2)
    assert "none.ply" in run("voronoi", parts / "none.ply", status=1)[1]
    assert names(tmp_path) == []


def test_help_has_examples():
    text, _ = run("voronoi", "--help")
    assert len(re.findall(r"^  blum voronoi ", text, re.MULTILINE)) >= 3 and "Exit status 3" in text
    assert "voronoi" in run("--help")[0]


# ---- Graphs ----


def test_graphs_of_diagrams(parts, tmp_path):
    out = tmp_path / "graph.json"
    found = run_json("voronoi", parts / "bracket.ply", "--graph", out)
    assert found["outputs"] == [str(out)] and found["certified"]
    graph = json.loads(out.read_text())
    assert graph["content"] == "graph of a Voronoi diagram" and graph["source"] == "bracket.ply"
    assert graph["regions"] == found["regions"]
    assert {name: len(graph[name]) for name in ("walls", "seams", "junctions")} == found["graph"]
    run("voronoi", parts / "bracket.ply", "--graph", tmp_path / "graph.graphml", "--quiet")
    text = (tmp_path / "graph.graphml").read_text()
    assert all(text.count(f'<node id="{part[:-1]}') == len(graph[part]) for part in ("walls", "seams", "junctions"))
    run("voronoi", parts / "gear.ply", *COARSE, "--graph", tmp_path / "gear.json", status=3)
    assert names(tmp_path) == ["graph.graphml", "graph.json"]


def test_options_of_graphs(parts, tmp_path):
    box = parts / "box.ply"
    assert "--graph" in run("voronoi", box, "--graph", tmp_path / "g.xml", status=2)[1]
    assert "--graph" in run("voronoi", box, "--medial", "--graph", tmp_path / "g.json", status=2)[1]


def test_graphs_of_patches(tmp_path):
    """A fine disc has three sheets and one closed seam. The summary, the graph and the columns name the same patches."""
    disc, walls, axis = tmp_path / "disc.ply", tmp_path / "walls.npz", tmp_path / "axis.npz"
    run("make", "cylinder", "--sides", 48, "--height", 0.5, "-o", disc)
    graph_of = ("--graph", tmp_path / "g.json", "--patch-angle", 30)
    found = run_json("voronoi", disc, "--walls", "-o", walls, *graph_of)
    assert found["graph"] == {"walls": 3, "seams": 1, "junctions": 0}
    graph, columns = json.loads((tmp_path / "g.json").read_text()), np.load(walls)
    assert graph["patches"] == found["patches"] and [patch["kind"] for patch in graph["patches"]] == ["face"] * 3
    patch = {site: k for k, each in enumerate(graph["patches"]) for site in each["sites"]}
    pairs = np.sort([[patch[site] for site in columns[f"triangle_site_{side}"].tolist()] for side in "ab"], axis=0)
    assert (pairs[0] == columns["triangle_patch_a"]).all() and (pairs[1] == columns["triangle_patch_b"]).all()

    found = run_json("voronoi", disc, "--medial", "--theta", 20, "-o", axis, *graph_of)
    graph, columns = json.loads((tmp_path / "g.json").read_text()), np.load(axis)
    assert found["axis"]["graph"]["sheets"] == len(graph["sheets"]) == 3
    assert (len(graph["seams"]), len(graph["junctions"])) == (1, 0)
    for sheet in graph["sheets"]:
        own = columns["triangle_patch_sheet"] == sheet["sheet"]
        assert own.sum() == sheet["triangles"] > 0
        sides = [set(columns[f"triangle_patch_{side}"][own].tolist()) for side in "ab"]
        assert sides == [{number} for number in sheet["sides"]]
    assert run_json("voronoi", disc, "--walls")["patches"] is None
    assert "--patch-angle" in run("voronoi", disc, "--patch-angle", 181, status=2)[1]


def test_graphs_of_fitted_patches(tmp_path):
    disc, axis = tmp_path / "disc.ply", tmp_path / "axis.npz"
    run("make", "cylinder", "--sides", 48, "--height", 0.5, "--radius", 2, "-o", disc)
    graph_of = ("--graph", tmp_path / "g.json", "--patch-fit", 1e-6)
    found = run_json("voronoi", disc, "--walls", *graph_of)
    assert found["graph"] == {"walls": 3, "seams": 1, "junctions": 0}
    assert json.loads((tmp_path / "g.json").read_text())["patches"] == found["patches"]
    shapes = [patch["shape"] for patch in found["patches"]]
    assert sorted(shape["kind"] for shape in shapes) == ["cylinder", "plane", "plane"]
    (side,) = (shape for shape in shapes if shape["kind"] == "cylinder")
    assert abs(side["radius"] - 2) < 1e-9 and abs(abs(side["axis"][2]) - 1) < 1e-9 and side["deviation"] < 1e-9
    assert "(2 planes, 1 cylinder)" in run("voronoi", disc, "--walls", *graph_of)[0]

    found = run_json("voronoi", disc, "--medial", "--theta", 20, "-o", axis, *graph_of)
    graph = json.loads((tmp_path / "g.json").read_text())
    assert found["axis"]["graph"]["sheets"] == len(graph["sheets"]) == 3
    assert [patch["shape"]["kind"] for patch in graph["patches"]] == [shape["kind"] for shape in shapes]
    # Edges of this cylinder bend by 7.5 degrees.
    found = run_json("voronoi", disc, "--walls", "--patch-angle", 7, "--patch-fit", 1e-6)
    assert [patch["shape"]["kind"] for patch in found["patches"]] == ["plane"] * 50
    for bad in (0, -1, "nan"):
        assert "--patch-fit" in run("voronoi", disc, f"--patch-fit={bad}", status=2)[1]


# ---- Cleaning ----


def test_cleaned_meshes(tmp_path):
    """The diagram of a cleaned box with many triangles and needles 1e-6 high is that of a box of twelve triangles."""
    rough, clean, out = tmp_path / "rough.off", tmp_path / "clean.ply", tmp_path / "axis.npz"
    rough.write_text(rough_box())
    found = run_json("voronoi", rough, "--clean", 1e-4, "--cleaned", clean)
    assert found["certified"] and found["cleaning"]["tolerance"] == 1e-4
    assert found["cleaning"]["deviation"] <= 1e-4 and found["cleaning"]["triangles"] < 30
    assert found["cleaning"]["triangles_before"] > 300 and found["cleaning"]["smallest_height_before"] < 2e-6
    assert found["outputs"] == [str(clean)] and found["cubes"] < 5000
    run("voronoi", rough, "--clean", 1e-4, "--cleaned", clean, "--medial", "--theta", 40, "-o", out)
    run("verify", clean, out)
    assert json.loads(str(np.load(out)["metadata"]))["source"] == "clean.ply"


def test_options_of_cleaning(parts, tmp_path):
    box, out, clean = parts / "box.ply", tmp_path / "o.vtp", tmp_path / "c.ply"
    assert "--clean" in run("voronoi", box, "--clean", 0, status=2)[1]
    assert "--cleaned" in run("voronoi", box, "--clean", 1e-3, "--cleaned", tmp_path / "c.vti", status=2)[1]
    assert "--cleaned" in run("voronoi", box, "--clean", 1e-3, "--medial", "-o", out, status=2)[1]
    assert "tolerance" in run("voronoi", box, "--clean", 100, "-o", out, status=2)[1]
    run("voronoi", box, "--clean", 1e-3, "--cleaned", box, status=2)
    assert names(tmp_path) == []
    run("voronoi", box, "--cleaned", clean)
    assert run_json("info", clean)["betti"] == [1, 0, 0]


def test_a_mesh_that_crosses_itself(tmp_path):
    """The diagram is that of the resolved solid; --cleaned writes the mesh of this solid."""
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    squares = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
    lines = []
    for k, (dx, dy, dz) in enumerate([(0, 0, 0), (0.5, 0.25, 0.125)]):
        lines += [f"v {x + dx} {y + dy} {z + dz}" for x, y, z in corners]
        lines += ["f " + " ".join(str(v + 8 * k) for v in square) for square in squares]
    crossing, mesh, axis = tmp_path / "crossing.obj", tmp_path / "apart.ply", tmp_path / "axis.vtp"
    crossing.write_text("\n".join(lines), "utf-8")
    facts = run_json("voronoi", crossing, "-o", tmp_path / "walls.vtp", "--cleaned", mesh, warns=True)
    assert facts["certified"] and any("resolved exactly" in warning["text"] for warning in facts["warnings"])
    assert run_json("info", mesh)["betti"] == [1, 0, 0]
    assert "--cleaned" in run("voronoi", crossing, "--medial", "-o", axis, status=1)[1]
    run("voronoi", crossing, "--medial", "-o", axis, "--cleaned", mesh, warns=True)
    run("verify", mesh, axis)
    assert any("--cleaned" in warning["text"] for warning in run_json("voronoi", crossing, warns=True)["warnings"])

