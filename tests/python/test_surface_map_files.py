"""Proves that other programs read Blum's surface maps and glTF files.

The program surface_map_files_sample writes a map of the linear function 3 + x + 2 y + 3 z over a box. NumPy, VTK and
trimesh open the files, and each number is compared with the function. The program lies beside the command-line tool
(environment variable BLUM) or in build/release/bin.
"""

import json
import os
import pathlib
import subprocess

import numpy
import pytest
import trimesh
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

import blum

PROJECT = pathlib.Path(__file__).resolve().parents[2]
TOOL = os.environ.get("BLUM") or str(PROJECT / "build" / "release" / "bin" / "blum")


def value_at(places):
    return 3 + places @ [1, 2, 3]


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    program = pathlib.Path(TOOL).parent / "surface_map_files_sample"
    done = subprocess.run([program, folder], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder


def test_numpy_finds_the_place_and_value_of_every_texel(maps):
    with numpy.load(maps / "map.npz") as file:
        arrays = {name: file[name] for name in file.files}
    triangle, distance = arrays["triangle"], arrays["distance"]
    assert distance.dtype == numpy.float32 and triangle.dtype == arrays["site"].dtype == numpy.int32
    assert arrays["vector"].shape == (*distance.shape, 3)
    assert numpy.array_equal(numpy.isnan(distance), triangle < 0)
    assert numpy.allclose(arrays["vertex_distance"], value_at(arrays["vertices"]))
    rows, columns = numpy.nonzero(triangle >= 0)
    of = triangle[rows, columns]
    # Barycentric coordinates of the centre of each texel in its triangle, from corners in texels.
    corners = arrays["corners"][of]
    steps = numpy.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
    middles = numpy.stack([columns + 0.5, rows + 0.5], axis=1) - corners[:, 0]
    u, v = numpy.linalg.solve(steps, middles[..., None])[..., 0].T
    a, b, c = numpy.moveaxis(arrays["vertices"][arrays["triangles"][of]], 1, 0)
    places = a + u[:, None] * (b - a) + v[:, None] * (c - a)
    assert numpy.allclose(distance[rows, columns], value_at(places), atol=1e-6)
    metadata = json.loads(str(arrays["metadata"]))
    assert metadata["source"] == "a box" and metadata["quantity"] == "distance" and metadata["units"] == "mm"


def test_trimesh_draws_the_texture(maps):
    scene = trimesh.load(maps / "map.glb", process=False)
    (mesh,) = scene.geometry.values()
    assert mesh.faces.shape == (12, 3) and mesh.vertices.shape == (24, 3)
    assert numpy.allclose(mesh.vertex_attributes["_DISTANCE"].ravel(), value_at(mesh.vertices))
    assert mesh.metadata["quantity"] == "distance" and mesh.metadata["color_range"][0] == 0
    image = mesh.visual.material.baseColorTexture
    with numpy.load(maps / "map.npz") as file:
        distance = file["distance"]
    assert image.size == distance.shape[::-1]
    # Larger values are darker, up to rounding to bytes.
    pixels = numpy.asarray(image.convert("RGB")).astype(float) @ [0.2126, 0.7152, 0.0722]
    known = numpy.isfinite(distance)
    order = numpy.argsort(distance[known])
    assert (numpy.diff(pixels[known][order][::50]) < 2).all()
    # trimesh's v points up. The texel at each corner of the mesh holds the corner's value.
    x, y = (mesh.visual.uv * [1, -1] + [0, 1]).T * numpy.array(image.size)[:, None]
    nearest = [distance[int(numpy.clip(j, 0, 63)), int(numpy.clip(i, 0, 95))] for i, j in zip(x, y, strict=True)]
    assert numpy.allclose(nearest, value_at(mesh.vertices), atol=0.13)  # the change over half a texel along both axes


def test_vtk_and_trimesh_read_columns(maps):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(maps / "map.vtp"))
    reader.Update()
    data = reader.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData())
    assert data.GetNumberOfPolys() == 12
    assert numpy.allclose(vtk_to_numpy(data.GetPointData().GetArray("distance")), value_at(points))
    cells = data.GetCellData()
    assert vtk_to_numpy(cells.GetArray("smallest")).tolist() == list(range(12))
    assert {cells.GetArrayName(i) for i in range(cells.GetNumberOfArrays())} >= {"largest", "mean", "error"}
    mesh = trimesh.load(maps / "map.ply", process=False)
    vertex = mesh.metadata["_ply_raw"]["vertex"]["data"]
    assert numpy.allclose(vertex["distance"], value_at(mesh.vertices))
    # MeshLab colours by this property (pymeshlab 2025.7 reads it as its vertex scalar; tried by hand).
    assert numpy.array_equal(vertex["quality"], vertex["distance"].astype(numpy.float32))
    # Blum's own reader does not see the copy.
    assert set(blum.read_complex(maps / "map.ply").complex.vertex_columns) == {"distance"}


def test_gltf_keeps_meshes_far_from_the_origin(tmp_path):
    part = blum.generate("gear")
    far = part.vertices + [4.5e6, -1.2e6, 250]  # numbers in single precision are half a unit apart there
    blum.Mesh(far, part.triangles).write(tmp_path / "far.glb")
    scene = trimesh.load(tmp_path / "far.glb", process=False)
    mesh = scene.to_geometry()
    assert numpy.array_equal(mesh.faces, part.triangles)
    assert numpy.abs(mesh.vertices - far).max() < 1e-6
