"""Proves that wrong arguments raise the exception that Python users expect, with the argument's name, and never crash.

Ctrl-C, progress callbacks and cancelled calls leave everything usable."""

import os
import signal
import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

blum = pytest.importorskip("blum")

VERTICES = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
TRIANGLES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]


@pytest.mark.parametrize(
    ("vertices", "triangles", "error", "text"),
    [
        ([[0, 0], [1, 1]], TRIANGLES, ValueError, "vertices has the shape"),
        (VERTICES, [[0, 1]], ValueError, "triangles has the shape"),
        (VERTICES, [[0, 1, 4]], ValueError, r"triangles\[0, 2\] is 4"),
        (VERTICES, [[0, 1, -1]], ValueError, r"triangles\[0, 2\] is -1"),
        (VERTICES, [[0.0, 1.0, 2.0]], TypeError, "triangles must hold integers"),
        (VERTICES, [[0, 1, 2**40]], ValueError, r"triangles\[0, 2\]"),
        ([["a", "b", "c"]], TRIANGLES, TypeError, "vertices must hold real numbers"),
        (np.array(VERTICES, dtype=complex), TRIANGLES, TypeError, "vertices must hold real numbers"),
        ([[np.nan, 0, 0], *VERTICES[1:]], TRIANGLES, ValueError, "vertex 0"),
        ([[np.inf, 0, 0], *VERTICES[1:]], TRIANGLES, ValueError, "vertex 0"),
        (np.zeros((0, 3)), np.zeros((0, 3), dtype=int), ValueError, "no"),
        (VERTICES, np.zeros((0, 3), dtype=int), ValueError, "no"),
        (object(), None, TypeError, "mesh is a object"),
        (None, None, TypeError, "mesh is a NoneType"),
        ("missing.ply", None, FileNotFoundError, "missing.ply"),
    ],
)
def test_wrong_meshes(vertices, triangles, error, text):
    for call in (blum.distance_field, blum.topology, blum.medial_axis, blum.ClosestPointQuery, blum.WindingNumber):
        with pytest.raises(error, match=text.replace("mesh is", "(mesh|shape) is")):
            call(vertices, triangles)


@pytest.mark.parametrize(
    ("options", "error", "text"),
    [
        ({"resolution": 1}, ValueError, "resolution"),
        ({"resolution": 2.5}, TypeError, "resolution"),
        ({"resolution": 10**12}, ValueError, "resolution"),
        ({"resolution": True}, TypeError, "resolution"),
        ({"spacing": 0}, ValueError, "spacing"),
        ({"spacing": float("nan")}, ValueError, "spacing"),
        ({"spacing": 1e-9}, (ValueError, MemoryError), "."),
        ({"padding": -1}, ValueError, "padding"),
        ({"sign": "maybe"}, ValueError, "sign is 'maybe'"),
        ({"site_ids": "voxels"}, ValueError, "site_ids"),
        ({"band": -1.0}, ValueError, "band"),
        ({"sites": "no"}, TypeError, "sites must be True or False"),
        ({"sites": 0}, TypeError, "sites must be True or False"),
        ({"band": "wide"}, TypeError, "band"),
        ({"bounds": (0, 1)}, (TypeError, ValueError), "bounds"),
        ({"grid": "fine"}, TypeError, "grid"),
        ({"threads": -1}, ValueError, "threads"),
        ({"threads": 10**6}, ValueError, "threads"),
        ({"progress": 3}, TypeError, "progress"),
    ],
)
def test_wrong_options(options, error, text):
    with pytest.raises(error, match=text):
        blum.distance_field(VERTICES, TRIANGLES, **options)


