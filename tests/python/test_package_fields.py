"""Proves that the package's fields, closest points and transforms equal brute force, SciPy and the command-line tool.

Every kind of input gives the same result, and arrays are shared as documented."""

import subprocess
import sys
import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def torus():
    return blum.generate("torus", ring_segments=24, tube_segments=12)


def soup(seed, triangles=20):
    random = np.random.default_rng(seed)
    vertices = random.uniform(-1, 1, (3 * triangles, 3))
    return vertices, np.arange(3 * triangles, dtype=np.int32).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(3))
def test_a_field_equals_brute_force(seed):
    vertices, triangles = soup(seed)
    field = blum.distance_field(vertices, triangles, resolution=20, sign="none")
    expected, _ = blum.reference.nearest((vertices, triangles), field.grid.positions())
    extent = np.linalg.norm(np.ptp(vertices, axis=0))
    assert np.abs(field.distance - expected).max() <= 1e-6 * 2 * extent
    # Sites are vertices, edges or faces.
    sites = blum.Sites(vertices, triangles)
    assert set(sites.kind(np.unique(field.site))) <= {"vertex", "edge", "face"}


def test_all_defaults_are_those_of_the_tool(torus, tmp_path):
    import tool

    torus.write(tmp_path / "torus.ply")
    tool.run("field", tmp_path / "torus.ply", "-o", tmp_path / "field.npz", "--resolution", 40)
    theirs, ours = blum.read_field(tmp_path / "field.npz"), blum.distance_field(torus, resolution=40)
    assert np.array_equal(theirs.distance, ours.distance) and np.array_equal(theirs.site, ours.site)
    assert theirs.grid == ours.grid and theirs.sign_rule == ours.sign_rule == "normals"


def test_arrays_are_shared_both_ways(torus):
    mesh = blum.Mesh(torus.vertices, torus.triangles)
    assert mesh.vertices is torus.vertices and mesh.triangles is torus.triangles
    field = blum.distance_field(mesh, resolution=16)
    assert field.distance is field.distance and field.distance.flags.c_contiguous
    assert np.shares_memory(np.from_dlpack(field.distance), field.distance)
    distance, expected = field.distance, field.distance.copy()
    del field
    for _ in range(3):
        blum.distance_field(mesh, resolution=16, sign="none")
    assert np.array_equal(distance, expected), "an array must outlive its field"
    image = np.zeros((4, 5, 6), dtype=np.float32)
    assert np.shares_memory(blum.Image(image).values, image)


def test_second_sites_have_no_vertex_of_the_first(torus, tmp_path):
    first = blum.distance_field(torus, resolution=20)
    assert first.distance2 is None and first.site2 is None and first.second is None
    field = blum.distance_field(torus, resolution=20, order=2)
    assert np.array_equal(field.distance, first.distance) and np.array_equal(field.site, first.site)
    assert field.distance2.dtype == np.float32 and field.site2.dtype == np.int32
    assert field.distance2.shape == field.site2.shape == field.distance.shape
    assert field.second == "no-common-vertex" and (field.distance2 >= np.abs(field.distance)).all()
    sites = blum.Sites(torus)
    own, other = sites.vertices(field.site.ravel()), sites.vertices(field.site2.ravel())
    assert not ((own[..., :, None] == other[..., None, :]) & (own[..., :, None] >= 0)).any()
    for end in ("nrrd", "npz", "vti"):
        field.write(tmp_path / f"both.{end}")
        again = blum.read_field(tmp_path / f"both.{end}")
        assert np.array_equal(again.distance2, field.distance2) and np.array_equal(again.site2, field.site2)
        assert again.second == field.second
    import pickle

    copy = pickle.loads(pickle.dumps(field))
    assert np.array_equal(copy.distance2, field.distance2) and np.array_equal(copy.site2, field.site2)
    assert copy.second == field.second


