"""Proves signs, shell meshes, percentiles, turned images and PolyData on families whose answers are known."""

import itertools
import warnings

import numpy as np
import pytest
from reported_solids import rotation, together

blum = pytest.importorskip("blum")


# Signs: every signed result is right inside and outside, or a warning reports why it may not be.


def sphere(radius, frequency=6):
    mesh = blum.generate("sphere", radius=radius, frequency=frequency)
    return mesh.vertices.copy(), mesh.triangles.astype(np.int32)


def box(low, high, segments=4):
    mesh = blum.generate("box", segments=segments)
    return low + (mesh.vertices + 0.5) * (np.array(high) - low), mesh.triangles.astype(np.int32)


def inverted(mesh):
    return mesh[0], mesh[1][:, ::-1].copy()


def flipped(mesh, seed=1, share=0.5):
    triangles = mesh[1].copy()
    turned = np.random.default_rng(seed).random(len(triangles)) < share
    triangles[turned] = triangles[turned][:, ::-1]
    return mesh[0], triangles


def shell(low, high, count=40):
    rng = np.random.default_rng(7)
    direction = rng.normal(size=(count, 3))
    return direction / np.linalg.norm(direction, axis=1)[:, None] * rng.uniform(low, high, (count, 1))


def bricks(*boxes):
    """Points inside boxes, and points outside of them."""
    rng = np.random.default_rng(8)
    inside = np.concatenate([low + np.subtract(high, low) * rng.uniform(0.1, 0.9, (30, 3)) for low, high in boxes])
    outside = rng.uniform(-1, 3, (200, 3))
    for low, high in boxes:
        outside = outside[~np.all((outside > np.array(low) - 0.05) & (outside < np.array(high) + 0.05), axis=1)]
    return inside, outside


def star():
    """A prism over a pentagram, which winds twice around its middle."""
    turn = 4 * np.pi * np.arange(5) / 5
    flat = np.c_[np.cos(turn), np.sin(turn)]
    vertices = np.r_[np.c_[flat, 0 * turn - 0.5], np.c_[flat, 0 * turn + 0.5], [[0, 0, -0.5], [0, 0, 0.5]]]
    triangles = [
        t
        for i, j in zip(range(5), [1, 2, 3, 4, 0], strict=True)
        for t in ([i, j, 5 + j], [i, 5 + j, 5 + i], [10, j, i], [11, 5 + i, 5 + j])
    ]
    return vertices, np.array(triangles, dtype=np.int32)


A, B, C = ((0.0, 0, 0), (1, 1, 1)), ((1.5, 0, 0), (2.5, 1, 1)), ((0.5, 0.5, 0.5), (1.5, 1.5, 1.5))
BALL, LARGE, MIDDLE, SMALL = sphere(1), sphere(2), sphere(1.4), sphere(0.8)
BALL_SIDES = shell(0, 0.9), shell(1.05, 2)
HOLLOW_SIDES = shell(1.5, 1.9), np.r_[shell(0, 1.3), shell(2.1, 3)]
THREE_SIDES = np.r_[shell(1.5, 1.9), shell(0, 0.7)], np.r_[shell(0.85, 1.3), shell(2.1, 3)]
STAR_SIDES = shell(0, 0.3), 0.8 * np.array([[np.cos(a), np.sin(a), 0] for a in np.pi / 5 * np.arange(1, 10, 2)])
OPEN_BOX = box(*A)[0], np.array([t for t in box(*A)[1] if box(*A)[0][t][:, 2].min() < 0.999], dtype=np.int32)

