"""Proves the package's signed distances with gradients, winding numbers, near primitives and surface samples."""

import pickle

import blum
import numpy as np
import pytest


def test_signed_distances_are_those_of_closest_points():
    mesh = blum.generate("organic", frequency=10)
    queries = np.random.default_rng(1).normal(size=(40, 100, 3))
    found = blum.signed_distance(mesh, queries)
    expected = blum.closest_points(mesh, queries)
    assert np.array_equal(found.distance, expected.distance) and np.array_equal(found.site, expected.site)
    assert np.array_equal(found.closest, expected.closest) and np.array_equal(found.triangle, expected.triangle)
    assert found.gradient.shape == (40, 100, 3)
    assert np.allclose(np.linalg.norm(found.gradient, axis=-1), 1)
    assert np.allclose(found.closest + found.gradient * found.distance[..., None], queries)
    # A step along the gradient increases the distance by its length.
    step = 1e-6
    there = blum.signed_distance(mesh, queries + step * found.gradient)
    grown = (there.distance - found.distance) / step
    assert np.mean(np.abs(grown - 1) < 1e-3) > 0.99


def test_gradients_of_queries():
    box = blum.generate("box")
    query = blum.ClosestPointQuery(box)
    places = np.array([[[0.1, 0, 0.5], [0, 0.5, 0.5]], [[0, 0, 2], [0.3, 0, 0]]])
    assert query(places).gradient is None
    found = query(places, gradient=True)
    root = np.sqrt(0.5)
    assert np.allclose(found.gradient, [[[0, 0, 1], [0, root, root]], [[0, 0, 1], [1, 0, 0]]], atol=1e-15)
    assert np.array_equal(found.gradient, blum.signed_distance(box, places).gradient)
    assert np.array_equal(found.distance, query(places).distance)
    # The normal of a vertex is its pseudonormal, and the same bytes for any number of threads.
    mesh = blum.generate("organic", frequency=10)
    query = blum.ClosestPointQuery(mesh)
    found = query(mesh.vertices, gradient=True)
    normals = blum.pseudonormals(mesh)[: len(mesh.vertices)]
    assert np.allclose(found.gradient, normals / np.linalg.norm(normals, axis=1)[:, None], atol=1e-14)
    assert np.array_equal(found.gradient, query(mesh.vertices, gradient=True, threads=1).gradient)


def test_undefined_gradients_are_nan():
    box = blum.generate("box")
    found = blum.signed_distance(box, [[0.1, 0, 0.5], [0, 0, 2], [0, 0, 9]], max_distance=3)
    assert found.gradient[0].tolist() == [0, 0, 1] and found.distance[0] < 1e-15
    assert found.gradient[1].tolist() == [0, 0, 1]
    assert np.isnan(found.gradient[2]).all() and found.distance[2] == np.inf and found.site[2] == -1
    with pytest.raises(blum.InvalidOption, match="query 1"):
        blum.signed_distance(box, [[0, 0, 0], [0, np.nan, 0]])
    assert blum.signed_distance(box, np.zeros((0, 3))).distance.shape == (0,)


def test_many_queries_equal_few_queries():
    mesh = blum.generate("organic", frequency=20)
    queries = np.random.default_rng(2).normal(size=(30000, 3))
    many = blum.closest_points(mesh, queries)
    query = blum.ClosestPointQuery(mesh)
    few = [query(part) for part in np.split(queries[:5000], 50)]
    for name in ("distance", "site", "triangle", "closest"):
        assert np.array_equal(getattr(many, name)[:5000], np.concatenate([getattr(part, name) for part in few]))


def test_winding_numbers_are_those_of_full_sums():
    random = np.random.default_rng(5)
    closed, open_ = blum.generate("sphere", frequency=8), blum.generate("organic", frequency=8, holes=2)
    for mesh, most in ((closed, 1e-11), (open_, 1e-9)):
        points = random.normal(size=(50, 100, 3))
        found = blum.winding_number(mesh, points)
        assert found.shape == (50, 100) and np.abs(found - blum.WindingNumber(mesh)(points)).max() <= most
    assert set(np.unique(blum.winding_number(closed, points)).tolist()) == {0.0, 1.0}
    with pytest.raises(blum.InvalidOption, match="max_error"):
        blum.winding_number(closed, points, max_error=0)
    with pytest.raises(blum.InvalidOption, match="point 0"):
        blum.winding_number(closed, [[np.inf, 0, 0]])