def test_second_sites_of_other_objects_are_those_of_the_other_mesh():
    one = blum.generate("sphere", frequency=4)
    vertices = np.vstack([one.vertices, one.vertices * 0.5 + (2, 0.3, 0)])
    triangles = np.vstack([one.triangles, one.triangles + len(one.vertices)])
    other = blum.Mesh(vertices[len(one.vertices) :], one.triangles)
    field = blum.distance_field(vertices, triangles, resolution=24, sign="none", order=2, second="other-object")
    near = [blum.distance_field(mesh, grid=field.grid, sign="none").distance for mesh in (one, other)]
    assert np.abs(field.distance2 - np.maximum(*near)).max() < 1e-5
    # Objects given by any labels give the same result; one object alone has no second site.
    labels = np.where(np.arange(len(vertices)) < len(one.vertices), -7, 1000)
    given = blum.distance_field(
        vertices, triangles, grid=field.grid, sign="none", order=2, second="other-object", objects=labels
    )
    assert np.array_equal(given.distance2, field.distance2) and np.array_equal(given.site2, field.site2)
    one_object = blum.FieldSolver(field.grid, sign="none", order=2, second="other-object")
    alone = one_object.compute(vertices, triangles, objects=np.zeros(len(vertices), dtype=int))
    assert np.isinf(alone.distance2).all() and (alone.site2 == -1).all()
    assert np.array_equal(one_object.compute(vertices, triangles).distance2, field.distance2)


def test_wrong_arguments_of_order_2_are_rejected(torus):
    with pytest.raises(blum.InvalidOption, match="order"):
        blum.distance_field(torus, resolution=8, order=3)
    with pytest.raises(blum.InvalidOption, match="objects"):
        blum.distance_field(torus, resolution=8, objects=np.zeros(len(torus.vertices), dtype=int))
    with pytest.raises(blum.InvalidOption, match="objects"):
        blum.distance_field(torus, resolution=8, order=2, second="other-object", objects=[1, 2])
    with pytest.raises(ValueError, match="integers of the shape"):
        blum.distance_field(torus, resolution=8, order=2, second="other-object", objects=[0.5])
    with pytest.raises(blum.InvalidOption, match="CPU"):
        blum.distance_field(torus, resolution=8, order=2, device="cuda")


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int64])
@pytest.mark.parametrize("index", [np.int32, np.uint32, np.int64, np.uint8])
def test_every_dtype_and_order_gives_the_same_field(dtype, index):
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]])
    triangles = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    expected = blum.distance_field(vertices.astype(float), triangles.astype(np.int32), resolution=12)
    given_vertices = np.asfortranarray(vertices.astype(dtype))
    field = blum.distance_field(given_vertices, triangles.astype(index)[::-1][::-1], resolution=12)
    assert np.array_equal(field.distance, expected.distance)


def test_objects_of_other_packages(torus, tmp_path):
    trimesh, meshio = pytest.importorskip("trimesh"), pytest.importorskip("meshio")
    pyvista = pytest.importorskip("pyvista")
    torus.write(tmp_path / "torus.ply")
    inputs = [
        trimesh.Trimesh(torus.vertices, torus.triangles, process=False),
        meshio.Mesh(torus.vertices, [("triangle", torus.triangles)]),
        torus.to_pyvista(),
        torus.to_pyvista().cast_to_unstructured_grid(),
        tmp_path / "torus.ply",
        str(tmp_path / "torus.ply"),
        (torus.vertices, torus.triangles),
    ]
    expected = blum.distance_field(torus, resolution=16).distance
    for value in inputs:
        field = blum.distance_field(value, resolution=16)
        assert np.abs(field.distance - expected).max() < 1e-6, type(value)
    assert torus.to_trimesh().is_watertight
    assert isinstance(torus.to_pyvista(), pyvista.PolyData)
    grid = blum.distance_field(torus, resolution=16).to_pyvista()
    assert np.array_equal(grid.point_data["distance"], expected.ravel())


@pytest.mark.parametrize(
    "shape",
    [
        'blum.generate("torus")',
        'blum.distance_field(blum.generate("torus"), resolution=8)',
        'blum.medial_axis(blum.generate("torus"), resolution=32).simplify(60)',
    ],
)
def test_arrays_that_vtk_holds_until_exit_cause_no_leak_report(shape):
    pytest.importorskip("pyvista")
    code = f"import blum; held = {shape}.to_pyvista()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stderr == ""