SIGNS = {
    "inverted box": (inverted(box(*A)), bricks(A)),
    "half-flipped box": (flipped(box(*A)), bricks(A)),
    "half-flipped coarse box": (flipped(box(*A, segments=1)), bricks(A)),
    "one flipped triangle": (flipped(box(*A), 2, 0.01), bricks(A)),
    "nearly all triangles flipped": (flipped(box(*A), 4, 0.9), bricks(A)),
    "inverted ball": (inverted(BALL), BALL_SIDES),
    "half-flipped ball": (flipped(BALL), BALL_SIDES),
    "one of two boxes inverted": (together(box(*A), inverted(box(*B))), bricks(A, B)),
    "both boxes inverted": (together(inverted(box(*A)), inverted(box(*B))), bricks(A, B)),
    "one of two boxes half flipped": (together(flipped(box(*A)), box(*B)), bricks(A, B)),
    "both boxes half flipped": (together(flipped(box(*A), 2), flipped(box(*B), 5)), bricks(A, B)),
    "hollow": (together(LARGE, inverted(MIDDLE)), HOLLOW_SIDES),
    "hollow, inverted": (together(inverted(LARGE), MIDDLE), HOLLOW_SIDES),
    "hollow, half flipped": (together(flipped(LARGE), flipped(MIDDLE, 2)), HOLLOW_SIDES),
    "three shells": (together(LARGE, inverted(MIDDLE), SMALL), THREE_SIDES),
    "three shells, inverted": (together(inverted(LARGE), MIDDLE, inverted(SMALL)), THREE_SIDES),
    "three shells, half flipped": (together(flipped(LARGE), flipped(MIDDLE, 2), flipped(SMALL, 3)), THREE_SIDES),
    "crossing": (together(box(*A), box(*C)), bricks(A, C)),
    "crossing, both inverted": (together(inverted(box(*A)), inverted(box(*C))), bricks(A, C)),
    "crossing, half flipped": (together(flipped(box(*A)), flipped(box(*C), 2)), bricks(A, C)),
    "pentagram": (star(), STAR_SIDES),
    "pentagram, inverted": (inverted(star()), STAR_SIDES),
    "pentagram, half flipped": (flipped(star(), 3), STAR_SIDES),
    "open box": (OPEN_BOX, ([[0.5, 0.5, 0.3], [0.2, 0.7, 0.2]], [[0.5, 0.5, 1.5], [2, 2, 2]])),
    "open box, half flipped": (flipped(OPEN_BOX), ([[0.5, 0.5, 0.3], [0.2, 0.7, 0.2]], [[0.5, 0.5, 1.5], [2, 2, 2]])),
    "doubled ball": (together(BALL, BALL), BALL_SIDES),
    "doubled ball, opposite": (together(BALL, inverted(BALL)), BALL_SIDES),
    "torus, half flipped": (
        flipped((blum.generate("torus").vertices, blum.generate("torus").triangles.astype(np.int32))),
        ([[1, 0, 0], [0, -1, 0]], [[0, 0, 0], [3, 0, 0]]),
    ),
}


def tetrahedra(points, size=1e-4):
    corner = size * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    triangles = np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]], dtype=np.int32)
    return together(*((point + corner, triangles) for point in points))


def from_field(make, points):
    field = make()
    node = np.round((points - field.origin) / field.spacing).astype(int)
    node = node.clip(0, np.array(field.distance.shape)[::-1] - 1)
    distance = field.distance[node[:, 2], node[:, 1], node[:, 0]]
    away = np.linalg.norm(field.origin + node * field.spacing - points, axis=1)
    return np.where(np.abs(distance) > away, distance, np.nan)  # nan: the surface may lie between node and point


def refitted(mesh, points):
    query = blum.ClosestPointQuery(mesh[0] + 1, mesh[1])
    query.refit(mesh[0])
    return query(points).distance


def mapped(mesh, points):
    found = blum.surface_distance_map(tetrahedra(points), mesh, sign="auto", texel=1e-4)
    return found.faces[:, 0].reshape(-1, 4).mean(axis=1)


def deviation(mesh, points):
    return np.array([blum.surface_deviation(tetrahedra([p]), mesh, sign="auto", pieces=10).mean for p in points[::10]])


ENTRIES = {
    "signed_distance": lambda mesh, points: blum.signed_distance(mesh, points).distance,
    "closest_points": lambda mesh, points: blum.closest_points(mesh, points).distance,
    "ClosestPointQuery": lambda mesh, points: blum.ClosestPointQuery(mesh)(points).distance,
    "refit": refitted,
    "distance_field": lambda mesh, points: from_field(lambda: blum.distance_field(mesh, resolution=28), points),
    "surface_distance_map": mapped,
    "surface_deviation": deviation,
}


@pytest.mark.parametrize("name", SIGNS)
def test_signs_are_right_or_a_warning_is_given(name):
    mesh, sides = SIGNS[name]
    for entry, distances in ENTRIES.items():
        wrong = 0
        with warnings.catch_warnings(record=True) as given:
            warnings.simplefilter("always")
            for points, sign in zip(sides, (-1, 1), strict=True):
                found = distances(mesh, np.array(points, dtype=float))
                wrong += np.sum(found * sign < 0)
        assert wrong == 0 or any(issubclass(w.category, blum.InputWarning) for w in given), f"{entry}: {wrong} wrong"


# Percentiles of surface maps and deviations: distributions that are known.


