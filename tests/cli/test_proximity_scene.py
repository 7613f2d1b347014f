"""Proves that `blum proximity` finds the close pairs of a scene, equal in every format and in the package.

Wrong input is rejected, and no failure leaves a half-written file."""

import csv
import json
import re
import signal
import subprocess
import time

import numpy as np
import pytest
from tool import BLUM, names, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")
blum = pytest.importorskip("blum")

#: Queries of solids and of motions, and those without pairs; other tests cover them.
ELSEWHERE = {"signed", "penetration", "continuous", "meets", "translation"}


def method_of(query):
    return re.search(r"ProximityScene\.(\w+)\(\)", run("proximity", query, "--help")[0])[1]


def all_queries():
    """Every query of the tool that is tested here; the help of a query names the package's method."""
    if not BLUM:
        return []
    listed = run("proximity", "--help")[0].split("Subcommands:")[1].split("Examples:")[0]
    return [query for query in re.findall(r"^  (\w+)  ", listed, re.M) if query not in ELSEWHERE]


QUERIES = [(query, [], lambda scene, query=query: getattr(scene, method_of(query))()) for query in all_queries()]
QUERIES += [
    ("separation", ["--max-distance", "0.3"], lambda scene: scene.separation(max_distance=0.3)),
    ("closest", ["--self"], lambda scene: scene.closest_primitives()),
    ("closest", ["--max-distance", "0.05"], lambda scene: scene.closest_primitives(0.05)),
    ("collide", ["--self"], lambda scene: scene.collisions()),
    ("collide", ["--max-distance", "0"], lambda scene: scene.collisions()),
    ("collide", ["--self", "--max-distance", "5e-2"], lambda scene: scene.closer_than(0.05)),
]


@pytest.fixture(scope="module")
def objects(tmp_path_factory):
    """Two meshes that meet, and a third one apart that has segments and crosses itself."""
    folder = tmp_path_factory.mktemp("scene")
    run("make", "torus", "-o", folder / "torus.ply", "--ring-segments", 24, "--tube-segments", 12)
    torus = blum.read_mesh(folder / "torus.ply")
    blum.Mesh(torus.vertices + [0.9, 0.1, 0.2], torus.triangles).write(folder / "moved.ply")
    random = np.random.default_rng(3)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (random.normal(size=(30, 3)) * 0.4 + [0, 0, 2]).tolist()]
    lines += [f"f {k + 1} {k + 2} {k + 3}" for k in range(0, 24, 3)] + ["l 25 26", "l 27 28"]
    (folder / "soup.obj").write_text("\n".join(lines) + "\n")
    return [folder / "torus.ply", folder / "moved.ply", folder / "soup.obj"]


def scene_of(files, compare_self):
    scene = blum.ProximityScene()
    for file in files:
        scene.add(file, compare_self=compare_self)
    return scene


def read_npz(path):
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def read_csv(path):
    with path.open() as file:
        rows = list(csv.DictReader(file))

    def both(kind, names):
        return np.array([[[kind(row[f"{side}_{n}"]) for n in names] for side in ("first", "second")] for row in rows])

    return {
        "object": both(int, ["object"]).reshape(-1, 2),
        "primitive": both(int, ["primitive"]).reshape(-1, 2),
        "distance": np.array([float(row["distance"]) for row in rows]),
        "closest": both(float, "xyz").reshape(-1, 2, 3),
        "feature": both(int, ["feature_0", "feature_1", "feature_2"]).reshape(-1, 2, 3),
    }


def read_json(path):
    shapes = {"object": (-1, 2), "primitive": (-1, 2), "distance": (-1,), "closest": (-1, 2, 3), "feature": (-1, 2, 3)}
    text = json.loads(path.read_text())
    return {"metadata": text["metadata"], **{name: np.array(text[name]).reshape(shapes[name]) for name in shapes}}