def test_signed_distances_agree_with_trimesh(torus):
    trimesh = pytest.importorskip("trimesh")
    points = np.random.default_rng(3).uniform(-1.2, 1.2, (300, 3))
    found = blum.closest_points(torus, points)
    mesh = torus.to_trimesh()
    closest, distance, _ = trimesh.proximity.closest_point_naive(mesh, points)
    assert np.abs(np.abs(found.distance) - distance).max() < 1e-9
    assert np.abs(found.closest - closest).max() < 1e-6
    assert np.array_equal(found.distance < 0, blum.WindingNumber(torus).is_inside(points))


@settings(max_examples=40, deadline=None)
@given(arrays(np.bool_, st.tuples(*[st.integers(1, 7)] * 3)), st.tuples(*[st.sampled_from([0.5, 1.0, 3.0])] * 3))
def test_transforms_equal_scipy(mask, spacing):
    if not mask.any():
        with pytest.raises(ValueError, match="no voxel"):
            blum.distance_transform(mask, spacing=spacing, signed=False)
        return
    field = blum.distance_transform(mask, spacing=spacing, signed=False)
    expected = ndimage.distance_transform_edt(~mask, sampling=spacing[::-1])
    assert np.allclose(field.distance, expected, rtol=1e-6, atol=0)
    assert mask.ravel()[field.site].all()
    squared, _ = blum.reference.nearest_voxel(mask, np.arange(mask.size), grid=field.grid)
    assert np.allclose(field.distance.ravel() ** 2, squared, rtol=1e-6)


def test_labels_thresholds_and_bands():
    image = blum.generate("balls_image", count=3)
    one, two = blum.distance_transforms(image, [1, 2])
    assert np.array_equal(one.distance, blum.distance_transform(image, label=1).distance)
    assert np.array_equal(two.distance < 0, image.values == 2)
    above = blum.distance_transform(image, threshold=2)
    assert np.array_equal(above.distance < 0, image.values >= 2)
    band = blum.distance_transform(image, band=2.0)
    assert band.band == 2.0 and np.abs(band.distance).max() == 2.0 and (band.site == -1).any()
    assert np.array_equal(blum.selected_voxels(image, label=3), image.values == 3)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_interpolation_is_right_at_nodes_and_nan_outside(seed):
    vertices, triangles = soup(seed, 3)
    field = blum.distance_field(vertices, triangles, resolution=8)
    values = field.interpolate(field.grid.positions())
    assert np.abs(values - field.distance).max() < 1e-6
    assert np.isnan(field.interpolate(np.array(field.grid.bounds[1]) + 1))


def test_a_solver_follows_a_deforming_mesh(torus):
    grid = blum.Grid.around(torus, resolution=24, padding=0.5)
    own, reused = blum.FieldSolver(grid), blum.FieldSolver(grid, reuse=True)
    for scale in (1.0, 0.7, 1.3):
        vertices = torus.vertices * scale
        expected = blum.distance_field(vertices, torus.triangles, grid=grid)
        for solver in (own, reused):
            frame = solver.compute(vertices, torus.triangles)
            assert np.array_equal(frame.distance, expected.distance) and np.array_equal(frame.site, expected.site)
    first = own.compute(torus).distance.copy()
    kept = own.compute(torus).distance
    own.compute(torus.vertices * 0.5, torus.triangles)
    assert np.array_equal(kept, first), "without reuse each frame has its own arrays"


@pytest.mark.parametrize("options", [{}, {"band": 0.1, "sign": "winding"}, {"site_ids": "triangles"}])
def test_fields_without_sites_have_the_same_distances(torus, tmp_path, options):
    grid = blum.Grid.around(torus, resolution=24)
    expected = blum.distance_field(torus, grid=grid, **options).distance
    field = blum.distance_field(torus, grid=grid, sites=False, **options)
    assert field.site is None and np.array_equal(field.distance, expected)
    solver = blum.FieldSolver(grid, sites=False, reuse=True, **options)
    for _ in range(2):
        frame = solver.compute(torus)
        assert frame.site is None and np.array_equal(frame.distance, expected)
    for name in ("field.nrrd", "field.npz", "field.vti"):
        field.write(tmp_path / name)
        back = blum.read_field(tmp_path / name)
        assert back.site is None and np.array_equal(back.distance, expected)
    assert len(list(tmp_path.iterdir())) == 3
    assert field.interpolate([0, 0, 0]) == blum.distance_field(torus, grid=grid, **options).interpolate([0, 0, 0])


