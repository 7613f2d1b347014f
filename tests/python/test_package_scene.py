"""Proves that the package's answers about scenes equal a comparison of all pairs of triangles, also after updates.

Every kind of array gives the same answers, and wrong arguments are rejected by name."""

import dataclasses
import threading
import warnings

import numpy as np
import pytest

blum = pytest.importorskip("blum")

IDENTITY = np.eye(3)


def soup(count, seed, size=0.3):
    """(vertices, triangles): random triangles without common vertices."""
    random = np.random.default_rng(seed)
    corners = random.uniform(-1, 1, (count, 1, 3)) + random.normal(scale=size, size=(count, 3, 3))
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def turned(seed):
    """A random rotation."""
    rotation, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return rotation * np.sign(np.linalg.det(rotation))


def corners(mesh, place=None):
    vertices, triangles = mesh
    rotation, translation = place or (IDENTITY, np.zeros(3))
    return (vertices @ rotation.T + translation)[triangles]


def dot(a, b):
    return (a * b).sum(-1)


def edges_apart(p, u, q, v):
    """The distance between the segments from p along u and from q along v."""

    def clipped(x):
        return np.clip(x, 0, 1)[..., None]

    w = q - p
    best = np.full(p.shape[:-1], np.inf)
    for t in (0, 1):  # an end of one segment and the closest point of the other
        s = clipped(dot(w + t * v, u) / dot(u, u))
        best = np.minimum(best, np.linalg.norm(w + t * v - s * u, axis=-1))
        s = clipped(dot(t * u - w, v) / dot(v, v))
        best = np.minimum(best, np.linalg.norm(w + s * v - t * u, axis=-1))
    normal = np.cross(u, v)
    s, t = (dot(np.cross(w, other), normal) / dot(normal, normal) for other in (v, u))
    inside = (s > 0) & (s < 1) & (t > 0) & (t < 1)
    apart = np.abs(dot(w, normal)) / np.linalg.norm(normal, axis=-1)
    return np.where(inside, np.minimum(best, apart), best)


def corner_and_face_apart(p, q, triangle):
    """The distance of p above a triangle, infinite beside it; and True if the segment pq crosses the triangle."""
    a, b, c = triangle[:, 0], triangle[:, 1], triangle[:, 2]
    normal = np.cross(b - a, c - a)

    def inside(x):
        return np.all([dot(np.cross(e - s, x - s), normal) >= 0 for s, e in ((a, b), (b, c), (c, a))], axis=0)

    height, end = dot(p - a, normal), dot(q - a, normal)
    foot = p - (height / dot(normal, normal))[:, None] * normal
    through = p + (height / (height - end))[:, None] * (q - p)
    apart = np.abs(height) / np.linalg.norm(normal, axis=-1)
    return np.where(inside(foot), apart, np.inf), (height * end <= 0) & inside(through)


@np.errstate(divide="ignore", invalid="ignore")  # NaN of parallel edges and planes counts as outside
def slow_distances(a, b):
    """(n,): distances of pairs of triangles, not of coplanar ones that meet. Shares no code with the library."""
    best = np.full(len(a), np.inf)
    for i in range(3):
        for j in range(3):
            u, v = a[:, (i + 1) % 3] - a[:, i], b[:, (j + 1) % 3] - b[:, j]
            best = np.minimum(best, edges_apart(a[:, i], u, b[:, j], v))
    for one, other in ((a, b), (b, a)):
        for k in range(3):
            apart, passes = corner_and_face_apart(one[:, k], one[:, (k + 1) % 3], other)
            best = np.where(passes, 0, np.minimum(best, apart))
    return best


def pairs_of(a, b):
    """All pairs of n and m triangles."""
    return np.repeat(a, len(b), axis=0), np.tile(b, (len(a), 1, 1))


def all_distances(a, b):
    """(n, m): the distances of all pairs."""
    return slow_distances(*pairs_of(a, b)).reshape(len(a), len(b))


def on_feature(point, triangle, feature):
    """True if a point lies in the hull of the corners of a feature."""
    own = triangle[[k for k in feature if k >= 0]]
    if len(own) == 1:
        return np.allclose(point, own[0], atol=1e-9)
    weights = np.linalg.lstsq((own[1:] - own[0]).T, point - own[0], rcond=None)[0]
    return (
        np.allclose(own[0] + weights @ (own[1:] - own[0]), point, atol=1e-9)
        and weights.min() > -1e-9
        and weights.sum() < 1 + 1e-9
    )


def test_distances_of_triangles_equal_those_of_edges_and_faces():
    a, b = pairs_of(corners(soup(60, 1, 0.5)), corners(soup(60, 2, 0.5)))
    found, wanted = blum.triangle_distances(a, b).distance, slow_distances(a, b)
    assert 100 < (wanted == 0).sum() < 3000 and np.array_equal(found == 0, wanted == 0)
    assert np.allclose(found, wanted, rtol=0, atol=1e-12)


