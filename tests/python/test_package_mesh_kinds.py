"""Proves that all functions and methods of a mesh accept the same kinds of meshes, with identical results."""

import inspect
import operator
import re
import typing
from types import SimpleNamespace

import numpy as np
import pytest
from content import content_of

blum = pytest.importorskip("blum")

#: Start and goal of a motion that passes through the origin.
BESIDE = ((np.eye(3), (0, 0, 5)), (np.eye(3), (5, 0, 0)))
FALL = ((np.eye(3), (0, 0, 5)), (np.eye(3), (0, 0, -5)))
POINTS = np.array([[0.1, 0.2, 0.9], [2.0, 0.0, 0.0], [0.3, -0.2, 0.1]])


class Vectors:
    """Like Open3D's Vector3dVector: without the attributes of an array, but np.asarray() accepts it."""

    def __init__(self, rows):
        self._rows = np.array(rows)

    def __len__(self):
        return len(self._rows)

    def __getitem__(self, index):
        return self._rows[index]


class Tensor:
    """Like Open3D's tensor, which may lie on a device."""

    def __init__(self, values):
        self._values = np.array(values)

    def cpu(self):
        return self

    def numpy(self):
        return self._values


class TensorMap(dict):
    """Like Open3D's TensorMap: missing attributes raise a KeyError."""

    def __getattr__(self, name):
        return self[name]


def of_trimesh(mesh, folder):
    return pytest.importorskip("trimesh").Trimesh(mesh.vertices, mesh.triangles, process=False)


def of_pyvista(mesh, folder):
    pyvista = pytest.importorskip("pyvista")
    return pyvista.PolyData.from_regular_faces(np.array(mesh.vertices), np.array(mesh.triangles))


def of_meshio(mesh, folder):
    return pytest.importorskip("meshio").Mesh(mesh.vertices, [("triangle", mesh.triangles)])


def of_open3d(mesh, folder):
    return SimpleNamespace(vertices=Vectors(mesh.vertices), triangles=Vectors(mesh.triangles))


def of_open3d_tensors(mesh, folder):
    return SimpleNamespace(
        vertex=TensorMap(positions=Tensor(mesh.vertices)),
        triangle=TensorMap(indices=Tensor(mesh.triangles.astype(np.int64))),
    )


def of_file(mesh, folder):
    mesh.write(folder / "mesh.ply")
    return folder / "mesh.ply"


KINDS = {
    "path": of_file,
    "str": lambda mesh, folder: str(of_file(mesh, folder)),
    "pair": lambda mesh, folder: (mesh.vertices, mesh.triangles),
    "lists": lambda mesh, folder: (mesh.vertices.tolist(), mesh.triangles.tolist()),
    "blum": lambda mesh, folder: mesh,
    "trimesh": of_trimesh,
    "pyvista": of_pyvista,
    "meshio": of_meshio,
    "open3d": of_open3d,
    "open3d tensors": of_open3d_tensors,
}


def scene_of(mesh):
    scene = blum.ProximityScene()
    first = scene.add(blum.generate("box"))
    scene.update(first, transform=(np.eye(3), [3, 0, 0]))
    return scene, scene.add(mesh)


def updated_scene(mesh):
    scene, index = scene_of(blum.generate("box"))
    scene.update(index, mesh=mesh)
    return scene.separation(0, index)


def replaced(mesh):
    mapper = blum.SurfaceMapper(blum.generate("box"), blum.generate("box"), texel=0.1)
    mapper.replace_other(mesh)
    return mapper.map()


def axis_of(mesh):
    return blum.medial_axis(mesh, resolution=16).simplify(60)


def page_of(mesh, folder):
    page = blum.view(part=mesh, output=folder / "page.html", show=False)
    text = page.read_text("utf-8")
    page.unlink()
    return len(text)  # the page contains times and sources


def solver():
    return blum.FieldSolver(blum.Grid.around(blum.generate("box"), resolution=8))


AXIS = axis_of(blum.generate("box"))

