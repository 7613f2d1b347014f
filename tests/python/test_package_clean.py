"""Proves that blum.clean_mesh() keeps the topology and the tolerance, and returns the numbers of kept vertices."""

import subprocess
import sys

import blum
import numpy as np
import pytest
from made import made_solid, names


def test_a_cleaned_mesh_and_its_report():
    shape = blum.noisy(blum.subdivided(blum.generate("bracket"), 2), 1e-7)
    found = blum.clean_mesh(shape, 1e-5)
    report = found.report
    assert len(found.mesh.triangles) == report.triangles < report.triangles_before / 10
    assert np.array_equal(found.mesh.vertices, shape.vertices[found.vertex_of])
    assert (np.diff(found.vertex_of.astype(np.int64)) > 0).all()
    assert report.betti == report.betti_before == blum.topology(found.mesh).betti == (1, 4, 0)
    assert len(blum.self_intersections(found.mesh).pairs) == 0
    assert blum.hausdorff_distance(shape, found.mesh, tolerance=1e-6).lower <= report.deviation <= 1e-5
    assert repr(report).startswith("CleanReport(")
    again = blum.clean_mesh(shape, 1e-5, threads=1)
    assert np.array_equal(again.mesh.triangles, found.mesh.triangles)


# One solid of every second family: plates, slits, needles, screws, lattices, chains.
@pytest.mark.parametrize("family, variant", names()[:40:2], ids=[f"{f}-{v}" for f, v in names()[:40:2]])
def test_made_solids_keep_their_topology_and_stay_near(family, variant):
    made = made_solid(family, variant)
    if len(made.triangles) > 20_000:
        pytest.skip("too large for a test that is quick")
    size = np.linalg.norm(np.ptp(made.vertices, axis=0))
    for part in (1e-6, 1e-3, 0.03):
        try:
            found = blum.clean_mesh((made.vertices, made.triangles), part * size)
        except blum.InvalidMesh as error:
            assert "touches itself" in str(error)  # bodies may touch each other
            return
        assert found.report.betti == made.betti
        assert found.report.deviation <= part * size
        apart = blum.hausdorff_distance(
            (made.vertices, made.triangles), found.mesh, tolerance=0.1 * part * size, max_points=200_000
        )
        assert apart.lower <= found.report.deviation * (1 + 1e-9) + 1e-14 * size


def test_wrong_meshes_and_options_are_rejected():
    box = blum.generate("box")
    with pytest.raises(blum.InvalidMesh, match="closed"):
        blum.clean_mesh((box.vertices, box.triangles[1:]), 0.1)
    for tolerance in (0, -1, float("nan"), 1e9):
        with pytest.raises(blum.InvalidOption, match="tolerance"):
            blum.clean_mesh(box, tolerance)
    with pytest.raises(TypeError):
        blum.clean_mesh(box)
    with pytest.raises(TypeError):
        blum.clean_mesh(box, "much")
    seams = box.vertices[box.triangles.ravel()], np.arange(36).reshape(12, 3)
    assert len(blum.clean_mesh(seams, 0.1, weld=0).mesh.vertices) == 8


def test_progress_is_shown():
    code = "import blum; blum.clean_mesh(blum.subdivided(blum.generate('box'), 5), 1e-6, progress=True)"
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_parts_that_face_the_wrong_way_are_reversed():
    part = blum.generate("bracket")
    triangles = part.triangles.copy()
    triangles[5] = triangles[5, ::-1]
    found = blum.oriented_mesh((part.vertices, triangles[:, ::-1]))
    assert (found.reversed_triangles, found.reversed_shells) == (1, 1)
    assert found.mesh.triangles.shape == triangles.shape and blum.topology(found.mesh).betti == (1, 4, 0)
    assert blum.voronoi_complex(found.mesh).report.certified
    with pytest.warns(blum.InputWarning, match="1 triangle faces another way") as told:
        assert blum.voronoi_complex((part.vertices, triangles)).report.certified
        assert blum.clean_mesh((part.vertices, triangles), 1e-6).report.reversed_triangles == 1
    assert [warning.message.code for warning in told] == 2 * ["reversed-shells"]
    with pytest.raises(blum.InvalidMesh, match="not closed"):
        blum.oriented_mesh((part.vertices, triangles[1:]))
