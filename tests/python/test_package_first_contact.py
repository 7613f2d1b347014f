"""Proves that the package returns the first of all collisions, for scenes and in one call."""

import blum
import numpy as np
import pytest

BOX = blum.generate("box", segments=3)


def first_row(found):
    """Time, kind and numbers of the first of all collisions. Between equal times the order of kinds decides."""
    first, second = 0, 1
    rows = [
        (float(time), 0 if row[0] == first else 1, *row.tolist())
        for row, time in zip(found.vertex_face, found.vertex_face_time, strict=True)
    ]
    rows += [(float(time), 2, *row.tolist()) for row, time in zip(found.edge_edge, found.edge_edge_time, strict=True)]
    assert {row[2] for row in rows} <= {first, second}
    return min(rows)


def contact_row(contact):
    if contact.kind == "edge_edge":
        (a, b), (c, d) = contact.edges
        assert contact.vertex is None and contact.face is None
        return contact.time, 2, contact.object[0], a, b, contact.object[1], c, d
    assert contact.edges is None
    is_first = contact.kind == "vertex_face"
    of_vertex, of_face = contact.object if is_first else contact.object[::-1]
    return contact.time, 0 if is_first else 1, of_vertex, contact.vertex, of_face, contact.face


@pytest.mark.parametrize("aside", [[0, 0], [0.25, 0.125], [0.03, 0.01]])
@pytest.mark.parametrize("fall", [4.0, 3.0])
def test_the_first_of_all_collisions(aside, fall):
    scene = blum.ProximityScene()
    start = BOX.vertices + np.array([*aside, 3])
    scene.add(BOX)
    scene.add((start, BOX.triangles))
    end = start - [0, 0, fall]
    expected = first_row(scene.continuous({1: end}))
    for threads in (1, 2):
        found = scene.first_contact({1: end}, threads=threads)
        assert contact_row(found) == expected
    assert blum.first_contact(BOX, BOX, (start, BOX.triangles), end) == found
    earlier = scene.first_contact({1: end}, min_separation=0.5)
    assert earlier.time < found.time


def test_one_mesh_meets_itself():
    ball = blum.generate("sphere", frequency=4)
    end = ball.vertices * [1, 1, -0.3]
    found = blum.first_contact(ball, end)
    assert found.time == blum.continuous_collisions(ball, end).earliest
    assert found.object == (0, 0)


def test_nothing_meets():
    scene = blum.ProximityScene()
    scene.add(BOX)
    scene.add((BOX.vertices + 3, BOX.triangles))
    assert scene.first_contact({1: BOX.vertices + 2}) is None
    assert blum.first_contact(BOX, BOX) is None
    assert blum.first_contact(BOX, BOX.vertices - 1, (BOX.vertices + 3, BOX.triangles)) is None


def test_wrong_arguments_are_rejected():
    with pytest.raises(TypeError, match="other_end is given, but other is not"):
        blum.first_contact(BOX, BOX, other_end=BOX)
    with pytest.raises(ValueError, match="same number"):
        blum.first_contact(BOX, BOX.vertices[:2])
    with pytest.raises(ValueError, match="same number"):
        blum.first_contact(BOX, BOX, BOX, BOX.vertices[:2])
    with pytest.raises(blum.InvalidOption, match="tolerance"):
        blum.first_contact(BOX, BOX, tolerance=0)
    with pytest.raises(TypeError, match="speed"):
        blum.first_contact(BOX, BOX, speed=1)
    with pytest.raises(blum.InvalidMesh, match="finite"):
        blum.first_contact(BOX, np.full_like(BOX.vertices, np.nan))
    with pytest.raises(blum.InvalidOption, match="object 9"):
        blum.ProximityScene().first_contact({9: BOX.vertices})