def read_vtp(path):
    vtk = pytest.importorskip("vtkmodules.vtkIOXML")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    count = data.GetNumberOfLines()
    assert data.GetNumberOfCells() == count and data.GetNumberOfPoints() == 2 * count
    cells = {name: vtk_to_numpy(data.GetCellData().GetArray(name)) for name in ("object", "primitive", "distance")}
    if count == 0:
        return {**cells, "closest": np.zeros((0, 2, 3)), "feature": np.zeros((0, 2, 3))}
    ends = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(-1, 2)
    feature = vtk_to_numpy(data.GetCellData().GetArray("feature")).reshape(-1, 2, 3)
    return {**cells, "closest": vtk_to_numpy(data.GetPoints().GetData())[ends], "feature": feature}


READERS = {"npz": read_npz, "csv": read_csv, "json": read_json, "vtp": read_vtp}


@pytest.mark.parametrize(("query", "options", "ask"), QUERIES)
def test_every_format_equals_the_package(objects, tmp_path, query, options, ask):
    wanted = ask(scene_of(objects, "--self" in options))
    for extension, read in READERS.items():
        output = tmp_path / f"p.{extension}"
        answer = run_json("proximity", query, *objects, *options, "-o", output)
        found = read(output)
        for name in ("object", "primitive", "distance", "closest", "feature"):
            column = getattr(wanted, name)
            assert found[name].tolist() == column.tolist(), (extension, name)
        assert answer["pairs"] == len(wanted) > 0 and answer["outputs"] == [str(output)]
        assert answer["object_pairs"] == wanted.object_pairs
        assert [answer["candidates"], answer["exact_tests"]] == [wanted.candidates, wanted.exact_tests]
        assert answer["min_distance"] == answer["closest"]["distance"] == wanted.closest_pair.distance
        assert answer["closest"]["point"] == wanted.closest_pair.closest.tolist()
        assert answer["closest"]["object"] == list(wanted.closest_pair.object)
        assert answer["closest"]["primitive"] == list(wanted.closest_pair.primitive)
    types = {name: array.dtype.str[1:] for name, array in read_npz(tmp_path / "p.npz").items() if name != "metadata"}
    assert types == {"object": "i4", "primitive": "i4", "distance": "f8", "closest": "f8", "feature": "i4"}
    metadata = json.loads(str(read_npz(tmp_path / "p.npz")["metadata"]))
    typed = read_json(tmp_path / "p.json")["metadata"]
    within = [float(options[k + 1]) for k, word in enumerate(options) if word == "--max-distance"]
    assert typed["self"] is ("--self" in options) and [typed[key] for key in ("max_distance",) if key in typed] == within
    assert metadata == {**typed, **{key: metadata[key] for key in ("self", "max_distance") if key in metadata}}
    assert metadata["query"] == query and metadata["object_2"] == "soup.obj"
    assert metadata["self"] == ("true" if "--self" in options else "false")


def test_files_of_pairs_are_not_read_as_fields(objects, tmp_path):
    pairs = tmp_path / "p.npz"
    run("proximity", "collide", *objects, "--max-distance", "1", "-o", pairs)
    for command in (["info", pairs], ["view", pairs, "-o", tmp_path / "page.html"]):
        assert "it holds pairs of primitives" in run(*command, status=1)[1]
    run("proximity", "continuous", objects[0], "--self", "--to", objects[0], "-o", pairs)
    assert "it holds collisions" in run("info", pairs, status=1)[1]


@pytest.mark.parametrize("extension", READERS)
def test_empty_results_are_written(objects, tmp_path, extension):
    output = tmp_path / f"p.{extension}"
    answer = run_json("proximity", "closest", objects[0], objects[2], "--max-distance", "1e-3", "-o", output)
    assert [answer["pairs"], answer["min_distance"], answer["closest"]] == [0, None, None]
    found = READERS[extension](output)
    assert {name: found[name].shape for name in ("object", "distance", "closest", "feature")} == {
        "object": (0, 2), "distance": (0,), "closest": (0, 2, 3), "feature": (0, 2, 3)}  # fmt: skip


