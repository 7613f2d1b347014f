"""Proves that other programs read Blum's field and image files, and that Blum reads theirs.

NumPy, VTK, pynrrd and SimpleITK open Blum's files. Blum reads image files of pynrrd, SimpleITK, nibabel and NumPy.
The program files_sample writes the expected values, sizes, spacing, origin and direction without Blum's writers.

The program lies beside the command-line tool (environment variable BLUM) or in build/release/bin, or the environment
variable BLUM_FILES_SAMPLE names it.
"""

import gzip
import json
import os
import pathlib
import subprocess

import nibabel
import nrrd
import numpy
import pytest
import SimpleITK
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_FLOAT
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

PROJECT = pathlib.Path(__file__).resolve().parents[2]
FIELDS = ["field", "turned", "flat", "triangles", "voxels"]
MESH_FIELDS = [name for name in FIELDS if name != "voxels"]
TYPES = ["uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"]


def program():
    chosen = os.environ.get("BLUM_FILES_SAMPLE")
    if chosen:
        return chosen
    tool = os.environ.get("BLUM")
    folder = pathlib.Path(tool).parent if tool else PROJECT / "build" / "release" / "bin"
    return str(folder / "files_sample")


def call(*arguments):
    done = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.fixture(scope="session")
def samples(tmp_path_factory):
    folder = tmp_path_factory.mktemp("samples")
    call("all", folder)
    return folder


class Expected:
    """Expected content of a sample: arrays [z, y, x], and geometry in x, y, z order."""

    def __init__(self, folder, name):
        known = json.loads((folder / f"{name}.expected.json").read_text())
        self.known = known
        self.shape = tuple(reversed(known["size"]))
        self.origin = numpy.array(known["origin"])
        self.spacing = numpy.array(known["spacing"])
        self.direction = numpy.array(known["columns"], float).T
        self.base = folder / name

    def array(self, ending, dtype):
        return numpy.fromfile(f"{self.base}{ending}", dtype).reshape(self.shape)

    @property
    def distance(self):
        return self.array(".distance.bin", numpy.float32)

    @property
    def site(self):
        return self.array(".site.bin", numpy.int32)


def assert_same(actual, expected):
    assert actual.dtype == expected.dtype
    numpy.testing.assert_array_equal(actual, expected)


def test_samples_have_something_to_compare(samples):
    """The sample has both signs, several sites and nodes beyond the band, so that the comparisons are meaningful."""
    field = Expected(samples, "field")
    assert (field.distance < 0).any() and (field.distance > 0).any()
    assert (field.site == -1).any() and len(numpy.unique(field.site)) > 5


@pytest.mark.parametrize("name", FIELDS)
def test_npz_in_numpy(samples, name):
    expected = Expected(samples, name)
    with numpy.load(samples / f"{name}.npz", allow_pickle=False) as npz:
        assert_same(npz["distance"], expected.distance)
        assert_same(npz["site"], expected.site)
        assert_same(npz["origin"], expected.origin)
        assert_same(npz["spacing"], expected.spacing)
        assert_same(npz["direction"], expected.direction)
        metadata = json.loads(str(npz["metadata"]))
        assert metadata["source"] == "tétra.obj"
        assert metadata["blum_version"] == "0.0.0-sample"
        assert metadata["sign_rule"] == "winding" and metadata["site_ids"] == expected.known["site_ids"]
        assert metadata["sign_reason"] == 'an edge is free; "winding" is used'
        assert float(metadata["band"]) == 0.6
        assert metadata["distance"].startswith("negative inside")
        assert [metadata[f"{k}_count"] for k in ("vertex", "edge", "face")] == ["5", "7", "4"]
        names = {"distance", "site", "origin", "spacing", "direction", "metadata"}
        assert set(npz.files) == names | (set() if name == "voxels" else {"vertices", "site_vertices"})


@pytest.mark.parametrize("name", MESH_FIELDS)
def test_npz_sites_lead_to_the_mesh(samples, name):
    """The distance to the named site, computed from the file alone, equals the stored distance."""
    with numpy.load(samples / f"{name}.npz") as npz:
        vertices, corners = npz["vertices"], npz["site_vertices"]
        assert vertices.dtype == numpy.float64 and vertices.shape == (5, 3)
        assert corners.dtype == numpy.int32 and corners.shape == ((4, 3) if name == "triangles" else (16, 3))
        if name != "triangles":
            numpy.testing.assert_array_equal(corners, numpy.loadtxt(samples / "site_vertices.txt", dtype=int))
        vertex_sites = 0
        for z, y, x in numpy.argwhere(npz["site"] >= 0):
            c = corners[npz["site"][z, y, x]]
            if (c >= 0).sum() != 1:
                continue
            point = npz["origin"] + npz["direction"] @ (npz["spacing"] * [x, y, z])
            length = numpy.linalg.norm(point - vertices[c[0]])
            assert abs(length - abs(npz["distance"][z, y, x])) < 1e-6
            vertex_sites += 1
        assert vertex_sites > 3 or name == "triangles"


