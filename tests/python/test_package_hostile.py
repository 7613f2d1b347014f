"""Proves that inputs that once broke the package do not, by the smallest case of each.

The cases are masked arrays, processes that end while threads compute, pickles, arrays that change, solvers that are
called again, and names that are not UTF-8."""

import copy
import pickle
import subprocess
import sys
import threading
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

blum = pytest.importorskip("blum")


@pytest.fixture(scope="module")
def box():
    return blum.generate("box")


def test_masked_arrays_are_refused_everywhere(box):
    masked = np.ma.masked_array([[0, 1, 10**9]], mask=[[0, 0, 1]])
    points = np.ma.masked_array(np.zeros((3, 3)), mask=True)
    image = np.ma.masked_array(np.ones((2, 2, 2)), mask=True)
    for call, name in (
        (lambda: blum.MedialComplex(np.zeros((3, 3)), triangles=masked), "triangles"),
        (lambda: blum.Mesh(np.zeros((3, 3)), masked), "triangles"),
        (lambda: blum.Mesh(points, [[0, 1, 2]]), "vertices"),
        (lambda: blum.closest_points(box, points), "points"),
        (lambda: blum.distance_transform(image), "image"),
        (lambda: blum.voxel_topology(image > 0), "mask"),
        (lambda: blum.reference.nearest_voxel(np.ones((3, 3, 3), bool), masked[0]), "voxels"),
        (lambda: blum.Grid(points[0], 1, (2, 2, 2)), "origin"),
    ):
        with pytest.raises(TypeError, match=f"{name} is a masked array"):
            call()


def test_overridden_methods_of_subclasses_are_ignored():
    class Liar(np.ndarray):
        def min(self, *_args, **_kwargs):
            return 0

        max = min

    with pytest.raises(ValueError, match=r"triangles\[0, 2\]"):
        blum.Mesh(np.zeros((3, 3)), np.array([[0, 1, 10**9]]).view(Liar))


def test_sheets_and_sites_of_an_axis_are_checked():
    corners = np.eye(3)
    with pytest.raises(ValueError, match=r"triangle_sheet\[0\]"):
        blum.MedialComplex(corners, triangles=[[0, 1, 2]], triangle_sheet=[2**31 - 2])
    for wrong in (2**32 + 1, -7):
        with pytest.raises(ValueError, match="sites"):
            blum.MedialComplex(corners, sites=[[wrong, 0]] * 3)


@pytest.mark.parametrize("beta", [1.0, 0.0, -2.0, float("inf"), float("nan")])
def test_winding_numbers_refuse_an_invalid_beta(box, beta):
    for mesh in (box, blum.generate("sphere")):
        with pytest.raises(ValueError, match="approximate"):
            blum.WindingNumber(mesh)([[0, 0, 0.0]], approximate=beta)


def test_fields_are_not_written_with_another_mesh(tmp_path, box):
    vertices, triangles = box.vertices.copy(), box.triangles.copy()
    field = blum.distance_field(vertices, triangles, resolution=8)
    kept = triangles[0, 0]
    triangles[0, 0] = 10**9
    with pytest.raises(ValueError, match="triangle 0"):
        field.write(tmp_path / "field.npz")
    triangles[0, 0] = kept
    field.write(tmp_path / "field.npz")
    field.mesh = blum.Mesh(np.eye(3), [[0, 1, 2]])
    with pytest.raises(ValueError, match="the field belongs to another mesh"):
        field.write(tmp_path / "other.npz")
    assert not (tmp_path / "other.npz").exists()


def test_arrays_change_only_in_place(box):
    mesh = blum.Mesh(box.vertices.copy(), box.triangles)
    image = blum.Image(np.zeros((2, 2, 2), dtype=np.uint8))
    field = blum.distance_field(mesh, resolution=8)
    for thing, names in (
        (mesh, ("vertices", "triangles", "segments", "points")),
        (image, ("values", "grid", "space")),
        (field, ("distance", "site", "grid")),
    ):
        for name in names:
            with pytest.raises(AttributeError):
                setattr(thing, name, getattr(thing, name))
    mesh.vertices[:] *= 2
    assert blum.closest_points(mesh, [[0, 0, 5.0]]).distance[0] == 4
    image.values[0] = 1
    assert blum.selected_voxels(image).sum() == 4


