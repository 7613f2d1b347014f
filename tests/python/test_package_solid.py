"""Proves that blum.Solid finds the bodies and the inside of meshes and images, and that certificates use them."""

import warnings

import blum
import numpy as np
import pytest


def box(lower, upper, is_reversed=False):
    x, y, z = np.array([lower, upper], dtype=float).T
    corners = np.array([[a, b, c] for c in z for b in y for a in x])
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])
    return corners, triangles[:, ::-1] if is_reversed else triangles


def joined(*meshes):
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([triangles + start for start, (_, triangles) in zip(starts, meshes, strict=False)]),
    )


def test_bodies_shells_and_points_of_a_polyhedron():
    hollow = joined(box((0, 0, 0), (9, 9, 9)), box((3, 3, 3), (6, 6, 6), True), box((4, 4, 4), (5, 5, 5)))
    solid = blum.Solid(*hollow)
    assert (solid.rule, solid.betti, solid.reversed_shells) == ("polyhedron", (2, 0, 1), 0)
    assert [(shell.depth, shell.parent) for shell in solid.shells] == [(0, None), (1, 0), (2, 1)]
    assert [shell.volume for shell in solid.shells] == pytest.approx([729, 27, 1])
    outer, inner = solid.bodies
    assert (outer.betti, inner.betti) == ((1, 0, 1), (1, 0, 0))
    assert np.array_equal(hollow[0][outer.vertex_of], outer.mesh.vertices)
    assert np.array_equal(outer.vertex_of[outer.mesh.triangles], hollow[1][outer.triangle_of])
    points = np.array([[[1, 1, 1], [3.5, 3.5, 3.5]], [[4.5, 4.5, 4.5], [10, 0, 0]]])
    assert solid.inside(points).tolist() == [[True, False], [True, False]]
    assert solid.bounds == ((0, 0, 0), (9, 9, 9))


def test_parts_that_face_the_wrong_way_are_reversed():
    solid = blum.Solid(*box((0, 0, 0), (1, 2, 3), True))
    assert solid.reversed_shells == 1 and solid.shells[0].is_reversed
    assert solid.inside([0.5, 1, 1.5])
    vertices, triangles = box((0, 0, 0), (1, 2, 3))
    triangles[3] = triangles[3, ::-1]
    assert blum.Solid(vertices, triangles).reversed_triangles == 1


def test_open_meshes_are_decided_by_winding_numbers():
    vertices, triangles = box((0, 0, 0), (1, 1, 1))
    solid = blum.Solid(vertices, triangles[1:])
    assert (solid.rule, solid.betti) == ("winding", None)
    assert "open" in solid.reason or "border" in solid.reason or "closed" in solid.reason
    assert solid.inside([[0.5, 0.5, 0.5], [2, 0, 0]]).tolist() == [True, False]
    assert blum.Solid(vertices, triangles[1:, ::-1]).faces_inwards


def test_images_are_their_selected_voxels():
    image = np.zeros((4, 5, 6), dtype=np.uint8)
    image[1, 1, 1], image[3, 3, 3] = 1, 2
    assert blum.Solid(image).betti == (2, 0, 0)
    solid = blum.Solid(image, label=2)
    assert (solid.rule, solid.betti) == ("voxels", (1, 0, 0))
    assert solid.inside([[3, 3, 3], [1, 1, 1]]).tolist() == [True, False]
    assert blum.Solid(image, threshold=1.5).betti == (1, 0, 0)
    with pytest.raises(blum.InvalidOption, match="exclude"):
        blum.Solid(image, label=1, threshold=1)
    with pytest.raises(blum.InvalidOption, match="mesh"):
        blum.Solid(*box((0, 0, 0), (1, 1, 1)), label=1)
    with pytest.raises(ValueError, match="finite"):
        solid.inside([np.nan, 0, 0])


def test_a_certificate_against_another_selection_causes_a_warning(tmp_path):
    image = np.zeros((12, 12, 12), dtype=np.uint8)
    image[2:5, 2:9, 2:5], image[7:10, 2:9, 7:10] = 1, 2
    blum.medial_axis(image, label=1).simplify(60).write(tmp_path / "axis.npz")
    axis = blum.read_medial(tmp_path / "axis.npz")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert blum.certify(axis, image)
        assert blum.certify(axis, image, label=1)
    with pytest.warns(blum.InputWarning, match="computed with label=1; label=2 is used, because it was given"):
        assert not blum.certify(axis, image, label=2)


def test_a_certificate_repeats_the_weld_of_the_axis(tmp_path):
    vertices, triangles = box((0, 0, 0), (1, 2, 3))
    loose = vertices[triangles].reshape(-1, 3)
    blum.Mesh(loose, np.arange(len(loose)).reshape(-1, 3)).write(tmp_path / "loose.ply")
    axis = blum.medial_axis(tmp_path / "loose.ply", weld=0, resolution=32).simplify(60)
    axis.write(tmp_path / "axis.vtp")
    read = blum.read_medial(tmp_path / "axis.vtp")
    assert blum.certify(read, tmp_path / "loose.ply")
    with pytest.warns(blum.InputWarning, match="weld=0; weld=0.001 is used"):
        assert blum.certify(read, tmp_path / "loose.ply", weld=0.001)
