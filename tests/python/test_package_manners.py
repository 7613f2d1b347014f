"""Proves that mistakes in arguments cause errors with a remedy, and that images of SimpleITK keep their places."""

import inspect
import re

import numpy as np
import pytest

blum = pytest.importorskip("blum")

BOX = blum.generate("box")
GRID = blum.Grid((-1, -1, -1), 0.5, (5, 5, 5))
IMAGE = blum.generate("ball_image", size=8)


@pytest.mark.parametrize(
    ("call", "wrong", "right"),
    [
        (lambda **options: blum.distance_field(BOX, **options), "resolutoin", "resolution"),
        (lambda **options: blum.distance_field(BOX, **options), "sing", "sign"),
        (lambda **options: blum.distance_field(BOX, **options), "Resolution", "resolution"),
        (lambda **options: blum.FieldSolver(GRID, **options), "sits", "sites"),
        (lambda **options: blum.closest_points(BOX, [[0, 0, 0]], **options), "max_dist", "max_distance"),
        (lambda **options: blum.ClosestPointQuery(BOX, **options), "maxdistance", "max_distance"),
        (lambda **options: blum.medial_axis(BOX, **options), "lambda", "lambda_"),
        (lambda **options: blum.distance_transform(IMAGE, **options), "treshold", "threshold"),
        (lambda **options: blum.voronoi_complex(BOX, **options), "tolerence", "tolerance"),
        (lambda **options: blum.Solid(BOX).model(**options), "resolutions", "resolution"),
        (lambda **options: blum.ProximityScene(**options), "cull", "culling"),
    ],
)
def test_a_misspelt_option_names_the_nearest_one(call, wrong, right):
    with pytest.raises(TypeError, match=rf"\(\) has no option '{wrong}': did you mean '{right}'\?$"):
        call(**{wrong: 1})


def test_an_option_like_no_other_lists_all_of_them():
    with pytest.raises(
        TypeError, match=r"sample_surface\(\) has no option 'qqq': there are mesh, .*, seed, blue_noise"
    ):
        blum.sample_surface(BOX, 10, qqq=1)


def test_wrapped_functions_keep_their_names_and_arguments():
    for name in ("distance_field", "medial_axis", "voronoi_complex"):
        function = getattr(blum, name)
        assert function.__name__ == name and function.__module__.startswith("blum._")
        assert not any(each.kind is each.VAR_KEYWORD for each in inspect.signature(function).parameters.values())
    with pytest.raises(TypeError, match="2 positional arguments but 3 were given"):
        blum.distance_field(BOX.vertices, BOX.triangles, GRID, sign="none")


@pytest.mark.parametrize(
    "call",
    [
        lambda: blum.distance_field(BOX, GRID),
        lambda: blum.distance_field(BOX.vertices, GRID),
        lambda: blum.FieldSolver(GRID).compute(BOX, GRID),
        lambda: blum.medial_axis(BOX, GRID),
        lambda: blum.topology(BOX, GRID),
    ],
)
def test_a_grid_in_the_place_of_triangles_is_named(call):
    with pytest.raises(TypeError, match=r"triangles is a blum\.Grid.*pass a grid by its name, grid=\.\.\."):
        call()


def test_a_second_argument_after_a_mesh_is_named(tmp_path):
    BOX.write(tmp_path / "box.ply")
    for mesh in (BOX, tmp_path / "box.ply"):
        with pytest.raises(TypeError, match=r"has triangles of its own: leave out triangles"):
            blum.topology(mesh, BOX.triangles)
        with pytest.raises(TypeError, match=r"has triangles of its own: leave out triangles"):
            blum.ClosestPointQuery(mesh, [[0, 0, 0]])
    with pytest.raises(TypeError, match="points must hold real numbers, not Grid"):
        blum.closest_points(BOX, GRID)
    with pytest.raises(TypeError, match="vertices must hold real numbers, not Grid"):
        blum.distance_field(GRID, BOX.triangles)


@pytest.mark.parametrize(
    "call",
    [
        lambda **options: blum.distance_field(BOX, **options),
        lambda **options: blum.distance_field(BOX, bounds=((0, 0, 0), (1, 1, 1)), **options),
        lambda **options: blum.Grid.around(BOX, **options),
        lambda **options: blum.Grid.within(((0, 0, 0), (1, 1, 1)), **options),
        lambda **options: blum.MedialComplex([[0, 0, 0]], radius=[1]).reconstruct(**options),
        lambda **options: blum.medial_axis(BOX, **options),
        lambda **options: blum.Solid(BOX).model(**options),
    ],
)
def test_resolution_and_spacing_exclude_each_other(call):
    with pytest.raises(blum.InvalidOption, match="resolution and spacing exclude each other"):
        call(resolution=16, spacing=0.1)
    assert call(resolution=16) is not None and call(spacing=0.1) is not None


def test_a_grid_excludes_resolution_and_spacing():
    for options in ({"resolution": 8}, {"spacing": 1}, {"bounds": ((0, 0, 0), (1, 1, 1))}):
        with pytest.raises(blum.InvalidOption, match="grid excludes bounds, spacing and resolution"):
            blum.distance_field(BOX, grid=GRID, **options)


def test_the_default_resolution_is_256():
    assert max(blum.Grid.around(BOX).size) == max(blum.Grid.within(((0, 0, 0), (1, 2, 3))).size) == 256


