"""Proves that other programs read Blum's files of medial axes, and that Blum reads theirs.

VTK, NumPy and short readers in this file open Blum's files; Blum reads files of VTK and NumPy. The program
medial_files_sample writes the expected numbers without Blum's writers, and every number is compared.

The program lies beside the command-line tool (environment variable BLUM) or in build/release/bin, or the environment
variable BLUM_MEDIAL_FILES_SAMPLE names it.
"""

import json
import os
import pathlib
import re
import subprocess

import numpy
import pytest
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPolyDataWriter

PROJECT = pathlib.Path(__file__).resolve().parents[2]
SEAM, CURVE = 2, 3
METADATA = {
    "content": "medial axis",
    "blum_version": "1.2.3",
    "source": 'models/été "1".obj',
    "site_ids": "voxels",
    "theta": "0.3333333333333333",
    "lambda": "1e-07",
    "spacing": "0.1",
    "solid_rule": "winding",
    "grid_origin": "1e+06 -2.5 0.14285714285714285",
    "grid_spacing": "0.1 0.3333333333333333 1e-07",
    "grid_size": "4 3 2",
    "grid_direction": "0 0.6 -0.8 1 0 0 0 -0.8 -0.6",
    "label": "-9007199254740993",
    "weld": "1e-06",
}


def program():
    chosen = os.environ.get("BLUM_MEDIAL_FILES_SAMPLE")
    if chosen:
        return chosen
    tool = os.environ.get("BLUM")
    folder = pathlib.Path(tool).parent if tool else PROJECT / "build" / "release" / "bin"
    return str(folder / "medial_files_sample")


def call(*arguments):
    done = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="session")
def samples(tmp_path_factory):
    folder = tmp_path_factory.mktemp("axes")
    call("all", folder)
    return folder


class Axis:
    """The content of an axis as arrays."""

    def __init__(self, path):
        known = json.loads(path.read_text())
        self.vertices, self.edges, self.triangles = known["vertices"], known["edges"], known["triangles"]
        self.position = self.column("vertices", "position", float)
        self.radius = self.column("vertices", "radius", float)
        self.separation_angle = self.column("vertices", "separation_angle", float)
        self.role = self.column("vertices", "role", numpy.int32)
        self.footprints = self.column("vertices", "footprints", float)
        self.sites = self.column("vertices", "sites", numpy.int32)
        self.edge = self.column("edges", "vertices", numpy.int32)
        self.edge_angle = self.column("edges", "separation_angle", numpy.float32)
        self.edge_role = self.column("edges", "role", numpy.int32)
        self.triangle = self.column("triangles", "vertices", numpy.int32)
        self.triangle_angle = self.column("triangles", "separation_angle", numpy.float32)
        self.sheet = self.column("triangles", "sheet", numpy.int32)

    def column(self, items, name, dtype):
        return numpy.array([item[name] for item in getattr(self, items)], dtype)

    @property
    def curves(self):
        return self.edge[self.edge_role == CURVE]

    @property
    def isolated(self):
        used = set(self.edge.ravel()) | set(self.triangle.ravel())
        return [v for v in range(len(self.position)) if v not in used]


@pytest.fixture(scope="session")
def expected(samples):
    return Axis(samples / "axis.expected.json")


def read_by_blum(path):
    out = path.with_suffix(".shown.json")
    call("show", path, out)
    return Axis(out)


def assert_same(actual, expected):
    actual = numpy.asarray(actual)
    assert actual.dtype == expected.dtype
    numpy.testing.assert_array_equal(actual, expected)


def assert_metadata(metadata):
    assert METADATA.items() <= metadata.items()
    assert "linear index" in metadata["sites"] and "unselected" in metadata["sites"] and "2 seam" in metadata["roles"]


