"""Proves that the tool reads a pipe once: the answer is that of the file, or a clear error, and never a wait."""

import gzip
import os
import signal
import struct
import subprocess
import threading

import numpy as np
import pytest
from tool import BLUM, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

SECONDS = 20  # a second opening of a pipe would wait for ever
VALUES = (np.indices((9, 10, 11)).sum(axis=0) % 3 == 0).astype(np.uint8)


def nrrd(encoding, data):
    header = f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: 11 10 9\nspacings: 1 2 3\nencoding: {encoding}\n\n"
    return header.encode() + data


def nifti():
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, 11, 10, 9, 1, 1, 1, 1)
    struct.pack_into("<hh", header, 70, 2, 8)
    struct.pack_into("<4f", header, 76, 1, 1, 2, 3)
    struct.pack_into("<f", header, 108, 352)
    header[344:348] = b"n+1\0"
    return bytes(header) + VALUES.tobytes()


def npy(folder):
    np.save(folder / "values.npy", VALUES)
    return (folder / "values.npy").read_bytes()


IMAGES = {
    "raw nrrd": (".nrrd", "NRRD", lambda _: nrrd("raw", VALUES.tobytes())),
    "gzip nrrd": (".nrrd", "NRRD", lambda _: nrrd("gzip", gzip.compress(VALUES.tobytes()))),
    "text nrrd": (".nrrd", "NRRD", lambda _: nrrd("text", " ".join(map(str, VALUES.ravel())).encode())),
    "nii": (".nii", "NIfTI", lambda _: nifti()),
    "nii.gz": (".nii.gz", "NIfTI", lambda _: gzip.compress(nifti())),
    "npy": (".npy", "NPY", npy),
}


def call(*arguments, data=None, status=0):
    done = subprocess.run([BLUM, *map(str, arguments)], input=data, capture_output=True, timeout=SECONDS, check=False)
    assert done.returncode == status, done.stderr
    return (done.stderr if status else done.stdout).decode()


def through(path, data, *arguments, status=0):
    """Answer to a command that reads a pipe into which a thread writes `data` once."""
    os.mkfifo(path)

    def write():
        with open(path, "wb") as pipe:
            pipe.write(data)

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    answer = call(*arguments, status=status)
    writer.join(SECONDS)
    assert not writer.is_alive()
    path.unlink()
    return answer


def without_names(text):
    """The lines of an answer without the first, which names the file, and without times."""
    return [line for line in text.splitlines()[1:] if "time" not in line and " s" not in line and "wrote" not in line]


@pytest.mark.parametrize("kind", IMAGES)
def test_images_from_pipes_are_those_of_the_file(kind, tmp_path):
    end, name, data_of = IMAGES[kind]
    data = data_of(tmp_path)
    file, link = tmp_path / f"image{end}", tmp_path / f"link{end}"
    file.write_bytes(data)
    link.symlink_to("/dev/stdin")
    wanted = call("info", file)
    assert f": {name} image of uint8" in wanted.splitlines()[0]
    for path in (tmp_path / f"pipe{end}", tmp_path / "pipe"):
        assert without_names(found := through(path, data, "info", path)) == without_names(wanted)
        assert f": {name} image of uint8" in found.splitlines()[0]
    for path in (link, "/dev/stdin"):
        assert without_names(found := call("info", path, data=data)) == without_names(wanted)
        assert f": {name} image of uint8" in found.splitlines()[0]
    call("field", file, "-o", tmp_path / "file.npz")
    for path in (tmp_path / f"pipe{end}", tmp_path / "pipe"):
        through(path, data, "field", path, "-o", tmp_path / "pipe.npz")
        with np.load(tmp_path / "file.npz") as one, np.load(tmp_path / "pipe.npz") as two:
            assert np.array_equal(one["distance"], two["distance"]) and np.array_equal(one["site"], two["site"])
    path = tmp_path / "pipe"
    through(path, data, "view", path, "-o", tmp_path / "page.html")
    through(path, data, "medial", path, "-o", tmp_path / "axis.vtp", "--label", 1)


