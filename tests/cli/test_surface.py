"""Proves that `blum surface` writes the mesh of a level of a field and rejects fields without that level."""

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    """Fields of a ball of radius 1 around the origin."""
    folder = tmp_path_factory.mktemp("surface")
    run("make", "sphere", "-o", folder / "ball.ply", "--radius", 1)
    bounds = ("--bounds", "-2,-2,-2,2,2,2", "--resolution", 40)
    for name in ("ball.nrrd", "ball.npz", "ball.vti"):
        run("field", folder / "ball.ply", "-o", folder / name, *bounds)
    run("field", folder / "ball.ply", "-o", folder / "unsigned.npz", "--sign", "none", *bounds)
    run("field", folder / "ball.ply", "-o", folder / "band.npz", "--band", 0.3, *bounds)
    return folder


def radii(path):
    vertices = [line.split()[1:] for line in path.read_text().splitlines() if line.startswith("v ")]
    return np.linalg.norm(np.array(vertices, dtype=float), axis=1)


@pytest.mark.parametrize("end", ["nrrd", "npz", "vti"])
@pytest.mark.parametrize("level", [None, 0.5, -0.5])
def test_the_surface_lies_at_the_level(ball, tmp_path, end, level):
    given = [] if level is None else ["--level", level]
    summary = run_json("surface", ball / f"ball.{end}", "-o", tmp_path / "s.obj", *given)
    assert summary["command"] == "surface" and summary["level"] == (level or 0)
    off = radii(tmp_path / "s.obj")
    assert len(off) == summary["surface"]["vertices"] and np.abs(off - 1 - (level or 0)).max() < 0.02
    facts = run_json("info", tmp_path / "s.obj")
    assert str(summary["outputs"][0]) == str(tmp_path / "s.obj") and facts


@pytest.mark.parametrize("end", ["obj", "off", "stl", "ply"])
def test_every_format_of_meshes_is_written(ball, tmp_path, end):
    out, _ = run("surface", ball / "ball.npz", "-o", tmp_path / f"s.{end}")
    assert "triangles at the level 0" in out and names(tmp_path) == [f"s.{end}"]


def test_fields_without_the_level_are_rejected_and_nothing_is_written(ball, tmp_path):
    for arguments, reason in [
        (("ball.npz", "--level", 9), "or all are below"),
        (("ball.npz", "--level", -3), "or all are below"),
        (("unsigned.npz",), "are unsigned"),
        (("band.npz", "--level", 1), "up to 0.3 only"),
    ]:
        name, *rest = arguments
        _, err = run("surface", ball / name, "-o", tmp_path / "s.ply", *rest, status=1)
        assert "no surface at the level" in err and reason in err
    for arguments in [("--level", "nan"), ("--level", "x"), ("-o", "s.nrrd"), ("-o", "s.png")]:
        run("surface", ball / "ball.npz", "-o", tmp_path / "s.ply", *arguments, status=2)
    assert "not a field" in run("surface", ball / "ball.ply", "-o", tmp_path / "s.ply", status=1)[1]
    assert names(tmp_path) == []


def test_reconstruct_names_the_verb_for_fields(ball, tmp_path):
    for name in ("ball.nrrd", "ball.npz", "ball.vti"):
        _, err = run("reconstruct", ball / name, "-o", tmp_path / "s.ply", status=2)
        assert "blum surface FIELD --level L -o MESH" in err
    assert "--level" in run("surface", "--help")[0]
