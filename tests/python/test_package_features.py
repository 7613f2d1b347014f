"""Proves that the close features of a mesh equal a comparison of all pairs, and that wrong arguments are rejected."""

import numpy as np
import pytest

blum = pytest.importorskip("blum")


def corners_of(vertices, rows):
    """(n, 3, 3): rows of one, two or three vertices as triangles, of which some are degenerate."""
    rows = np.array(rows).reshape(len(rows), -1)
    return vertices[np.column_stack([rows, np.repeat(rows[:, -1:], 3 - rows.shape[1], axis=1)])]


def all_edges(triangles, segments=()):
    pairs = [(t[i], t[j]) for t in triangles for i, j in ((0, 1), (1, 2), (2, 0))] + list(segments)
    return sorted({tuple(sorted(map(int, pair))) for pair in pairs if pair[0] != pair[1]})


def compared(vertices, first, second, numbers, distance):
    """The pairs of `numbers` within `distance`, and their distances."""
    apart = blum.triangle_distances(corners_of(vertices, first), corners_of(vertices, second)).distance
    near = apart <= distance
    return np.array(numbers)[near].tolist(), apart[near].tolist()


def slow_features(mesh, distance):
    """The close features by comparing all pairs one by one."""
    vertices, triangles = np.array(mesh.vertices), mesh.triangles.tolist()
    edges = all_edges(triangles, mesh.segments.tolist())
    named = sorted({*np.ravel(triangles).astype(int), *mesh.segments.ravel().tolist(), *mesh.points.tolist()})
    faces = [(v, f) for v in named for f, corners in enumerate(triangles) if v not in corners]
    pairs = [(a, b) for b in range(len(edges)) for a in range(b) if not set(edges[a]) & set(edges[b])]
    pairs.sort()
    of_faces = compared(vertices, [[v] for v, _ in faces], [triangles[f] for _, f in faces], faces, distance)
    of_edges = compared(vertices, [edges[a] for a, _ in pairs], [edges[b] for _, b in pairs], pairs, distance)
    return (*of_faces, *of_edges, [list(edge) for edge in edges])


def crumpled(seed):
    """A sheet with random vertices, with segments and a point."""
    random = np.random.default_rng(seed)
    grid = np.arange(20).reshape(4, 5)
    a, b, c, d = (part.ravel() for part in (grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]))
    triangles = np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return blum.Mesh(random.normal(size=(26, 3)), triangles, segments=[[20, 3], [22, 21], [5, 6]], points=[24])


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("distance", [0, 0.1, 0.5, 10])
def test_close_features_equal_a_comparison_of_all_pairs(seed, distance):
    mesh = crumpled(seed)
    found = blum.close_features(mesh, distance)
    wanted = slow_features(mesh, distance)
    assert found.vertex_face.tolist() == [list(pair) for pair in wanted[0]]
    assert found.vertex_face_distance.tolist() == pytest.approx(wanted[1], rel=1e-12)
    assert found.edge_edge.tolist() == [list(pair) for pair in wanted[2]]
    assert found.edge_edge_distance.tolist() == pytest.approx(wanted[3], rel=1e-12)
    assert found.edges.tolist() == wanted[4]
    every = [*wanted[1], *wanted[3]]
    assert found.min_distance == (pytest.approx(min(every), rel=1e-12) if every else None)
    assert found.vertex_face.dtype == found.edge_edge.dtype == found.edges.dtype == np.int32


def test_neighbours_without_a_common_vertex_are_found():
    """In a strip of three triangles, the outer vertices and edges are close to the next triangle."""
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [2, 1, 0]]
    found = blum.close_features((vertices, [[0, 1, 2], [1, 3, 2], [1, 4, 3]]), 1)
    assert [0, 1] in found.vertex_face.tolist() and [4, 1] in found.vertex_face.tolist()
    named = found.edges[found.edge_edge].tolist()
    assert [[0, 1], [2, 3]] in named and not [pair for pair in named if set(pair[0]) & set(pair[1])]
    assert found.min_distance == pytest.approx(np.sqrt(0.5))


def test_vertices_in_one_place_are_one_vertex():
    box = blum.generate("box")
    loose = blum.Mesh(box.vertices[box.triangles.ravel()], np.arange(3 * len(box.triangles)).reshape(-1, 3))
    for distance in (0, 0.6, 1):
        told = []
        for mesh in (box, loose):
            found = blum.close_features(mesh, distance)
            places = [tuple(place) for place in mesh.vertices.tolist()]
            edges = [frozenset(places[end] for end in edge) for edge in found.edges.tolist()]
            faces = {(places[vertex], face) for vertex, face in found.vertex_face.tolist()}
            told.append((faces, {frozenset(edges[edge] for edge in pair) for pair in found.edge_edge.tolist()}))
        assert told[0] == told[1]
        assert [len(pairs) > 0 for pairs in told[0]] == [distance > 0.7, distance > 0]


def test_a_vertex_that_touches_a_face_is_found():
    floor, above = [[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 0], [2, 1, 2], [1, 2, 2]]
    found = blum.close_features((floor + above, [[0, 1, 2], [3, 4, 5]]), 0)
    assert found.vertex_face.tolist() == [[3, 0]] and found.vertex_face_distance.tolist() == [0]


def test_meshes_without_faces_or_edges():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 1], [1, 1, 1.0]])
    wires = blum.close_features(blum.Mesh(vertices, segments=[[0, 1], [3, 2]]), 2)
    assert wires.edges.tolist() == [[0, 1], [2, 3]] and wires.edge_edge.tolist() == [[0, 1]]
    assert wires.vertex_face.shape == (0, 2) and wires.min_distance == pytest.approx(np.sqrt(2))
    cloud = blum.close_features(blum.Mesh(vertices), 2)
    assert cloud.edges.shape == (0, 2) and cloud.edge_edge.shape == (0, 2) and cloud.min_distance is None


def test_close_features_do_not_depend_on_threads():
    mesh = blum.generate("torus", ring_segments=24, tube_segments=12)
    one, many = (blum.close_features(mesh, 0.3, threads=threads) for threads in (1, 4))
    assert len(one.edge_edge) > 0
    for name in ("vertex_face", "vertex_face_distance", "edge_edge", "edge_edge_distance", "edges"):
        assert getattr(one, name).tobytes() == getattr(many, name).tobytes()


def test_wrong_arguments_are_rejected():
    box = blum.generate("box")
    for distance, error, message in [
        (-1, blum.InvalidOption, "distance is -1"),
        (np.nan, blum.InvalidOption, "distance is"),
        ("near", TypeError, "distance must be a number"),
    ]:
        with pytest.raises(error, match=message):
            blum.close_features(box, distance)
    with pytest.raises(blum.InvalidMesh):
        blum.close_features(blum.Mesh(np.zeros((3, 3)), np.zeros((0, 3), dtype=int)), 1)
    with pytest.raises(TypeError, match="threads"):
        blum.close_features(box, 1, threads=1.5)
