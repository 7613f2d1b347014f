"""Proves that meshes of PyVista, meshio and trimesh keep their lines and free points, or are rejected with advice.

Expected distances are those of NumPy to each point, segment and triangle.
"""

import typing
import warnings

import numpy as np
import pytest

blum = pytest.importorskip("blum")

VERTICES = np.array(
    [[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0], [0, 0, 2], [8, 1, 1], [9, 3, 1], [9, 5, 2], [-6, 1, 1], [-5, -4, 3]],
    dtype=float,
)
QUAD, LINE, FREE = [0, 1, 2, 3], [5, 6, 7], [8, 9]
TRIANGLES, SEGMENTS = [[0, 1, 2], [0, 2, 3]], [[5, 6], [6, 7]]
QUERIES = np.vstack([VERTICES, np.random.default_rng(1).uniform(-8, 10, (200, 3))])


def distances_to_points(queries, points):
    return np.linalg.norm(queries[:, None] - points[None], axis=-1).min(axis=1)


def distances_to_segment(queries, first, last):
    along = last - first
    share = np.clip((queries - first) @ along / (along @ along), 0, 1)
    return np.linalg.norm(queries - (first + share[:, None] * along), axis=1)


def distances_to_quad(queries):
    """Distances to the rectangle (0, 0, 0) to (4, 3, 0)."""
    return np.linalg.norm(queries - np.clip(queries, [0, 0, 0], [4, 3, 0]), axis=1)


def expected(face=True, line=True, free=True):
    found = [distances_to_quad(QUERIES)] if face else []
    found += [distances_to_segment(QUERIES, *VERTICES[ends]) for ends in SEGMENTS] if line else []
    found += [distances_to_points(QUERIES, VERTICES[FREE])] if free else []
    return np.min(found, axis=0)


def distances(mesh):
    return blum.closest_points(mesh, QUERIES, sign="none").distance


@pytest.fixture(scope="module")
def pyvista():
    return pytest.importorskip("pyvista")


def padded(cells):
    return np.concatenate([[len(cell), *cell] for cell in cells])


FACES = {
    "triangles": {"faces": padded(TRIANGLES)},
    "a quad": {"faces": padded([QUAD])},
    "a strip": {"strips": padded([[1, 2, 0, 3]])},
    "a quad and triangles": {"faces": padded([QUAD, *TRIANGLES])},
}
LINES = {"segments": padded(SEGMENTS), "a polyline": padded([LINE]), "both": padded([LINE, *SEGMENTS])}
POINTS = {"vertices": padded([[k] for k in FREE]), "a polyvertex": padded([FREE]), "mixed": padded([FREE, FREE[:1]])}


@pytest.mark.parametrize("faces", FACES)
@pytest.mark.parametrize("lines", LINES)
@pytest.mark.parametrize("points", POINTS)
def test_polydata_keep_lines_and_points(pyvista, faces, lines, points):
    mesh = pyvista.PolyData(VERTICES, **FACES[faces], lines=LINES[lines], verts=POINTS[points])
    mesh.cell_data["column"] = np.arange(mesh.n_cells)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        np.testing.assert_allclose(distances(mesh), expected(), atol=1e-12)
    topology = blum.topology(mesh)
    assert topology.segments == {"segments": 2, "a polyline": 2, "both": 4}[lines]
    assert topology.points == (3 if points == "mixed" else 2)


def test_polydata_with_one_kind_of_cells_have_only_that_kind(pyvista):
    alone = pyvista.PolyData(VERTICES, lines=LINES["a polyline"])
    np.testing.assert_allclose(distances(alone), expected(face=False, free=False), atol=1e-12)
    alone = pyvista.PolyData(VERTICES, verts=POINTS["vertices"])
    np.testing.assert_allclose(distances(alone), expected(face=False, line=False), atol=1e-12)
    none = np.zeros(0, dtype=int)
    empty = pyvista.UnstructuredGrid(none, none, VERTICES)
    for cloud in (pyvista.PolyData(VERTICES), pyvista.PointSet(VERTICES), empty):
        np.testing.assert_allclose(distances(cloud), distances_to_points(QUERIES, VERTICES), atol=1e-12)


def test_points_and_lines_of_unstructured_grids_are_kept(pyvista):
    types = [pyvista.CellType[name] for name in ("QUAD", "POLY_LINE", "VERTEX", "VERTEX")]
    mesh = pyvista.UnstructuredGrid(padded([QUAD, LINE, *([k] for k in FREE)]), types, VERTICES)
    np.testing.assert_allclose(distances(mesh), expected(), atol=1e-6)
    # A volume hides neither a point nor a line in it.
    cells = padded([[0, 1, 3, 4], [1], [8], [5, 6]])
    inside = np.vstack([[[0.1, 0.1, 0.1]], VERTICES])[[1, 0, *range(2, 10)]]
    inside[1] = [0.2, 0.2, 0.2]
    types = [pyvista.CellType[name] for name in ("TETRA", "VERTEX", "VERTEX", "LINE")]
    mesh = blum.topology(pyvista.UnstructuredGrid(cells, types, inside))
    assert (mesh.triangles, mesh.segments, mesh.points) == (4, 1, 2)


