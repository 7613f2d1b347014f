"""Proves that meshes of other packages are accepted, and welded on request."""

from types import SimpleNamespace

import numpy as np
import pytest

blum = pytest.importorskip("blum")


def test_tensors_of_open3d_are_meshes():
    box = blum.generate("box")

    class Tensor:
        def __init__(self, values):
            self._values = values

        def cpu(self):
            return self

        def numpy(self):
            return self._values

    mesh = SimpleNamespace(
        vertex={"positions": Tensor(box.vertices.astype(np.float32))},
        triangle={"indices": Tensor(box.triangles.astype(np.int64))},
    )
    assert blum.topology(mesh).betti == (1, 0, 0)
    with pytest.raises(TypeError, match=r"vertex\.positions"):
        blum.topology(SimpleNamespace(vertex={}, triangle={}))


def test_every_function_of_a_mesh_welds_seams_on_request():
    box = blum.generate("box")
    seams = blum.Mesh(box.vertices[box.triangles.ravel()], np.arange(3 * len(box.triangles)).reshape(-1, 3))
    assert not blum.topology(seams).closed and blum.topology(seams, weld=0).betti == (1, 0, 0)
    assert blum.distance_field(seams, resolution=8, weld=0).sign_rule == "normals"
    assert blum.solid_rule(seams, weld=0).rule == "polyhedron"
    assert blum.medial_axis(seams, resolution=16, weld=0).report.rule == "polyhedron"
    assert blum.closest_points(seams, [[0, 0, 3]], weld=0).distance.shape == (1,)
    with pytest.raises(blum.InvalidOption, match="tolerance"):
        blum.topology(seams, weld=-1)
    points = [[0, 0, 3]]
    solver = blum.FieldSolver(blum.Grid.around(seams, resolution=8))
    assert solver.compute(seams).sign_rule == "winding" and solver.compute(seams, weld=0).sign_rule == "normals"
    assert len(blum.noisy(seams, 0.01, weld=0).vertices) == len(blum.weld(seams).vertices)
    assert len(blum.subdivided(seams, weld=0).vertices) == len(blum.subdivided(box).vertices)
    assert blum.reference.nearest(seams, points, weld=0)[0] == blum.reference.nearest(seams, points)[0]
    assert abs(blum.reference.winding_number(seams, points, weld=0)[0]) < 1e-9


def test_meshes_that_are_open_only_along_seams_cause_a_warning(recwarn):
    box = blum.generate("box")
    corners = box.triangles.ravel()
    apart = SimpleNamespace(vertices=box.vertices[corners], faces=np.arange(len(corners)).reshape(-1, 3))
    with pytest.warns(blum.InputWarning, match="weld=0 merges them"):
        assert not blum.topology(apart).closed
    recwarn.clear()
    assert blum.topology(apart, weld=0).closed
    whole = SimpleNamespace(vertices=box.vertices, faces=box.triangles)
    opened = SimpleNamespace(vertices=apart.vertices[3:], faces=apart.faces[:-1])
    for mesh in (whole, opened, blum.Mesh(apart.vertices, apart.faces), (apart.vertices, apart.faces)):
        blum.topology(mesh)
    assert not recwarn.list