def made(folder, name):
    """Bytes of a small field, axis, map, diagram or centreline."""
    box, image, file = folder / "box.ply", folder / "tube.nrrd", folder / name
    run("make", "box", "-o", box)
    kind = name.partition(".")[0]
    if kind == "centreline":
        run("make", "tube_image", "--nodes", 2, "--pitch", 20, "-o", image)
        run("centreline", image, "-o", file)
    elif kind == "extended":
        run("medial", box, "--resolution", 24, "-o", folder / "axis.vtp", "--extend", file)
    elif kind == "map":
        run("surface-map", box, box, "-o", file, "--texel", 0.5)
    else:
        run(kind, box, "-o", file, "--resolution", 12)
    return file


#: Results whose first bytes show what they are, so that any name will do.
SEEN_BY_CONTENT = [
    "field.nrrd",
    "field.npz",
    "field.vti",
    "medial.vtp",
    "medial.npz",
    "voronoi.vtp",
    "voronoi.npz",
    "centreline.vtp",
    "centreline.npz",
    "extended.vtp",
    "extended.npz",
]
SEEN_BY_NAME = ["medial.ply", "medial.ma", "medial.obj", "voronoi.ply", "centreline.ply", "extended.ply"]


def info_through_a_pipe(file):
    """The lines of `info` for a file that comes from a pipe."""
    lines = without_names(call("info", file))
    if file.name == "field.nrrd":  # the sites are in another file, which the pipe does not have beside it
        lines = [line if not line.startswith("sites") else "sites     none in the file" for line in lines]
    return lines


@pytest.mark.parametrize("name", SEEN_BY_CONTENT + SEEN_BY_NAME)
def test_fields_axes_and_diagrams_are_read_once(name, tmp_path):
    file = made(tmp_path, name)
    wanted = info_through_a_pipe(file)
    pipe = tmp_path / f"pipe{file.suffix}"
    assert without_names(through(pipe, file.read_bytes(), "info", pipe)) == wanted
    through(pipe, file.read_bytes(), "view", pipe, "-o", tmp_path / "page.html")
    if name.startswith("field"):
        through(pipe, file.read_bytes(), "surface", pipe, "--level", 0, "-o", tmp_path / "level.ply")
    if name.startswith("medial") and file.suffix != ".obj":
        through(pipe, file.read_bytes(), "reconstruct", pipe, "-o", tmp_path / "solid.ply", "--resolution", 12)
        box = tmp_path / "box.ply"
        files = call("verify", box, file, status=0) if file.suffix != ".ma" else ""
        if files:
            through(pipe, file.read_bytes(), "verify", box, pipe)


@pytest.mark.parametrize("name", SEEN_BY_CONTENT)
def test_results_of_any_name_are_found_by_their_content(name, tmp_path):
    file, pipe = made(tmp_path, name), tmp_path / "pipe"
    wanted = info_through_a_pipe(file)
    data = file.read_bytes()
    assert without_names(through(pipe, data, "info", pipe)) == wanted
    assert without_names(call("info", "/dev/stdin", data=data)) == wanted
    other = tmp_path / "other.name"
    other.write_bytes(data)
    assert without_names(call("info", other)) == wanted
    through(pipe, data, "view", pipe, "-o", tmp_path / "page.html")
    if name.startswith("field"):
        through(pipe, data, "surface", pipe, "--level", 0, "-o", tmp_path / "level.ply")
    for start in (b"PK\x03\x04", b'<VTKFile type="UnstructuredGrid">'):
        call("info", "/dev/stdin", data=start + b" and no more", status=1)


def test_maps_are_shown_from_a_pipe(tmp_path):
    file = made(tmp_path, "map.npz")
    pipe = tmp_path / "pipe.npz"
    through(pipe, file.read_bytes(), "view", pipe, "-o", tmp_path / "page.html")


def test_binary_stl_of_any_name_is_found_by_its_size(tmp_path):
    run("make", "box", "-o", tmp_path / "box.stl")
    data = (tmp_path / "box.stl").read_bytes()
    wanted = without_names(call("info", tmp_path / "box.stl"))
    assert without_names(call("info", "/dev/stdin", data=data)) == wanted
    pipe = tmp_path / "pipe"
    assert without_names(through(pipe, data, "info", pipe)) == wanted
    assert "no known format" in call("info", "/dev/stdin", data=data + b"\0", status=1)
    assert "no known format" in call("info", "/dev/stdin", data=data[:-1], status=1)


