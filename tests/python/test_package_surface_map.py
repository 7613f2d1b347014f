"""Proves known values, shapes and errors of surface maps, thickness, Hausdorff distances and deviations."""

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def organic():
    return blum.generate("organic", frequency=6)


@pytest.fixture(scope="module")
def torus():
    return blum.generate("torus")


def test_maps_hold_exact_distances(organic, torus):
    found = blum.surface_distance_map(organic, torus, texel=0.05)
    height, width = found.distance.shape
    assert found.distance.dtype == np.float32 and found.vector.shape == (height, width, 3)
    assert found.triangle.shape == found.site.shape == (height, width)
    assert np.array_equal(np.isnan(found.distance), found.triangle < 0)
    known = found.triangle >= 0
    assert np.allclose(np.linalg.norm(found.vector[known], axis=1), found.distance[known], rtol=1e-5, atol=1e-6)
    # Barycentric coordinates of the centre of each texel in its triangle.
    t = found.triangle[known]
    rows, columns = np.nonzero(known)
    middle = np.stack([columns + 0.5, rows + 0.5], axis=1)
    a, b, c = (found.corners[t, k] for k in range(3))
    whole = cross(b - a, c - a)
    u, v = cross(middle - a, c - a) / whole, cross(b - a, middle - a) / whole
    inside = (u >= 0) & (v >= 0) & (u + v <= 1)
    assert inside.mean() > 0.3
    corners = organic.vertices[organic.triangles[t]]
    points = (corners * np.stack([1 - u - v, u, v], axis=1)[:, :, None]).sum(1)[inside]
    exact = blum.closest_points(torus, points, sign="none")
    assert np.allclose(exact.distance, found.distance[known][inside], atol=1e-6)
    assert np.allclose(blum.closest_points(torus, organic.vertices, sign="none").distance, found.vertex_distance)
    assert (found.error > 0).all() and found.error.max() < 0.06
    assert found.texture_coordinates.min() > 0 and found.texture_coordinates.max() < 1
    for k in (0, 17):
        values = found.distance[found.triangle == k]
        assert np.allclose(found.faces[k], [values.min(), values.max(), values.mean()], atol=1e-6)


def cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def test_maps_are_written(organic, torus, tmp_path):
    found = blum.surface_distance_map(organic, torus, texel=0.1)
    for extension in ("npz", "png", "glb", "ply", "vtp"):
        found.write(tmp_path / f"map.{extension}", units="mm", range=(0, 1))
        assert (tmp_path / f"map.{extension}").stat().st_size > 1000
    held = np.load(tmp_path / "map.npz")
    assert np.array_equal(held["distance"], found.distance, equal_nan=True)
    assert np.array_equal(held["vertices"], organic.vertices)
    with pytest.raises(blum.InvalidOption, match="extension"):
        found.write(tmp_path / "map.obj")
    with pytest.raises(blum.InvalidOption, match="range"):
        found.write(tmp_path / "map.png", range=(2, 1))
    with pytest.raises(blum.FileError):
        found.write(tmp_path / "none" / "map.png")


def test_meshes_that_move_keep_their_texture(organic, torus):
    mapper = blum.SurfaceMapper(organic, torus, texel=0.1)
    first = mapper.map()
    mapper.move_target(organic.vertices * 1.5)
    mapper.move_other(torus.vertices + np.array([0, 0, 2]))
    second = mapper.map()
    assert np.array_equal(first.triangle, second.triangle) and np.array_equal(first.corners, second.corners)
    moved = blum.Mesh(torus.vertices + np.array([0, 0, 2]), torus.triangles)
    exact = blum.closest_points(moved, organic.vertices * 1.5, sign="none").distance
    assert np.array_equal(second.vertex_distance, exact)
    mapper.replace_other(blum.generate("sphere"))
    assert not np.array_equal(mapper.map().vertex_distance, exact)
    with pytest.raises(blum.InvalidMesh):
        mapper.move_target(torus.vertices)