def test_npz_opens_with_standard_unzip(samples):
    """Standard tools report no damage: checksums, sizes and offsets agree."""
    import zipfile

    with zipfile.ZipFile(samples / "field.npz") as archive:
        assert archive.testzip() is None
        assert all(entry.compress_type == zipfile.ZIP_STORED for entry in archive.infolist())


def read_vti(path):
    reader = vtkXMLImageDataReader()
    problems = []
    reader.AddObserver("ErrorEvent", lambda *_: problems.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: problems.append("warning"))
    reader.SetFileName(str(path))
    reader.Update()
    assert not problems
    return reader.GetOutput()


@pytest.mark.parametrize("name", FIELDS)
def test_vti_in_vtk(samples, name):
    expected = Expected(samples, name)
    image = read_vti(samples / f"{name}.vti")
    assert image.GetDimensions() == tuple(expected.known["size"])
    numpy.testing.assert_array_equal(image.GetOrigin(), expected.origin)
    numpy.testing.assert_array_equal(image.GetSpacing(), expected.spacing)
    matrix = image.GetDirectionMatrix()
    direction = [[matrix.GetElement(row, column) for column in range(3)] for row in range(3)]
    numpy.testing.assert_array_equal(direction, expected.direction)
    points = image.GetPointData()
    assert_same(vtk_to_numpy(points.GetArray("distance")).reshape(expected.shape), expected.distance)
    assert_same(vtk_to_numpy(points.GetArray("site")).reshape(expected.shape), expected.site)
    assert points.GetScalars().GetName() == "distance"
    metadata = json.loads(image.GetFieldData().GetAbstractArray("metadata").GetValue(0))
    assert metadata["source"] == "tétra.obj"
    last = numpy.array(expected.known["size"]) - 1
    place = numpy.zeros(3)
    image.TransformIndexToPhysicalPoint([int(i) for i in last], place)
    numpy.testing.assert_allclose(place, expected.origin + expected.direction @ (last * expected.spacing), atol=1e-14)


def assert_nrrd_geometry(header, expected):
    numpy.testing.assert_allclose(header["space origin"], expected.origin, rtol=0, atol=0)
    steps = (expected.direction * expected.spacing).T
    numpy.testing.assert_allclose(header["space directions"], steps, rtol=0, atol=1e-16)


@pytest.mark.parametrize("name", FIELDS)
def test_nrrd_in_pynrrd(samples, name):
    expected = Expected(samples, name)
    distance, header = nrrd.read(str(samples / f"{name}.nrrd"), index_order="C")
    assert_same(distance, expected.distance)
    assert_nrrd_geometry(header, expected)
    assert header["sign_rule"] == "winding" and header["band"] == "0.6"
    assert header["site_file"] == f"{name}.site.nrrd"
    assert header["source"] == "ttra.obj"  # pynrrd drops characters outside ASCII
    site, header = nrrd.read(str(samples / f"{name}.site.nrrd"), index_order="C")
    assert_same(site, expected.site)
    assert_nrrd_geometry(header, expected)
    assert header["sites"].startswith("site ids:")


def assert_itk(image, array, expected):
    assert_same(SimpleITK.GetArrayFromImage(image), array)
    numpy.testing.assert_allclose(image.GetOrigin(), expected.origin, rtol=1e-15)
    numpy.testing.assert_allclose(image.GetSpacing(), expected.spacing, rtol=1e-15)
    numpy.testing.assert_allclose(numpy.reshape(image.GetDirection(), (3, 3)), expected.direction, atol=1e-15)


@pytest.mark.parametrize("name", FIELDS)
def test_nrrd_in_itk(samples, name):
    expected = Expected(samples, name)
    image = SimpleITK.ReadImage(str(samples / f"{name}.nrrd"))
    assert_itk(image, expected.distance, expected)
    assert image.GetMetaData("sign_rule") == "winding"
    assert image.GetMetaData("source") == "tétra.obj"
    assert_itk(SimpleITK.ReadImage(str(samples / f"{name}.site.nrrd")), expected.site, expected)


