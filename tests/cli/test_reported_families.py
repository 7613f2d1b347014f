"""Proves, on families of inputs, what the tool does with pipes, level surfaces, and its own files in `blum view`."""

import os
import struct
import subprocess
import threading
import time

import numpy as np
import pytest
from tool import BLUM, run, run_json

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")


# Pipes: the answer of a pipe is that of the file.


def wavy(count):
    """Vertices and triangles of an open surface."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(count), np.arange(count)))
    corner = np.array([i * count + j for i in range(count - 1) for j in range(count - 1)])
    triangles = np.r_[np.c_[corner, corner + 1, corner + count + 1], np.c_[corner, corner + count + 1, corner + count]]
    return np.c_[x, y, np.sin(x * 0.3) + 0.2 * np.cos(y)].astype(float), triangles.astype(np.int32)


def text(rows, form):
    return "".join(form % tuple(row) for row in rows)


def obj(v, t):
    return ("# a comment\n" + text(v, "v %.7g %.7g %.7g\n") + text(t + 1, "f %d %d %d\n")).encode()


def off(v, t):
    return (f"OFF\n{len(v)} {len(t)} 0\n" + text(v, "%.7g %.7g %.7g\n") + text(t, "3 %d %d %d\n")).encode()


def ply_header(kind, v, t):
    return (
        f"ply\nformat {kind} 1.0\nelement vertex {len(v)}\n"
        + "".join(f"property double {c}\n" for c in "xyz")
        + f"element face {len(t)}\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def ply_text(v, t):
    return ply_header("ascii", v, t) + (text(v, "%.7g %.7g %.7g\n") + text(t, "3 %d %d %d\n")).encode()


def ply_binary(v, t, order="<"):
    faces = np.zeros(len(t), dtype=[("count", "u1"), ("corners", order + "i4", 3)])
    faces["count"], faces["corners"] = 3, t
    kind = "binary_little_endian" if order == "<" else "binary_big_endian"
    return ply_header(kind, v, t) + v.astype(order + "f8").tobytes() + faces.tobytes()


def stl_binary(v, t):
    rows = np.zeros(len(t), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    rows["corners"] = v[t]
    return b"solid in name only".ljust(80) + struct.pack("<I", len(t)) + rows.tobytes()


def stl_text(v, t):
    facet = "facet normal 0 0 1\nouter loop\n" + 3 * "vertex %.7g %.7g %.7g\n" + "endloop\nendfacet\n"
    return ("solid s\n" + text(v[t].reshape(-1, 9), facet) + "endsolid s\n").encode()


WRITERS = {
    "obj": (obj, ".obj"),
    "off": (off, ".off"),
    "ply text": (ply_text, ".ply"),
    "ply little": (ply_binary, ".ply"),
    "ply big": (lambda v, t: ply_binary(v, t, ">"), ".ply"),
    "stl binary": (stl_binary, ".stl"),
    "stl text": (stl_text, ".stl"),
}


def write_slowly(path, data):
    with open(path, "wb", buffering=0) as pipe:
        for k in range(60):
            pipe.write(data[k : k + 1])
            time.sleep(0.001)
        for k in range(60, len(data), 4099):
            pipe.write(data[k : k + 4099])


def through_fifo(folder, name, data):
    path = folder / name
    os.mkfifo(path)
    writer = threading.Thread(target=write_slowly, args=(path, data), daemon=True)
    writer.start()
    found = run_json("info", path)
    writer.join(5)
    path.unlink()
    return found


def through_shell(line):
    done = subprocess.run(["bash", "-c", line], capture_output=True, timeout=30, check=True)
    return done.stdout.decode()


def facts(report):
    drop = ("path", "phases", "time", "seconds", "peak_memory_bytes")
    if isinstance(report, dict):
        return {key: facts(value) for key, value in report.items() if key not in drop}
    return report


@pytest.mark.parametrize("size", [9, 90], ids=["small", "above 64 KiB"])
@pytest.mark.parametrize("kind", WRITERS)
def test_meshes_from_pipes_are_those_of_the_file(kind, size, tmp_path):
    write, end = WRITERS[kind]
    data = write(*wavy(size))
    assert (len(data) > 65536) == (size == 90)
    file = tmp_path / f"mesh{end}"
    file.write_bytes(data)
    wanted = facts(run_json("info", file))
    assert facts(through_fifo(tmp_path, f"pipe{end}", data)) == wanted
    link = tmp_path / f"link{end}"
    link.symlink_to("/dev/stdin")
    run("make", "box", "-o", tmp_path / "box.ply")
    run("query", tmp_path / "box.ply", file, "-o", tmp_path / "file.npz", "--sign", "none")
    through_shell(f"cat '{file}' | '{BLUM}' query '{tmp_path}/box.ply' '{link}' -o '{tmp_path}/pipe.npz' --sign none")
    with np.load(tmp_path / "file.npz") as one, np.load(tmp_path / "pipe.npz") as two:
        assert np.array_equal(one["points"], two["points"]) and np.array_equal(one["distance"], two["distance"])
    if kind != "stl text":
        assert facts(through_fifo(tmp_path, "pipe", data)) == wanted
        assert through_shell(f"cat '{file}' | '{BLUM}' info /dev/stdin | tail -n +2 | grep -v time") == through_shell(
            f"'{BLUM}' info '{file}' | tail -n +2 | grep -v time"
        )


@pytest.mark.parametrize("end", [".csv", ".xyz", ".txt"])
@pytest.mark.parametrize("count", [30, 9000])
def test_points_from_pipes_are_those_of_the_file(end, count, tmp_path):
    points = np.random.default_rng(46).normal(size=(count, 3))
    form = "%.9g,%.9g,%.9g\n" if end == ".csv" else "%.9g %.9g %.9g\n"
    file, link = tmp_path / f"points{end}", tmp_path / f"link{end}"
    file.write_text(("x,y,z\n" if end == ".csv" else "") + text(points, form))
    link.symlink_to("/dev/stdin")
    run("make", "box", "-o", tmp_path / "box.ply")
    through_shell(f"cat '{file}' | '{BLUM}' query '{tmp_path}/box.ply' '{link}' -o '{tmp_path}/pipe.npz'")
    with np.load(tmp_path / "pipe.npz") as found:
        assert np.allclose(found["points"], points, atol=1e-8)


# test_pipes.py covers images and other files.


# Level surfaces: a line states the error, and warnings name surfaces that are cut off or too thin.


def level(folder, shape, options, value, warns):
    run("make", *shape, "-o", folder / "shape.ply")
    run("field", folder / "shape.ply", "-o", folder / "field.npz", *options, warns=warns)
    done = subprocess.run(
        [BLUM, "surface", folder / "field.npz", "-o", folder / "level.ply", f"--level={value}"],
        capture_output=True,
        timeout=30,
        check=False,
    )
    return done.returncode, done.stdout.decode(), done.stderr.decode()


BALL = ("sphere", "--frequency", 8)
HALF = ("--resolution", 24, "--bounds=-2,-2,0,2,2,2")
TOP = ("--resolution", 24, "--bounds=-2,-2,-2,2,2,0.5")
BAND = ("--resolution", 40, "--band", 0.2)


def plate(thickness):
    return ("box", "--size-x", 4, "--size-y", 3, "--size-z", thickness)


LEVELS = {
    "surface": (BALL, ("--resolution", 40), 0, "", 0),
    "outside": (BALL, ("--resolution", 40), 0.15, "", 0),
    "inside": (BALL, ("--resolution", 40), -0.5, "", 0),
    "bulges out of the grid": (BALL, ("--resolution", 40), 0.25, "cut off", 0),
    "only corners of the grid": (BALL, ("--resolution", 40), 1, "cut off", 0),
    "beyond the grid": (BALL, ("--resolution", 40), 5, "no surface", 1),
    "deeper than the shape": (BALL, ("--resolution", 40), -1.1, "no surface", 1),
    "half a ball": (BALL, HALF, 0, "cut off", 0),
    "top cut off": (BALL, TOP, 0, "cut off", 0),
    "top of a level cut off": (BALL, TOP, 0.3, "cut off", 0),
    "in the band": (BALL, BAND, 0.19, "", 0),
    "at the end of the band": (BALL, BAND, 0.2, "outside it", 0),
    "beyond the band": (BALL, BAND, 0.3, "outside it", 1),
    "below the band": (BALL, BAND, -0.3, "outside it", 1),
    "thick plate": (plate(0.4), ("--spacing", 0.1), 0, "", 0),
    "plate of two steps": (plate(0.2), ("--spacing", 0.1), 0.05, "", 0),
    "inside a plate of two steps": (plate(0.2), ("--spacing", 0.1), -0.05, "one node thick", 0),
    "plate of one step": (plate(0.1), ("--spacing", 0.1), 0, "one node thick", 0),
    "plate between nodes": (plate(0.05), ("--spacing", 0.1), 0, "no surface", 1),
    "unsigned": (BALL, ("--resolution", 24, "--sign", "none"), 0, "unsigned", 1),
    "unsigned, below": (BALL, ("--resolution", 24, "--sign", "none"), -0.1, "unsigned", 1),
}


@pytest.mark.parametrize("name", LEVELS)
def test_level_surfaces_state_their_error_and_their_gaps(name, tmp_path):
    shape, options, value, word, status = LEVELS[name]
    code, out, err = level(tmp_path, shape, options, value, name == "plate between nodes")
    assert code == status
    assert word in err if word else err == ""
    if status == 0:
        assert "half a cell's diagonal" in out


# Every file that the tool writes is shown as what it is, or refused with a reason.


def test_view_names_what_files_contain(tmp_path):
    run("make", "torus", "--ring-segments", 24, "--tube-segments", 12, "-o", tmp_path / "torus.ply")
    run("make", "box", "-o", tmp_path / "box.ply")
    run("make", "tube_image", "--nodes", 2, "--pitch", 20, "-o", tmp_path / "tubes.nrrd")
    torus, box, tubes = (tmp_path / name for name in ("torus.ply", "box.ply", "tubes.nrrd"))
    commands = {
        "medial axis": (["medial", box, "--resolution", 16], ["vtp", "ply", "ma", "npz"]),
        "field": (["field", torus, "--resolution", 16], ["nrrd", "npz", "vti"]),
        "Voronoi diagram": (["voronoi", box, "--resolution", 4], ["vtp", "npz", "ply"]),
        "walls": (["voronoi", box, "--resolution", 4, "--walls"], ["vtp", "npz", "ply"]),
        "centrelines": (["centreline", tubes], ["vtp", "npz", "ply"]),
        "surface map": (["surface-map", torus, box, "--texel", 0.2], ["npz", "vtp"]),
    }
    commands["points"] = (["sample", box, "-n", 9], ["vtp"])
    shown = {"torus.ply": "mesh", "tubes.nrrd": "image"}
    for end in ("vtp", "npz"):
        run("medial", box, "--resolution", 16, "-o", tmp_path / "axis.vtp", "--extend", tmp_path / f"shell.{end}")
        shown[f"shell.{end}"] = "extended medial axis"
    for k, (word, (command, ends)) in enumerate(commands.items()):
        for end in ends:
            run(*command, "-o", tmp_path / f"file{k}.{end}")
            shown[f"file{k}.{end}"] = word
    for name, word in shown.items():
        out, _ = run("view", tmp_path / name, "-o", tmp_path / "page.html")
        label = out[out.rindex("(") :].lower()
        assert word.lower() in label or (word == "centrelines" and "centreline" in label), f"{name}: {out}"
        assert (tmp_path / "page.html").stat().st_size > 1000
