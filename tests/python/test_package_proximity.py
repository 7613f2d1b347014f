"""Proves that the package's continuous collisions equal those of single queries, for every kind of array.

Wrong arguments are rejected by name."""

import numpy as np
import pytest

blum = pytest.importorskip("blum")

TRIANGLE = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]


def questions(count, seed):
    return np.random.default_rng(seed).integers(-3, 4, (2, count, 4, 3)).astype(np.float64)


def test_all_pairs_equal_those_of_single_queries():
    random = np.random.default_rng(1)
    vertices = random.uniform(size=(40, 1, 3)).repeat(3, axis=1) + random.normal(scale=0.3, size=(40, 3, 3))
    vertices = vertices.reshape(-1, 3)
    triangles = np.arange(120).reshape(40, 3)
    end = vertices + random.normal(scale=0.3, size=vertices.shape)
    found = blum.continuous_collisions((vertices, triangles), end)
    pairs = [(v, f) for v in range(120) for f in range(40) if v not in triangles[f]]
    four = np.array([[v, *triangles[f]] for v, f in pairs])
    times = blum.vertex_face_impacts(vertices[four], end[four])
    met = ~np.isnan(times)
    assert 10 < met.sum() == len(found.vertex_face)
    assert np.array_equal(found.vertex_face, four[met]) and np.array_equal(found.vertex_face_time, times[met])
    assert np.array_equal(found.face, [f for _, f in np.array(pairs)[met]])
    edges = sorted(tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles.tolist() for k in range(3))
    four = np.array([[*a, *b] for n, a in enumerate(edges) for b in edges[n + 1 :] if not set(a) & set(b)])
    times = blum.edge_edge_impacts(vertices[four], end[four], threads=2)
    met = ~np.isnan(times)
    assert np.array_equal(found.edge_edge, four[met]) and np.array_equal(found.edge_edge_time, times[met])
    assert found.earliest == min(found.vertex_face_time.min(), found.edge_edge_time.min())
    assert found.exact_tests <= found.box_pairs
    assert (
        repr(found) == f"ContinuousCollisions({len(found.vertex_face)} vertex_face, {len(found.edge_edge)} edge_edge)"
    )


def test_meshes_without_contact_give_empty_results():
    found = blum.continuous_collisions((TRIANGLE, [[0, 1, 2]]), TRIANGLE)
    assert found.vertex_face.shape == (0, 4) == found.edge_edge.shape and found.earliest is None
    assert blum.vertex_face_impacts(np.zeros((0, 4, 3)), np.zeros((0, 4, 3))).shape == (0,)


def test_times_are_early_by_no_more_than_the_tolerance():
    start, end = questions(300, 2)
    exact = blum.vertex_face_impacts(start, end, tolerance=1e-11)
    for tolerance in (1e-3, 0.25, 1):
        times = blum.vertex_face_impacts(start, end, tolerance=tolerance)
        assert np.array_equal(np.isnan(times), np.isnan(exact))
        known = ~np.isnan(times)
        assert (times[known] <= exact[known] + 1e-11).all() and (times[known] >= exact[known] - tolerance).all()


def test_arrays_of_other_kinds_are_taken():
    start, end = questions(20, 3)
    times = blum.edge_edge_impacts(start, end)
    for given in ((start.astype(np.int64), end.astype(np.float32)), (start.tolist(), np.asfortranarray(end))):
        assert np.array_equal(blum.edge_edge_impacts(*given), times, equal_nan=True)


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (lambda: blum.continuous_collisions((TRIANGLE, [[0, 1, 2]]), TRIANGLE[:2]), ValueError, "same number"),
        (lambda: blum.continuous_collisions((TRIANGLE, [[0, 1, 2]]), [1, 2, 3]), ValueError, "end has the shape"),
        (lambda: blum.continuous_collisions((TRIANGLE, [[0, 1, 2]]), "x"), FileNotFoundError, "x"),
        (
            lambda: blum.continuous_collisions((TRIANGLE, [[0, 1, 2]]), np.full((3, 3), np.nan)),
            ValueError,
            "at the end",
        ),
        (lambda: blum.continuous_collisions(3, TRIANGLE), TypeError, "mesh is a int"),
        (lambda: blum.vertex_face_impacts(np.zeros((2, 4, 3)), np.zeros((1, 4, 3))), ValueError, "equal numbers"),
        (lambda: blum.vertex_face_impacts(np.zeros((4, 3)), np.zeros((4, 3))), ValueError, r"must have \(n, 4, 3\)"),
        (lambda: blum.edge_edge_impacts(np.full((1, 4, 3), np.inf), np.zeros((1, 4, 3))), ValueError, "not finite"),
        (lambda: blum.edge_edge_impacts(*questions(1, 4), tolerance=0), ValueError, "tolerance"),
        (lambda: blum.edge_edge_impacts(*questions(1, 4), tolerence=1), TypeError, "tolerence"),
    ],
)
def test_wrong_arguments_are_refused_by_name(call, error, text):
    with pytest.raises(error, match=text):
        call()