@pytest.mark.parametrize("dtype", TYPES)
def test_written_images(samples, dtype):
    expected = Expected(samples, f"image_{dtype}")
    values = expected.array(".bin", dtype)
    assert_same(numpy.load(samples / f"image_{dtype}.npy"), values)
    array, header = nrrd.read(str(samples / f"image_{dtype}.nrrd"), index_order="C")
    assert_same(array, values)
    assert_nrrd_geometry(header, expected)
    assert_itk(SimpleITK.ReadImage(str(samples / f"image_{dtype}.nrrd")), values, expected)


class Read:
    """The content of an image file as Blum reads it."""

    def __init__(self, path, folder):
        out = folder / "read"
        call("image", path, out)
        known = json.loads((folder / "read.json").read_text())
        self.size = known["size"]
        self.values = numpy.fromfile(f"{out}.bin", known["type"]).reshape(tuple(reversed(known["size"])))
        self.origin = numpy.array(known["origin"])
        self.spacing = numpy.array(known["spacing"])
        self.direction = numpy.array(known["columns"]).T
        self.affine = numpy.eye(4)
        self.affine[:3, :3] = self.direction * self.spacing
        self.affine[:3, 3] = self.origin
        numpy.testing.assert_allclose(self.direction.T @ self.direction, numpy.eye(3), atol=1e-14)


def array_of(dtype):
    info = numpy.iinfo(dtype) if numpy.issubdtype(dtype, numpy.integer) else numpy.finfo(dtype)
    array = (numpy.arange(60) * 1.5).astype(dtype).reshape(3, 4, 5)
    array[0, 0, 0], array[0, 0, 1] = info.min, info.max
    return array


def turned(angle=0.4, tilt=0.9):
    c, s, e, f = numpy.cos(angle), numpy.sin(angle), numpy.cos(tilt), numpy.sin(tilt)
    return numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ numpy.array([[1, 0, 0], [0, e, -f], [0, f, e]])


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("encoding", ["raw", "gzip", "text"])
@pytest.mark.parametrize("detached", [False, True])
def test_reads_pynrrd(tmp_path, dtype, encoding, detached):
    if encoding == "text" and (dtype.startswith("float") or dtype.endswith("64")):
        array = (numpy.arange(60) * 0.25).astype(dtype).reshape(3, 4, 5)  # pynrrd rounds the largest numbers
    else:
        array = array_of(dtype)
    steps = (turned() * [0.5, 0.75, 2]).T
    header = {"space": "left-posterior-superior", "space directions": steps, "space origin": [1, -2, 3.5],
              "encoding": encoding, "endian": "little"}
    path = tmp_path / ("a.nhdr" if detached else "a.nrrd")
    nrrd.write(str(path), array, header, index_order="C", detached_header=detached)
    read = Read(path, tmp_path)
    assert_same(read.values, array)
    numpy.testing.assert_allclose(read.affine[:3, :3].T, steps, atol=1e-15)
    numpy.testing.assert_array_equal(read.origin, [1, -2, 3.5])


def test_reads_pynrrd_spacings_and_flat_images(tmp_path):
    array = numpy.arange(12, dtype=numpy.uint8).reshape(3, 4)
    nrrd.write(str(tmp_path / "a.nrrd"), array, {"spacings": [0.5, 2.0]}, index_order="C")
    read = Read(tmp_path / "a.nrrd", tmp_path)
    assert_same(read.values[0], array)
    numpy.testing.assert_array_equal(read.spacing, [0.5, 2, 1])


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("extension", [".nrrd", ".nhdr", ".nii", ".nii.gz", ".hdr"])
@pytest.mark.parametrize("packed", [False, True])
def test_reads_itk(tmp_path, dtype, extension, packed):
    array = array_of(dtype)
    image = SimpleITK.GetImageFromArray(array)
    image.SetSpacing([0.5, 0.75, 2])
    image.SetOrigin([1, -2, 3.5])
    image.SetDirection(turned().ravel())
    path = tmp_path / f"a{extension}"
    SimpleITK.WriteImage(image, str(path), packed)
    read = Read(path, tmp_path)
    assert_same(read.values, array)
    expected = numpy.eye(4)
    expected[:3, :3] = turned() * [0.5, 0.75, 2]
    expected[:3, 3] = [1, -2, 3.5]
    nifti = "nrrd" not in extension and "nhdr" not in extension
    if nifti:
        expected = numpy.diag([-1, -1, 1, 1]) @ expected  # LPS to RAS, which Blum leaves to the user
    numpy.testing.assert_allclose(read.affine, expected, atol=2e-6 if nifti else 1e-14)


