"""Proves that surfaces of turned images lie where NumPy puts them, in PyVista, VTK, SimpleITK and nibabel.

The expected points are the middles between the centre of a selected voxel and the centre of a neighbour that is not
selected. They follow from the mask and the affine of the image, without Blum.
"""

import os
import pathlib
import re

import numpy as np
import pytest

blum = pytest.importorskip("blum")
pyvista = pytest.importorskip("pyvista")
vtk = pytest.importorskip("vtk")

PROJECT = pathlib.Path(__file__).resolve().parents[2]
DATA = pathlib.Path(os.environ.get("BLUM_DATA_DIR", PROJECT.parent / "shared/data"))
TO_OTHER_AXES = np.array([-1, -1, 1])  # Between the axes of NIfTI (right, anterior) and of ITK (left, posterior).


def middles(selected, affine):
    """Middles of the edges (x, y, z) between selected voxels [x, y, z] and others, in lexicographic order."""
    found = []
    for axis in range(3):
        step = np.eye(3, dtype=int)[axis]
        differ = np.diff(selected.astype(int), axis=axis) != 0
        found.append(np.argwhere(differ) + 0.5 * step)
    steps = np.vstack(found)
    return ordered(steps @ affine[:3, :3].T + affine[:3, 3])


def ordered(points):
    """Distinct points by x, then y, then z, without the differences of rounding."""
    return np.unique(np.round(np.asarray(points, dtype=float), 5) + 0.0, axis=0)


def assert_same_points(points, expected):
    assert ordered(points).shape == expected.shape
    np.testing.assert_allclose(ordered(points), expected, rtol=0, atol=2e-5)


def affine_of(spacing, origin, direction):
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.array(direction) * spacing, origin
    return affine