def test_sample_has_something_to_compare(expected):
    assert set(expected.edge_role) == {1, SEAM, CURVE} and len(expected.isolated) == 1
    assert len(set(expected.sheet)) == 3 and (expected.sites == -1).any()


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def cells(array, corners):
    assert_same(vtk_to_numpy(array.GetOffsetsArray()),
                corners * numpy.arange(array.GetNumberOfCells() + 1, dtype=numpy.int64))
    return vtk_to_numpy(array.GetConnectivityArray()).reshape(-1, corners).astype(numpy.int32)


def test_vtp_in_vtk(samples, expected):
    data = read_vtp(samples / "axis.vtp")
    assert_same(vtk_to_numpy(data.GetPoints().GetData()), expected.position)
    points = data.GetPointData()
    assert points.GetScalars().GetName() == "radius"
    names = {"radius", "footprint_0", "footprint_1", "site_0", "site_1", "separation_angle", "role"}
    assert {points.GetArrayName(k) for k in range(points.GetNumberOfArrays())} == names
    known = {"radius": expected.radius, "separation_angle": expected.separation_angle, "role": expected.role,
             "footprint_0": expected.footprints[:, 0], "footprint_1": expected.footprints[:, 1],
             "site_0": expected.sites[:, 0], "site_1": expected.sites[:, 1]}
    for name, values in known.items():
        assert_same(vtk_to_numpy(points.GetArray(name)), values)

    assert_same(cells(data.GetVerts(), 1).ravel(), numpy.array(expected.isolated, numpy.int32))
    assert_same(cells(data.GetLines(), 2), expected.edge)
    assert_same(cells(data.GetPolys(), 3), expected.triangle)
    none = numpy.full(len(expected.isolated) + len(expected.edge), -1, numpy.int32)
    angle_of_isolated = expected.separation_angle[expected.isolated].astype(numpy.float32)
    known = {"separation_angle": [angle_of_isolated, expected.edge_angle, expected.triangle_angle],
             "role": [expected.role[expected.isolated], expected.edge_role,
                      numpy.full(len(expected.triangle), -1, numpy.int32)],
             "sheet": [none, expected.sheet]}
    assert data.GetCellData().GetNumberOfArrays() == 3
    for name, values in known.items():
        assert_same(vtk_to_numpy(data.GetCellData().GetArray(name)), numpy.concatenate(values))
    assert_metadata(json.loads(data.GetFieldData().GetAbstractArray("metadata").GetValue(0)))


def test_empty_vtp_in_vtk(samples):
    data = read_vtp(samples / "empty.vtp")
    assert data.GetNumberOfPoints() == 0 and data.GetNumberOfCells() == 0
    assert data.GetPointData().GetArray("radius") is not None
    assert_metadata(json.loads(data.GetFieldData().GetAbstractArray("metadata").GetValue(0)))


def test_npz_in_numpy(samples, expected):
    known = {"vertices": expected.position, "radius": expected.radius, "separation_angle": expected.separation_angle,
             "role": expected.role,
             "footprint_0": expected.footprints[:, 0], "footprint_1": expected.footprints[:, 1],
             "site_0": expected.sites[:, 0], "site_1": expected.sites[:, 1],
             "edges": expected.edge, "edge_separation_angle": expected.edge_angle, "edge_role": expected.edge_role,
             "triangles": expected.triangle, "triangle_separation_angle": expected.triangle_angle,
             "triangle_sheet": expected.sheet}
    with numpy.load(samples / "axis.npz", allow_pickle=False) as npz:
        assert set(npz.files) == set(known) | {"metadata"}
        for name, values in known.items():
            assert_same(npz[name], values)
        assert_metadata(json.loads(str(npz["metadata"])))
        middle = npz["vertices"][npz["edges"]].mean(axis=1)  # the indices are valid
        assert middle.shape == (len(expected.edge), 3)
    with numpy.load(samples / "empty.npz", allow_pickle=False) as npz:
        assert npz["vertices"].shape == (0, 3) and npz["footprint_0"].shape == (0, 3)


PLY_TYPES = {"double": "<f8", "float": "<f4", "int": "<i4", "uchar": "u1"}