def test_separation_is_reported_as_text_and_json(objects):
    out = run("proximity", "separation", *objects)[0]
    scene = scene_of(objects, False)
    assert "3 objects, 1,160 triangles, 2 segments and points" in out and "found                 3 pairs of objects" in out
    assert "torus.ply, moved.ply  distance 0: they touch or overlap near (" in out
    assert f"torus.ply, soup.obj   distance {scene.separation(0, 2).distance:.6g}, from (" in out
    answer = run_json("proximity", "separation", *objects, "--max-distance", "0")
    assert answer["query"] == "separation" and answer["max_distance"] == 0 and answer["self"] is False
    assert [one["triangles"] for one in answer["objects"]] == [576, 576, 8]
    assert [one["segments"] for one in answer["objects"]] == [0, 0, 2]
    assert answer["objects"][0]["file"] == str(objects[0]) and answer["pairs"] == 1 and answer["outputs"] == []
    assert {"read", "build", "objects", "primitives"} <= answer["seconds"].keys()
    assert answer["total_seconds"] > 0 and answer["peak_memory_bytes"] > 2**20 and answer["threads"] >= 1
    assert run("proximity", "separation", *objects, "--quiet")[0] == ""
    alone = run("proximity", "separation", objects[0], "--self")[0]
    assert "torus.ply, itself" in alone and "1 object, 576 triangles\n" in alone


@pytest.mark.parametrize(("chosen", "options"), [([0, 1], []), ([0, 2], []), ([0, 1, 2], []), ([0], ["--self"]),
                                                 ([2], ["--self"]), ([0, 2], ["--self"])])  # fmt: skip
def test_meets_answers_as_the_package_and_as_collide(objects, chosen, options):
    files = [objects[k] for k in chosen]
    wanted = scene_of(files, bool(options)).meets()
    assert wanted is (run_json("proximity", "collide", *files, *options)["pairs"] > 0)
    for threads in (1, 2):
        answer = run_json("proximity", "meets", *files, *options, "--threads", threads)
        assert answer["meets"] is wanted and answer["query"] == "meets" and answer["self"] is bool(options)
        assert [one["file"] for one in answer["objects"]] == list(map(str, files)) and "pairs" not in answer
    out = run("proximity", "meets", *files, *options)[0]
    assert ("found  yes: primitives meet\n" if wanted else "found  no: no two primitives meet\n") in out


def test_meets_writes_no_pairs(objects, tmp_path):
    assert "--output" in run("proximity", "meets", *objects, "--output", tmp_path / "p.npz", status=2)[1]
    assert "--self" in run("proximity", "meets", objects[0], status=2)[1]


def test_text_lists_only_the_first_pairs(objects):
    out = run("proximity", "separation", *objects[:1] * 8)[0]
    assert out.count("they touch or overlap") == 6 and "22 pairs more: -o PAIRS lists all" in out


def test_files_do_not_depend_on_threads(objects, tmp_path):
    for extension in READERS:
        files = []
        for threads in (1, 2, 7):
            output = tmp_path / f"{threads}.{extension}"
            run("proximity", "collide", *objects, "--self", "--max-distance", "0.1", "-o", output, "--threads",
                threads)  # fmt: skip
            files.append(output.read_bytes())
        assert files[0] == files[1] == files[2]


def test_culling_changes_no_file(objects, tmp_path):
    arguments = "closest", *objects, "--self", "-o"
    wanted = run_json("proximity", *arguments, tmp_path / "bvh.npz", "--culling", "bvh")
    answer = run_json("proximity", *arguments, tmp_path / "v.npz", "--culling", "voronoi", "--cell-size", "1.5")
    assert [wanted["culling"], wanted["cells"]] == ["bvh", 0]
    assert answer["culling"] == "voronoi" and answer["cells"] > 0 and answer["left_over"] >= 0
    assert (tmp_path / "bvh.npz").read_bytes() == (tmp_path / "v.npz").read_bytes()