def test_given_texture_coordinates(torus):
    square = blum.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    places = np.array([[0.1, 0.1], [0.9, 0.1], [0.9, 0.9], [0.1, 0.9]])[square.triangles]
    found = blum.SurfaceMapper(square, torus, texture_coordinates=places, texture_size=(64, 32)).map()
    assert found.distance.shape == (32, 64) and np.allclose(found.texture_coordinates, places)
    exact = blum.closest_points(torus, [[0.5, 0.5, 0]], sign="none").distance[0]
    assert abs(found.distance[16, 32] - exact) <= found.error.max() < 0.1
    with pytest.raises(blum.InvalidOption, match="cover the same texel"):
        blum.SurfaceMapper(square, torus, texture_coordinates=places[[0, 0]], texture_size=(64, 64))
    with pytest.raises(ValueError, match="shape"):
        blum.SurfaceMapper(square, torus, texture_coordinates=places[0])


def test_several_others_are_distinguished(organic):
    left = blum.generate("sphere", frequency=3)
    right = blum.Mesh(left.vertices + np.array([6, 0, 0]), left.triangles)
    wide = blum.Mesh(organic.vertices * [4, 1, 1] + np.array([3, 0, 0]), organic.triangles)
    found = blum.surface_distance_map(wide, left, right, texel=0.2)
    known = found.triangle >= 0
    assert set(np.unique(found.object[known])) == {0, 1} and (found.object[~known] == -1).all()
    alone = [blum.surface_distance_map(wide, each, texel=0.2).distance for each in (left, right)]
    assert np.allclose(found.distance[known], np.minimum(*alone)[known])
    clear = known & (np.abs(alone[0] - alone[1]) > 1e-5)
    assert clear.sum() > 0.9 * known.sum()
    assert np.array_equal(found.object[clear] == 1, (alone[1] < alone[0])[clear])
    signed = blum.surface_distance_map(wide, left, right, texel=0.2, sign="auto")
    assert (signed.distance[known] < 0).any() and signed.sign_rule == "normals"


def test_far_things_are_left_out(organic, torus):
    found = blum.surface_distance_map(organic, torus, texel=0.1, max_distance=0.2)
    known = found.triangle >= 0
    assert np.isinf(found.distance[known]).any() and (found.site[np.isinf(found.distance)] == -1).all()


def test_self_maps_leave_neighbours_out(torus):
    found = blum.self_distance_map(torus, texel=0.2)
    assert found.quantity == "self-distance" and np.nanmin(found.distance) > 0


def test_thickness_of_a_plate():
    plate = blum.generate("box", size_x=4, size_y=3, size_z=0.5)
    assert sorted({round(value, 9) for value in blum.thickness(plate).thickness}) == [0.5, 3, 4]
    points = np.array([[[0.3, 0.2, 0.25], [0.1, 1.4, 0.25]]])
    ball = blum.thickness(plate, points, kind="ball")
    assert ball.thickness.shape == (1, 2) and ball.opposite.shape == (1, 2, 3)
    assert np.allclose(ball.thickness, [[0.5, 0.2]], atol=1e-5)
    whole = blum.thickness_map(plate, kind="ball", texel=0.1)
    assert whole.quantity == "ball-thickness" and whole.error is None and np.nanmax(whole.distance) <= 0.50001
    with pytest.raises(blum.InvalidOption, match="kind"):
        blum.thickness(plate, kind="cube")
    with pytest.raises(blum.InvalidOption, match="separation"):
        blum.thickness(plate, kind="ball", separation=200)