def test_closest_points_of_triangles_lie_on_their_features():
    a, b = corners(soup(200, 3)), corners(soup(200, 4))
    found = blum.triangle_distances(a, b)
    assert found.closest.shape == (200, 2, 3) == found.feature.shape and found.feature.dtype == np.int32
    assert np.allclose(np.linalg.norm(found.closest[:, 0] - found.closest[:, 1], axis=1), found.distance, atol=1e-12)
    for k in range(200):
        for side, triangle in enumerate((a[k], b[k])):
            assert found.distance[k] == 0 or on_feature(found.closest[k, side], triangle, found.feature[k, side])
    same = blum.triangle_distances(a.tolist(), np.asfortranarray(b), threads=2)
    assert np.array_equal(same.closest, found.closest)
    small = a.astype(np.float32)
    found = blum.triangle_distances(small, b).distance
    assert np.array_equal(found, blum.triangle_distances(small.astype(np.float64), b).distance)
    assert blum.triangle_distances(np.zeros((0, 3, 3)), np.zeros((0, 3, 3))).distance.shape == (0,)


def check_scene(scene, meshes, places, numbers):
    """Checks all answers of a scene of soups against a comparison of all pairs."""
    shown = {n: corners(mesh, place) for n, mesh, place in zip(numbers, meshes, places, strict=True)}
    every = {(i, j): all_distances(shown[i], shown[j]) for i in numbers for j in numbers if i < j}
    apart = scene.separation()
    assert list(map(tuple, apart.object.tolist())) == sorted(every)
    for pair in apart:
        table = every[pair.object]
        assert pair.primitive == tuple(int(k) for k in np.unravel_index(table.argmin(), table.shape))
        assert pair.distance == pytest.approx(table.min(), abs=1e-12)
        one = scene.separation(*pair.object)
        assert (one.object, one.primitive, one.distance) == (pair.object, pair.primitive, pair.distance)
        assert np.array_equal(one.closest, pair.closest) and np.array_equal(one.feature, pair.feature)
        back = scene.separation(*pair.object[::-1])
        assert back.distance == pair.distance and np.array_equal(back.closest, pair.closest[::-1])
    nearest = scene.closest_primitives()
    for i in numbers:
        tables = [every[i, j] if i < j else every[j, i].T for j in numbers if i != j]
        assert np.allclose(nearest.distance[nearest.object[:, 0] == i], np.hstack(tables).min(1), atol=1e-12)
    for distance, found in ((0.25, scene.closer_than(0.25)), (0, scene.collisions()), (0, scene.closer_than(0))):
        told = set(map(tuple, np.hstack([found.object, found.primitive]).tolist()))
        assert len(told) == len(found) <= found.exact_tests
        assert told == {
            (*pair, int(i), int(j)) for pair, table in every.items() for i, j in np.argwhere(table <= distance)
        }


def test_scenes_equal_a_comparison_of_all_pairs_after_updates():
    meshes = [soup(25, seed) for seed in (5, 6, 7)]
    places = [None] * 3
    scene = blum.ProximityScene()
    assert repr(scene) == "ProximityScene(0 objects)" and len(scene.separation()) == 0
    assert [scene.add(mesh) for mesh in meshes] == [0, 1, 2]
    check_scene(scene, meshes, places, [0, 1, 2])
    places[1] = turned(8), np.array([0.5, 0, 0.25])
    scene.update(1, transform=places[1])
    check_scene(scene, meshes, places, [0, 1, 2])
    places[2] = turned(9), np.array([0, 0.125, 0])
    scene.update(2, transform=np.column_stack(places[2]))
    meshes[2] = meshes[2][0] * [1, 2, 0.5], meshes[2][1]
    scene.update(2, vertices=meshes[2][0])
    check_scene(scene, meshes, places, [0, 1, 2])
    meshes[0] = soup(40, 10)
    places[0] = turned(11), np.zeros(3)
    whole = np.eye(4)
    whole[:3] = np.column_stack(places[0])
    scene.update(0, mesh=meshes[0], transform=whole)
    check_scene(scene, meshes, places, [0, 1, 2])
    scene.remove(1)
    assert repr(scene) == "ProximityScene(2 objects)"
    check_scene(scene, [meshes[0], meshes[2]], [places[0], places[2]], [0, 2])
    meshes.append(soup(10, 12))
    assert scene.add(meshes[3], transform=(turned(13), [0, 0, 1])) == 3
    check_scene(scene, [meshes[0], *meshes[2:]], [places[0], places[2], (turned(13), np.array([0, 0, 1]))], [0, 2, 3])


def test_culling_changes_no_answer():
    def answers(**options):
        scene = blum.ProximityScene(**options)
        for seed in (81, 82):
            scene.add(soup(150, seed, 0.1), compare_self=True, transform=(turned(seed), [0, 0, 0]))
        return [scene.separation(), scene.closest_primitives(), scene.closer_than(0.1), scene.collisions()]

    wanted, found = answers(culling="bvh"), answers(culling="voronoi", cell_size=np.float32(1.5))
    assert any(one.culling == "voronoi" and one.cells > 0 for one in found)
    assert all(one.culling == "bvh" and one.cells == 0 for one in wanted)
    for one, other in zip(found, wanted, strict=True):
        for name in ("object", "primitive", "distance", "closest", "feature"):
            assert np.array_equal(getattr(one, name), getattr(other, name))