#: Functions that need more than a mesh, by name. Functions that need only a mesh follow from their signatures.
TAKERS = {
    "distance_field": lambda mesh: blum.distance_field(mesh, resolution=8),
    "FieldSolver.compute": lambda mesh: solver().compute(mesh),
    "Grid.around": lambda mesh: blum.Grid.around(mesh, resolution=8),
    "reference.nearest": lambda mesh: blum.reference.nearest(mesh, POINTS),
    "reference.winding_number": lambda mesh: blum.reference.winding_number(mesh, POINTS),
    "Sites": lambda mesh: blum.Sites(mesh).edges,
    "WindingNumber": lambda mesh: blum.WindingNumber(mesh)(POINTS),
    "winding_number": lambda mesh: blum.winding_number(mesh, POINTS),
    "noisy": lambda mesh: blum.noisy(mesh, 0.01),
    "clean_mesh": lambda mesh: blum.clean_mesh(mesh, 1e-6),
    "close_features": lambda mesh: blum.close_features(mesh, 0.1),
    "closest_points": lambda mesh: blum.closest_points(mesh, POINTS),
    "ClosestPointQuery": lambda mesh: blum.ClosestPointQuery(mesh)(POINTS),
    "signed_distance": lambda mesh: blum.signed_distance(mesh, POINTS),
    "sample_surface": lambda mesh: blum.sample_surface(mesh, 20),
    "sample_near": lambda mesh: blum.sample_near(mesh, 20),
    "Solid": lambda mesh: blum.Solid(mesh).inside(POINTS),
    "medial_axis": axis_of,
    "certify": lambda mesh: blum.certify(AXIS, mesh),
    "AxisVerifier": lambda mesh: blum.AxisVerifier(mesh).certify(AXIS),
    "axis_graph": lambda mesh: blum.axis_graph(AXIS, mesh),
    "extend_axis": lambda mesh: blum.extend_axis(AXIS, mesh),
    "MedialComplex.extend": lambda mesh: AXIS.extend(mesh),
    "MedialComplex.with_patches": lambda mesh: AXIS.with_patches(mesh=mesh),
    "ProximityScene.add": lambda mesh: scene_of(mesh)[0].separation(0, 1),
    "ProximityScene.update": updated_scene,
    "separation": lambda mesh: blum.separation(mesh, (blum.generate("box").vertices + 3, [[0, 1, 2]])),
    "collisions": lambda mesh: blum.collisions([mesh, blum.generate("box")]),
    "continuous_collisions": lambda mesh: blum.continuous_collisions(mesh, mesh),
    "first_contact": lambda mesh: blum.first_contact(mesh, mesh, mesh, mesh),
    "surface_distance_map": lambda mesh: blum.surface_distance_map(mesh, mesh, texel=0.1),
    "SurfaceMapper": lambda mesh: blum.SurfaceMapper(mesh, mesh, texel=0.1).map(),
    "SurfaceMapper.replace_other": replaced,
    "self_distance_map": lambda mesh: blum.self_distance_map(mesh, texel=0.1),
    "thickness_map": lambda mesh: blum.thickness_map(mesh, texel=0.1),
    "hausdorff_distance": lambda mesh: blum.hausdorff_distance(mesh, mesh),
    "least_translation": lambda mesh: blum.least_translation(mesh, blum.generate("box")),
    "certify_motion": lambda mesh: blum.certify_motion(mesh, blum.generate("box"), *FALL),
    "MotionCertifier": lambda mesh: blum.MotionCertifier(mesh, blum.generate("box")).certify(*FALL),
    "verify_path": lambda mesh: blum.verify_path(FALL, mesh, blum.generate("box")),
    "plan": lambda mesh: blum.plan(mesh, blum.generate("box"), *BESIDE, planner="sliding").poses,
    "directed_hausdorff_distance": lambda mesh: blum.directed_hausdorff_distance(mesh, mesh),
    "surface_deviation": lambda mesh: blum.surface_deviation(mesh, mesh),
    "view": page_of,
}