def flat(corner, u, v, count=1):
    step = np.linspace(0, 1, count + 1)
    vertices = np.array([np.array(corner) + a * np.array(u) + b * np.array(v) for a in step for b in step], dtype=float)
    cells = [i * (count + 1) + j for i in range(count) for j in range(count)]
    triangles = [t for k in cells for t in ([k, k + count + 1, k + count + 2], [k, k + count + 2, k + 1])]
    return vertices, np.array(triangles, dtype=np.int32)


def slope(degrees, count=1):
    turn = np.radians(degrees)
    return flat((0, 0, 0), (np.cos(turn), 0, np.sin(turn)), (0, 1, 0), count)


def ball_at(centre, radius):
    mesh = blum.generate("sphere", radius=radius, frequency=40)
    return mesh.vertices + centre, mesh.triangles.astype(np.int32)


GROUND = flat((-50, -50, 0), (100, 0, 0), (0, 100, 0))
CUBE = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5), 1)
LINE = flat((-9, 0, -1e-9), (18, 0, 0), (0, 0, 2e-9))
CORNER = (np.array([[0, 0, 0], [1e-9, 0, 0], [0, 1e-9, 0]]), np.array([[0, 1, 2]], dtype=np.int32))
FALLING = (np.array([[0, 0, 1], [1, 0, 0], [1, 1, 0.0]]), np.array([[0, 1, 2]], dtype=np.int32))
RISING = (np.array([[0, 0, 0], [1, 0, 1], [1, 1, 1.0]]), np.array([[0, 1, 2]], dtype=np.int32))
STEPS = together(flat((0, 0, 0.01), (0.97, 0, 0), (0, 1, 0)), flat((2, 0, 1), (0.03, 0, 0), (0, 1, 0)))

# Surface, other mesh, sign rule, the distance below which the share p of the surface lies, and the error of facets.
DISTRIBUTIONS = {
    "10 degrees": (slope(10), GROUND, "none", lambda p: p * np.sin(np.radians(10)), 0),
    "30 degrees": (slope(30, 7), GROUND, "none", lambda p: p * 0.5, 0),
    "80 degrees": (slope(80, 2), GROUND, "none", lambda p: p * np.sin(np.radians(80)), 0),
    "2 degrees": (slope(2, 40), GROUND, "none", lambda p: p * np.sin(np.radians(2)), 0),
    "across": (flat((0, 0, -0.3), (1, 0, 1), (0, 2, 0)), GROUND, "none", lambda p: np.maximum(p / 2, p - 0.3), 0),
    "parallel": (flat((0, 0, 0.25), (1, 0, 0), (0, 1, 0), 3), GROUND, "none", lambda p: 0.25 + 0 * p, 0),
    "rising triangle": (RISING, GROUND, "none", np.sqrt, 0),
    "falling triangle": (FALLING, GROUND, "none", lambda p: 1 - np.sqrt(1 - p), 0),
    "ball above ground": (ball_at((0, 0, 3), 1), GROUND, "none", lambda p: 2 + 2 * p, 4e-3),
    "small ball": (ball_at((0, 0, 30), 0.01), GROUND, "none", lambda p: 29.99 + 0.02 * p, 1e-4),
    "ball in ball": (ball_at((0, 0, 0), 1), ball_at((0, 0, 0), 1.5), "none", lambda p: 0.5 + 0 * p, 2e-3),
    "ball in ball, signed": (ball_at((0, 0, 0), 1), ball_at((0, 0, 0), 1.5), "auto", lambda p: 0 * p - 0.5, 2e-3),
    "shifted ball": (
        *(ball_at((0.2, 0, 0), 1), ball_at((0, 0, 0), 1.5), "auto"),
        *(lambda p: np.sqrt(1.04 + 0.4 * (2 * p - 1)) - 1.5, 4e-3),
    ),
    "around a point": (
        *(flat((-1, -1, 0), (2, 0, 0), (0, 2, 0)), CORNER, "none"),
        *(lambda p: np.where(p < np.pi / 4, np.sqrt(4 * p / np.pi), np.nan), 0),
    ),
    "around a line": (flat((-1, -1, 0), (2, 0, 0), (0, 2, 0)), LINE, "none", lambda p: p, 0),
    "cubes": (CUBE, (2 * CUBE[0], CUBE[1]), "none", lambda p: 0.5 + 0 * p, 0),
    "cubes, signed": (CUBE, (2 * CUBE[0], CUBE[1]), "auto", lambda p: 0 * p - 0.5, 0),
    "steps": (STEPS, GROUND, "none", lambda p: np.where(p < 0.97, 0.01, 1), 0),
}