def test_objects_are_compared_by_layers_exclusion_and_with_themselves():
    scene = blum.ProximityScene()
    robot = [scene.add(soup(10, seed), layers=1, meets=2) for seed in (1, 2)]
    table = scene.add(soup(10, 3), layers=2)
    assert scene.separation().object.tolist() == [[0, table], [1, table]]
    assert scene.separation(*robot) is not None
    scene.exclude(table, 0)
    assert scene.separation().object.tolist() == [[1, table]]
    scene.exclude(0, table, excluded=False)
    assert len(scene.separation()) == 2
    itself = scene.add(soup(10, 4), layers=np.uint32(4), meets=0, compare_self=np.True_)
    assert [itself, itself] in scene.separation().object.tolist()
    scene.exclude(itself, itself)
    assert len(scene.separation()) == 2


def test_self_comparison_leaves_neighbours_out():
    strip = [[k / 2, k % 2, 0] for k in range(12)], [[k, k + 1, k + 2] for k in range(10)]
    triangles = np.array(strip[1])
    found = blum.closest_primitives(strip)
    assert found.object_pairs == 1 and np.array_equal(found.primitive[:, 0], np.arange(10))
    table = all_distances(corners((np.array(strip[0]), triangles)), corners((np.array(strip[0]), triangles)))
    table[[[bool(set(t) & set(u)) for u in triangles.tolist()] for t in triangles.tolist()]] = np.inf
    assert np.allclose(found.distance, table.min(1)) and np.array_equal(found.primitive[:, 1], table.argmin(1))
    assert len(blum.collisions(strip)) == 0
    folded = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.9, 0]], [[0, 1, 2], [0, 1, 3]]
    assert blum.collisions(folded).primitive.tolist() == [[0, 1]]
    assert len(blum.collisions(folded, max_distance=1)) == 0, "they share vertices"


def test_collisions_of_a_mesh_with_itself_are_its_self_intersections():
    wide = blum.noisy(blum.generate("torus", ring_segments=24, tube_segments=12), 0.4)
    wanted = blum.self_intersections(wide).pairs
    assert len(wanted) > 100 and np.array_equal(blum.collisions(wide).primitive, wanted)


def test_verbs_in_one_call_are_those_of_scenes():
    a, b = soup(20, 21), soup(20, 22)
    scene = blum.ProximityScene()
    scene.add(a), scene.add(b)
    assert blum.separation(a, b).primitive == scene.separation(0, 1).primitive
    assert blum.separation(a, (b[0] + 50, b[1]), max_distance=1) is None
    for found, wanted in [
        (blum.closest_primitives([a, b]), scene.closest_primitives()),
        (blum.closest_primitives((blum.Mesh(*a), blum.Mesh(*b)), max_distance=0.1), scene.closest_primitives(0.1)),
        (blum.collisions([a, b], threads=1), scene.collisions()),
        (blum.collisions([a, b], max_distance=np.float32(0.25)), scene.closer_than(0.25)),
    ]:
        assert 0 < len(found) == len(wanted)
        for name in ("object", "primitive", "distance", "closest", "feature"):
            assert np.array_equal(getattr(found, name), getattr(wanted, name))
    assert len(blum.closest_primitives([a, b], compare_self=True)) == 40
    assert len(blum.closest_primitives([a])) == 20 and len(blum.closest_primitives(a, compare_self=False)) == 0


def test_segments_and_points_are_numbered_after_triangles():
    mesh = blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [3, 0, 0], [4, 0, 0], [9, 9, 9]], [[0, 1, 2]], [[4, 3]], [5])
    scene = blum.ProximityScene()
    scene.add(mesh, compare_self=True)
    scene.add(([[3.5, 0, 1], [3.5, 5, 1], [4.5, 5, 1]], [[0, 1, 2]]))
    found = scene.closest_primitives()
    assert found.object.tolist() == [[0, 0], [0, 1], [0, 1], [1, 0]]
    assert found.primitive.tolist() == [[0, 1], [1, 0], [2, 0], [0, 1]]
    assert found.feature[0].tolist() == [[1, -1, -1], [3, -1, -1]], "vertices of the mesh"
    assert found.feature[1].tolist() == [[3, 4, -1], [0, -1, -1]], "an edge, the smaller vertex first"
    assert found.feature[2, 0].tolist() == [5, -1, -1]


def test_arrays_of_other_kinds_are_taken():
    vertices, triangles = soup(20, 31)
    vertices = vertices.astype(np.float32).astype(np.float64)
    other = soup(20, 32)
    wanted = blum.separation((vertices, triangles), other)
    spread = np.zeros((len(vertices), 6))
    spread[:, ::2] = vertices
    for given in (vertices.astype(np.float32), spread[:, ::2], np.asfortranarray(vertices), vertices.tolist()):
        assert blum.separation((given, triangles), other).distance == wanted.distance
        scene = blum.ProximityScene()
        scene.add((vertices + 1, triangles.astype(np.int32))), scene.add(other)
        scene.update(0, given)
        assert scene.separation(0, 1).distance == wanted.distance