def ply_dtype(properties):
    """The type of one element; lists have three entries."""
    fields = []
    for words in properties:
        if words[0] == "list":
            fields += [("corners", PLY_TYPES[words[1]]), (words[3], PLY_TYPES[words[2]], 3)]
        else:
            fields.append((words[1], PLY_TYPES[words[0]]))
    return numpy.dtype(fields)


def read_ply(path):
    """Elements as arrays of records, and the metadata."""
    head, data = path.read_bytes().split(b"end_header\n", 1)
    lines = head.decode("ascii").splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"]
    metadata, elements = {}, []
    for line in lines[2:]:
        words = line.split()
        if words[:2] == ["comment", "blum"]:
            metadata |= json.loads(line.split(None, 2)[2])
        elif words[0] == "element":
            elements.append((words[1], int(words[2]), []))
        else:
            assert words[0] == "property"
            elements[-1][2].append(words[1:])
    arrays = {}
    for name, count, properties in elements:
        dtype = ply_dtype(properties)
        arrays[name] = numpy.frombuffer(data, dtype, count)
        data = data[count * dtype.itemsize:]
    assert not data
    return arrays, metadata


def test_ply_by_its_header(samples, expected):
    arrays, metadata = read_ply(samples / "axis.ply")
    vertex, edge, face = arrays["vertex"], arrays["edge"], arrays["face"]
    assert_same(numpy.stack([vertex[a] for a in "xyz"], 1), expected.position)
    assert_same(vertex["radius"], expected.radius)
    assert_same(vertex["separation_angle"], expected.separation_angle)
    assert_same(vertex["role"], expected.role)
    for i in range(2):
        assert_same(numpy.stack([vertex[f"footprint_{i}_{a}"] for a in "xyz"], 1), expected.footprints[:, i])
        assert_same(vertex[f"site_{i}"], expected.sites[:, i])
    assert_same(numpy.stack([edge["vertex1"], edge["vertex2"]], 1), expected.edge)
    assert edge.dtype.names == ("vertex1", "vertex2"), "trimesh takes every column for a corner"
    attributes = arrays["edge_attributes"]
    assert_same(attributes["separation_angle"], expected.edge_angle)
    assert_same(attributes["role"], expected.edge_role)
    assert list(arrays) == ["vertex", "face", "edge", "edge_attributes"]
    assert_same(vertex["quality"], expected.radius.astype(numpy.float32))
    assert (face["corners"] == 3).all()
    assert_same(face["vertex_indices"], expected.triangle)
    assert_same(face["separation_angle"], expected.triangle_angle)
    assert_same(face["sheet"], expected.sheet)
    assert_metadata(metadata)


def test_ply_in_vtk(samples, expected):
    reader = vtkPLYReader()
    reader.SetFileName(str(samples / "axis.ply"))
    reader.Update()
    data = reader.GetOutput()
    assert_same(vtk_to_numpy(data.GetPoints().GetData()).astype(numpy.float32),
                expected.position.astype(numpy.float32))
    assert_same(cells(data.GetPolys(), 3), expected.triangle)


def test_obj_by_hand(samples, expected):
    rows = {"v": [], "f": [], "l": [], "p": []}
    for line in (samples / "axis.obj").read_text().splitlines():
        keyword, *words = line.split()
        rows[keyword].append([float(w) if keyword == "v" else int(w) - 1 for w in words])
    assert_same(rows["v"], expected.position)
    assert_same(numpy.array(rows["f"], numpy.int32), expected.triangle)
    assert_same(numpy.array(rows["l"], numpy.int32), expected.curves)
    assert rows["p"] == [[v] for v in expected.isolated]
    used = {v for key in "flp" for row in rows[key] for v in row}
    assert used == set(range(len(rows["v"])))