@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_percentiles_are_those_of_the_distribution(name):
    surface, other, sign, quantile, facets = DISTRIBUTIONS[name]
    wanted = quantile(np.array([0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99]))
    known = ~np.isnan(wanted)
    deviation = blum.surface_deviation(surface, other, sign=sign, pieces=200000)
    error = np.abs(np.array(deviation.percentiles) - wanted)
    assert np.all(error[known] <= deviation.percentile_error + facets + 1e-6)
    found = blum.surface_distance_map(surface, other, sign=sign).statistics()
    slack = 2e-3 * np.ptp(wanted[known]) + 2e-6 * np.nanmax(np.abs(wanted)) + facets
    assert np.all(np.abs(np.array(found.percentiles) - wanted)[known] <= slack)


# Images with turned axes: all results lie at the voxels, for every reader.

SPACING, ORIGIN, SIZE = np.array([0.7, 1.1, 1.6]), np.array([-31.0, 12, 55]), (26, 18, 14)
TURNS = {f"turned {seed}": rotation(100 + seed) for seed in range(6)}
TURNS |= {f"axes {order}": np.eye(3)[:, order] for order in itertools.permutations(range(3))}
TURNS |= {f"flipped {signs}": np.diag(signs) for signs in itertools.product((1.0, -1.0), repeat=3)}
TURNS |= {f"mirrored {seed}": rotation(200 + seed) @ np.diag([1, 1, -1.0]) for seed in range(3)}


def blob():
    """An ellipsoid with a bar at one side, [z, y, x]."""
    z, y, x = np.mgrid[: SIZE[2], : SIZE[1], : SIZE[0]]
    at = np.stack([x, y, z], -1) * SPACING
    ball = (((at - np.array([11, 8, 7]) * SPACING) / [4.2, 4.5, 6.5]) ** 2).sum(-1) < 1
    return ball | (np.abs(at - np.array([18, 8, 6]) * SPACING) < [4, 1.5, 2.5]).all(-1)


def written(kind, turn, folder):
    values = blob().astype(np.uint8)
    if kind == "nibabel":
        nibabel = pytest.importorskip("nibabel")
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = turn * SPACING, ORIGIN
        nibabel.save(nibabel.Nifti1Image(values.transpose(2, 1, 0), affine), folder / "image.nii.gz")
        return folder / "image.nii.gz"
    if kind == "pynrrd":
        header = {"space": "left-posterior-superior", "space directions": (turn * SPACING).T, "space origin": ORIGIN}
        pytest.importorskip("nrrd").write(str(folder / "image.nrrd"), values.transpose(2, 1, 0), header)
        return folder / "image.nrrd"
    image = pytest.importorskip("SimpleITK").GetImageFromArray(values)
    image.SetSpacing(SPACING.tolist())
    image.SetOrigin(ORIGIN.tolist())
    image.SetDirection(np.ascontiguousarray(turn).ravel().tolist())
    return image


def in_vtk(path):
    """Positions and distances of a .vti file, and its surface, as VTK reads them."""
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D
    from vtkmodules.vtkIOXML import vtkXMLImageDataReader

    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    image.GetPointData().SetActiveScalars("distance")
    edges = vtkFlyingEdges3D()
    edges.SetInputData(image)
    edges.SetValue(0, 0)
    edges.Update()
    points = np.array([image.GetPoint(k) for k in range(image.GetNumberOfPoints())])
    surface = vtk_to_numpy(edges.GetOutput().GetPoints().GetData())
    return points, vtk_to_numpy(image.GetPointData().GetArray("distance")), surface