def test_results_outlive_the_scene():
    scene = blum.ProximityScene()
    scene.add(soup(20, 41)), scene.add(soup(20, 42))
    found = scene.closest_primitives()
    kept = found.closest.copy(), found.feature.copy()
    closest, feature = found.closest, found.feature
    del found, scene
    assert np.array_equal(closest, kept[0]) and np.array_equal(feature, kept[1])


def test_pairs_are_a_sequence():
    found = blum.closest_primitives([soup(5, 51), soup(5, 52)])
    assert repr(found) == "ProximityPairs(10 pairs)" and len(list(found)) == 10
    assert found[-1].primitive == tuple(found.primitive[-1]) and found[np.int64(3)].distance == found.distance[3]
    assert found.closest_pair.distance == found.distance.min()
    with pytest.raises(IndexError):
        found[10]
    none = blum.collisions(blum.generate("sphere"))
    assert not none and none.closest_pair is None


def test_refused_changes_leave_the_scene_as_it_was():
    a, b = soup(20, 61), soup(20, 62)
    scene = blum.ProximityScene()
    scene.add(a), scene.add(b)
    wanted = scene.separation(0, 1)
    for change in (
        {"transform": 2 * np.eye(3, 4)},
        {"transform": (IDENTITY, [0, np.nan, 0])},
        {"transform": 2 * np.eye(3, 4), "vertices": a[0] + 1},
        {"vertices": a[0][:-3]},
        {"vertices": np.full_like(a[0], np.inf)},
        {"mesh": (a[0] * np.nan, a[1])},
        {"mesh": a, "vertices": a[0]},
        {},
    ):
        with pytest.raises(ValueError):
            scene.update(0, **change)
    with pytest.raises(ValueError):
        scene.add(a, transform=np.diag([1.0, 1.0, 1.5, 1.0]))
    assert scene.separation(0, 1).distance == wanted.distance and scene.add(a) == 2


def scene_of_two():
    scene = blum.ProximityScene()
    scene.add(soup(3, 1)), scene.add(soup(3, 2))
    return scene


@pytest.mark.parametrize(
    ("call", "error", "text"),
    [
        (lambda s: s.add(3), TypeError, "mesh is a int"),
        (lambda s: s.add(soup(1, 1), layers=-1), ValueError, "layers is -1"),
        (lambda s: s.add(soup(1, 1), meets=2**32), ValueError, "meets is 4294967296"),
        (lambda s: s.add(soup(1, 1), layers=1.0), TypeError, "layers must be an integer"),
        (lambda s: s.add(soup(1, 1), name=3), TypeError, "name must be a string"),
        (lambda s: s.add(([[0, 0, 1e71], [0, 0, 0]], [[0, 1, 1]]), name="far"), ValueError, "'far': a coordinate is"),
        (lambda s: s.rename(0, None), TypeError, "name must be a string"),
        (lambda s: s.rename(2, "a"), ValueError, "no object 2"),
        (lambda s: s.add(soup(1, 1), compare_self="no"), TypeError, "compare_self must be True or False"),
        (lambda s: s.add(soup(1, 1), transform="x"), TypeError, "transform"),
        (lambda s: s.add(soup(1, 1), transform=np.eye(3)), ValueError, r"transform has the shape \(3, 3\)"),
        (lambda s: s.add(soup(1, 1), transform=(np.eye(4), [0, 0, 0])), ValueError, r"transform\[0\] has the shape"),
        (lambda s: s.add(soup(1, 1), transform=np.eye(4)[::-1]), ValueError, "last row of transform"),
        (lambda s: s.add(([[0, 0, 1e71], [0, 0, 0]], [[0, 1, 1]])), ValueError, "1e70"),
        (lambda s: s.remove(2), ValueError, "no object 2"),
        (lambda s: s.remove(-1), ValueError, "index is -1"),
        (lambda s: s.update(5, transform=np.eye(4)), ValueError, "no object 5"),
        (lambda s: s.update(0, [1, 2, 3]), ValueError, "vertices has the shape"),
        (lambda s: s.exclude(0, 7), ValueError, "no object 7"),
        (lambda s: s.exclude(0, 1, 1), TypeError, "excluded must be True or False"),
        (lambda s: s.separation(0), ValueError, "both a and b"),
        (lambda s: s.separation(0, 2), ValueError, "no object 2"),
        (lambda s: s.separation("a", "b"), TypeError, "a must be an integer"),
        (lambda s: s.separation(0, 1, -1), ValueError, "max_distance is -1"),
        (lambda s: s.closest_primitives(np.nan), ValueError, "max_distance is nan"),
        (lambda s: s.closer_than(-0.5), ValueError, "distance is -0.5"),
        (lambda s: s.closer_than("near"), TypeError, "distance must be a number"),
        (lambda s: s.closest_primitives(threads=-1), ValueError, "threads"),
        (lambda _: blum.ProximityScene(culling="octree"), ValueError, "culling is 'octree'"),
        (lambda _: blum.ProximityScene(cell_size=0), ValueError, "cell_size"),
        (lambda _: blum.ProximityScene(cells=2), TypeError, "cells"),
        (lambda _: blum.collisions([], max_distance=1), ValueError, "meshes is empty"),
        (lambda _: blum.collisions(soup(1, 1), max_distance=-1), ValueError, "max_distance is -1"),
        (lambda _: blum.collisions([soup(1, 1), 3]), TypeError, r"meshes\[1\] is a int"),
        (lambda _: blum.separation(soup(1, 1), None), TypeError, "b is a NoneType"),
        (lambda _: blum.triangle_distances(np.zeros((1, 3, 3)), np.zeros((2, 3, 3))), ValueError, "equal numbers"),
        (lambda _: blum.triangle_distances(np.zeros((3, 3)), np.zeros((3, 3))), ValueError, r"must have \(n, 3, 3\)"),
        (lambda _: blum.triangle_distances(np.full((1, 3, 3), np.nan), np.zeros((1, 3, 3))), ValueError, "not finite"),
        (lambda _: blum.triangle_distances([["x"]], [["x"]]), TypeError, "a must hold real numbers"),
    ],
)
def test_wrong_arguments_are_refused_by_name(call, error, text):
    with pytest.raises(error, match=text):
        call(scene_of_two())


