# Proves that `--smooth` takes the solid inside the smooth surface of an image, records this in files, and that
# `blum verify` checks against the same solid.
import json

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

ALONG = np.array([0.3, 0.5, 0.81]) / np.linalg.norm([0.3, 0.5, 0.81])
MIDDLE = np.array([15.2, 15.7, 15.9])
SPACING = 0.5  # spacing of the image in rod.nrrd


def offsets(points):
    """Distances of points from the axis of the rod."""
    along = np.clip((points - MIDDLE) @ ALONG, -10, 10)
    return np.linalg.norm(points - MIDDLE - along[..., None] * ALONG, axis=-1)


@pytest.fixture(scope="module")
def rod(tmp_path_factory):
    """An image of a rod of radius 4 with round ends, and an image that has another label beside the rod."""
    folder = tmp_path_factory.mktemp("smooth")
    z, y, x = np.meshgrid(*[np.arange(32)] * 3, indexing="ij")
    image = (offsets(np.stack([x, y, z], axis=-1)) < 4).astype(np.uint8)
    np.save(folder / "rod.npy", image)
    image[1:3, 1:3, 1:3] = 7
    np.save(folder / "labels.npy", image)
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 32 32 32\nencoding: raw\nspace: LPS\n" \
             f"space directions: ({SPACING},0,0) (0,{SPACING},0) (0,0,{SPACING})\nspace origin: (3,4,5)\n\n"
    (folder / "rod.nrrd").write_bytes(header.encode() + (image == 1).astype(np.uint8).tobytes())
    return folder