def test_weights_give_the_closest_points():
    mesh = blum.generate("organic", frequency=10)
    found = blum.signed_distance(mesh, np.random.default_rng(6).normal(size=(20, 50, 3)))
    corners = mesh.vertices[mesh.triangles[found.triangle]]
    assert found.barycentric.shape == (20, 50, 3) and (found.barycentric >= 0).all()
    assert np.allclose((corners * found.barycentric[..., None]).sum(-2), found.closest, rtol=0, atol=1e-13)
    wires = blum.Mesh([[0, 0, 0], [1, 0, 0]], segments=[[0, 1]])
    assert np.isnan(blum.signed_distance(wires, [[0, 0, 1.0]]).barycentric).all()


def test_near_primitives_are_those_of_each_query():
    mesh = blum.generate("organic", frequency=8)
    query = blum.ClosestPointQuery(mesh)
    points = np.random.default_rng(7).normal(size=(30, 10, 3))
    few = query.nearest_primitives(points, 4)
    assert few.first.tolist() == list(range(0, 1201, 4)) and few.primitive.dtype == np.int32
    assert np.array_equal(few.distance[::4], np.abs(query(points).distance).ravel())
    assert np.allclose(np.linalg.norm(few.closest - np.repeat(points.reshape(-1, 3), 4, axis=0), axis=1), few.distance)
    near = query.within(points, 0.7, threads=1)
    assert near.first[0] == 0 and near.first[-1] == len(near.primitive) == len(near.site) > 0
    assert near.distance.max() <= 0.7 and repr(near) == f"NearPrimitives({len(near.primitive):,} of 300 queries)"
    for q in range(0, 300, 50):
        alone = query.within(points.reshape(-1, 3)[q : q + 1], 0.7)
        assert np.array_equal(alone.primitive, near.primitive[near.first[q] : near.first[q + 1]])
    with pytest.raises(blum.InvalidOption, match="distance"):
        query.within(points, -1)
    with pytest.raises(blum.InvalidOption, match="k is -1"):
        query.nearest_primitives(points, -1)
    assert query.within(np.zeros((0, 3)), 1).first.tolist() == [0]


def test_a_refitted_query_answers_as_a_new_one():
    mesh = blum.generate("organic", frequency=10)
    query = blum.ClosestPointQuery(mesh)
    points = np.random.default_rng(8).normal(size=(5000, 3))
    for scale in (1.5, [1, -1, 1], 0.1):
        moved = mesh.vertices * scale
        query.refit(moved)
        expected = blum.ClosestPointQuery((moved, mesh.triangles))
        assert query.sign_reason == expected.sign_reason
        found, other = query(points), expected(points)
        for name in ("closest", "distance", "site", "triangle"):
            assert np.array_equal(getattr(found, name), getattr(other, name))
    with pytest.raises(blum.InvalidMesh, match="vertices"):
        query.refit(mesh.vertices[1:])
    with pytest.raises(ValueError, match="vertices"):
        query.refit(mesh.vertices.ravel())


def test_gradients_of_interpolants():
    field = blum.distance_field(blum.generate("sphere"), resolution=48)
    points = np.random.default_rng(9).normal(size=(40, 5, 3)) * 0.4
    values, gradient = field.interpolate(points, gradient=True)
    assert np.array_equal(values, field.interpolate(points), equal_nan=True) and gradient.shape == (40, 5, 3)
    inside = ~np.isnan(values)
    assert np.isnan(gradient[~inside]).all() and inside.sum() > 100
    step = 1e-7
    for axis in range(3):
        there = field.interpolate(points + step * np.eye(3)[axis])
        slope = (there - values) / step
        assert np.mean(np.abs(slope - gradient[..., axis])[inside] < 1e-5) > 0.99


