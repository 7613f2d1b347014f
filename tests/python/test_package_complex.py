"""Proves that complexes in Python hold any columns, share them without copies, and reject wrong arrays by name."""

import copy
import pickle

import pytest

blum = pytest.importorskip("blum")
np = pytest.importorskip("numpy")

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def sample():
    return blum.Complex(
        SQUARE,
        edges=[[0, 1], [2, 3]],
        triangles=[[0, 1, 2]],
        vertex_columns={"weight": [1.0, 2.0, 3.0, 4.0], "normal": np.ones((4, 3), dtype=np.float32)},
        edge_columns={"id": np.array([7, 2**40])},
        triangle_columns={"part": np.array([3], dtype=np.int32), "flag": [True]},
    )


def test_columns_are_read_only_views():
    complex = sample()
    assert list(complex.vertex_columns) == ["weight", "normal"]
    assert complex.vertex_columns["normal"].shape == (4, 3) and complex.vertex_columns["normal"].dtype == np.float32
    assert complex.edge_columns["id"].dtype == np.int64 and complex.edge_columns["id"][1] == 2**40
    assert complex.triangle_columns["part"].dtype == np.int32
    assert complex.triangle_columns["flag"].tolist() == [1]
    weight = complex.vertex_columns["weight"]
    assert np.shares_memory(weight, complex._core.vertex_columns["weight"])
    with pytest.raises(ValueError, match="read-only"):
        weight[0] = 5
    with pytest.raises(TypeError):
        complex.vertex_columns["more"] = weight
    del complex
    assert weight.tolist() == [1, 2, 3, 4], "a view keeps what it shows alive"


def test_topology_and_pickling():
    complex = sample()
    assert complex.homology() == (1, 0, 0) == blum.homology(4, complex.edges, complex.triangles)
    again = pickle.loads(pickle.dumps(complex))
    assert np.array_equal(again.vertices, complex.vertices) and np.array_equal(again.edges, complex.edges)
    for name, column in complex.vertex_columns.items():
        assert np.array_equal(again.vertex_columns[name], column) and again.vertex_columns[name].dtype == column.dtype
    assert repr(again) == "Complex(4 vertices, 2 edges, 1 triangles)"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"vertex_columns": {"weight": [1.0]}}, "weight"),
        ({"vertex_columns": {"": [1.0] * 4}}, "name"),
        ({"vertex_columns": {"a\0b": [1.0] * 4}}, "without null characters"),
        ({"vertex_columns": {"\ud800": [1.0] * 4}}, "UTF-8"),
        ({"edges": [[0, 4]]}, "edges"),
        ({"edges": [[1, 1]]}, "twice"),
        ({"vertex_columns": {"deep": np.zeros((4, 2, 2))}}, "axes"),
    ],
)
def test_wrong_arrays_are_rejected_by_name(arguments, told):
    with pytest.raises(ValueError, match=told):
        blum.Complex(SQUARE, **arguments)
    with pytest.raises(TypeError, match="numbers"):
        blum.Complex(SQUARE, vertex_columns={"word": ["a", "b", "c", "d"]})


def test_names_of_columns_in_files_are_text(tmp_path):
    path = tmp_path / "axis.vtp"
    blum.MedialComplex([[0, 0, 0], [1, 0, 0]], radius=[1, 1], edges=[[0, 1]]).write(path)
    content = path.read_bytes()
    path.write_bytes(content.replace(b'"radius"', b'"a&amp;b"'))
    assert "a&b" in blum.read_medial(path).vertex_columns
    path.write_bytes(content.replace(b'"radius"', b'"rad\xefus"'))
    with pytest.raises(ValueError, match=r"axis\.vtp.*UTF-8"):
        blum.read_medial(path)


def test_medial_axes_are_complexes():
    axis = blum.medial_axis(blum.generate("box"), resolution=24)
    piece, nested = axis.simplify(60), axis.nested()
    assert isinstance(piece, blum.Complex) and isinstance(nested, blum.Complex)
    assert list(piece.edge_columns) == ["separation_angle", "role"]
    assert np.array_equal(piece.footprints[:, 1], piece.vertex_columns["footprint_1"])
    assert np.array_equal(piece.sites[:, 0], piece.vertex_columns["site_0"])
    assert set(nested.edge_columns) == {"separation_angle", "role", "from", "until"}
    assert piece.homology() == piece.certificate.axis_betti
    again = pickle.loads(pickle.dumps(nested))
    assert again.least_theta == nested.least_theta and np.array_equal(again.edge_from, nested.edge_from)


def test_copies_of_medial_axes_keep_all_columns_and_all_angles(tmp_path):
    axis = blum.medial_axis(blum.generate("box"), resolution=16)
    axis.write(tmp_path / "axis.npz")
    arrays = dict(np.load(tmp_path / "axis.npz"))
    arrays["extra"] = np.arange(len(arrays["vertices"]))
    np.savez(tmp_path / "more.npz", **arrays)
    read = blum.read_medial(tmp_path / "more.npz")
    for again in (pickle.loads(pickle.dumps(read)), copy.deepcopy(read)):
        assert list(again.vertex_columns) == list(read.vertex_columns) and "extra" in again.vertex_columns
        assert np.array_equal(again.vertex_columns["extra"], arrays["extra"])
        assert read.nested is not None and again.nested is not None
        assert np.array_equal(again.nested.edge_until, read.nested.edge_until)
    pytest.importorskip("pyvista")
    assert set(read.to_pyvista().point_data) == set(read.vertex_columns)


