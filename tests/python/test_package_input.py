"""Proves that meshes of many kinds are taken, welded where that is asked for."""

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


def test_seams_are_welded_wherever_a_mesh_is_taken():
    box = blum.generate("box")
    seams = blum.Mesh(box.vertices[box.triangles.ravel()], np.arange(3 * len(box.triangles)).reshape(-1, 3))
    assert not blum.topology(seams).closed and blum.topology(seams, weld=0).betti == (1, 0, 0)
    assert blum.distance_field(seams, resolution=8, weld=0).sign_rule == "normals"
    assert blum.solid_rule(seams, weld=0).rule == "polyhedron"
    assert blum.medial_axis(seams, resolution=16, weld=0).report.rule == "polyhedron"
    assert blum.closest_points(seams, [[0, 0, 3]], weld=0).distance.shape == (1,)
    with pytest.raises(blum.InvalidOption, match="tolerance"):
        blum.topology(seams, weld=-1)