def turned_image():
    """An image of a mask [z, y, x] that is turned about two axes, and the affine of its voxels."""
    cosine, sine = np.cos(0.7), np.sin(0.7)
    direction = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
    direction = direction @ np.array([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    mask = np.zeros((9, 8, 7), dtype=np.uint8)
    mask[3:6, 2:5, 2:4] = 1
    mask[6, 3, 2] = 1
    spacing, origin = (0.5, 0.7, 0.9), (30, -4, 5)
    image = blum.Image(mask, spacing, origin, direction, space="right-anterior-superior")
    return image, mask.transpose() > 0, affine_of(spacing, origin, direction)


def file_image():
    """The image of a file, with the mask and the affine that nibabel reads."""
    path = DATA / "reported/turned.nii.gz"
    if not path.exists():
        pytest.skip(f"no file {path}")
    read = pytest.importorskip("nibabel").load(path)
    return blum.read_image(path), np.asarray(read.dataobj) > 0, read.affine


@pytest.fixture(params=[turned_image, file_image], ids=["made", "file"])
def turned(request):
    """A signed field of two values, so that contours pass through the middles, and the expected points."""
    image, selected, affine = request.param()
    values = np.where(selected.transpose(), -1.0, 1.0)
    field = blum.Field(values, image.grid)
    return image, field, middles(selected, affine), affine


def test_contours_of_pyvista_lie_where_the_affine_puts_them(turned):
    _, field, expected, _ = turned
    nodes = field.to_pyvista()
    assert isinstance(nodes, pyvista.StructuredGrid)
    assert np.array_equal(nodes.point_data["distance"], field.distance.ravel())
    assert_same_points(nodes.contour([0.0], scalars="distance").points, expected)


@pytest.mark.parametrize("kind", ["vtkContourFilter", "vtkContourGrid"])
def test_contours_of_vtk_lie_where_the_affine_puts_them(turned, kind):
    _, field, expected, _ = turned
    nodes = field.to_pyvista()
    if kind == "vtkContourGrid":
        nodes = nodes.cast_to_unstructured_grid()
    contour = getattr(vtk, kind)()
    contour.SetInputData(nodes)
    contour.SetInputArrayToProcess(0, 0, 0, 0, "distance")
    contour.SetValue(0, 0.0)
    contour.Update()
    assert_same_points(pyvista.wrap(contour.GetOutput()).points, expected)


def test_the_recipe_of_the_guide_puts_the_surface_there(turned, tmp_path, capsys):
    _, field, expected, _ = turned
    text = (PROJECT / "docs/guide/files.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    (recipe,) = [block for block in blocks if "vtkFiltersCore" in block]
    field.write(tmp_path / "knot.vti")
    recipe = recipe.replace('"knot.vti"', repr(str(tmp_path / "knot.vti")))
    recipe = recipe.replace("SetValue(0, 0.1)", "SetValue(0, 0)")
    names = {}
    exec(compile(recipe, "docs/guide/files.md", "exec"), names)
    assert int(capsys.readouterr().out.split()[0]) > 0
    assert_same_points(pyvista.wrap(names["offset"].GetOutput()).points, expected)


def test_paraviews_filters_put_the_surface_there(turned, tmp_path):
    """The filters that the guide names for ParaView: first a point set, then a contour."""
    _, field, expected, _ = turned
    field.write(tmp_path / "field.vti")
    reader, nodes, contour = vtk.vtkXMLImageDataReader(), vtk.vtkImageDataToPointSet(), vtk.vtkContourFilter()
    reader.SetFileName(str(tmp_path / "field.vti"))
    nodes.SetInputConnection(reader.GetOutputPort())
    contour.SetInputConnection(nodes.GetOutputPort())
    contour.SetInputArrayToProcess(0, 0, 0, 0, "distance")
    contour.SetValue(0, 0.0)
    contour.Update()
    assert_same_points(pyvista.wrap(contour.GetOutput()).points, expected)


def test_zero_surfaces_lie_between_the_same_voxels(turned):
    """Blum's own surface also has vertices on diagonals, so only its box equals that of the expected points."""
    _, field, expected, _ = turned
    surface = field.zero_surface()
    inside = pyvista.PolyData(expected).bounds
    lower, upper = surface.bounds
    assert np.all(np.array(lower) <= np.array(inside[::2]) + 1e-5)
    assert np.all(np.array(upper) >= np.array(inside[1::2]) - 1e-5)
    nearest = blum.reference.nearest(surface, expected)[0]
    assert nearest.max() < 1e-5


def test_simpleitk_finds_zero_at_the_surface(turned, tmp_path):
    """The file of this field states no world axes, so SimpleITK takes its coordinates as they are."""
    sitk = pytest.importorskip("SimpleITK")
    _, field, expected, _ = turned
    field.write(tmp_path / "field.nrrd")
    read = sitk.ReadImage(str(tmp_path / "field.nrrd"), sitk.sitkFloat32)
    values = [read.EvaluateAtPhysicalPoint(point.tolist()) for point in expected]
    assert np.abs(values).max() < 1e-4 and len(values) > 10


def test_simpleitk_puts_the_field_of_an_image_there(turned, tmp_path):
    sitk = pytest.importorskip("SimpleITK")
    image, _, _, affine = turned
    field = blum.distance_transform(image)
    field.write(tmp_path / "field.nrrd")
    read = sitk.ReadImage(str(tmp_path / "field.nrrd"), sitk.sitkFloat32)
    # Nodes are where the affine puts them.
    for index in ((0, 0, 0), (1, 2, 3), (5, 4, 3)):
        place = np.array(read.TransformIndexToPhysicalPoint(index)) * TO_OTHER_AXES
        np.testing.assert_allclose(place, affine[:3, :3] @ index + affine[:3, 3], atol=1e-5)
        assert read[index] == field.distance[index[::-1]]


def test_grids_along_the_axes_stay_images():
    field = blum.distance_field(blum.generate("box"), resolution=8)
    image = field.to_pyvista()
    assert isinstance(image, pyvista.ImageData) and image.dimensions == field.grid.size
    np.testing.assert_allclose(image.points.reshape(8, 8, 8, 3), field.grid.positions(), atol=1e-12)


@pytest.mark.parametrize("order", [1, 2])
def test_all_values_of_turned_fields_keep_their_places(order):
    _, _, affine = turned_image()
    size = (4, 5, 6)
    direction = affine[:3, :3] / np.linalg.norm(affine[:3, :3], axis=0)
    field = blum.distance_field(blum.generate("box"), grid=blum.Grid((0, 0, 0), 0.3, size, direction), order=order)
    nodes = field.to_pyvista()
    names = ["distance", "site"] if order == 1 else ["distance", "site", "distance2", "site2"]
    assert sorted(nodes.point_data.keys()) == sorted(names)
    for node in range(0, 120, 7):
        k, j, i = np.unravel_index(node, size[::-1])
        np.testing.assert_allclose(nodes.points[node], direction @ (0.3 * np.array([i, j, k])), atol=1e-12)
        assert all(nodes.point_data[name][node] == getattr(field, name)[k, j, i] for name in names)
