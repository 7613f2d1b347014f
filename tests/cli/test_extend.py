# Proves that --extend writes one extended surface for each written axis, in every format.
# The summary reports the rim vertices that reach the border and those that do not.
from pathlib import Path

import numpy as np
import pytest

from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    path = tmp_path_factory.mktemp("plate") / "plate.ply"
    run("make", "box", "--size-x", 20, "--size-y", 10, "--size-z", 1, "-o", path)
    return path


def medial(plate, output, *arguments, warns=False):
    return run_json("medial", plate, "-o", output, "--resolution", 60, *arguments, warns=warns)


def area(vertices, triangles):
    corners = vertices[triangles]
    return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)


def stl_corners(path):
    data = np.frombuffer(Path(path).read_bytes()[84:], dtype=np.dtype([("f", "<f4", 12), ("a", "<u2")]))
    return data["f"][:, 3:].reshape(-1, 3, 3).astype(float)


def test_the_file_spans_the_plate(plate, tmp_path):
    shell = tmp_path / "s.npz"
    summary = medial(plate, tmp_path / "a.npz", "--theta", 110, "--extend", shell)
    assert names(tmp_path) == ["a.npz", "s.npz"] == [Path(name).name for name in summary["outputs"]]
    with np.load(shell) as file, np.load(tmp_path / "a.npz") as axis:
        told = summary["solids"][0]["axes"][0]["extended"]
        is_new = file["triangle_extended"] == 1
        areas = area(file["vertices"], file["triangles"])
        assert told["file"] == str(shell)
        assert np.isclose(areas.sum(), 200) and np.isclose(told["area"], 200)
        assert np.isclose(areas[~is_new].sum(), told["axis_area"]) and told["axis_area"] < 175
        assert (told["triangles"], told["vertices"]) == (is_new.sum(), file["extended"].sum())
        assert told["rim_vertices"] == told["reached_border"] > 0 == told["not_reached"]
        count = len(axis["vertices"])
        assert np.array_equal(file["vertices"][:count], axis["vertices"])
        assert np.array_equal(file["thickness"][:count], 2 * axis["radius"])
        assert np.allclose(file["thickness"], 1) and set(file["triangle_sheet"]) == {0}
        assert np.allclose(file["vertices"].min(axis=0), [-10, -5, 0])
        assert np.allclose(file["vertices"].max(axis=0), [10, 5, 0])
        assert b"extended medial axis" in file["metadata"].tobytes().replace(b"\0", b"")


@pytest.mark.parametrize("extension", ["vtp", "ply", "obj", "stl"])
def test_formats_hold_the_surface_or_its_columns(plate, tmp_path, extension):
    shell = tmp_path / f"s.{extension}"
    medial(plate, tmp_path / "a.vtp", "--theta", 110, "--extend", shell)
    if extension == "stl":
        corners = stl_corners(shell)
    elif extension == "obj":
        lines = [line.split() for line in shell.read_text().splitlines()]
        vertices = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
        corners = vertices[np.array([line[1:] for line in lines if line[0] == "f"], dtype=int) - 1]
    else:
        content = shell.read_bytes()
        assert all(column in content for column in (b"thickness", b"extended", b"sheet"))
        assert extension != "ply" or b'"content": "extended medial axis"' in content
        return
    assert np.isclose(area(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3)).sum(), 200)


def test_every_angle_has_its_own_extended_surface(plate, tmp_path):
    summary = medial(
        plate, tmp_path / "a.vtp", "--theta", "100,120", "--extend", tmp_path / "s.ply", "--graph", tmp_path / "g.json"
    )
    wanted = [
        f"{name}-theta{theta}.{kind}"
        for name, kind in (("a", "vtp"), ("g", "json"), ("s", "ply"))
        for theta in (100, 120)
    ]
    assert names(tmp_path) == sorted(wanted) == sorted(Path(name).name for name in summary["outputs"])


def test_a_length_too_short_for_the_border_causes_a_warning(plate, tmp_path):
    summary = medial(
        plate, tmp_path / "a.vtp", "--theta", 110, "--extend", tmp_path / "s.ply", "--extend-length", 0.3, warns=True
    )
    told = summary["solids"][0]["axes"][0]["extended"]
    assert told["not_reached"] == told["rim_vertices"] > 0 and told["triangles"] == 0
    assert any("are not extended" in warning["text"] for warning in summary["warnings"])
    out, _ = run(
        "medial", plate, "-o", tmp_path / "a.vtp", "--theta", 110, "--resolution", 60, "--extend", tmp_path / "s.ply"
    )
    assert "extended" in out and "reach the surface" in out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--extend", "s.foo"], "the extension must be"),
        (["--extend-length", "3"], "needs --extend"),
        (["--extend", "s.ply", "--extend-length", "0"], "--extend-length"),
        (["--extend", "a.vtp"], "a.vtp"),
    ],
)
def test_wrong_arguments_are_rejected(plate, tmp_path, arguments, message):
    given = [str(tmp_path / word) if "." in word else word for word in arguments]
    _, err = run("medial", plate, "-o", tmp_path / "a.vtp", *given, status=2)
    assert message in err and not names(tmp_path)


def test_axes_without_sheets_are_rejected_or_reported(tmp_path):
    run("make", "torus", "-o", tmp_path / "t.ply")
    medial_of = ["medial", tmp_path / "t.ply", "-o", tmp_path / "a.vtp", "--resolution", 32, "--theta", 170, "--extend"]
    _, err = run(*medial_of, tmp_path / "s.stl", status=2)
    assert ".stl files hold only triangles, and the axis has none" in err and names(tmp_path) == ["t.ply"]
    out, _ = run(*medial_of, tmp_path / "s.obj")
    assert "the axis has no rims" in out and names(tmp_path) == ["a.vtp", "s.obj", "t.ply"]


def test_images_need_smooth_to_be_extended(tmp_path):
    run("make", "ball_image", "-o", tmp_path / "b.nrrd")
    _, err = run("medial", tmp_path / "b.nrrd", "-o", tmp_path / "a.vtp", "--extend", tmp_path / "s.ply", status=2)
    assert "--smooth" in err and names(tmp_path) == ["b.nrrd"]