def takers():
    """Each function of blum with an argument of the type MeshLike."""
    found = {}
    for name in blum.__all__:
        thing = getattr(blum, name)
        if inspect.isclass(thing):
            own = {
                f"{name}.{k}": getattr(thing, k) for k, v in vars(thing).items() if inspect.isroutine(v) and k[0] != "_"
            }
            found |= {name: thing.__init__} | own if "__init__" in vars(thing) else own
        elif inspect.isroutine(thing):
            found[name] = thing
    found |= {f"reference.{k}": getattr(blum.reference, k) for k in ("nearest", "winding_number")}
    annotations = {k: str(getattr(v, "__annotations__", {})) for k, v in found.items()}
    return {k: v for k, v in found.items() if re.search("MeshLike|MeshOrVertices|Viewable", annotations[k])}


def needs_only_a_mesh(taker):
    needed = [one for one in inspect.signature(taker).parameters.values() if one.default is one.empty]
    return len([one for one in needed if one.kind is not one.VAR_KEYWORD]) == 1


TAKERS |= {
    name: taker
    for name, taker in takers().items()
    if name not in TAKERS and inspect.isfunction(taker) and "." not in name and needs_only_a_mesh(taker)
}


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    """The result of each function for two arrays, computed once."""
    known = {}

    def of(name):
        if name not in known:
            box = blum.generate("box")
            known[name] = result(name, (box.vertices, box.triangles), tmp_path_factory.mktemp("arrays"))
        return known[name]

    return of


def result(name, mesh, folder):
    taker = TAKERS[name]
    return content_of(taker(mesh, folder) if taker is page_of else taker(mesh))


@pytest.mark.filterwarnings("ignore::blum.InputWarning")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", TAKERS)
def test_results_are_those_of_arrays(name, kind, expected, tmp_path):
    mesh = KINDS[kind](blum.generate("box"), tmp_path)
    assert result(name, mesh, tmp_path) == expected(name)


def test_vertices_and_triangles_may_be_two_arguments():
    box = blum.generate("box")
    names = [name for name, taker in takers().items() if "triangles" in inspect.signature(taker).parameters]
    methods = {"MedialComplex.extend", "MedialComplex.with_patches"}
    of_axis = {"certify", "axis_graph", "extend_axis", *methods}
    assert {*names} >= of_axis | {"distance_field", "medial_axis", "voronoi_complex"}
    coarse = {"medial_axis": {"resolution": 16}, "distance_field": {"resolution": 8}}
    for name in {*names} - of_axis:
        options = coarse.get(name, {})
        taker = operator.attrgetter(name)(blum) if name != "FieldSolver.compute" else solver().compute
        assert content_of(taker(box.vertices, box.triangles, **options)) == content_of(taker(box, **options)), name
    for name in of_axis - methods:
        taker = getattr(blum, name)
        assert content_of(taker(AXIS, box.vertices, box.triangles)) == content_of(taker(AXIS, box)), name


def test_every_function_of_a_mesh_is_tested():
    unwrapped = {name.removesuffix(".__init__") for name in takers()}
    assert unwrapped == set(TAKERS)


def test_the_type_names_the_kinds():
    names = {getattr(kind, "__name__", str(kind)) for kind in typing.get_args(blum.MeshLike)}
    assert {"Mesh", "str", "TrimeshLike", "Open3DLike", "Open3DTensorLike", "MeshioLike", "PyVistaLike"} <= names


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (3, r"is a int, but must be a blum\.Mesh, a path, a pair \(vertices, triangles\)"),
        (POINTS, r"is a ndarray, but must .*: blum\.Mesh\(points\) makes one of points alone"),
        (SimpleNamespace(points=POINTS), r"must .*: blum\.Mesh\(points\) makes one of points alone"),
        (SimpleNamespace(geometry={}, to_mesh=None), r"must .*: its method to_mesh\(\) makes one"),
        (SimpleNamespace(vertex=TensorMap(), triangle=TensorMap()), r"has no vertex\.positions and triangle\.indices"),
    ],
)
def test_non_meshes_are_rejected_with_a_hint(given, message):
    for taker in (blum.topology, blum.pseudonormals, lambda mesh: blum.distance_field(mesh, resolution=8)):
        with pytest.raises(TypeError, match=message):
            taker(given)
