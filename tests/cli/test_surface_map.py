"""Proves that `blum surface-map` writes maps of every kind in every format and rejects wrong arguments."""

import json

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def shapes(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shapes")
    run("make", "box", "--size-x", 4, "--size-y", 3, "--size-z", 0.5, "-o", folder / "plate.ply")
    run("make", "sphere", "-o", folder / "sphere.ply")
    run("make", "torus", "-o", folder / "torus.ply")
    return folder


def test_distances_to_other_meshes(shapes, tmp_path):
    out = tmp_path / "map.npz"
    found = run_json("surface-map", shapes / "plate.ply", shapes / "sphere.ply", "-o", out, "--texel", 0.05, "--sign", "auto")
    held = np.load(out)
    assert held["distance"].shape == (found["height"], found["width"])
    known = held["triangle"] >= 0
    assert known.sum() == found["texels"] and found["without_value"] == 0
    assert np.isclose(held["distance"][known].min(), found["smallest"]["distance"])
    assert np.isclose(held["distance"][known].max(), found["largest"]["distance"])
    assert found["quantity"] == "distance" and found["sign_rule"] == "normals" and found["smallest"]["distance"] < 0
    corner = np.linalg.norm([2, 1.5, 0.25])
    assert np.isclose(found["largest"]["distance"], corner - 1, atol=0.05)
    assert np.isclose(held["triangle_error"].max(), found["largest_error"]) and found["largest_error"] < 0.06
    meta = json.loads(str(held["metadata"]))
    assert meta["quantity"] == "distance" and meta["tool"] == "blum surface-map"


def test_the_closest_of_several_is_named(shapes, tmp_path):
    found = run_json(
        "surface-map", shapes / "plate.ply", shapes / "torus.ply", shapes / "sphere.ply", "-o", tmp_path / "map.png",
        "--texel", 0.1
    )
    assert {found["smallest"]["object"], found["largest"]["object"]} <= {0, 1}


def test_thickness_and_self(shapes, tmp_path):
    ray = run_json("surface-map", shapes / "plate.ply", "-o", tmp_path / "ray.ply", "--thickness", "ray")
    assert np.isclose(ray["smallest"]["distance"], 0.5) and np.isclose(ray["largest"]["distance"], 4)
    assert ray["quantity"] == "ray-thickness" and ray["largest_error"] is None
    ball = run_json("surface-map", shapes / "plate.ply", "-o", tmp_path / "ball.vtp", "--thickness", "ball")
    assert np.isclose(ball["largest"]["distance"], 0.5, atol=1e-5)
    own = run_json("surface-map", shapes / "torus.ply", "-o", tmp_path / "own.npz", "--self", "--max-distance", 0.05)
    assert own["quantity"] == "self-distance" and own["without_value"] > 0


def test_maps_without_values_cause_a_warning(shapes, tmp_path):
    run("make", "sphere", "--radius", 0.2, "-o", tmp_path / "far.ply")
    far = run_json(
        "surface-map", shapes / "torus.ply", tmp_path / "far.ply", "-o", tmp_path / "m.png", "--max-distance", 0.01, warns=True
    )
    assert far["smallest"] is None and "nothing lies within" in far["warnings"][0]["text"]


def test_all_formats_at_once(shapes, tmp_path):
    outs = [tmp_path / f"map.{extension}" for extension in ("npz", "png", "glb", "ply", "vtp")]
    options = [word for out in outs for word in ("-o", out)]
    text, _ = run(
        "surface-map", shapes / "plate.ply", shapes / "sphere.ply", *options, "--units", "mm", "--range", "0,2", "--texel", 0.1
    )
    assert all(out.stat().st_size > 500 for out in outs) and text.count("wrote") == 5 and " mm (1.4 % of the size) between texels" in text


def test_wrong_arguments_are_rejected(shapes, tmp_path):
    plate, sphere, out = shapes / "plate.ply", shapes / "sphere.ply", tmp_path / "map.png"
    for words, said in (
        ((plate, "-o", out), "another mesh"),
        ((plate, sphere, "-o", out, "--self"), "takes one mesh"),
        ((plate, "-o", out, "--self", "--thickness", "ray"), "different kinds"),
        ((plate, "-o", out, "--thickness", "cone"), "'ray' or 'ball'"),
        ((plate, "-o", out, "--thickness", "ray", "--separation", 20), "--thickness ball"),
        ((plate, "-o", out, "--self", "--sign", "auto"), "--sign"),
        ((plate, sphere, "-o", out, "--range", "2"), "two numbers"),
        ((plate, sphere, "-o", out, "--range", "2,1"), "less"),
        ((plate, sphere, "-o", out, "--texel", 0), "--texel"),
        ((plate, sphere, "-o", out, "--max-distance", -1), "--max-distance"),
        ((plate, sphere, "-o", tmp_path / "map.obj"), "extension"),
        ((plate, sphere, "-o", plate), "plate.ply"),
    ):
        assert said in run("surface-map", *words, status=2)[1], words
    assert "16384" in run("surface-map", plate, sphere, "-o", out, "--texel", 1e-9, status=2)[1]
    assert not out.exists()


def test_values_by_area(shapes, tmp_path):
    found = run_json("surface-map", shapes / "plate.ply", "-o", tmp_path / "ray.npz", "--thickness", "ray")
    by_area = found["by_area"]
    area, thin = 2 * (12 + 2 + 1.5), 2 * 12
    assert np.isclose(by_area["area"], area) and np.isclose(by_area["measured_area"], area)
    assert np.isclose(by_area["mean"], (thin * 0.5 + 2 * 2 * 3 + 2 * 1.5 * 4) / area)
    assert np.allclose(by_area["percentiles"][:5], 0.5) and np.allclose(by_area["percentiles"][5:], 4)
    text, _ = run("surface-map", shapes / "plate.ply", "-o", tmp_path / "ray.npz", "--thickness", "ray",
                  "--verbose")  # fmt: skip
    assert "percentiles  1 % below 0.5, 5 % below 0.5" in text and "by area" in text


def test_meshes_without_an_inside_cause_a_warning(shapes, tmp_path):
    corners = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]

    def box(name, faces):
        lines = [f"v {x} {y} {z}" for x, y, z in corners] + ["f " + " ".join(str(v + 1) for v in face) for face in faces]
        (tmp_path / name).write_text("\n".join(lines) + "\n")
        words = ("surface-map", tmp_path / name, "-o", tmp_path / "map.npz", "--thickness", "ray", "--texel", 0.1)
        warning = run_json(*words, warns=True)["warnings"][0]
        return warning["code"], warning["text"]

    assert run_json("surface-map", shapes / "plate.ply", "-o", tmp_path / "m.npz", "--thickness", "ray")["warnings"] == []
    code, text = box("open.obj", quads[:-1])
    assert code == "open-mesh" and "the mesh is open (4 edges" in text
    code, text = box("turned.obj", [*quads[:-1], quads[-1][::-1]])
    assert code == "facing" and "face different ways (4 edges)" in text
    assert "face into the solid" in box("inwards.obj", [quad[::-1] for quad in quads])[1]
    corners += [(0.25 + x / 2, 0.25 + y / 2, 0.25 + z / 2) for x, y, z in corners]
    inner = [tuple(v + 8 for v in quad) for quad in quads]
    assert "lie in or cross each other" in box("nested.obj", quads + inner)[1]
    hollow = [quad[::-1] for quad in inner]
    words = ("surface-map", tmp_path / "hollow.obj", "-o", tmp_path / "map.npz", "--thickness", "ray", "--texel", 0.1)
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += ["f " + " ".join(str(v + 1) for v in face) for face in quads + hollow]
    (tmp_path / "hollow.obj").write_text("\n".join(lines) + "\n")
    assert run_json(*words)["warnings"] == []