def test_a_removed_object_is_named():
    scene = scene_of_two()
    scene.remove(0)
    for call in (lambda: scene.remove(0), lambda: scene.update(0, transform=np.eye(4)), lambda: scene.separation(0, 1)):
        with pytest.raises(blum.InvalidOption, match="no object 0: it was removed"):
            call()


class Stop(Exception):
    pass


def test_progress_can_stop_a_query_and_cannot_change_the_scene():
    scene = blum.ProximityScene()
    scene.add(soup(60000, 71, size=0.02), compare_self=True)
    phases, refused = [], []

    def stop(fraction, phase):
        phases.append(phase)
        assert 0 <= fraction <= 1
        try:
            scene.remove(0)
        except RuntimeError as error:
            refused.append(str(error))
        raise Stop

    with pytest.raises(Stop):
        scene.closest_primitives(threads=1, progress=stop)
    assert len(phases) == 1 == len(refused) and "in use" in refused[0]
    assert len(scene.closest_primitives(1e-3)) > 0, "the scene still answers"


def test_threads_may_share_a_scene():
    scene = scene_of_two()
    wanted = scene.closest_primitives().distance.tolist()
    wrong = []

    def ask():
        for _ in range(20):
            scene.update(1, transform=np.eye(4))
            if scene.closest_primitives().distance.tolist() != wanted:
                wrong.append(1)

    workers = [threading.Thread(target=ask) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not wrong


def two_boxes(shift):
    box = blum.generate("box")
    scene = blum.ProximityScene()
    scene.add(box)
    scene.add((box.vertices + shift, box.triangles))
    return scene, box


def test_penetration_of_boxes_is_exact():
    scene, _ = two_boxes([0.1, 0.2, 0.75])
    (part,) = scene.penetration(0, 1, depth_tolerance=1e-4)
    assert part.depth == pytest.approx(0.25, abs=1e-12)
    assert part.depth <= part.depth_bound <= part.depth * (1 + 1e-4) + 1e-12
    assert part.direction == pytest.approx([0, 0, -1], abs=1e-9)
    assert part.volume == pytest.approx(0.9 * 0.8 * 0.25, abs=1e-12)
    assert sum(part.area) == pytest.approx(2 * (0.9 * 0.8 + 0.9 * 0.25 + 0.8 * 0.25), abs=1e-12)
    assert np.linalg.norm(part.deep_point - part.surface_point) == pytest.approx(part.depth)
    assert all((curve[0] == curve[-1]).all() for curve in part.curves)
    assert scene.signed_separation(0, 1) == -part.depth
    assert "depth" in repr(part)


def test_signed_separation_changes_its_sign_at_contact():
    for height, sign in ((1.5, 1), (np.nextafter(1, 2), 1), (1, 0), (np.nextafter(1, 0), -1)):
        scene, box = two_boxes([0, 0, 0])
        vertices = box.vertices + np.array([0.25, 0.25, 1])
        vertices[vertices[:, 2] == 0.5, 2] = height - 0.5
        scene.update(1, vertices)
        assert np.sign(scene.signed_separation(0, 1)) == sign
        assert bool(scene.penetration(0, 1)) == (sign < 0)


def scene_of_solids():
    """Boxes and balls, some of which overlap; one object overlaps itself in two parts."""
    scene, (box, ball) = blum.ProximityScene(), (blum.generate("box"), blum.generate("sphere", radius=0.5, frequency=4))
    two = np.vstack([box.vertices, box.vertices + np.array([0.4, 0.2, 0.3])])
    twice = two, np.vstack([box.triangles, np.asarray(box.triangles) + len(box.vertices)])
    for mesh, at in (box, [0, 0, 0]), (ball, [0.1, 0, 0.9]), (ball, [5, 0, 0]), (twice, [0.3, 0.6, 0.7]):
        scene.add(mesh, compare_self=mesh is twice, transform=(IDENTITY, at))
    return scene, [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3), (3, 3)]