def test_meshes_images_fields_and_axes_pickle_and_copy(box):
    named = copy.copy(box)
    named.source = "box.ply"
    image = blum.Image(np.arange(8).reshape(2, 2, 2), (1, 2, 3), (4, 5, 6), [[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    field = blum.distance_field(named, resolution=8, band=0.3)
    piece = blum.medial_axis(named, resolution=16).simplify(60)
    for again in (lambda thing: pickle.loads(pickle.dumps(thing)), copy.deepcopy):
        mesh = again(named)
        assert np.array_equal(mesh.vertices, named.vertices) and mesh.source == "box.ply"
        assert again(image).grid == image.grid and np.array_equal(again(image).values, image.values)
        other = again(field)
        assert np.array_equal(other.distance, field.distance) and np.array_equal(other.site, field.site)
        for name in ("grid", "band", "sign_rule", "sign_reason", "site_ids", "source"):
            assert getattr(other, name) == getattr(field, name), name
        axis = again(piece)
        assert axis.certificate and axis.theta == 60 and axis.counts == piece.counts
        for name in ("vertices", "footprints", "sites", "edge_role", "triangle_sheet", "triangle_angle"):
            assert np.array_equal(getattr(axis, name), getattr(piece, name)), name


def test_processes_exchange_meshes_and_fields(box):
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        field = pool.submit(blum.distance_field, box, resolution=8).result(timeout=120)
    assert np.array_equal(field.distance, blum.distance_field(box, resolution=8).distance)


@pytest.mark.parametrize("threads", [1, 3])
def test_python_ends_while_daemon_threads_compute(threads):
    program = (
        "import blum, threading, time\n"
        "mesh = blum.generate('sphere', frequency=32)\n"
        "def work():\n"
        "    while True:\n"
        "        blum.distance_field(mesh, resolution=128)\n"
        f"for _ in range({threads}):\n"
        "    threading.Thread(target=work, daemon=True).start()\n"
        "time.sleep(0.5)\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_python_ends_while_a_daemon_thread_holds_a_result():
    program = (
        "import blum, threading, time\n"
        "def work():\n"
        "    field = blum.distance_field(blum.generate('box'), resolution=8)\n"
        "    held.set()\n"
        "    while field:\n"
        "        pass\n"
        "held = threading.Event()\n"
        "threading.Thread(target=work, daemon=True).start()\n"
        "held.wait()\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_the_child_of_a_fork_computes_and_ends():
    program = (
        "import blum, os, sys, threading, time\n"
        "mesh = blum.generate('sphere', frequency=32)\n"
        "threading.Thread(target=blum.distance_field, args=(mesh,), kwargs={'resolution': 200}, daemon=True).start()\n"
        "time.sleep(0.05)\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    sys.exit(0 if blum.topology(mesh).betti == (1, 0, 0) else 1)\n"
        "sys.exit(os.waitpid(child, 0)[1])\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


def test_a_solver_cannot_be_called_while_it_computes(box):
    solver = blum.FieldSolver(blum.Grid.around(box, resolution=64))
    with pytest.raises(RuntimeError, match="computing"):
        solver.compute(box, progress=lambda _fraction, _phase: solver.compute(box))
    assert solver.compute(box).distance.min() < 0


def test_facts_of_a_frame_stay_during_the_next_computation(box):
    solver = blum.FieldSolver(blum.Grid.around(box, resolution=24), reuse=True)
    frame = solver.compute(box)
    facts = (frame.seconds, frame.sign_reason, frame.grid)
    ends = threading.Event()

    def compute():
        while not ends.is_set():
            solver.compute(box)

    thread = threading.Thread(target=compute)
    thread.start()
    until = time.monotonic() + 0.5
    while time.monotonic() < until:
        assert (frame.seconds, frame.sign_reason, frame.grid) == facts
    ends.set()
    thread.join()


def test_labels_have_64_bits(box):
    for dtype, label in ((np.uint32, 2**32 - 1), (np.int64, -(2**62))):
        image = np.zeros((2, 2, 2), dtype=dtype)
        image[0] = label
        assert blum.selected_voxels(image, label=label).sum() == 4
        assert blum.distance_transforms(image, [label])[0].distance.min() < 0
    for wrong in (3, "12", None):
        with pytest.raises(TypeError, match="labels"):
            blum.distance_transforms(np.ones((2, 2, 2), int), wrong)


def test_names_of_files_may_be_any_bytes(tmp_path, box):
    broken, whole = (tmp_path / name for name in ("bad\udcff.ply", "good\udcff.ply"))
    try:
        broken.write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    except OSError:
        pytest.skip("this file system has no such names")
    with pytest.raises(blum.FormatError, match=r"bad\\xff"):
        blum.read_mesh(broken)
    with pytest.raises(OSError, match="bad"):
        blum.view(broken, output=tmp_path / "page.html")
    box.write(whole)
    blum.distance_field(whole, resolution=8).write(tmp_path / "field.npz")
    blum.medial_axis(whole, resolution=16).simplify(60).write(tmp_path / "axis.npz")
    assert blum.read_medial(tmp_path / "axis.npz").theta == 60


def test_too_large_numbers_and_ragged_lists_are_rejected_by_name(box):
    for call, name in (
        (lambda: blum.distance_field(box, padding=10**400), "padding"),
        (lambda: blum.Grid([[1, 2], [3]], 1, (2, 2, 2)), "origin"),
        (lambda: blum.distance_field(box, bounds=([[1, 2], [3]], (1, 1, 1))), "bounds"),
        (lambda: blum.distance_field(box, sign=np.array(["auto", "none"])), "sign"),
        (lambda: blum.Field(np.zeros((2, 2, 2)), None), "grid"),
        (lambda: blum.certify(None, box), "axis"),
        (lambda: blum.Image(np.zeros((2, 2, 2)), space=5), "space"),
        (lambda: blum.distance_transform(np.eye(5)), r"image\[None\]"),
    ):
        with pytest.raises((TypeError, ValueError), match=name):
            call()


def test_suspicious_input_causes_warnings(box):
    def code_of(call, *arguments, match, **options):
        with pytest.warns(blum.InputWarning, match=match) as told:
            call(*arguments, **options)
        assert all(warning.filename == __file__ for warning in told)
        return told[0].message.code

    inwards, opened = (box.vertices, box.triangles[:, ::-1]), (box.vertices, box.triangles[1:])
    assert code_of(blum.distance_field, *inwards, resolution=8, match="1 shell was reversed") == "facing"
    elsewhere = blum.Grid((9, 9, 9), 1, (2, 2, 2))
    assert code_of(blum.distance_field, box, grid=elsewhere, match="no node is inside") == "nothing-inside"
    assert code_of(blum.medial_axis, *opened, resolution=16, match="open.*as voxels") == "solid-of-voxels"
    reversal = "1 shell faces the wrong way and was reversed"
    assert code_of(blum.medial_axis, *inwards, resolution=16, match=reversal) == "reversed-shells"
    assert code_of(blum.voronoi_complex, *inwards, match=reversal) == "reversed-shells"
    assert code_of(blum.thickness_map, opened, texel=0.2, match="the mesh is open") == "open-mesh"
    assert code_of(blum.thickness, inwards, match="face into the solid") == "facing"
    far = blum.generate("sphere", radius=9)
    nothing = "nothing lies within"
    assert code_of(blum.surface_distance_map, box, far, texel=0.2, max_distance=1, match=nothing) == "nothing-found"
    plate = np.ones((1, 9, 9), dtype=bool)
    assert code_of(blum.centreline, plate, match="single layer") == "single-layer"
    again = pickle.loads(pickle.dumps(blum.InputWarning("text", "facing")))
    assert (str(again), again.code, blum.InputWarning("text").code) == ("text", "facing", "")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        blum.distance_field(box, resolution=8)
        blum.distance_field(box.vertices, box.triangles[:, ::-1], resolution=8, sign="none")
        blum.medial_axis(box, resolution=16)


def test_representations_show_the_main_facts(box):
    turned = blum.Grid((0.1 + 0.2, 0, 0), 1, (2, 2, 2), [[-1, 0, 0], [0, -1, 0], [0, 0, 1]])
    assert repr(turned) == (
        "Grid(origin=(0.3, 0, 0), spacing=(1, 1, 1), size=(2, 2, 2), "
        "direction=[[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]])"
    )
    mesh = "Mesh(8 vertices, 12 triangles)"
    assert repr(blum.Sites(box)) == "Sites(8 vertices, 18 edges, 12 faces)"
    assert repr(blum.WindingNumber(box)) == f"WindingNumber({mesh})"
    assert repr(blum.ClosestPointQuery(box)) == f"ClosestPointQuery({mesh}, sign_rule='normals')"
    assert repr(blum.FieldSolver(turned, reuse=True)) == f"FieldSolver({turned!r}, reuse=True)"