NEGATIVE_THREADS = {
    "distance_field": lambda threads: blum.distance_field(BOX, resolution=8, threads=threads),
    "distance_transform": lambda threads: blum.distance_transform(IMAGE, threads=threads),
    "closest_points": lambda threads: blum.closest_points(BOX, [[0, 0, 0]], threads=threads),
    "topology": lambda threads: blum.topology(BOX, threads=threads),
    "medial_axis": lambda threads: blum.medial_axis(BOX, resolution=8, threads=threads),
    "separation": lambda threads: blum.separation(BOX, BOX, threads=threads),
    "thickness": lambda threads: blum.thickness(BOX, threads=threads),
    "Solid": lambda threads: blum.Solid(BOX, threads=threads),
    "Sites": lambda threads: blum.Sites(BOX, threads=threads),
    "oriented_mesh": lambda threads: blum.oriented_mesh(BOX, threads=threads),
    "CellularModel.complex": lambda threads: blum.Solid(BOX).model(resolution=2).complex(threads=threads),
    "thread_count": lambda threads: blum.thread_count(threads),
}


@pytest.mark.parametrize("name", NEGATIVE_THREADS)
@pytest.mark.parametrize("threads", [-1, 10**6])
def test_numbers_of_threads_out_of_range_are_rejected(name, threads):
    with pytest.raises(blum.InvalidOption, match=re.escape(f"threads is {threads}, but must be 0 (all cores) to 1024")):
        NEGATIVE_THREADS[name](threads)


def test_images_are_no_meshes():
    for image in (IMAGE, IMAGE.values):
        with pytest.raises(TypeError, match=r"smooth_surface\(image\) makes one of an image"):
            blum.distance_field(image, resolution=8)


# Images of SimpleITK. Expected places are those of its TransformIndexToPhysicalPoint().


@pytest.fixture(scope="module")
def sitk():
    return pytest.importorskip("SimpleITK")


def scan(sitk):
    """A turned image of a block of 2 x 3 x 4 voxels of the value 5, and one voxel of the value 7."""
    values = np.zeros((9, 8, 7), dtype=np.int16)
    values[3:7, 2:5, 3:5] = 5
    values[1, 1, 1] = 7
    image = sitk.GetImageFromArray(values)
    cosine, sine = np.cos(0.4), np.sin(0.4)
    image.SetSpacing((0.5, 0.75, 2.0))
    image.SetOrigin((10, -20, 30))
    image.SetDirection((cosine, -sine, 0, sine, cosine, 0, 0, 0, 1))
    return image, values


def places(image, indices):
    """Places of voxels [z, y, x] by SimpleITK."""
    return np.array([image.TransformIndexToPhysicalPoint([int(i) for i in index[::-1]]) for index in indices])


def test_transforms_of_simpleitk_equal_brute_force(sitk):
    image, values = scan(sitk)
    field = blum.distance_transform(image, label=5, signed=False)
    every = places(image, np.argwhere(np.ones_like(values)))
    chosen = places(image, np.argwhere(values == 5))
    expected = np.linalg.norm(every[:, None] - chosen[None], axis=-1).min(axis=1)
    np.testing.assert_allclose(field.distance.ravel(), expected, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(field.grid.positions().reshape(-1, 3), every, atol=1e-12)


def test_fields_of_simpleitk_go_back_to_the_same_places(sitk, tmp_path):
    image, _ = scan(sitk)
    blum.distance_transform(image, label=5).write(tmp_path / "field.nrrd")
    read = sitk.ReadImage(str(tmp_path / "field.nrrd"))
    assert read.GetSize() == image.GetSize()
    for name in ("GetSpacing", "GetOrigin", "GetDirection"):
        np.testing.assert_allclose(getattr(read, name)(), getattr(image, name)(), atol=1e-12)


def test_every_function_of_an_image_takes_simpleitk(sitk, tmp_path):
    image, values = scan(sitk)
    own = blum.as_image(image)
    assert np.array_equal(own.values, values) and own.space == "left-posterior-superior"
    assert np.array_equal(blum.selected_voxels(image, label=7), values == 7)
    vertices = blum.smooth_surface(image, label=5, iterations=0).vertices
    inside = places(image, np.argwhere(values == 5))
    assert np.all(vertices.min(axis=0) < inside.min(axis=0)) and np.all(vertices.max(axis=0) > inside.max(axis=0))
    solid = blum.Solid(image, label=5)
    assert solid.betti == (1, 0, 0) and solid.inside(inside).all()
    axis = blum.medial_axis(image, label=5).simplify(60)
    assert axis.certificate.holds and blum.certify(axis, image, label=5).holds
    assert blum.centreline(image, label=5)[0].voxels == 24
    assert blum.distance_transforms(image, [5, 7])[1].distance.shape == values.shape
    assert blum.view(image, output=tmp_path / "page.html", show=False).stat().st_size > 1000


def test_images_of_simpleitk_with_other_shapes_are_rejected(sitk):
    flat = sitk.GetImageFromArray(np.ones((3, 4), dtype=np.uint8))
    colours = sitk.GetImageFromArray(np.ones((3, 4, 5, 3), dtype=np.uint8), isVector=True)
    for image, found in ((flat, "2 axes and 1 numbers"), (colours, "3 axes and 3 numbers")):
        with pytest.raises(blum.InvalidImage, match=rf"image has {found} per voxel, but must have 3 axes and 1 number"):
            blum.distance_transform(image)
    image, _ = scan(sitk)
    with pytest.raises(blum.InvalidOption, match="spacing is given, but the image has its own"):
        blum.distance_transform(image, spacing=1)
    with pytest.raises(TypeError, match=r"SimpleITK image: .* blum\.as_image\(image\)"):
        blum.Image(image)


def test_images_of_nibabel_are_rejected_with_advice():
    nibabel = pytest.importorskip("nibabel")
    with pytest.raises(TypeError, match=r"is a Nifti1Image.*blum\.read_image\(path\) reads its file"):
        blum.distance_transform(nibabel.Nifti1Image(np.ones((3, 3, 3), dtype=np.uint8), np.eye(4)))