def test_meshes_keep_everything_through_pyvista(pyvista):
    mesh = blum.Mesh(VERTICES, TRIANGLES, SEGMENTS, FREE)
    for other in (mesh.to_pyvista(), mesh.to_pyvista().cast_to_unstructured_grid()):
        again = blum.weld(other)
        assert (len(again.triangles), len(again.segments), len(again.points)) == (2, 2, 2)
        np.testing.assert_allclose(distances(other), expected(), atol=1e-12)


def test_meshio_keeps_lines_and_points():
    meshio = pytest.importorskip("meshio")
    cells = [("quad", [QUAD]), ("line", SEGMENTS), ("vertex", [[k] for k in FREE])]
    np.testing.assert_allclose(distances(meshio.Mesh(VERTICES, cells)), expected(), atol=1e-12)
    # Tetrahedra may lie beside the triangles of their surface.
    volume = [("triangle", TRIANGLES), ("tetra", [[0, 1, 2, 4]]), *cells[1:]]
    np.testing.assert_allclose(distances(meshio.Mesh(VERTICES, volume)), expected(), atol=1e-12)


@pytest.mark.parametrize(
    ("kind", "corners"),
    [("triangle6", 6), ("line3", 3), ("polygon", 5), ("quad8", 8), ("tetra", 4), ("hexahedron", 8)],
)
@pytest.mark.parametrize("others", [[], [("line", SEGMENTS), ("vertex", [[8]])], [("triangle", TRIANGLES)]])
def test_meshio_cells_are_not_left_out_in_silence(kind, corners, others):
    meshio = pytest.importorskip("meshio")
    mesh = meshio.Mesh(VERTICES, [*others, (kind, [list(range(corners))])])
    if others and others[0][0] == "triangle" and kind in ("tetra", "hexahedron"):
        assert blum.topology(mesh).triangles == 2
        return
    with pytest.raises(blum.InvalidMesh, match=rf"mesh has cells of the kind '{kind}'.*pyvista\.from_meshio"):
        blum.topology(mesh)


def test_the_advice_for_meshio_works(pyvista):
    meshio = pytest.importorskip("meshio")
    corners = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]]
    mesh = meshio.Mesh(corners, [("tetra", [[0, 1, 2, 3]])])
    assert abs(blum.topology(pyvista.from_meshio(mesh)).area - (3 * 2 + 2 * np.sqrt(3))) < 1e-6


@pytest.mark.parametrize(
    ("make", "advice"),
    [
        (lambda trimesh: trimesh.Scene([trimesh.creation.box()]), r"to_mesh\(\) makes one .*dump\(concatenate=True\)"),
        (lambda trimesh: trimesh.PointCloud(VERTICES), r"blum\.Mesh\(cloud\.vertices\) makes one"),
        (lambda trimesh: trimesh.load_path(VERTICES[LINE]), r"segments=path\.vertex_nodes\) makes one"),
    ],
)
def test_other_objects_of_trimesh_are_rejected_with_advice(make, advice):
    trimesh = pytest.importorskip("trimesh")
    with pytest.raises(TypeError, match=advice):
        blum.topology(make(trimesh))


def test_the_advice_for_trimesh_works():
    trimesh = pytest.importorskip("trimesh")
    scene = trimesh.Scene([trimesh.creation.box(), trimesh.creation.box().apply_translation([3, 0, 0])])
    assert blum.topology(scene.to_mesh()).betti == (2, 0, 0)
    path = trimesh.load_path(VERTICES[LINE])
    line = blum.Mesh(path.vertices, segments=path.vertex_nodes)
    np.testing.assert_allclose(distances(line), expected(face=False, free=False), atol=1e-12)
    cloud = blum.Mesh(trimesh.PointCloud(VERTICES[FREE]).vertices)
    np.testing.assert_allclose(distances(cloud), expected(face=False, line=False), atol=1e-12)


def test_other_objects_of_vtk_are_rejected_with_advice(pyvista):
    vtk = pytest.importorskip("vtk")
    with pytest.raises(TypeError, match=r"combine\(\) makes one"):
        blum.topology(pyvista.MultiBlock([pyvista.Sphere()]))
    assert blum.topology(pyvista.MultiBlock([pyvista.Sphere()]).combine()).closed
    source = vtk.vtkSphereSource()
    source.Update()
    with pytest.raises(TypeError, match=r"pyvista\.wrap\(\) makes one"):
        blum.topology(source.GetOutput())
    assert blum.topology(pyvista.wrap(source.GetOutput())).closed


def test_as_mesh_is_public_and_usable_in_type_hints(pyvista):
    def lengths(mesh: blum.MeshLike) -> blum.Mesh:
        return blum.as_mesh(mesh)

    assert typing.get_type_hints(lengths) == {"mesh": blum.MeshLike, "return": blum.Mesh}
    mesh = lengths(pyvista.PolyData(VERTICES, faces=padded([QUAD]), lines=padded([LINE]), verts=padded([FREE])))
    assert isinstance(mesh, blum.Mesh) and lengths(mesh) is mesh
    assert mesh.segments.tolist() == SEGMENTS and mesh.points.tolist() == FREE
    assert np.array_equal(mesh.vertices, VERTICES)
    assert len(blum.as_mesh(VERTICES[[0, 1, 2, 2]], [[0, 1, 3]], weld=0).vertices) == 3
    with pytest.raises(TypeError, match="part is a int, but must be"):
        blum.as_mesh(3, name="part")