def test_wrong_arguments_and_files_are_rejected(objects, tmp_path):
    torus, moved, soup = objects
    out = tmp_path / "p.npz"
    (tmp_path / "far.obj").write_text("v 0 0 1e71\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "nan.obj").write_text("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "empty.obj").write_text("")
    (tmp_path / "folder.csv").mkdir()
    for arguments, status, message in [
        ([torus], 2, "add --self, or the files of more objects"),
        ([torus, "-o", out], 2, "add --self"),
        ([torus, moved, "--max-distance", "-0.5"], 2, "--max-distance '-0.5': must not be negative"),
        ([torus, moved, "--max-distance", "nan"], 2, "--max-distance 'nan'"),
        ([torus, moved, "--max-distance", "inf"], 2, "--max-distance 'inf'"),
        ([torus, moved, "--max-distance", "near"], 2, "is not a number"),
        ([torus, moved, "--tolerance", "0.1"], 2, "there is no option --tolerance"),
        ([torus, moved, "--min-separation", "0.1"], 2, "there is no option --min-separation"),
        ([torus, moved, "--culling", "octree"], 2, "--culling"),
        ([torus, moved, "--cell-size", "0"], 2, "--cell-size"),
        ([torus, moved, "--threads", "-1"], 2, "--threads"),
        ([torus, moved, "-o", tmp_path / "p.txt"], 2, "the extension must be .npz, .csv, .json or .vtp"),
        ([torus, soup, "-o", soup], 2, ""),
        ([torus, moved, "-o", out, "--json", out], 2, ""),
        ([torus, tmp_path / "absent.ply"], 1, "absent.ply"),
        ([torus, tmp_path], 1, str(tmp_path)),
        ([torus, tmp_path / "nan.obj"], 1, "nan.obj"),
        ([torus, tmp_path / "empty.obj"], 1, "empty.obj"),
        ([torus, tmp_path / "far.obj"], 1, "far.obj': a coordinate is beyond 1e70"),
        ([torus, moved, "-o", tmp_path / "absent" / "p.npz"], 1, "absent"),
        ([torus, moved, "-o", "/proc/p.csv"], 1, "/proc"),
        ([torus, moved, "-o", tmp_path / "folder.csv"], 1, "folder.csv"),
        ([], 2, "SCENE"),
    ]:
        assert message in run("proximity", "separation", *arguments, status=status)[1], arguments
    for arguments, message in [
        ([], "a query is missing; the queries are separation, "),
        (["separate", torus, moved], "there is no query 'separate' (did you mean separation?); the queries are "),
        ([torus, moved], "there is no query "),
    ]:
        assert message in run("proximity", *arguments, status=2)[1], arguments
    assert names(tmp_path) == ["empty.obj", "far.obj", "folder.csv", "nan.obj"]


@pytest.mark.parametrize("extension", READERS)
def test_a_full_disk_leaves_the_file_as_it_was(objects, tmp_path, extension):
    output = tmp_path / f"p.{extension}"
    output.write_bytes(b"old")
    arguments = [BLUM, "proximity", "closest", *objects, "--self", "-o", output]
    limited = ["bash", "-c", 'trap "" XFSZ; ulimit -f 4; exec "$@"', "limited", *map(str, arguments)]
    done = subprocess.run(limited, capture_output=True, check=False, timeout=60)
    assert done.returncode == 1 and b"blum: error: " in done.stderr
    assert output.read_bytes() == b"old" and names(tmp_path) == [output.name]
    run("proximity", "closest", *objects, "--self", "-o", output)
    assert len(READERS[extension](output)["distance"]) == 1162 and names(tmp_path) == [output.name]


def test_interrupted_work_ends_by_the_signal_and_leaves_nothing(tmp_path):
    run("make", "soup", "-o", tmp_path / "soup.ply", "--triangles", 200000)
    (tmp_path / "out.npz").write_bytes(b"old")
    arguments = ["proximity", "closest", "soup.ply", "--self", "-o", "out.npz", "--threads", "1"]
    with subprocess.Popen([BLUM, *arguments], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        time.sleep(0.7)
        assert process.poll() is None, "the work was done before it could be interrupted"
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, err = process.communicate(timeout=30)
    assert process.returncode == -signal.SIGINT and err.endswith(b"blum: error: cancelled\n")
    assert time.monotonic() - start < 3
    assert (tmp_path / "out.npz").read_bytes() == b"old" and names(tmp_path) == ["out.npz", "soup.ply"]