def test_points_of_any_name_are_found_by_their_content(tmp_path):
    box = tmp_path / "box.ply"
    run("make", "box", "-o", box)
    points = np.random.default_rng(46).normal(size=(900, 3))
    np.save(tmp_path / "p.npy", points)
    np.savez(tmp_path / "p.npz", points=points)
    np.savetxt(tmp_path / "p.csv", points, delimiter=",", header="x,y,z", comments="")
    np.savetxt(tmp_path / "p.xyz", points)
    run("sample", box, "-n", 40, "-o", tmp_path / "p.ply")
    for end in ("obj", "off", "stl"):
        run("make", "box", "-o", tmp_path / f"p.{end}")
    for end in ("npy", "npz", "csv", "xyz", "ply", "obj", "off", "stl"):
        file = tmp_path / f"p.{end}"
        call("query", box, file, "-o", tmp_path / "file.npz")
        call("query", box, "/dev/stdin", "-o", tmp_path / "pipe.npz", data=file.read_bytes())
        with np.load(tmp_path / "file.npz") as one, np.load(tmp_path / "pipe.npz") as two:
            assert np.array_equal(one["points"], two["points"]) and len(one["points"]) > 7, end
    for data in (b"", b"a sonnet\nof words\n", b"1 2\n3 4\n", b"\0\0\0\0"):
        error = call("query", box, "/dev/stdin", "-o", tmp_path / "pipe.npz", data=data, status=1)
        assert "/dev/stdin points.csv" in error


def test_a_dash_is_explained(tmp_path):
    run("make", "box", "-o", tmp_path / "box.ply")
    box, data = tmp_path / "box.ply", (tmp_path / "box.ply").read_bytes()
    commands = [
        ["info", "-"],
        ["field", "-", "-o", tmp_path / "f.npz"],
        ["view", "-", "-o", tmp_path / "v.html"],
        ["query", "-", box, "-o", tmp_path / "q.npz"],
        ["query", box, "-", "-o", tmp_path / "q.npz"],
        ["query", box, "-", box, "-o", tmp_path / "q.npz"],
        ["medial", "-", "-o", tmp_path / "a.vtp"],
        ["verify", "-", box],
        ["reconstruct", "-", "-o", tmp_path / "r.ply"],
    ]
    for command in commands:
        done = subprocess.run([BLUM, *map(str, command)], input=data, capture_output=True, timeout=SECONDS, check=False)
        assert done.returncode in (1, 2) and b"/dev/stdin" in done.stderr, (command, done.stderr)


def test_a_pipe_that_is_given_twice_is_refused(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)  # nobody writes: the tool must not open it
    for command in (
        ["query", pipe, pipe, "-o", tmp_path / "q.npz"],
        ["hausdorff", pipe, pipe],
        ["view", pipe, pipe, "-o", tmp_path / "v.html"],
        ["view", pipe, pipe],
    ):
        assert "is a pipe and is given twice" in call(*command, status=2)


def test_files_of_one_content_are_refused_as_pipes(tmp_path):
    header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: pipe.nhdr\n\n"
    pipe = tmp_path / "pipe.nhdr"
    assert "one of several files" in through(pipe, header.encode(), "info", pipe, status=1)


@pytest.mark.parametrize(
    "command",
    [
        ["info"],
        ["info", "--json", "-"],
        ["field", "-o", "f.npz"],
        ["view", "-o", "v.html"],
        ["medial", "-o", "a.vtp"],
        ["voronoi", "-o", "d.vtp"],
        ["sample", "-n", "9", "-o", "s.ply"],
        ["centreline", "-o", "c.json"],
    ],
)
def test_a_signal_ends_the_wait_for_a_writer(command, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    arguments = [BLUM, command[0], "pipe", *command[1:]]
    with subprocess.Popen(arguments, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            with pytest.raises(subprocess.TimeoutExpired):
                process.wait(0.5)
            process.terminate()
            assert process.wait(SECONDS) == -signal.SIGTERM
        finally:
            process.kill()