def test_penetrations_of_all_solids_equal_those_of_each_pair():
    scene, pairs = scene_of_solids()
    wanted = [part for pair in pairs for part in scene.penetration(*pair, depth_tolerance=0.1)]
    found = scene.penetrations(depth_tolerance=0.1)
    assert len(found) == len(wanted) > 3
    for one, other in zip(found, wanted, strict=True):
        for field in dataclasses.fields(blum.Penetration):
            mine, its = getattr(one, field.name), getattr(other, field.name)
            if field.name == "curves":
                assert [curve.tolist() for curve in mine] == [curve.tolist() for curve in its]
            else:
                assert np.array_equal(mine, its), field.name
    assert [part.object for part in found] == sorted(part.object for part in found)
    signed = scene.signed_separations(depth_tolerance=0.1)
    assert list(map(tuple, signed.object.tolist())) == pairs
    assert signed.distance.tolist() == [scene.signed_separation(*pair, depth_tolerance=0.1) for pair in pairs]
    apart = scene.separation()
    for k, pair in enumerate(signed):
        if pair.distance >= 0:
            assert pair.primitive == apart[k].primitive and np.array_equal(pair.closest, apart[k].closest)
            continue
        part = next(part for part in wanted if part.object == pair.object)
        points = [part.deep_point, part.surface_point]
        assert np.array_equal(pair.closest, points if part.is_first_deep else points[::-1])
        assert (pair.feature >= 0).all()  # both features are triangles
    assert signed.closest_pair.distance == -max(part.depth for part in found)


def test_penetrations_of_all_solids_take_the_options_of_pairs():
    scene, _ = scene_of_solids()
    told = []
    scene.penetrations(progress=lambda fraction, phase: told.append((fraction, phase)))
    assert told[-1] == (1, "penetration") and told == sorted(told)
    box = blum.generate("box")
    cup = scene.add((box.vertices + np.array([0, 30, 0]), np.asarray(box.triangles)[1:]), name="cup")
    assert len(scene.signed_separations()) == 11  # the box of the cup is apart from all others
    for call in (scene.penetrations, lambda: scene.penetration(0, cup)):
        with pytest.raises(blum.InvalidMesh, match=r"^'cup' is not closed"):
            call()
    scene.rename(cup, "bowl")
    with pytest.raises(blum.InvalidMesh, match=r"^'bowl' is not closed"):
        scene.penetrations()
    scene.rename(cup, "")
    with pytest.raises(blum.InvalidMesh, match=r"^object 4 is not closed"):
        scene.penetrations()
    for call in (scene.penetrations, scene.signed_separations):
        with pytest.raises(blum.InvalidOption, match="depth_tolerance"):
            call(depth_tolerance=0)
        with pytest.raises(TypeError, match="depth"):
            call(depth=1)
    empty = blum.ProximityScene()
    assert empty.penetrations() == [] and len(empty.signed_separations()) == 0


def test_pairs_that_meet_at_the_start_are_warned_of():
    scene, box = two_boxes([0.5, 0, 0])
    with pytest.warns(blum.InputWarning, match="already at the start of the motion, so their times are 0") as caught:
        found = scene.continuous({1: box.vertices + np.array([3, 0, 0])})
    assert caught[0].message.code == "meet-at-start" and found.earliest == 0
    at_start = np.count_nonzero(found.vertex_face_time == 0) + np.count_nonzero(found.edge_edge_time == 0)
    assert str(caught[0].message).startswith(f"{at_start} pairs meet")
    both = np.concatenate([box.vertices, box.vertices + np.array([0.5, 0, 0])])
    triangles = np.concatenate([box.triangles, box.triangles + 8])
    with pytest.warns(blum.InputWarning, match=f"{at_start} pairs meet already"):
        blum.continuous_collisions((both, triangles), both)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        scene, _ = two_boxes([2, 0, 0])
        assert scene.continuous({1: box.vertices - np.array([1, 0, 0])}).earliest > 0


