"""Proves that results, shapes and queries have the same content after a pickle or a copy, also in another process."""

import copy
import pathlib
import pickle
import subprocess
import sys

import numpy as np
import pytest
from content import content_of

blum = pytest.importorskip("blum")

BOX = blum.generate("box")
POINTS = np.random.default_rng(1).uniform(-1, 1, (50, 3))
TUBES = blum.generate("tube_image", nodes=2)
WAYS = {
    "pickle": lambda value: pickle.loads(pickle.dumps(value)),
    "deepcopy": copy.deepcopy,
    "copy": copy.copy,
}


def expected_distances(points, side=1.0):
    """Signed distances from the surface of a cube around the origin."""
    away = np.abs(points) - side / 2
    outside = np.linalg.norm(np.maximum(away, 0), axis=1)
    return np.where(outside > 0, outside, away.max(axis=1))


def diagram():
    return blum.voronoi_complex(BOX, resolution=4)


def axis():
    return blum.medial_axis(BOX, resolution=16).simplify(60)


#: Functions that make data, by name. Their content is compared.
DATA = {
    "Mesh": lambda: blum.Mesh(BOX.vertices, BOX.triangles, [[0, 6]], [1]),
    "Grid": lambda: blum.Grid((1, 2, 3), (0.5, 0.6, 0.7), (3, 4, 5), [[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    "Image": lambda: blum.Image(TUBES.values, 0.5, 3, space="left-posterior-superior"),
    "Field": lambda: blum.distance_field(BOX, resolution=8, order=2, band=0.3),
    "Field of an image": lambda: blum.distance_transform(TUBES),
    "Complex": lambda: blum.Complex([[0, 0, 0], [1, 0, 0]], edges=[[0, 1]], edge_columns={"cost": [2.5]}),
    "MedialComplex": axis,
    "MedialComplex.nested": lambda: blum.medial_axis(BOX, resolution=16).nested(),
    "certificate": lambda: axis().certificate,
    "axis graph": lambda: axis().graph(),
    "ExtendedAxis": lambda: axis().extend(),
    "medial report": lambda: blum.medial_axis(BOX, resolution=16).report,
    "VoronoiComplex": diagram,
    "Voronoi graph": lambda: diagram().graph(),
    "Voronoi regions": lambda: diagram().regions(),
    "Voronoi sites": lambda: diagram().sites(),
    "Centrelines": lambda: list(blum.centreline(TUBES)),
    "labels": TUBES.labels,
    "topology": lambda: blum.topology(BOX),
    "bodies": lambda: blum.Solid(BOX).bodies,
    "CleanedMesh": lambda: blum.clean_mesh(blum.subdivided(BOX), 1e-6),
    "ClosestPoints": lambda: blum.closest_points(BOX, POINTS),
    "NearPrimitives": lambda: blum.ClosestPointQuery(BOX).within(POINTS, 0.5),
    "SignedDistances": lambda: blum.signed_distance(BOX, POINTS),
    "samples": lambda: blum.sample_near(BOX, 20),
    "pairs": lambda: blum.collisions([BOX, blum.generate("sphere")]),
    "pair": lambda: blum.separation(BOX, blum.Mesh([[0, 0, 3]])),
    "impacts": lambda: blum.continuous_collisions(BOX, BOX.vertices[::-1].copy()),
    "first contact": lambda: blum.first_contact(BOX, BOX.vertices[::-1].copy()),
    "features": lambda: blum.close_features(BOX, 0.5),
    "SurfaceMap": lambda: blum.surface_distance_map(BOX, blum.generate("sphere"), texel=0.1),
    "thickness map": lambda: blum.thickness_map(BOX, texel=0.1),
    "Thickness": lambda: blum.thickness(BOX),
    "hausdorff": lambda: blum.hausdorff_distance(BOX, blum.generate("sphere")),
    "shapes": blum.shapes,
    "formats": blum.file_formats,
}


@pytest.mark.filterwarnings("ignore::blum.InputWarning")
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", DATA)
def test_data_keep_their_content(name, way):
    made = DATA[name]()
    again = WAYS[way](made)
    assert type(again) is type(made) and content_of(again) == content_of(made)
    assert repr(again) == repr(made)


@pytest.mark.parametrize("way", WAYS)
def test_fields_keep_their_facts(way):
    mesh = blum.Mesh(BOX.vertices, BOX.triangles)
    mesh.source = "box.ply"
    field = blum.distance_field(mesh, resolution=8, device="auto")
    again = WAYS[way](field)
    names = ("seconds", "device", "device_reason", "sign_rule", "sign_reason", "band", "site_ids", "source", "grid")
    assert {name: getattr(again, name) for name in names} == {name: getattr(field, name) for name in names}
    assert again.seconds and again.mesh.source == "box.ply"
    nodes = field.grid.positions().reshape(-1, 3)
    np.testing.assert_allclose(again.distance.ravel(), expected_distances(nodes), atol=1e-6)


@pytest.mark.parametrize("way", WAYS)
def test_queries_of_points_answer_the_same(way):
    query = WAYS[way](blum.ClosestPointQuery(BOX, max_distance=0.4, sign="winding"))
    found = query(POINTS)
    near = np.abs(expected_distances(POINTS)) <= 0.4
    np.testing.assert_allclose(found.distance[near], expected_distances(POINTS)[near], atol=1e-12)
    assert np.isinf(found.distance[~near]).all() and near.any() and not near.all()
    assert query.sign_rule == "winding" and content_of(query.within(POINTS, 0.2)) == content_of(
        blum.ClosestPointQuery(BOX).within(POINTS, 0.2)
    )
    inside = expected_distances(POINTS) < 0
    winding = WAYS[way](blum.WindingNumber(BOX))
    assert np.array_equal(winding.is_inside(POINTS), inside)
    np.testing.assert_allclose(winding(POINTS), inside, atol=1e-9)
    solid = WAYS[way](blum.Solid(BOX))
    assert np.array_equal(solid.inside(POINTS), inside) and solid.betti == (1, 0, 0)
    sites = WAYS[way](blum.Sites(BOX))
    assert len(sites) == 8 + 18 + 12 and sites.vertices([37]).tolist() == [BOX.triangles[11].tolist()]


@pytest.mark.parametrize("way", WAYS)
def test_copies_follow_refits_and_stay_apart(way):
    query, moved = blum.ClosestPointQuery(BOX), BOX.vertices * 2
    query.refit(moved)
    moved *= 0  # The caller may reuse its array.
    again = WAYS[way](query)
    np.testing.assert_allclose(again(POINTS * 3).distance, expected_distances(POINTS * 3, 2), atol=1e-12)
    again.refit(BOX.vertices)
    np.testing.assert_allclose(query(POINTS * 3).distance, expected_distances(POINTS * 3, 2), atol=1e-12)
    np.testing.assert_allclose(again(POINTS * 3).distance, expected_distances(POINTS * 3), atol=1e-12)


@pytest.mark.parametrize("way", WAYS)
def test_solids_of_images_and_crossings_are_the_same(way):
    image = blum.Image((np.arange(60).reshape(3, 4, 5) % 3).astype(np.uint8), spacing=(1, 2, 3))
    solid = WAYS[way](blum.Solid(image, label=2))
    centres = image.grid.positions()
    assert np.array_equal(solid.inside(centres), image.values == 2)
    vertices = np.concatenate([BOX.vertices, BOX.vertices + np.array([0.5, 0.25, 0.125])])
    crossing = blum.Solid(vertices, np.concatenate([BOX.triangles, BOX.triangles + 8]))
    again = WAYS[way](crossing)
    assert again.resolved == crossing.resolved is not None
    assert content_of(again.surface) == content_of(crossing.surface)
    model = crossing.model(resolution=2)
    assert content_of(WAYS[way](model).report) == content_of(model.report)
    assert content_of(WAYS[way](model).complex()) == content_of(model.complex())
    assert blum.clean_mesh(again, 1e-6).report == blum.clean_mesh(crossing, 1e-6).report


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", ["mesh", "image"])
def test_medial_axes_are_computed_again(way, kind):
    if kind == "mesh":
        made = blum.medial_axis(BOX, resolution=16, least_theta=30, grid_shift=0.25)
    else:
        made = blum.medial_axis(TUBES, label=1, least_theta=30)
    again = WAYS[way](made)
    assert "_core" not in vars(again), "the axis is computed at its first use"
    assert (again.least_theta, again.greatest_theta) == (30, 180) and content_of(again.report) == content_of(
        made.report
    )
    assert repr(again) == repr(made)
    for theta in (30, 90):
        one, other = again.simplify(theta), made.simplify(theta)
        assert content_of(one) == content_of(other) and one.theta == theta
    assert content_of(again.nested()) == content_of(made.nested())
    assert content_of(again.certified(60)) == content_of(made.certified(60))


@pytest.mark.parametrize("way", WAYS)
def test_maps_can_be_written_and_measured(way, tmp_path):
    box, ball = blum.Mesh(BOX.vertices, BOX.triangles, points=[0]), blum.generate("sphere", radius=2)
    made = blum.surface_distance_map(box, ball, blum.generate("sphere", radius=0.6), texel=0.1)
    again = WAYS[way](made)
    assert content_of(again) == content_of(made) and np.array_equal(again.object, made.object)
    assert again.statistics() == made.statistics() and again.seconds == made.seconds
    assert again.mesh.points.tolist() == [0]
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    made.write(tmp_path / "a/map.ply"), again.write(tmp_path / "b/map.ply")
    assert (tmp_path / "a/map.ply").read_bytes() == (tmp_path / "b/map.ply").read_bytes()
    with pytest.raises(ValueError, match="files do not record"):
        _ = WAYS[way](read_back(made, tmp_path)).object


def read_back(made, folder):
    made.write(folder / "map.npz")
    return blum.read_surface_map(folder / "map.npz")


@pytest.mark.parametrize("way", WAYS)
def test_mappers_follow_their_meshes(way):
    corners = np.tile(np.array([[0, 0], [0, 0.1], [0.1, 0]]), (12, 1, 1)) + np.arange(12).reshape(-1, 1, 1) * [0, 0.08]
    corners[:, :, 0] += np.arange(12).reshape(-1, 1) % 2 * 0.5
    for options in ({"texel": 0.2}, {"texture_coordinates": corners, "texture_size": (64, 64)}):
        mapper = blum.SurfaceMapper(BOX, blum.generate("sphere", radius=3), **options)
        mapper.move_target(BOX.vertices * 0.5)
        mapper.replace_other(blum.generate("box", size_x=4, size_y=4, size_z=4))
        mapper.move_other(blum.generate("box").vertices * 6)
        again = WAYS[way](mapper)
        assert content_of(again.map()) == content_of(mapper.map())
        # The inner cube has half the side; its faces are 2.75 from those of the outer cube.
        assert abs(float(again.map().faces[:, 0].min()) - 2.75) < 1e-5
        again.move_target(BOX.vertices)
        assert float(mapper.map().faces[:, 0].min()) > 2.7 > float(again.map().faces[:, 0].min())


@pytest.mark.parametrize("way", WAYS)
def test_solvers_and_verifiers_work_again(way):
    solver = blum.FieldSolver(blum.Grid((-1, -1, -1), 0.25, (9, 9, 9)), reuse=True, sites=False)
    solver.compute(BOX)
    again = WAYS[way](solver)
    field = again.compute(BOX)
    nodes = field.grid.positions().reshape(-1, 3)
    np.testing.assert_allclose(field.distance.ravel(), expected_distances(nodes), atol=1e-6)
    assert field.site is None and repr(again) == repr(solver)
    verifier, piece = blum.AxisVerifier(BOX), axis()
    first = verifier.certify(piece)
    assert content_of(WAYS[way](verifier).certify(piece)) == content_of(first) and first.holds


@pytest.mark.parametrize("way", WAYS)
def test_scenes_keep_objects_numbers_and_comparisons(way):
    ball, place = blum.generate("sphere"), np.eye(4)
    scene = blum.ProximityScene(culling="voronoi", cell_size=3)
    table = scene.add(BOX, name="table")
    gone = scene.add(ball)
    moved = scene.add(ball, layers=2, meets=1, transform=place)
    folded = scene.add(blum.Mesh(BOX.vertices, BOX.triangles, [[0, 6]], [1]), compare_self=True, name="folded")
    other = scene.add(ball, name="other")
    scene.remove(gone)
    place[:3, 3] = (0, 0, 0.9)
    scene.update(moved, transform=place)
    scene.update(folded, vertices=BOX.vertices * 1.5)
    scene.update(other, mesh=BOX)
    scene.rename(other, "box")
    scene.exclude(table, other)
    scene.exclude(folded, folded)
    scene.exclude(folded, folded, False)
    place[:] = 7  # The caller may reuse the array.

    again = WAYS[way](scene)
    assert repr(again) == repr(scene) == "ProximityScene(4 objects)"

    def answers(asked):
        return [
            content_of(asked.collisions()), content_of(asked.separation()), content_of(asked.closest_primitives(0.3)),
            content_of(asked.separation(table, moved)),
        ]  # fmt: skip

    wanted = answers(scene)
    assert answers(again) == wanted and len(scene.collisions()) > 0
    objects = {tuple(pair) for pair in again.collisions().object.tolist()}
    assert (table, other) not in objects and (table, moved) in objects
    assert again.collisions().culling == "voronoi"
    # Both scenes are complete, and independent of each other.
    for numbers in (again, scene):
        with pytest.raises(blum.InvalidOption, match="1"):
            numbers.update(gone, vertices=ball.vertices)
    again.update(moved, transform=np.eye(4))
    again.exclude(table, other, False)
    assert answers(scene) == wanted != answers(again)
    assert again.add(BOX) == scene.add(BOX) == 5
    again.remove(table)
    with pytest.raises(blum.InvalidMesh, match="'box'"):
        again.update(other, vertices=[[0, 0, 0]])
    assert repr(WAYS[way](again)) == "ProximityScene(4 objects)"


def test_pickles_are_whole_in_another_process(tmp_path):
    held = {
        "query": blum.ClosestPointQuery(BOX),
        "winding": blum.WindingNumber(BOX),
        "solid": blum.Solid(BOX),
        "axis": blum.medial_axis(BOX, resolution=16),
        "map": blum.thickness_map(BOX, texel=0.1),
    }
    (tmp_path / "held.pickle").write_bytes(pickle.dumps(held))
    code = (
        "import pickle, sys, pathlib\n"
        "held = pickle.loads(pathlib.Path(sys.argv[1]).read_bytes())\n"
        "print(held['query']([[0, 0, 5]]).distance.tolist(), held['winding']([[0, 0, 0]]).round(9).tolist(),\n"
        "      held['solid'].betti, held['axis'].simplify(120).sheet_count, held['map'].statistics().largest)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path / "held.pickle")], capture_output=True, text=True, check=True
    )
    sheets = held["axis"].simplify(120).sheet_count
    assert done.stdout.split("\n")[0] == f"[4.5] [1.0] (1, 0, 0) {sheets} 1.0"


def test_no_temporary_files_stay(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    pickle.loads(pickle.dumps(blum.thickness_map(BOX, texel=0.1)))
    assert not list(pathlib.Path(tmp_path).iterdir())