def test_hausdorff_distances_are_intervals(organic):
    moved = blum.Mesh(organic.vertices + np.array([0, 0, 0.125]), organic.triangles)
    found = blum.hausdorff_distance(organic, moved, tolerance=1e-4)
    assert found.lower <= 0.125 and found.upper - found.lower <= 1e-4 and found.upper > 0.1
    ends = np.array(found.points)
    assert np.isclose(np.linalg.norm(ends[0] - ends[1]), found.lower)
    one = blum.directed_hausdorff_distance(organic, moved, tolerance=1e-4)
    assert (one.lower, one.upper) == (found.forward.lower, found.forward.upper)
    assert max(found.forward.upper, found.backward.upper) == found.upper
    with pytest.raises(blum.InvalidOption, match="tolerance"):
        blum.hausdorff_distance(organic, moved, tolerance=0)


def test_deviations_are_by_area():
    slope = blum.Mesh([[0, 0, 0], [2, 0, 1], [2, 3, 1], [0, 3, 0]], [[0, 1, 2], [0, 2, 3]])
    plane = blum.Mesh([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], [[0, 1, 2], [0, 2, 3]])
    found = blum.surface_deviation(slope, plane, pieces=20000)
    assert np.isclose(found.mean, 0.5, atol=1e-5) and abs(found.rms - 3**-0.5) <= found.rms_error
    assert np.allclose(found.percentiles, [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99], atol=found.percentile_error)


def test_wrong_arguments_are_rejected(organic):
    with pytest.raises(TypeError, match="self_distance_map"):
        blum.surface_distance_map(organic)
    with pytest.raises(blum.InvalidOption, match="16384"):
        blum.surface_distance_map(organic, organic, texel=1e-7)
    with pytest.raises(TypeError, match="texels"):
        blum.surface_distance_map(organic, organic, texels=3)
    with pytest.raises(blum.InvalidMesh):
        blum.hausdorff_distance(organic, blum.Mesh([[np.nan, 0, 0]], points=[0]))


@pytest.mark.parametrize("kind", ["distance", "self", "thickness"])
def test_maps_are_read_as_they_were_written(tmp_path, kind):
    part, other = blum.generate("torus"), blum.generate("box")
    if kind == "distance":
        map = blum.surface_distance_map(part, other, texel=0.1, sign="auto")
    elif kind == "self":
        map = blum.self_distance_map(part, texel=0.1, max_distance=0.2)
    else:
        map = blum.thickness_map(part, texel=0.1)
    map.write(tmp_path / "map.npz", units="mm")
    again = blum.read_surface_map(tmp_path / "map.npz")
    assert (again.quantity, again.sign_rule, again.sign_reason) == (map.quantity, map.sign_rule, map.sign_reason)
    for name in ("distance", "vector", "site", "triangle", "corners", "vertex_distance", "faces"):
        assert np.array_equal(getattr(again, name), getattr(map, name), equal_nan=name != "site"), name
    assert (again.error is None) == (map.error is None) and (
        map.error is None or np.array_equal(again.error, map.error)
    )
    assert np.array_equal(again.mesh.vertices, part.vertices) and np.array_equal(again.mesh.triangles, part.triangles)
    assert again.statistics() == map.statistics()
    again.write(tmp_path / "again.glb")
    with pytest.raises(ValueError, match="do not record which"):
        _ = again.object
    with pytest.raises(blum.FormatError, match="does not hold a surface map"):
        blum.distance_field(part, resolution=8).write(tmp_path / "field.npz")
        blum.read_surface_map(tmp_path / "field.npz")


def test_statistics_are_by_area():
    plate = blum.generate("box", size_x=4, size_y=3, size_z=0.5)
    thick = blum.thickness_map(plate, texel=0.05).statistics()
    assert thick.area == pytest.approx(31) and thick.measured_area == thick.area
    assert thick.mean == pytest.approx((24 * 0.5 + 4 * 3 + 3 * 4) / 31)
    assert thick.percentiles[3] == pytest.approx(0.5) and thick.percentiles[6] == pytest.approx(4)
    near = blum.surface_distance_map(plate, blum.generate("sphere"), texel=0.1, max_distance=0.1).statistics()
    assert 0 < near.measured_area < near.area and near.largest <= np.float32(0.1)