def test_ma_by_hand(samples, expected):
    """The format of the Blender add-on blender-mat-addon: counts, then the lines of each kind, in this order."""
    lines = iter((samples / "axis.ma").read_text().splitlines())
    counts = [int(word) for word in next(lines).split()]
    rows = []
    for kind, count, size in zip("vef", counts, (4, 2, 3)):
        parts = [next(lines).split() for _ in range(count)]
        assert all(part[0] == kind and len(part) == 1 + size for part in parts)
        rows.append([[float(w) if kind == "v" else int(w) for w in part[1:]] for part in parts])
    assert next(lines, None) is None
    assert_same(rows[0], numpy.column_stack([expected.position, expected.radius]))
    assert_same(numpy.array(rows[2], numpy.int32), expected.triangle)
    sides = [(t[i], t[(i + 1) % 3]) for t in expected.triangle for i in range(3)]
    distinct = {tuple(sorted(map(int, e))) for e in [*map(tuple, expected.edge), *sides]}
    assert [tuple(e) for e in rows[1]] == sorted(distinct)


@pytest.mark.parametrize("extension", ["obj", "ma"])
def test_no_long_numbers_in_text(samples, extension):
    """17 digits determine a double."""
    words = (samples / f"axis.{extension}").read_text().split()
    assert max(len(re.sub(r"e.*|\D", "", word).lstrip("0")) for word in words) <= 17


def poly_data(expected):
    data = vtkPolyData()
    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(expected.position, deep=True))
    data.SetPoints(points)
    for corners, values, put in [(3, expected.triangle, data.SetPolys), (2, expected.curves, data.SetLines)]:
        array = vtkCellArray()
        for row in values:
            array.InsertNextCell(corners, [int(v) for v in row])
        put(array)
    radius = numpy_to_vtk(expected.radius.astype(numpy.float32), deep=True)
    radius.SetName("radius")
    data.GetPointData().AddArray(radius)
    return data


@pytest.mark.parametrize("length", [32, 64])
@pytest.mark.parametrize("big", [False, True])
def test_reads_vtp_of_vtk(tmp_path, expected, length, big):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetInputData(poly_data(expected))
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.SetHeaderType(length)
    (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
    assert writer.Write() == 1
    axis = read_by_blum(tmp_path / "a.vtp")
    assert_same(axis.position, expected.position)
    assert_same(axis.radius, expected.radius.astype(numpy.float32).astype(float))
    assert_same(axis.triangle, expected.triangle)
    assert_same(axis.edge, expected.curves)


@pytest.mark.parametrize("binary", [False, True])
def test_reads_ply_of_vtk(tmp_path, expected, binary):
    writer = vtkPLYWriter()
    writer.SetFileName(str(tmp_path / "a.ply"))
    writer.SetInputData(poly_data(expected))
    (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
    writer.Write()
    axis = read_by_blum(tmp_path / "a.ply")
    numpy.testing.assert_allclose(axis.position, expected.position, rtol=1e-5, atol=1e-6)
    assert_same(axis.triangle, expected.triangle)


@pytest.mark.parametrize("save", [numpy.savez, numpy.savez_compressed])
def test_reads_npz_of_numpy(tmp_path, expected, save):
    save(tmp_path / "a.npz", vertices=numpy.asfortranarray(expected.position), radius=expected.radius.astype(">f4"),
         edges=expected.edge.astype(numpy.uint64), triangles=expected.triangle.astype(numpy.int16))
    axis = read_by_blum(tmp_path / "a.npz")
    assert_same(axis.position, expected.position)
    assert_same(axis.radius, expected.radius.astype(numpy.float32).astype(float))
    assert_same(axis.triangle, expected.triangle)
    assert_same(axis.edge, expected.curves)


@pytest.mark.parametrize("extension", ["vtp", "ply", "npz"])
def test_blum_reads_its_own_files(samples, expected, extension, tmp_path):
    copy = tmp_path / f"axis.{extension}"
    copy.write_bytes((samples / copy.name).read_bytes())
    axis = read_by_blum(copy)
    assert (axis.vertices, axis.edges, axis.triangles) == (expected.vertices, expected.edges, expected.triangles)