def test_threads_call_at_once(torus):
    grid, expected = blum.Grid.around(torus, resolution=32), blum.distance_field(torus, resolution=32).distance
    solver, wrong = blum.FieldSolver(grid, reuse=False), []

    def work():
        for _ in range(5):
            if not np.array_equal(blum.distance_field(torus, grid=grid, threads=1).distance, expected):
                wrong.append("field")
            if not np.array_equal(solver.compute(torus, threads=1).distance, expected):
                wrong.append("solver")

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


def test_files_go_round(torus, tmp_path):
    field = blum.distance_field(torus, resolution=12)
    for name in ("field.nrrd", "field.npz", "field.vti"):
        field.write(tmp_path / name)
        back = blum.read_field(tmp_path / name)
        assert np.array_equal(back.distance, field.distance) and np.array_equal(back.site, field.site)
    torus.write(tmp_path / "torus.off")
    assert np.array_equal(blum.read_mesh(tmp_path / "torus.off").vertices, torus.vertices)
    image = blum.Image(np.arange(24, dtype=np.int16).reshape(2, 3, 4), spacing=(1, 2, 3), origin=(4, 5, 6))
    image.write(tmp_path / "image.nrrd")
    again = blum.read_image(tmp_path / "image.nrrd")
    assert np.array_equal(again.values, image.values) and again.grid == image.grid


def test_level_surfaces_and_topology(torus):
    surface = blum.distance_field(torus, resolution=48).zero_surface()
    facts = blum.topology(surface)
    assert facts.betti == (1, 1, 0) and facts.closed and facts.manifold and facts.shells[0].genus == 1
    assert not len(blum.self_intersections(surface).pairs)
    crossing = blum.self_intersections(
        np.array([[0, 0, -1], [0, 0, 1], [0, 1, 0], [-1, 0.2, 0], [1, 0.2, 0], [0, 0.4, 1.0]]), [[0, 1, 2], [3, 4, 5]]
    )
    assert crossing.pairs.tolist() == [[0, 1]] and crossing.crosses.tolist() == [True]


def test_typed_image_names_are_complete():
    from typing import get_args

    from blum._shapes import _ImageName

    assert set(get_args(_ImageName)) == {name for name, shape in blum.shapes().items() if shape.kind == "image"}


def volume(mesh):
    return np.linalg.det(mesh.vertices[mesh.triangles]).sum() / 6


def test_meshes_made_of_polygons_and_of_meshes():
    square = np.array([[0, 0], [4, 0], [4, 3], [0, 3]])
    frame = blum.extrusion(square, [[[1, 1], [3, 1], [3, 2], [1, 2]]], thickness=0.5, stacks=2)
    assert blum.topology(frame).betti == (1, 1, 0) and np.isclose(volume(frame), (12 - 2) * 0.5)
    assert frame.bounds == ((0, 0, -0.25), (4, 3, 0.25))
    fine = blum.subdivided(frame, 2)
    assert len(fine.triangles) == 16 * len(frame.triangles) and np.isclose(volume(fine), 5)
    assert np.array_equal(blum.noisy(frame, 0).vertices, frame.vertices)
    moved = [np.linalg.norm(blum.noisy(frame, 0.1, seed=seed).vertices - frame.vertices, axis=1) for seed in (1, 2)]
    assert all(0.02 < found.max() <= 0.1 for found in moved) and not np.array_equal(*moved)
    for call, name in (
        (lambda: blum.extrusion(square[:, :1]), "outline"),
        (lambda: blum.extrusion(square, [[[1, 1], [3, np.nan], [3, 2]]]), r"holes\[0\]|finite"),
        (lambda: blum.extrusion(square, thickness=0), "thickness"),
        (lambda: blum.noisy(frame, -1), "amplitude"),
        (lambda: blum.noisy(frame, 1, seed=-1), "seed"),
        (lambda: blum.subdivided(frame, 13), "levels"),
    ):
        with pytest.raises(ValueError, match=name):
            call()