@pytest.mark.parametrize("blue_noise", [False, True])
def test_samples_lie_on_the_surface(blue_noise):
    mesh = blum.generate("torus")
    found = blum.sample_surface(mesh, 3000, seed=7, blue_noise=blue_noise)
    assert found.points.shape == found.normals.shape == (3000, 3) and found.triangle.dtype == np.int32
    assert np.abs(blum.closest_points(mesh, found.points, sign="none").distance).max() < 1e-15
    corners = mesh.vertices[mesh.triangles[found.triangle]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.allclose(found.normals, normals / np.linalg.norm(normals, axis=1)[:, None])
    again = blum.sample_surface(mesh, 3000, seed=7, blue_noise=blue_noise, threads=1)
    assert np.array_equal(found.points, again.points)


def test_samples_near_have_exact_distances():
    mesh = blum.generate("organic", frequency=8)
    found = blum.sample_near(mesh, 4000, sigma=0.05, in_box=0.5, seed=3)
    expected = blum.closest_points(mesh, found.points)
    assert np.array_equal(found.distance, expected.distance) and np.array_equal(found.site, expected.site)
    assert (found.distance < 0).any() and np.abs(found.distance[:2000]).max() < 0.4


def test_bad_input_is_refused():
    box = blum.generate("box")
    for call, match in (
        (lambda: blum.sample_surface(box, -1), "count is -1"),
        (lambda: blum.sample_near(box, 10, sigma=0), "sigma"),
        (lambda: blum.sample_near(box, 10, in_box=2), "in_box"),
        (lambda: blum.sample_surface(([[0, 0, 0], [1, 1, 1]], [[0, 1, 1]]), 5), "no triangle"),
    ):
        with pytest.raises(ValueError, match=match):
            call()
    with pytest.raises(TypeError, match="count"):
        blum.sample_surface(box, 1.5)
    with pytest.raises(TypeError, match="colour"):
        blum.sample_surface(box, 5, colour="red")


def test_distances_of_a_reversed_mesh_cause_a_warning():
    ball = blum.generate("sphere", frequency=4)
    inside_out = blum.Mesh(ball.vertices, ball.triangles[:, ::-1])
    calls = {
        "signed_distance": lambda: blum.signed_distance(inside_out, [[0, 0, 0]]).distance,
        "closest_points": lambda: blum.closest_points(inside_out, [[0, 0, 0]]).distance,
        "query": lambda: blum.ClosestPointQuery(inside_out)([[0, 0, 0]]).distance,
        "sample_near": lambda: blum.sample_near(inside_out, 50, in_box=1).distance,
        "field": lambda: blum.distance_field(inside_out, resolution=8).distance,
        "solver": lambda: blum.FieldSolver(blum.Grid((-1, -1, -1), 0.5, (5, 5, 5))).compute(inside_out).distance,
        "map": lambda: blum.surface_distance_map(blum.generate("box"), inside_out, texel=0.2, sign="auto").distance,
        "deviation": lambda: [blum.surface_deviation(blum.generate("box"), inside_out, sign="auto").smallest],
    }
    for name, call in calls.items():
        with pytest.warns(blum.InputWarning, match="1 shell was reversed") as issued:
            assert np.nanmin(call()) < 0, name
        assert [warning.message.code for warning in issued] == ["facing"], name
    near = blum.sample_near(ball, 10)
    assert near.sign_rule == "normals" and "faces outwards" in near.sign_reason
    with pytest.warns(blum.InputWarning, match="inside out"):
        assert blum.signed_distance(inside_out, [[0, 0, 0]], sign="winding").distance[0] > 0


def test_signed_results_carry_rule_reason_and_warnings():
    """A box inside out: every signed result names its rule, its reason and the repair, also after pickling."""
    box = blum.generate("box")
    inwards = blum.Mesh(box.vertices, box.triangles[:, ::-1])
    with pytest.warns(blum.InputWarning, match="1 shell was reversed"):
        query = blum.ClosestPointQuery(inwards)
        found = {
            "query": query,
            "query(p)": query([[0, 0, 0]]),
            "closest_points": blum.closest_points(inwards, [[0, 0, 0]]),
            "signed_distance": blum.signed_distance(inwards, [[0, 0, 0]]),
            "sample_near": blum.sample_near(inwards, 5),
            "distance_field": blum.distance_field(inwards, resolution=8),
            "surface_distance_map": blum.surface_distance_map(box, inwards, texel=0.5, sign="auto"),
        }
    for name, result in found.items():
        for each in (result, pickle.loads(pickle.dumps(result))):
            assert each.sign_rule == "normals", name
            assert each.sign_reason.endswith("after 1 shell was reversed"), name
            assert [warning.text.endswith("1 shell was reversed") for warning in each.warnings] == [True], name
    assert blum.signed_distance(box, [[0, 0, 0]]).warnings == []


def test_open_boxes_that_face_inwards_have_an_inside():
    """A box without lid: its distances are those of the box that faces outwards, with a warning."""
    box = blum.generate("box")
    lidless = box.triangles[:10]
    point = [[0.1, 0.0, 0.0]]
    right = blum.signed_distance((box.vertices, lidless), point)
    with pytest.warns(blum.InputWarning, match="1 part was reversed"):
        wrong = blum.signed_distance((box.vertices, lidless[:, ::-1]), point)
    assert right.warnings == []
    assert right.distance[0] < 0
    np.testing.assert_array_equal(wrong.distance, right.distance)