def test_continuous_collisions_of_objects():
    scene, box = two_boxes([0.25, 0.25, 3])
    found = scene.continuous({1: box.vertices + np.array([0.25, 0.25, -1])})
    assert found.earliest == 0.5
    assert set(found.vertex_face[:, 0]) | set(found.vertex_face[:, 2]) == {0, 1}
    assert found.vertex_face.shape[1] == 4
    assert found.edge_edge.shape[1] == 6
    assert len(found.vertex_face_time) == len(found.vertex_face)
    moved = {"vertices": box.vertices, "transform": (IDENTITY, [0.25, 0.25, -1])}
    assert scene.continuous({1: moved}).earliest == 0.5
    # The scene has not changed, and objects at rest have no first contact.
    assert scene.separation(0, 1).distance == 2
    assert scene.continuous({}).earliest is None
    for empty in ([], np.zeros((0, 3)), {"vertices": []}):
        with pytest.raises(blum.InvalidMesh, match="has no vertices"):
            scene.continuous({1: empty})
    assert scene.continuous({1: {"transform": (IDENTITY, [0, 0, -1.5])}}, min_separation=0.6).earliest is not None
    matrix = np.eye(4)
    matrix[2, 3] = -1.5
    for place in [(IDENTITY, [0, 0, -1.5]), matrix, matrix[:3]]:  # the forms that update() accepts
        assert scene.continuous({1: place}).earliest == scene.continuous({1: {"transform": place}}).earliest


def test_wrong_motions_and_penetrations_are_rejected():
    scene, box = two_boxes([0, 0, 3])
    open_mesh = scene.add((box.vertices, np.asarray(box.triangles)[1:]))
    with pytest.raises(blum.InvalidMesh, match="closed"):
        scene.penetration(0, open_mesh)
    for options in ({"depth_tolerance": 0}, {"depth_tolerance": np.nan}):
        with pytest.raises(blum.InvalidOption, match="depth_tolerance"):
            scene.penetration(0, 1, **options)
    with pytest.raises(blum.InvalidMesh, match="vertices"):
        scene.continuous({1: box.vertices[:3]})
    with pytest.raises(blum.InvalidOption, match="speed"):
        scene.continuous({1: {"speed": 3}})
    with pytest.raises(blum.InvalidOption, match="object 9"):
        scene.continuous({9: box.vertices})
    with pytest.raises(blum.InvalidOption):
        scene.continuous({1: {"transform": np.diag([1, 1, -1, 1.0])}})


def test_pairs_can_be_sliced_and_reject_wrong_numbers():
    torus = blum.generate("torus")
    pairs = blum.closest_primitives(torus)
    few = pairs[1:7:2]
    assert isinstance(few, blum.ProximityPairs) and len(few) == 3
    assert few.primitive.tolist() == pairs.primitive[1:7:2].tolist() and few.exact_tests == pairs.exact_tests
    assert few[0].primitive == pairs[1].primitive and pairs[-1].primitive == pairs[len(pairs) - 1].primitive
    assert len(list(few)) == 3 and not pairs[0:0]
    with pytest.raises(IndexError, match="pair 9999 does not exist: there are 6,144 pairs"):
        pairs[9999]
    with pytest.raises(TypeError, match="the number of a pair must be an integer, not str"):
        pairs["first"]


def test_motions_must_be_a_dict():
    box = blum.generate("box")
    scene = blum.ProximityScene()
    scene.add(box, compare_self=True)
    with pytest.raises(TypeError, match="motions must be a dict from the number of an object"):
        scene.continuous([box.vertices, box.vertices])


def test_ends_may_be_meshes(tmp_path):
    cloth = blum.generate("sphere", frequency=4)
    end = blum.Mesh(cloth.vertices * [1, 1, -0.3], cloth.triangles)
    end.write(tmp_path / "end.ply")
    wanted = blum.continuous_collisions(cloth, end.vertices)
    assert len(wanted.vertex_face) > 0
    scene = blum.ProximityScene()
    scene.add(cloth, compare_self=True)
    for given in (end, tmp_path / "end.ply", str(tmp_path / "end.ply"), (end.vertices, end.triangles)):
        found = blum.continuous_collisions(cloth, given)
        assert found.vertex_face.tolist() == wanted.vertex_face.tolist()
        moved = scene.continuous({0: given})
        assert moved.vertex_face_time.tolist() == scene.continuous({0: end.vertices}).vertex_face_time.tolist()
    with pytest.raises(blum.InvalidMesh, match="end has other triangles than the mesh at the start"):
        blum.continuous_collisions(cloth, blum.Mesh(end.vertices, cloth.triangles[::-1]))


def test_closest_rotation_repairs_poses_in_single_precision():
    angle = 0.3
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    pose = np.eye(4, dtype=np.float32)
    pose[:3, :3] = turn
    pose[:3, 3] = [1, 2, 3]
    scene = blum.ProximityScene()
    scene.add(blum.generate("box"))
    with pytest.raises(
        blum.InvalidOption, match=r"only to within \d\.\d+e-08: it seems to be rounded to single precision.*closest_"
    ):
        scene.update(0, transform=pose)
    with pytest.raises(blum.InvalidOption, match="only to within 3: it scales or shears; scale vertices instead"):
        scene.update(0, transform=(2 * np.eye(3), [0, 0, 0]))
    fine = blum.closest_rotation(pose)
    scene.update(0, transform=fine)
    assert fine.shape == (4, 4) and fine.dtype == np.float64 and fine[:3, 3].tolist() == [1, 2, 3]
    assert np.abs(fine[:3, :3] - turn).max() < 1e-7
    u, _, v = np.linalg.svd(pose[:3, :3].astype(float))
    assert np.abs(blum.closest_rotation(pose[:3, :3]) - u @ v).max() < 1e-15
    rough = turn + 0.01 * np.arange(9).reshape(3, 3) / 8
    u, _, v = np.linalg.svd(rough)
    assert np.abs(blum.closest_rotation(rough) - u @ v).max() < 1e-14
    for wrong in (np.diag([1.0, 1, -1]), 2 * np.eye(3), np.full((3, 3), np.nan), np.zeros((3, 3))):
        with pytest.raises(blum.InvalidOption, match=r"not a rotation to within 0\.1"):
            blum.closest_rotation(wrong)
    with pytest.raises(ValueError, match="shape"):
        blum.closest_rotation([1, 2, 3])