def areas(arrays):
    a, b, c = (arrays["vertices"][arrays["triangles"][:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def test_a_slanted_rod_has_a_curve_and_only_narrow_sheets(rod, tmp_path):
    summary = run_json("medial", rod / "rod.npy", "-o", tmp_path / "a.npz", "--smooth", "--theta", "60,120")
    (solid,) = summary["solids"]
    axis, least = solid["axes"]
    assert summary["certified"] and solid["rule"] == "polyhedron" and solid["solid_betti"] == [1, 0, 0]
    assert solid["asked_spacing"] == 1 and solid["smooth"]["iterations"] == 60
    assert 0 < solid["smooth"]["largest_move"] < 0.5 and solid["smooth"]["held_vertices"] == 0
    assert least["counts"]["triangles"] == 0 and least["counts"]["curve_edges"] > 0
    # Sections that are not quite round leave ribbons of 0.7 voxels mean width, up to the ends. In the round ends, bumps with angles of
    # 60 to 70 degrees reach further.
    arrays = np.load(tmp_path / "a-theta60.npz")
    assert axis["counts"]["sheets"] <= 3 and areas(arrays).sum() < 0.7 * 20
    assert abs(arrays["radius"].mean() - 4) < 0.4
    off = offsets(arrays["vertices"])
    assert off.max() < 1.5 and off[arrays["separation_angle"] > 75].max() < 0.7
    curve = np.load(tmp_path / "a-theta120.npz")
    assert np.abs(curve["radius"] - 4).max() < 0.2 and offsets(curve["vertices"]).max() < 0.3
    assert json.loads(str(curve["metadata"]))["smooth"] == "60"
    # The voxels as boxes have sheets at this angle.
    boxes = run_json("medial", rod / "rod.npy", "-o", tmp_path / "b.npz")["solids"][0]
    assert boxes["smooth"] is None and boxes["axes"][0]["counts"]["sheets"] > 20
    assert areas(np.load(tmp_path / "b.npz")).sum() > 4 * areas(arrays).sum()


def test_trees_and_balls_are_certified(tmp_path):
    z, y, x = np.meshgrid(*[np.arange(44)] * 3, indexing="ij")
    places = np.stack([x, y, z], axis=-1).astype(float)

    def distance(begin, end):
        begin, end = np.array(begin, dtype=float), np.array(end, dtype=float)
        part = np.clip((places - begin) @ (end - begin) / ((end - begin) @ (end - begin)), 0, 1)
        return np.linalg.norm(places - begin - part[..., None] * (end - begin), axis=-1)

    tree = (distance((20, 21, 6), (22, 23, 22)) < 4.5) | (distance((22, 23, 22), (9, 16, 36)) < 3.2)
    tree |= distance((22, 23, 22), (34, 32, 34)) < 3.6
    np.save(tmp_path / "tree.npy", tree)
    summary = run_json("medial", tmp_path / "tree.npy", "-o", tmp_path / "t.npz", "--smooth", "--theta", 120)
    assert summary["certified"] and summary["solids"][0]["solid_betti"] == [1, 0, 0]
    arrays = np.load(tmp_path / "t.npz")
    edges = arrays["edges"][arrays["edge_role"] == 3]
    lengths = np.linalg.norm(arrays["vertices"][edges[:, 0]] - arrays["vertices"][edges[:, 1]], axis=1)
    # The middle of the fork and the round ends shorten the curves.
    assert 40 < lengths.sum() < 60 and areas(arrays).sum() < 25
    np.save(tmp_path / "ball.npy", np.linalg.norm(places - [20.3, 20.8, 21.1], axis=-1) < 9)
    run("medial", tmp_path / "ball.npy", "-o", tmp_path / "b.npz", "--smooth", "--theta", 120)
    ball = np.load(tmp_path / "b.npz")
    assert np.linalg.norm(ball["vertices"] - [20.3, 20.8, 21.1], axis=1).max() < 1
    assert np.abs(ball["radius"] - 9).max() < 0.3


def test_verify_recomputes_the_smooth_surface(rod, tmp_path):
    for end in ("vtp", "ply", "npz"):
        run("medial", rod / "rod.nrrd", "-o", tmp_path / f"a.{end}", "--smooth")
        certificate = run_json("verify", rod / "rod.nrrd", tmp_path / f"a.{end}")["certificate"]
        assert certificate["certified"] and certificate["against"] == "polyhedron"
        assert "smooth surface" in run("info", tmp_path / f"a.{end}")[0]
    radius = np.load(tmp_path / "a.npz")["radius"]
    assert abs(radius.mean() - 4 * SPACING) < 0.4 * SPACING
    # An axis that is moved out of the middle fails.
    arrays = dict(np.load(tmp_path / "a.npz"))
    arrays["vertices"] = arrays["vertices"] + [0.3, 0, 0]
    np.savez(tmp_path / "false.npz", **arrays)
    run("verify", rod / "rod.nrrd", tmp_path / "false.npz", status=3)
    # An axis without the record of smoothing fails against boxes.
    arrays = dict(np.load(tmp_path / "a.npz"))
    arrays["metadata"] = np.array(str(arrays["metadata"]).replace('"smooth"', '"rough"'))
    np.savez(tmp_path / "false.npz", **arrays)
    assert "polyhedron" in run("verify", rod / "rod.nrrd", tmp_path / "false.npz", status=3)[1]
    run("reconstruct", tmp_path / "a.npz", "-o", tmp_path / "r.ply", "--input", rod / "rod.nrrd", "--resolution", 40)


def test_files_without_metadata_need_the_option(rod, tmp_path):
    run("medial", rod / "rod.npy", "-o", tmp_path / "a.ma", "--smooth")
    assert "--smooth" in run("verify", rod / "rod.npy", tmp_path / "a.ma", status=3)[1]
    assert run_json("verify", rod / "rod.npy", tmp_path / "a.ma", "--smooth")["certificate"]["certified"]


def test_each_label_is_smoothed_alone(rod, tmp_path):
    solids = run_json("medial", rod / "labels.npy", "-o", tmp_path / "a.npz", "--smooth", "--label", "1,7",
                      "--resolution", 40)["solids"]
    assert [solid["label"] for solid in solids] == [1, 7]
    assert solids[0]["smooth"]["triangles"] > solids[1]["smooth"]["triangles"]
    assert names(tmp_path) == ["a-label1.npz", "a-label7.npz"]
    run("verify", rod / "labels.npy", tmp_path / "a-label1.npz", tmp_path / "a-label7.npz")


def test_surfaces_of_images_are_written(rod, tmp_path):
    summary = run_json("surface", rod / "labels.npy", "-o", tmp_path / "s.obj", "--smooth", "--label", 7)
    assert summary["image"]["kind"] == "image" and summary["iterations"] == 60 and summary["largest_move"] < 0.5
    facts = run_json("info", tmp_path / "s.obj")
    assert summary["surface"]["triangles"] == 48 and facts
    run("surface", rod / "labels.npy", "-o", tmp_path / "t.obj", "--smooth", "--threshold", 7, "--iterations", 0)
    lines = [line.split()[1:] for line in (tmp_path / "t.obj").read_text().splitlines() if line.startswith("v ")]
    vertices = np.array(lines, dtype=float)
    assert set(np.unique(vertices)) == {0.5, 1.5, 2.5}
    out, _ = run("surface", rod / "rod.nrrd", "-o", tmp_path / "u.ply", "--smooth")
    assert "at most 0.49 voxels from the surface of the boxes" in out


@pytest.mark.parametrize(
    ("arguments", "reason", "status"),
    [
        ("surface rod.npy -o s.ply", "not a field", 1),
        ("surface rod.npy -o s.ply --smooth --level 1", "fields", 2),
        ("surface rod.npy -o s.ply --smooth --label 1,2", "one label", 2),
        ("surface rod.npy -o s.ply --smooth --label 5", "has the label 5", 1),
        ("surface rod.npy -o s.ply --smooth --iterations -1", "0", 2),
        ("surface rod.npy -o s.ply --smooth --iterations 1001", "1000", 2),
        ("surface ball.ply -o s.ply --smooth", "not a voxel image", 1),
        ("surface f.npz -o s.ply --label 1", "--smooth", 2),
        ("medial ball.ply -o a.vtp --smooth", "images", 2),
        ("medial rod.npy -o a.vtp --smooth --weld", "meshes", 2),
        ("medial rod.npy -o a.vtp --spacing 1", "--smooth", 2),
        ("verify ball.ply a.vtp --smooth", "images", 2),
    ],
)
def test_wrong_arguments_and_inputs_are_rejected(rod, tmp_path, arguments, reason, status):
    run("make", "sphere", "-o", tmp_path / "ball.ply")
    run("field", tmp_path / "ball.ply", "-o", tmp_path / "f.npz", "--resolution", 16)
    before = names(tmp_path)
    words = arguments.split()
    given = [rod / word if word == "rod.npy" else tmp_path / word if "." in word else word for word in words]
    assert reason in run(*given, status=status)[1]
    assert names(tmp_path) == before