def test_wrong_points_images_and_axes(tmp_path):
    with pytest.raises(ValueError, match="points has the shape"):
        blum.closest_points((VERTICES, TRIANGLES), [1, 2])
    with pytest.raises(ValueError, match="1"):
        blum.closest_points((VERTICES, TRIANGLES), [[0, 0, 0], [0, np.nan, 0]])
    for values, error, text in (
        (np.zeros((2, 2, 2, 2)), ValueError, "4 axes"),
        (np.zeros((2, 2, 2), dtype=complex), TypeError, "image must hold"),
        (np.array([["a"]]), TypeError, "image must hold"),
        (np.zeros((0, 2, 2)), ValueError, "."),
        (np.zeros((2, 2, 2)), ValueError, "no voxel"),
    ):
        for call in (blum.distance_transform, lambda image: blum.medial_axis(blum.Image(image))):
            with pytest.raises(error, match=text):
                call(values)
    ball = blum.generate("ball_image", size=12)
    with pytest.raises(ValueError, match="exclude"):
        blum.distance_transform(ball, label=1, threshold=1)
    with pytest.raises(ValueError, match="spacing"):
        blum.distance_transform(ball, spacing=2)
    with pytest.raises(ValueError, match="spacing"):
        blum.distance_transform(np.ones((3, 3, 3)), spacing=(1, -1, 1))
    with pytest.raises(ValueError, match="theta"):
        blum.medial_axis(ball).simplify(181)
    with pytest.raises(ValueError, match=r"edges\[0, 1\] is 7"):
        blum.homology(3, edges=[[0, 7]])
    with pytest.raises(ValueError, match="radius"):
        blum.MedialComplex(VERTICES, radius=[1, 2])
    with pytest.raises(ValueError, match="no shape"):
        blum.generate("teapot")
    with pytest.raises(ValueError, match="frequency"):
        blum.generate("sphere", frequency=-1)
    broken = tmp_path / "broken.ply"
    broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 5\n")
    with pytest.raises(blum.FormatError, match=r"broken\.ply"):
        blum.read_mesh(broken)
    with pytest.raises(OSError, match=r"broken\.ply"):
        blum.topology(broken)


NUMBERS = st.one_of(
    arrays(
        st.sampled_from([np.float64, np.float32, np.int64, np.bool_, np.complex64, np.int8]),
        array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=5),
    ),
    st.none(),
    st.text(max_size=3),
    st.floats(),
    st.lists(st.integers(-3, 9), max_size=4),
)


@settings(max_examples=300, deadline=None)
@given(NUMBERS, NUMBERS)
def test_anything_at_all_gives_a_result_or_a_clear_error(first, second):
    for call in (
        lambda: blum.distance_field(first, second, resolution=5),
        lambda: blum.closest_points((first, second), first),
        lambda: blum.distance_transform(first, band=second),
        lambda: blum.homology(4, second, first),
        lambda: blum.medial_axis(first, second, resolution=8),
        lambda: blum.Grid(first, second, first),
        lambda: blum.weld((first, second)),
    ):
        try:
            call()
        except (ValueError, TypeError, OSError) as error:
            assert str(error)


def slow_call(progress=False):
    mesh = blum.generate("sphere", frequency=60)
    return blum.reference.nearest(mesh, np.random.default_rng(1).uniform(-2, 2, (100000, 3)), progress=progress)


def winding_numbers():
    mesh = blum.generate("sphere", frequency=100)
    return blum.reference.winding_number(mesh, np.random.default_rng(1).uniform(-2, 2, (10000, 3)))


def extrusion_of_many_holes():
    square = np.array([[-0.25, -0.25], [0.25, -0.25], [0.25, 0.25], [-0.25, 0.25]])
    holes = [square + np.array([x, y]) for x in range(70) for y in range(70)]
    return blum.extrusion([[-1, -1], [70, -1], [70, 70], [-1, 70]], holes)


@pytest.mark.parametrize("slow_call", [slow_call, winding_numbers, extrusion_of_many_holes], ids=lambda f: f.__name__)
def test_ctrl_c_cancels_soon_and_leaves_everything_usable(slow_call):
    # Background jobs of a shell ignore Ctrl-C, and Python keeps this setting.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def interrupt():
        time.sleep(0.5)
        interrupted.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    interrupted = []
    threading.Thread(target=interrupt).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            slow_call()
    finally:
        signal.signal(signal.SIGINT, before)
    assert time.perf_counter() - interrupted[0] < 0.5
    assert blum.distance_field(VERTICES, TRIANGLES, resolution=8).distance.shape


def test_an_exception_of_a_progress_callback_ends_the_call():
    class Enough(Exception):
        pass

    def stop(fraction, phase):
        raise Enough(phase)

    start = time.perf_counter()
    with pytest.raises(Enough):
        slow_call(stop)
    assert time.perf_counter() - start < 2


def test_progress_rises_and_names_phases():
    told = []
    axis = blum.medial_axis(
        blum.generate("torus"), resolution=128, progress=lambda fraction, phase: told.append((fraction, phase))
    )
    assert axis.report.topology_matches and all(0 <= fraction <= 1 and phase for fraction, phase in told)
    blum.medial_axis(blum.generate("torus"), resolution=48, progress=True)


def test_other_threads_run_while_a_call_works():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    blum.reference.nearest(blum.generate("sphere", frequency=30), np.zeros((300, 3)), threads=1)
    done.set()
    thread.join()
    assert len(ticks) > 5, "the interpreter's lock must not be held"