def nifti_image(kind, array, affine, dtype):
    image = kind(array, affine, dtype=dtype)
    image.header.set_data_dtype(dtype)
    return image


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("kind, name", [(nibabel.Nifti1Image, "a.nii"), (nibabel.Nifti1Image, "a.nii.gz"),
                                        (nibabel.Nifti2Image, "a.nii"), (nibabel.Nifti1Pair, "a.img"),
                                        (nibabel.Nifti2Pair, "a.hdr")])
def test_reads_nibabel(tmp_path, dtype, order, kind, name):
    array = array_of(dtype)
    affine = numpy.eye(4)
    affine[:3, :3] = turned() * [0.5, 0.75, 2] * [1, -1, 1]
    affine[:3, 3] = [1, -2, 3.5]
    header = kind.header_class(endianness=order)
    header.set_data_dtype(dtype)
    image = kind(array.T, affine, header)
    nibabel.save(image, tmp_path / name)
    read = Read(tmp_path / name, tmp_path)
    assert_same(read.values, array)
    numpy.testing.assert_allclose(read.affine, affine, atol=1e-6)


def test_reads_nibabel_qform_alone(tmp_path):
    array = array_of("int16")
    affine = numpy.eye(4)
    affine[:3, :3] = turned(2.5, -1.1) * [0.5, 0.75, 2] * [1, 1, -1]
    affine[:3, 3] = [1, -2, 3.5]
    image = nibabel.Nifti1Image(array.T, None)
    image.set_qform(affine, 1)
    image.set_sform(None, 0)
    nibabel.save(image, tmp_path / "a.nii.gz")
    read = Read(tmp_path / "a.nii.gz", tmp_path)
    assert_same(read.values, array)
    numpy.testing.assert_allclose(read.affine, nibabel.load(tmp_path / "a.nii.gz").get_qform(), atol=1e-6)
    numpy.testing.assert_allclose(read.affine, affine, atol=1e-6)


def test_reads_nibabel_scaled_values(tmp_path):
    """Floats stored as int16 with the slope and intercept that nibabel chooses."""
    array = numpy.linspace(-3.7, 12.9, 60).reshape(3, 4, 5)
    image = nibabel.Nifti1Image(array.T, numpy.eye(4))
    image.set_data_dtype(numpy.int16)
    nibabel.save(image, tmp_path / "a.nii")
    read = Read(tmp_path / "a.nii", tmp_path)
    assert_same(read.values, numpy.ascontiguousarray(nibabel.load(tmp_path / "a.nii").get_fdata().T))
    numpy.testing.assert_allclose(read.values, array, atol=1e-3)


@pytest.mark.parametrize("dtype", TYPES)
@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("layout", ["C", "F"])
def test_reads_numpy(tmp_path, dtype, order, layout):
    array = array_of(dtype)
    numpy.save(tmp_path / "a.npy", numpy.array(array.astype(numpy.dtype(dtype).newbyteorder(order)), order=layout))
    assert_same(Read(tmp_path / "a.npy", tmp_path).values, array)


def test_reads_numpy_bool_and_flat(tmp_path):
    array = numpy.arange(12).reshape(3, 4) % 3 == 0
    numpy.save(tmp_path / "a.npy", array)
    assert_same(Read(tmp_path / "a.npy", tmp_path).values[0], array.astype(numpy.uint8))


@pytest.mark.parametrize("save", [numpy.savez, numpy.savez_compressed])
@pytest.mark.parametrize("layout", ["C", "F"])
def test_reads_fields_of_numpy(tmp_path, save, layout):
    distance = numpy.array(numpy.linspace(-1, 1, 60).reshape(3, 4, 5), numpy.float32, order=layout)
    site = numpy.array(numpy.arange(60).reshape(3, 4, 5) - 1, numpy.int64, order=layout)
    direction = turned()
    save(tmp_path / "a.npz", distance=distance, site=site, origin=[1.0, 2, 3], spacing=numpy.array([1, 2, 4]),
         direction=direction, metadata=json.dumps({"band": "0.5", "note": "é"}))
    call("field", tmp_path / "a.npz", tmp_path / "out")
    known = json.loads((tmp_path / "out.json").read_text())
    assert_same(numpy.fromfile(tmp_path / "out.distance.bin", numpy.float32), distance.ravel())
    assert_same(numpy.fromfile(tmp_path / "out.site.bin", numpy.int32), site.ravel().astype(numpy.int32))
    assert known["size"] == [5, 4, 3] and known["origin"] == [1, 2, 3] and known["spacing"] == [1, 2, 4]
    numpy.testing.assert_allclose(numpy.array(known["columns"]).T, direction, atol=1e-15)