@pytest.mark.parametrize("ending", ["vtp", "ply", "npz"])
def test_files_return_the_written_complex(ending, tmp_path):
    made = sample()
    about = {"made by": "hand", "Größe": "β ≤ 3"}
    blum.write_complex(tmp_path / f"a.{ending}", made, metadata=about)
    file = blum.read_complex(tmp_path / f"a.{ending}")
    assert file.metadata == about and not file.further
    assert pickle.loads(pickle.dumps(file)).metadata == copy.deepcopy(file).metadata == about
    assert np.array_equal(file.complex.vertices, made.vertices) and np.array_equal(file.complex.edges, made.edges)
    assert np.array_equal(file.complex.triangles, made.triangles)
    for kind in ("vertex_columns", "edge_columns", "triangle_columns"):
        columns, read = getattr(made, kind), getattr(file.complex, kind)
        assert set(columns) == set(read)
        assert all(read[name].dtype == columns[name].dtype for name in columns)
        assert all(np.array_equal(read[name], columns[name]) for name in columns)


def test_impossible_files_are_rejected(tmp_path):
    made = sample()
    with pytest.raises(blum.InvalidOption, match="obj"):
        blum.write_complex(tmp_path / "a.obj", made)
    blum.write_complex(tmp_path / "a.obj", made, allow_loss=True)
    assert np.array_equal(blum.read_complex(tmp_path / "a.obj").complex.triangles, made.triangles)
    with pytest.raises(blum.InvalidOption, match="xyz"):
        blum.write_complex(tmp_path / "a.xyz", made)
    with pytest.raises(TypeError, match="complex"):
        blum.write_complex(tmp_path / "a.vtp", made.vertices)
    with pytest.raises(FileNotFoundError):
        blum.read_complex(tmp_path / "none.vtp")
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 and no more")
    with pytest.raises(blum.FileError, match=r"bad\.npz"):
        blum.read_complex(tmp_path / "bad.npz")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.obj", "bad.npz"]


def test_npz_files_hold_further_complexes(tmp_path):
    made, other = sample(), blum.Complex([[0, 0, 0], [1, 2, 3]], edges=[[0, 1]])
    blum.write_complex(tmp_path / "a.npz", made, further={"other": other, "more": made})
    file = blum.read_complex(tmp_path / "a.npz")
    assert sorted(file.further) == ["more", "other"]
    assert np.array_equal(file.further["other"].vertices, other.vertices)
    assert np.array_equal(file.further["more"].vertex_columns["weight"], made.vertex_columns["weight"])
    with pytest.raises(blum.InvalidOption, match="npz"):
        blum.write_complex(tmp_path / "a.vtp", made, further={"other": other})
    data = (tmp_path / "a.npz").read_bytes()
    for name in (b"oth\xff\xff", b"oth\0r"):
        (tmp_path / "b.npz").write_bytes(data.replace(b"other_", name + b"_"))
        with pytest.raises(blum.FormatError, match="name of the complex"):
            blum.read_complex(tmp_path / "b.npz")


def test_metadata_must_be_text_and_complexes_plain(tmp_path):
    made, path = sample(), tmp_path / "a.vtp"
    for metadata in (None, [("a", "b")], {"a": 1}, {1: "a"}):
        with pytest.raises(TypeError, match="metadata"):
            blum.write_complex(path, made, metadata=metadata)
    for metadata in ({"a": "\ud800"}, {"a\0": "b"}, {"": "b"}):
        with pytest.raises(blum.InvalidOption):
            blum.write_complex(path, made, metadata=metadata)
    diagram = blum.voronoi_complex(blum.generate("gear"), method="cubes", depth=3)
    for special in (diagram, blum.medial_axis(blum.generate("box"), resolution=16).simplify(60)):
        with pytest.raises(TypeError, match=r"write\(\)"):
            blum.write_complex(path, special)
        with pytest.raises(TypeError, match="further"):
            blum.write_complex(tmp_path / "a.npz", made, further={"other": special})
    blum.write_complex(path, diagram.with_failing_cells(), metadata={"certified": "false"})


def test_files_of_diagrams_read_back_as_complexes(tmp_path):
    found = blum.voronoi_complex(blum.generate("box"))
    found.write(tmp_path / "box.vtp")
    file = blum.read_complex(tmp_path / "box.vtp")
    assert file.metadata["content"] == "Voronoi diagram" and file.metadata["certified"] == "true"
    assert float(file.metadata["hausdorff_bound"]) == found.report.hausdorff_bound
    assert np.array_equal(file.complex.triangle_columns["site_b"], found.triangle_sites[:, 1])
    failed = blum.voronoi_complex(blum.generate("gear"), method="cubes", depth=3)
    failed.write(tmp_path / "gear.vtp", allow_uncertified=True)
    about = blum.read_complex(tmp_path / "gear.vtp").metadata
    assert about["certified"] == "false" and int(about["failing_cubes"]) == len(failed.report.failing)