@pytest.mark.parametrize("name", TURNS)
def test_results_of_turned_images_lie_at_their_voxels(name, tmp_path):
    spatial = pytest.importorskip("scipy.spatial")
    turn = TURNS[name]
    kind = ["nibabel", "pynrrd", "SimpleITK"][list(TURNS).index(name) % 3]
    image = blum.as_image(written(kind, turn, tmp_path))
    field = blum.distance_transform(image)
    nodes = np.argwhere(np.ones(SIZE[::-1], dtype=bool))[:, ::-1]
    world = ORIGIN + (nodes * SPACING) @ turn.T
    voxels = world[blob().ravel()]

    def lies_at_the_voxels(points):
        assert spatial.cKDTree(voxels).query(points)[0].max() < 1.7
        assert np.allclose(np.min(points, axis=0), voxels.min(axis=0), atol=1.7)
        assert np.allclose(np.max(points, axis=0), voxels.max(axis=0), atol=1.7)

    grid = field.to_pyvista()
    away, at = spatial.cKDTree(grid.points).query(world)
    assert away.max() < 1e-4
    assert np.allclose(np.asarray(grid.point_data["distance"])[at], field.distance.ravel(), atol=1e-5)
    lies_at_the_voxels(grid.contour([0.0], scalars="distance").points)
    lies_at_the_voxels(field.zero_surface(0.0).vertices)
    surface = blum.smooth_surface(image)
    lies_at_the_voxels(surface.vertices)
    a, b, c = np.moveaxis(surface.vertices[surface.triangles], 1, 0)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert 0.7 < volume / (len(voxels) * SPACING.prod()) < 1.2  # faces outwards, also in mirrored images
    field.write(tmp_path / "field.vti")
    points, distance, contour = in_vtk(tmp_path / "field.vti")
    away, at = spatial.cKDTree(points).query(world)
    assert away.max() < 1e-4 and np.allclose(distance[at], field.distance.ravel(), atol=1e-5)
    lies_at_the_voxels(contour)
    field.write(tmp_path / "field.nrrd")
    read = pytest.importorskip("SimpleITK").ReadImage(str(tmp_path / "field.nrrd"))
    to_file = np.diag([-1, -1, 1]) if kind == "nibabel" else np.eye(3)  # NIfTI has RAS axes, SimpleITK LPS
    for k in range(0, len(nodes), 97):
        index = tuple(map(int, nodes[k]))
        assert np.allclose(to_file @ read.TransformIndexToPhysicalPoint(index), world[k], atol=1e-4)
        assert np.isclose(read.GetPixel(*index), field.distance.ravel()[k], atol=1e-5)


# PolyData: verts, lines, polygons and strips in every mixture.


def segment_distance(p, a, b):
    along = (b - a) / ((b - a) @ (b - a))
    return np.linalg.norm(p - a - np.clip((p - a) @ along, 0, 1) * (b - a))


def triangle_distance(p, a, b, c):
    normal = np.cross(b - a, c - a)
    foot = p - ((p - a) @ normal) / (normal @ normal) * normal
    sides = ((a, b), (b, c), (c, a))
    if all(np.cross(y - x, foot - x) @ normal >= 0 for x, y in sides):
        return np.linalg.norm(p - foot)
    return min(segment_distance(p, x, y) for x, y in sides)


def mixed(kinds, seed):
    """A PolyData with the given kinds of cells, and its primitives as arrays of points."""
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    pyvista = pytest.importorskip("pyvista")
    rng = np.random.default_rng(seed)
    points = 3 * rng.normal(size=(22, 3))
    corner, u, v = rng.normal(size=(3, 3))
    points = np.r_[points, [corner, corner + u, corner + u + v, corner + v]]
    lists = {
        "Verts": [[0], [1], [2, 3, 4]],
        "Lines": [[5, 6], [7, 8, 9, 10]],
        "Polys": [[11, 12, 13], [14, 15, 16], [22, 23, 24, 25]],
        "Strips": [[17, 18, 19, 20, 21]],
    }
    data = pyvista.PolyData()
    data.points = points
    data.SetVerts(vtk.vtkCellArray())
    primitives = []
    for kind in kinds:
        cells = vtk.vtkCellArray()
        for corners in lists[kind]:
            cells.InsertNextCell(len(corners), corners)
            if kind == "Verts":
                primitives += [points[[k]] for k in corners]
            elif kind == "Lines":
                primitives += [points[[i, j]] for i, j in itertools.pairwise(corners)]
            elif kind == "Polys":
                primitives += [points[[corners[0], i, j]] for i, j in itertools.pairwise(corners[1:])]
            else:
                primitives += [points[corners[k : k + 3]] for k in range(len(corners) - 2)]
        getattr(data, "Set" + kind)(cells)
    return data, points, primitives or [points[[k]] for k in range(len(points))]


@pytest.mark.parametrize("seed", range(20))
def test_all_cells_of_polydata_count(seed):
    names = ["Verts", "Lines", "Polys", "Strips"]
    data, points, primitives = mixed([name for k, name in enumerate(names) if seed >> k & 1], seed)
    probes = np.r_[3 * np.random.default_rng(seed + 50).normal(size=(15, 3)), points]
    measure = [lambda p, a: np.linalg.norm(p - a), segment_distance, triangle_distance]
    wanted = [min(measure[len(corners) - 1](p, *corners) for corners in primitives) for p in probes]
    for shape in (data, data.cast_to_unstructured_grid()):
        assert np.allclose(blum.closest_points(shape, probes, sign="none").distance, wanted, atol=1e-5)
