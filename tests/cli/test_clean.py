"""Proves that `blum clean` removes needles and redundant vertices, keeps meshes closed and reports the deviation."""

import json

import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    """A plate with holes in single precision, as CAD programs export it."""
    folder = tmp_path_factory.mktemp("clean")
    run("make", "plate", "-o", folder / "plate.stl")
    return folder / "plate.stl"


def test_cylinders_lose_their_inner_rings(tmp_path):
    run("make", "cylinder", "--sides", 24, "--stacks", 40, "-o", tmp_path / "rings.ply")
    found = run_json("clean", tmp_path / "rings.ply", "-o", tmp_path / "clean.ply", "--tolerance", "1e-6")
    assert found["command"] == "clean" and found["tolerance"] == 1e-6
    assert found["vertices"] == 50 and found["triangles"] == 96
    assert found["triangles_before"] - found["triangles"] == 2 * found["collapses"]
    assert 0 <= found["deviation"] < 1e-9
    assert found["betti_before"] == found["betti"] == [1, 0, 0]
    assert found["smallest_height"] >= found["smallest_height_before"] > 0
    assert found["outputs"] == [str(tmp_path / "clean.ply")] and set(found["seconds"]) == {"read", "clean", "write"}
    info = run_json("info", tmp_path / "clean.ply")
    assert info["vertices"] == 50 and info["betti"] == [1, 0, 0]


def test_the_reported_deviation_bounds_the_hausdorff_distance(plate, tmp_path):
    out = tmp_path / "clean.obj"
    found = run_json("clean", plate, "-o", out, "--tolerance", "0.01")
    assert found["triangles"] < found["triangles_before"]
    apart = run_json("hausdorff", plate, out, "--only-distance", "--tolerance", "1e-5")
    assert 0 < apart["lower"] <= found["deviation"] <= 0.01


def test_text_reports_counts_deviation_and_topology(plate, tmp_path):
    text, _ = run("clean", plate, "-o", tmp_path / "clean.ply", "--tolerance", "0.01")
    for words in ("triangles", "deviation", "unchanged: 1 component, 6 tunnels, 0 voids", "wrote"):
        assert words in text
    assert "collapses" in run("clean", plate, "-o", tmp_path / "b.ply", "--tolerance", "0.01", "--verbose")[0]
    run("clean", plate, "-o", tmp_path / "again.ply", "--tolerance", "0.01", "--threads", 1)
    assert (tmp_path / "again.ply").read_bytes() == (tmp_path / "clean.ply").read_bytes()
    text, _ = run("clean", plate, "-o", tmp_path / "c.ply", "--tolerance", "0.01", "--quiet", "--json", tmp_path / "c.json")
    assert text == "" and json.loads((tmp_path / "c.json").read_text())["command"] == "clean"


def test_diagrams_of_cleaned_meshes_have_fewer_sites(tmp_path):
    run("make", "box", "--segments", 6, "-o", tmp_path / "box.ply")
    run("clean", tmp_path / "box.ply", "-o", tmp_path / "clean.ply", "--tolerance", "1e-6")
    assert run_json("voronoi", tmp_path / "clean.ply")["faces"] == 6


def test_wrong_arguments_and_meshes_are_rejected(plate, tmp_path):
    out = tmp_path / "out.ply"
    assert "--tolerance" in run("clean", plate, "-o", out, status=2)[1]
    for tolerance in ("0", "-1", "nan", "x"):
        assert "--tolerance" in run("clean", plate, "-o", out, "--tolerance", tolerance, status=2)[1]
    assert "diagonal" in run("clean", plate, "-o", out, "--tolerance", "1e9", status=2)[1]
    assert "--output" in run("clean", plate, "-o", tmp_path / "out.xyz", "--tolerance", "0.1", status=2)[1]
    run("make", "soup", "-o", tmp_path / "soup.ply")
    assert "closed" in run("clean", tmp_path / "soup.ply", "-o", out, "--tolerance", "0.1", status=1)[1]
    run("make", "ball_image", "-o", tmp_path / "image.nrrd")
    assert "not a mesh" in run("clean", tmp_path / "image.nrrd", "-o", out, "--tolerance", "0.1", status=1)[1]
    assert "out.ply" not in names(tmp_path)


def test_segments_and_points_are_left_out_with_a_warning(tmp_path):
    run("make", "box", "-o", tmp_path / "box.obj")
    with (tmp_path / "box.obj").open("a") as file:
        file.write("l 1 8\np 3\n")
    _, err = run("clean", tmp_path / "box.obj", "-o", tmp_path / "out.ply", "--tolerance", 0.001, warns=True)
    assert "1 segment and 1 point besides the triangles were left out" in err
    assert run_json("voronoi", tmp_path / "box.obj", "--clean", 0.001, warns=True)["certified"]
    _, err = run("voronoi", tmp_path / "box.obj", status=1)
    assert "box.obj" in err and "segments or points" in err
