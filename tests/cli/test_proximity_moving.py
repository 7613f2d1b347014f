"""Proves that `blum proximity continuous --to END...` finds the collisions of moving objects at known times.

Every format equals the package's arrays and names the objects of each pair. Wrong input is rejected."""

import csv
import json

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")

KINDS = "vertex_face", "edge_edge"
TOLERANCE = 1e-6


def moved(mesh, *offset):
    return blum.Mesh(mesh.vertices + np.array(offset, dtype=float), mesh.triangles)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A ball that falls through a plate, a ball that falls beside the plate, and a ring that turns inside out."""
    folder = tmp_path_factory.mktemp("moving")
    ball, plate = blum.generate("sphere", radius=0.5), blum.generate("box", size_x=4, size_y=4, size_z=0.2)
    ring = blum.generate("torus", ring_segments=16, tube_segments=8)
    for name, mesh in {
        "ball1.ply": moved(ball, 0.01, 0.02, 2),
        "ball2.ply": moved(ball, 0.01, 0.02, -2),
        "beside1.ply": moved(ball, 5, 0, 2),
        "beside2.ply": moved(ball, 5, 0, -2),
        "plate.ply": plate,
        "ring1.ply": moved(ring, 0, 0, 0.5),
        "ring2.ply": blum.Mesh(ring.vertices * [-1, 1, 0.3], ring.triangles),
    }.items():
        mesh.write(folder / name)
    return folder


def continuous(folder, start, end, output, *options):
    files = [*[folder / name for name in start], "--to", *[folder / name for name in end]]
    return run_json("proximity", "continuous", *files, "-o", output, *options)


def python_answer(folder, start, end, compare_self=False, **options):
    """The arrays that files must hold, computed by the package."""
    scene = blum.ProximityScene()
    meshes = [blum.read_mesh(folder / name) for name in start]
    for mesh in meshes:
        scene.add(mesh, compare_self=compare_self)
    moves = {k: blum.read_mesh(folder / name).vertices for k, name in enumerate(end) if name != start[k]}
    found = scene.continuous(moves, **options)
    faces, edges = found.vertex_face, found.edge_edge
    corners = [meshes[owner].triangles[face] for owner, face in faces[:, 2:].tolist()]
    return {
        "vertex_face": np.column_stack([faces[:, 1], np.reshape(corners, (-1, 3))]),
        "vertex_face_object": faces[:, [0, 2]],
        "vertex_face_time": found.vertex_face_time,
        "face": faces[:, 3],
        "edge_edge": edges[:, [1, 2, 4, 5]],
        "edge_edge_object": edges[:, [0, 3]],
        "edge_edge_time": found.edge_edge_time,
    }, found


def read_npz(path):
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def read_csv(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))
    out = {}
    for kind in KINDS:
        own = [row for row in rows if row["kind"] == kind]
        out[kind] = np.array([[int(row[x]) for x in "abcd"] for row in own]).reshape(-1, 4)
        out[f"{kind}_object"] = np.array([[int(row[f"{x}_object"]) for x in ("first", "second")] for row in own])
        out[f"{kind}_time"] = np.array([float(row["time"]) for row in own])
    return out


def read_json(path):
    return {
        name: value if name == "metadata" else np.array(value) for name, value in json.loads(path.read_text()).items()
    }


READERS = {"npz": read_npz, "csv": read_csv, "json": read_json}
SCENES = [
    (["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"], {}),
    (["plate.ply", "ball1.ply", "ring1.ply"], ["plate.ply", "ball2.ply", "ring2.ply"], {}),
    (["plate.ply", "ball1.ply", "ring1.ply"], ["plate.ply", "ball2.ply", "ring2.ply"], {"min_separation": 0.01}),
    (["ring1.ply", "plate.ply"], ["ring2.ply", "plate.ply"], {"compare_self": True, "tolerance": 1e-4}),
    (["ring1.ply"], ["ring2.ply"], {"compare_self": True}),
]


def options_of(options):
    named = {"compare_self": "--self", "min_separation": "--min-separation", "tolerance": "--tolerance"}
    return [
        text for name, value in options.items() for text in ([named[name]] if value is True else [named[name], value])
    ]


@pytest.mark.parametrize(("start", "end", "options"), SCENES)
def test_every_format_equals_the_package(folder, tmp_path, start, end, options):
    wanted, found = python_answer(folder, start, end, **options)
    assert len(wanted["vertex_face"]) > 0 and len(wanted["edge_edge"]) > 0
    for extension, read in READERS.items():
        output = tmp_path / f"p.{extension}"
        answer = continuous(folder, start, end, output, *options_of(options))
        arrays = read(output)
        for name, array in wanted.items():
            if name != "face" or extension != "csv":
                assert arrays[name].tolist() == array.tolist(), (extension, name)
        assert [answer[kind] for kind in KINDS] == [len(wanted[kind]) for kind in KINDS]
        assert answer["earliest"] == found.earliest
        assert [answer["box_pairs"], answer["exact_tests"]] == [found.box_pairs, found.exact_tests]
    types = {name: array.dtype.str[1:] for name, array in read_npz(tmp_path / "p.npz").items() if name != "metadata"}
    assert types == {name: "f8" if name.endswith("_time") else "i4" for name in wanted}
    metadata = json.loads(str(read_npz(tmp_path / "p.npz")["metadata"]))
    typed = read_json(tmp_path / "p.json")["metadata"]
    assert isinstance(typed["self"], bool)
    assert all(isinstance(typed[key], (int, float)) for key in ("tolerance", "min_separation"))
    assert metadata == {**typed, **{key: metadata[key] for key in ("self", "tolerance", "min_separation")}}
    with (tmp_path / "p.csv").open() as file:
        faces = [row["face"] for row in csv.DictReader(file)]
    told = wanted["face"].tolist()
    assert faces == [str(face) for face in told] + [""] * (len(faces) - len(told))
    assert [metadata[f"object_{k}"] for k in range(len(start))] == start
    assert [metadata[f"end_{k}"] for k in range(len(start))] == end


def test_features_are_drawn_at_their_contact(folder, tmp_path):
    """The ball falls by 4 onto the resting plate. In the file, the two features of each pair share a point."""
    wanted, _ = python_answer(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"])
    continuous(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"], tmp_path / "p.vtp")
    drawn = blum.read_complex(tmp_path / "p.vtp").complex
    faces, edges = len(wanted["vertex_face"]), len(wanted["edge_edge"])
    assert drawn.vertex_columns["vertex"].reshape(-1, 4).tolist() == [
        *wanted["vertex_face"].tolist(),
        *wanted["edge_edge"].tolist(),
    ]
    assert drawn.triangle_columns["time"].tolist() == wanted["vertex_face_time"].tolist()
    assert drawn.edge_columns["time"].tolist() == np.repeat(wanted["edge_edge_time"], 2).tolist()
    points = drawn.vertices.reshape(-1, 4, 3)
    assert len(points) == faces + edges
    # The four corners of two features that share a point lie in one plane. A time is at most 1e-6 early, and in 1e-6
    # the ball falls by 4e-6.
    a, b, c, d = points.transpose(1, 0, 2)
    normal = np.cross(np.where(np.arange(len(points))[:, None] < faces, c - b, b - a), d - c)
    height = np.abs(((c - a) * normal).sum(1)) / np.linalg.norm(normal, axis=1)
    assert height.max() < 4.1e-6


@pytest.mark.parametrize(("start", "end", "options"), SCENES)
def test_the_summary_lists_each_pair_of_objects(folder, tmp_path, start, end, options):
    answer = continuous(folder, start, end, tmp_path / "p.npz", *options_of(options))
    arrays = read_npz(tmp_path / "p.npz")
    assert [pair["object"] for pair in answer["pairs"]] == sorted(pair["object"] for pair in answer["pairs"])
    for pair in answer["pairs"]:
        own = {kind: (np.sort(arrays[f"{kind}_object"], axis=1) == pair["object"]).all(axis=1) for kind in KINDS}
        assert [pair[kind] for kind in KINDS] == [own[kind].sum() for kind in KINDS]
        assert pair["earliest"] == min(arrays[f"{kind}_time"][own[kind]].min(initial=9) for kind in KINDS)
    assert sum(pair["vertex_face"] for pair in answer["pairs"]) == answer["vertex_face"] == len(arrays["vertex_face"])
    assert [one["moves"] for one in answer["objects"]] == [a != b for a, b in zip(start, end, strict=True)]
    assert [one["file"] for one in answer["objects"]] == [str(folder / name) for name in start]
    assert [one["end"] for one in answer["objects"]] == [str(folder / name) for name in end]
    assert answer["query"] == "continuous" and answer["self"] is ("compare_self" in options)


def test_a_ball_meets_a_plate_at_the_known_time(folder, tmp_path):
    """The lowest point of the ball is 1.4 above the plate and falls by 4."""
    out = tmp_path / "p.npz"
    answer = continuous(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"], out)
    assert 1.4 / 4 - TOLERANCE <= answer["earliest"] <= 1.4 / 4
    arrays = read_npz(out)
    first = arrays["vertex_face_time"].argmin()
    assert arrays["vertex_face_object"][first].tolist() == [0, 1]
    bottom = blum.read_mesh(folder / "ball1.ply").vertices[arrays["vertex_face"][first, 0]]
    assert bottom[2] == pytest.approx(1.5)
    close = continuous(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"], out, "--min-separation", 0.4)
    assert 1.0 / 4 - TOLERANCE <= close["earliest"] <= 1.0 / 4


def test_two_balls_meet_in_the_middle(folder, tmp_path):
    """The tips of two octahedra are 3 apart and approach by 4, or by 2, which is too little."""
    tips = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]) * 0.5
    triangles = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    for name, x in {"a1": -2, "a2": 0, "b1": 2, "b2": 0}.items():
        blum.Mesh(tips + [x, 0, 0], triangles).write(tmp_path / f"{name}.ply")
    answer = continuous(tmp_path, ["a1.ply", "b1.ply"], ["a2.ply", "b2.ply"], tmp_path / "p.json")
    assert 3 / 4 - TOLERANCE <= answer["earliest"] <= 3 / 4
    alone = continuous(tmp_path, ["a1.ply", "b1.ply"], ["a2.ply", "b1.ply"], tmp_path / "p.json")
    assert [alone["earliest"], alone["pairs"]] == [None, []]


@pytest.mark.parametrize("extension", READERS)
def test_motions_without_contact_write_empty_files(folder, tmp_path, extension):
    output = tmp_path / f"p.{extension}"
    answer = continuous(folder, ["beside1.ply", "plate.ply"], ["beside2.ply", "plate.ply"], output)
    assert [answer["vertex_face"], answer["edge_edge"], answer["earliest"], answer["pairs"]] == [0, 0, None, []]
    assert {name: len(value) for name, value in READERS[extension](output).items() if name.endswith("_time")} == {
        "vertex_face_time": 0, "edge_edge_time": 0}  # fmt: skip


def test_an_object_with_an_equal_end_file_rests(folder, tmp_path):
    """Naming a copy of a file as the end gives the same result as naming the file again."""
    (tmp_path / "copy.ply").write_bytes((folder / "plate.ply").read_bytes())
    one = continuous(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", "plate.ply"], tmp_path / "one.csv")
    other = continuous(folder, ["ball1.ply", "plate.ply"], ["ball2.ply", tmp_path / "copy.ply"], tmp_path / "other.csv")
    assert (tmp_path / "one.csv").read_bytes() == (tmp_path / "other.csv").read_bytes()
    assert [one["objects"][1]["moves"], other["objects"][1]["moves"]] == [False, True]


def test_text_reports_objects_pairs_and_first_time(folder, tmp_path):
    files = ["--to", folder / "ball2.ply", folder / "plate.ply", "-o", tmp_path / "p.csv"]
    out = run("proximity", "continuous", folder / "ball1.ply", folder / "plate.ply", *files)[0]
    assert "2 objects, of which 1 moves; 5,132 triangles" in out
    assert "ball1.ply, plate.ply  " in out and "the first at time 0.349999" in out and f"{tmp_path / 'p.csv'}\n" in out
    ring = [folder / "ring1.ply", "--self", "--to", folder / "ring2.ply"]
    names_of_self = run("proximity", "continuous", *ring, *files[3:])[0]
    assert "ring1.ply, itself  " in names_of_self
    assert run("proximity", "continuous", folder / "ball1.ply", folder / "plate.ply", *files, "--quiet")[0] == ""


def test_text_lists_only_the_first_pairs_of_objects(folder, tmp_path):
    files = [folder / "ball1.ply"] + [folder / "plate.ply"] * 7
    ends = [folder / "ball2.ply"] + [folder / "plate.ply"] * 7
    out = run("proximity", "continuous", *files, "--to", *ends, "-o", tmp_path / "p.csv", warns=True)[0]
    assert "22 pairs of objects more: --json FILE lists all" in out  # resting plates in one place meet, too


def test_files_do_not_depend_on_threads(folder, tmp_path):
    start, end, _ = SCENES[1]
    for extension in READERS:
        files = []
        for threads in (1, 2, 7):
            output = tmp_path / f"{threads}.{extension}"
            continuous(folder, start, end, output, "--threads", threads)
            files.append(output.read_bytes())
        assert files[0] == files[1] == files[2]


def test_frames_of_one_mesh_equal_one_object_with_an_end(folder, tmp_path):
    """Without --to, two files are frames of one mesh. The pairs equal those of one object with --to."""
    run("proximity", "continuous", folder / "ring1.ply", folder / "ring2.ply", "--self", "-o",
        tmp_path / "frames.npz")  # fmt: skip
    continuous(folder, ["ring1.ply"], ["ring2.ply"], tmp_path / "object.npz", "--self")
    frames, objects = read_npz(tmp_path / "frames.npz"), read_npz(tmp_path / "object.npz")
    assert list(frames) == ["vertex_face", "vertex_face_time", "edge_edge", "edge_edge_time", "face", "metadata"]
    for name in set(frames) - {"metadata"}:
        assert frames[name].dtype == objects[name].dtype and frames[name].tolist() == objects[name].tolist()
    assert set(objects) - set(frames) == {"vertex_face_object", "edge_edge_object"}
    run("proximity", "continuous", folder / "ring1.ply", folder / "ring2.ply", "--self", "-o",
        tmp_path / "frames.json")  # fmt: skip
    text = read_json(tmp_path / "frames.json")
    assert list(text)[0] == "metadata" and set(text) == set(frames)
    assert text["face"].tolist() == frames["face"].tolist()


def test_ends_that_do_not_match_are_rejected(folder, tmp_path):
    ball, fallen, plate, ring = (folder / name for name in ("ball1.ply", "ball2.ply", "plate.ply", "ring1.ply"))
    out = tmp_path / "p.npz"
    mesh = blum.read_mesh(plate)
    blum.Mesh(mesh.vertices, mesh.triangles[::-1]).write(tmp_path / "other.ply")
    blum.Mesh(mesh.vertices * 1e72, mesh.triangles).write(tmp_path / "far.obj")
    two = [ball, plate, "-o", out, "--to"]
    for arguments, status, message in [
        ([*two, fallen], 2, "--to has 1 file, but 2 objects are given; give one file for each object, in the"),
        ([*two, fallen, plate, plate], 2, "--to has 3 files, but 2 objects are given"),
        ([*two, plate, fallen], 1, f"'{plate}': it has 8 vertices, not 2,562 like '{ball}': frames of one motion need"),
        ([*two, fallen, tmp_path / "other.ply"], 1, "other.ply': its triangles, segments or points have other corners"),
        ([*two, fallen, tmp_path / "far.obj"], 1, f"'{plate}' at the end: a coordinate is beyond 1e70"),
        ([tmp_path / "far.obj", "--self", "-o", out, "--to", plate], 1, "far.obj': a coordinate is beyond 1e70"),
        ([*two, fallen, tmp_path / "absent.ply"], 1, "absent.ply"),
        ([ball, "-o", out, "--to", fallen], 2, "add --self, or the files of more objects"),
        ([*two, fallen, plate, "-o", tmp_path / "p.obj"], 2, ""),
        ([ball, plate, "-o", tmp_path / "p.obj", "--to", fallen, plate], 2, "must be .npz, .csv, .json or .vtp"),
        ([ball, plate, "-o", fallen, "--to", fallen, plate], 2, ""),
        ([*two, fallen, plate, "--max-distance", "1"], 2, "there is no option --max-distance"),
        ([*two, fallen, plate, "--culling", "bvh"], 2, "there is no option --culling"),
        ([*two, fallen, plate, "--depth-tolerance", "0.1"], 2, "there is no option --depth-tolerance"),
        ([*two, fallen, plate, "--tolerance", "0"], 2, "tolerance"),
        ([*two, fallen, plate, "--min-separation", "-1"], 2, "min"),
        ([*two, fallen, plate, "--frames", "--self"], 2, "--frames and --to exclude each other"),
        ([ball, plate, ring, "--self", "-o", out], 2, "takes two files"),
        ([ball, plate, ring, "--self", "-o", out], 2, "their files at the end with --to"),
        ([ball, plate, "-o", out], 2, "--to END"),
    ]:
        assert message in run("proximity", "continuous", *arguments, status=status)[1], arguments
    for query in ("separation", "closest", "collide", "penetration"):
        error = run("proximity", query, *two, fallen, plate, status=2)[1]
        assert "there is no option --to" in error
    assert names(tmp_path) == ["far.obj", "other.ply"]


def test_pairs_that_meet_at_the_start_are_warned_of(folder, tmp_path):
    box = blum.generate("box")
    for name, step in {"a.ply": 0, "b.ply": 0.5, "c.ply": 5}.items():
        moved(box, step, 0, 0).write(tmp_path / name)
    pair = blum.Mesh(
        np.concatenate([box.vertices, box.vertices + np.array([0.5, 0, 0])]),
        np.concatenate([box.triangles, box.triangles + 8]),
    )
    for name, step in {"1.ply": 0, "2.ply": 1}.items():
        moved(pair, step, 0, 0).write(tmp_path / name)
    a, b, c, first, last = (tmp_path / name for name in ("a.ply", "b.ply", "c.ply", "1.ply", "2.ply"))
    for arguments in (
        ["proximity", "continuous", a, b, "--to", a, c],
        ["proximity", "continuous", first, last, "--self"],
        ["proximity", "continuous", first, last, first, "--frames", "--self"],
    ):
        _, err = run(*arguments, warns=True)
        assert "already at the start of the motion, so their times are 0" in err, arguments
        facts = run_json(*arguments, warns=True)
        assert [warning["code"] for warning in facts["warnings"]] == ["meet-at-start"]
    assert "warning" not in run("proximity", "continuous", a, c, "--to", a, c)[1]