def poses_of(count, seed, far):
    random = np.random.default_rng(seed)
    poses = np.tile(np.eye(4), (count, 1, 1))
    for k in range(count):
        poses[k, :3, :3] = turned(1000 * seed + k)
        poses[k, :3, 3] = random.uniform(-far, far, 3)
    return poses


def test_meets_equals_separation_and_collisions():
    scene = blum.ProximityScene()
    a, b = scene.add(soup(30, 1)), scene.add(blum.generate("sphere", radius=0.4))
    poses = poses_of(60, 2, 1.4)
    expected = []
    for pose in poses:
        scene.update(b, transform=pose)
        expected.append(scene.separation(a, b).distance == 0)
        assert scene.meets(a, b) is scene.meets(b, a, threads=1) is scene.meets() is expected[-1]
        assert bool(scene.collisions()) is expected[-1]
    assert 5 < sum(expected) < 55
    for threads in (1, 2, 7):
        found = scene.meets(a, b, poses, threads=threads)
        assert found.dtype == bool and found.tolist() == expected
    scene.update(b, transform=poses[0])
    assert scene.meets(a, b, poses[:, :3]).tolist() == expected
    assert scene.meets(a, b, np.asfortranarray(poses)).tolist() == expected
    assert scene.meets(a, b) is expected[0], "the scene has changed"
    assert scene.meets(a, b, np.zeros((0, 4, 4))).shape == (0,)


def test_meets_of_an_object_with_itself_equals_collisions():
    scene = blum.ProximityScene()
    crossing, ring = scene.add(soup(30, 1), compare_self=True), scene.add(blum.generate("torus"))
    assert scene.meets(crossing, crossing) is True and scene.meets(ring, ring) is False
    scene.exclude(crossing, ring)
    assert scene.meets() is bool(scene.collisions()) is True


def test_meets_names_wrong_arguments():
    scene = blum.ProximityScene()
    a, b = scene.add(blum.generate("box")), scene.add(blum.generate("box"))
    poses = np.tile(np.eye(4), (3, 1, 1))
    for call, error, text in [
        (lambda: scene.meets(a), blum.InvalidOption, "both a and b"),
        (lambda: scene.meets(transforms=poses), blum.InvalidOption, "both a and b"),
        (lambda: scene.meets(a, 7), blum.InvalidOption, "no object 7"),
        (lambda: scene.meets(a, a, poses), blum.InvalidOption, "itself"),
        (lambda: scene.meets(a, b, poses[0]), ValueError, r"\(4, 4\), but must have \(n, 4, 4\)"),
        (lambda: scene.meets(a, b, poses.astype(str)), TypeError, "transforms"),
        (lambda: scene.meets(a, b, poses + np.eye(4) * [[[0]], [[0]], [[1]]]), blum.InvalidOption, r"transforms\[2\]"),
        (lambda: scene.meets(a, b, np.concatenate([poses, 2 * poses])[:, :3]), blum.InvalidOption, r"transforms\[3\]"),
        (lambda: scene.meets(a, b, np.full((2, 3, 4), np.nan)), blum.InvalidOption, r"transforms\[0\]"),
        (lambda: scene.meets(a, b, threads=-1), blum.InvalidOption, "threads"),
    ]:
        with pytest.raises(error, match=text):
            call()


def test_meets_reports_progress():
    scene = blum.ProximityScene()
    a, b = scene.add(blum.generate("box")), scene.add(blum.generate("box"))
    seen = []
    scene.meets(a, b, poses_of(2000, 3, 2), progress=lambda fraction, phase: seen.append((fraction, phase)))
    assert seen[-1][0] == 1
    assert scene.meets(a, b, progress=lambda fraction, phase: seen.append(fraction)) is True


def test_long_queries_of_two_objects_end_as_brief_ones(tmp_path):
    """A search that outlasts the patience of a brief call starts again, and gives the same answer."""
    ball = blum.generate("sphere", frequency=150)
    shell = (ball.vertices * 1.0000005, ball.triangles)
    scene = blum.ProximityScene()
    a, b = scene.add(ball), scene.add(shell)
    assert scene.meets(a, b) is False
    assert 0 < scene.separation(a, b).distance < 1e-6