def test_reads_fields_of_vtk(tmp_path):
    image = vtkImageData()
    image.SetExtent(1, 5, 0, 3, -1, 1)
    image.SetSpacing(0.5, 0.75, 2)
    image.SetOrigin(1, -2, 3.5)
    image.AllocateScalars(VTK_FLOAT, 1)
    array = vtk_to_numpy(image.GetPointData().GetScalars())
    array[:] = numpy.arange(60)
    image.GetPointData().GetScalars().SetName("distance")
    writer = vtkXMLImageDataWriter()
    writer.SetFileName(str(tmp_path / "a.vti"))
    writer.SetInputData(image)
    writer.SetCompressorTypeToNone()
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.Write()
    call("field", tmp_path / "a.vti", tmp_path / "out")
    known = json.loads((tmp_path / "out.json").read_text())
    assert_same(numpy.fromfile(tmp_path / "out.distance.bin", numpy.float32), array)
    assert known["size"] == [5, 4, 3] and known["origin"] == [1.5, -2, 1.5] and known["spacing"] == [0.5, 0.75, 2]


@pytest.mark.parametrize("name", FIELDS)
@pytest.mark.parametrize("extension", [".nrrd", ".npz", ".vti"])
def test_reads_its_own_fields(samples, tmp_path, name, extension):
    expected = Expected(samples, name)
    call("field", samples / f"{name}{extension}", tmp_path / "out")
    assert_same(numpy.fromfile(tmp_path / "out.distance.bin", numpy.float32), expected.distance.ravel())
    assert_same(numpy.fromfile(tmp_path / "out.site.bin", numpy.int32), expected.site.ravel())


def test_reads_gzip_of_the_standard_library(tmp_path):
    array = array_of("float32")
    header = b"NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: gzip\n\n"
    (tmp_path / "a.nrrd").write_bytes(header + gzip.compress(array.tobytes()))
    assert_same(Read(tmp_path / "a.nrrd", tmp_path).values, array)


@pytest.mark.parametrize("name, space", [("a.nii.gz", "right-anterior-superior"), ("itk.nrrd", "left-posterior-superior"),
                                         ("ras.nrrd", "right-anterior-superior"), ("none.nrrd", None)])
def test_fields_lie_where_their_images_do(tmp_path, name, space):
    """A field keeps the world axes of its image, so programs that convert RAS to LPS place both alike."""
    labels = (array_of("uint8") % 3 == 0).astype(numpy.uint8)
    affine = numpy.eye(4)
    affine[:3, :3] = turned() * [0.5, 0.75, 2]
    affine[:3, 3] = [1, -2, 3.5]
    image = tmp_path / name
    if name.endswith(".nii.gz"):
        nibabel.save(nibabel.Nifti1Image(labels.T, affine), image)
    elif name == "itk.nrrd":
        written = SimpleITK.GetImageFromArray(labels)
        written.SetSpacing([0.5, 0.75, 2])
        written.SetDirection(turned().ravel())
        written.SetOrigin([1, -2, 3.5])
        SimpleITK.WriteImage(written, image)
    else:
        header = {"space directions": affine[:3, :3].T, "space origin": affine[:3, 3]}
        header |= {"space": space} if space else {"space dimension": 3}
        nrrd.write(str(image), labels.T, header)
    tool = os.environ.get("BLUM") or str(PROJECT / "build" / "release" / "bin" / "blum")
    subprocess.run([tool, "field", image, "-o", tmp_path / "field.nrrd", "--quiet"], check=True)
    for file in ("field.nrrd", "field.site.nrrd"):
        header = nrrd.read_header(str(tmp_path / file))
        assert header.get("space") == space and ("space dimension" in header) == (space is None)
        given, made = SimpleITK.ReadImage(image), SimpleITK.ReadImage(tmp_path / file)
        for corner in [(0, 0, 0), (4, 0, 0), (0, 3, 0), (0, 0, 2)]:
            numpy.testing.assert_allclose(made.TransformIndexToPhysicalPoint(corner),
                                          given.TransformIndexToPhysicalPoint(corner), atol=1e-5)
    subprocess.run([tool, "field", image, "-o", tmp_path / "field.npz", "--quiet"], check=True)
    with numpy.load(tmp_path / "field.npz") as npz:
        assert json.loads(str(npz["metadata"])).get("world_axes") == space
