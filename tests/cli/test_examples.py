"""Proves that each example in the tool's help runs, and that `blum` commands in documents use existing options."""

import functools
import pathlib
import re
import shlex
import shutil
import subprocess

import numpy as np
import pytest
from tool import BLUM, run

pytestmark = pytest.mark.skipif(not BLUM, reason="BLUM_CLI does not name the tool")

PROJECT = pathlib.Path(__file__).resolve().parents[2]
def serves(line: str) -> bool:
    """True for examples that serve a page until Ctrl-C; test_view.py tests serving."""
    return line.startswith("blum view") and " -o " not in line


@functools.cache
def help_of(*verb: str) -> str:
    return run(*verb, "--help")[0]


@functools.cache
def verbs() -> list[tuple[str, ...]]:
    """All commands: (), ("field",), ..., ("proximity", "separation"), ..."""
    found: list[tuple[str, ...]] = [()]
    for verb in found:
        listed = re.search(r"\nSubcommands:\n(.*?)\n\n", help_of(*verb), re.DOTALL)
        found += [(*verb, name) for name in re.findall(r"^  ([a-z][\w-]*) ", listed[1] if listed else "", re.MULTILINE)]
    return found


def examples(verb: tuple[str, ...]) -> list[str]:
    """Commands of the examples in a help text. Two spaces or more separate a command from its comment."""
    text = help_of(*verb).partition("Examples:\n")[2].partition("\n\n")[0]
    return [re.split(r"\s{2,}|$", line.strip())[0] for line in text.splitlines() if line.strip().startswith("blum ")]


def make_images(folder):
    """NIfTI and NRRD images of tubes and balls: labels 1 and 3; values of 300 and more; labels 2 and 7 to 9."""
    nibabel = pytest.importorskip("nibabel")
    x, y, z = np.mgrid[0:24, 0:24, 0:48]
    tube = ((x - 12) ** 2 + (y - 12) ** 2 < 36) & (z > 3) & (z < 44)
    ball = (x - 3) ** 2 + (y - 3) ** 2 + (z - 24) ** 2 < 6
    labels = (tube + 3 * ball).astype(np.uint8)
    nibabel.save(nibabel.Nifti1Image(labels, np.eye(4)), folder / "scan.nii.gz")
    shutil.copy(folder / "scan.nii.gz", folder / "vessels.nii.gz")
    np.save(folder / "scan.npy", 400 * (labels > 0).astype(np.int16))
    cells = np.select([ball, tube & (z < 16), tube & (z < 30), tube], [2, 7, 8, 9])
    np.save(folder / "cells.npy", cells.astype(np.uint8))
    nrrd = pytest.importorskip("nrrd")
    for name, source in (("scan.nrrd", "scan.npy"), ("ct.nrrd", "scan.npy"), ("cells.nrrd", "cells.npy")):
        nrrd.write(str(folder / name), np.load(folder / source))


def make_points(folder):
    """Points near a part, in each format that examples name."""
    points = np.random.default_rng(5).uniform(-1, 1, (200, 3))
    np.save(folder / "points.npy", points)
    np.savetxt(folder / "points.csv", points, delimiter=",", header="x,y,z", comments="")
    np.savetxt(folder / "scan.xyz", points)


def make_queries(folder):
    """A vertex that falls through a triangle, and an edge that falls through another edge; both answers are 1."""
    triangle = [(-1, -1, 0), (1, -1, 0), (0, 1, 0)]
    flat, high = [(-1, 0, 0), (1, 0, 0)], [(0, -1, 1), (0, 1, 1)]
    low = [(0, -1, -1), (0, 1, -1)]
    vertex_face = [(0, 0, 1), *triangle, (0, 0, -1), *triangle]
    edge_edge = [*flat, *high, *flat, *low]
    for name, points in (("unit-tests/vertex-face/data_0_0.csv", vertex_face), ("queries.csv", edge_edge)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("".join(f"{x},1,{y},1,{z},1,1\n" for x, y, z in points))


def make_path(folder):
    """A body and an obstacle, a path around it, and the path of another program."""
    run("make", "box", "-o", folder / "robot.ply", "--size-x", 0.2, "--size-y", 0.2, "--size-z", 0.2)
    run("make", "box", "-o", folder / "walls.ply")
    poses = ["-2,0,0,1,0,0,0", "-2,2,0,1,0,0,0", "2,2,0,1,0,0,0", "2,0,0,1,0,0,0"]
    run("plan", folder / "robot.ply", folder / "walls.ply", "--start=" + poses[0], "--goal", poses[-1],
        "-o", folder / "path.json")  # fmt: skip
    (folder / "path.csv").write_text("\n".join(poses))


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """A folder with small versions of the files that examples read."""
    folder = tmp_path_factory.mktemp("examples")
    size = ("--size-x", 1, "--size-y", 0.5, "--size-z", 0.4)
    boxes = ("part.ply", "part.stl", "part.obj", "part-off.obj", "design.stl", "housing.stl", "arm.ply", "a.ply")
    for name in boxes:
        run("make", "box", "-o", folder / name, *size)
    (folder / "part-off.obj").rename(folder / "simplified.obj")
    spheres = ("b.ply", "c.ply", "table.ply", "other.ply", "scan.ply", "scan.stl", "bunny.obj", "start.ply", "end.ply")
    for name in spheres:
        run("make", "sphere", "-o", folder / name, "--radius", 0.5, "--frequency", 4)
    frames = ("cloth.ply", "cloth.obj", "cloth1.ply", "cloth2.ply", "ball1.ply", "plate.ply", "ball2.ply", "f1.ply")
    for name in frames:
        run("make", "sphere", "-o", folder / name, "--frequency", 2)
    run("make", "linked_tori", "-o", folder / "parts.ply", "--ring-segments", 16, "--tube-segments", 8)
    run("make", "torus_knot", "-o", folder / "knot.ply")
    make_points(folder)
    make_queries(folder)
    make_images(folder)
    around = ("--bounds", "-1.5,-1.5,-1.5,1.5,1.5,1.5", "--resolution", 48)
    run("field", folder / "part.ply", "-o", folder / "part.nrrd", *around)
    for name in ("bunny.nrrd", "bunny.npz"):
        run("field", folder / "bunny.obj", "-o", folder / name, "--resolution", 64)
    for name in ("part.vtp", "axis.npz"):
        run("medial", folder / "part.stl", "-o", folder / name, "--resolution", 32)
    run("medial", folder / "part.stl", "-o", folder / "part.vtp", "--resolution", 32, "--theta", "20,60")
    run("medial", folder / "bunny.obj", "-o", folder / "bunny.vtp", "--resolution", 32)
    for name in ("grid.vtp", "before.vtp"):
        run("medial", folder / "part.stl", "-o", folder / name, "--resolution", 32, "--patch-angle", 30)
    for name in ("exact.vtp", "after.vtp"):
        run("voronoi", folder / "part.stl", "-o", folder / name, "--medial", "--patch-angle", 30)
    run("medial", folder / "scan.nii.gz", "-o", folder / "vessels.npz", "--label", 1)
    make_path(folder)
    return folder


def test_every_command_has_an_example():
    assert [verb for verb in verbs() if not examples(verb)] == []


@pytest.mark.parametrize("verb", verbs() if BLUM else [()], ids=lambda verb: "-".join(("blum", *verb)))
def test_examples_run(inputs, tmp_path, verb):
    shutil.copytree(inputs, tmp_path, dirs_exist_ok=True)
    for line in examples(verb):
        if serves(line):
            continue
        words = shlex.split(line.partition(" | ")[0])[1:]
        given = [name for word in words for name in (sorted(map(str, tmp_path.glob(word))) if "*" in word else [word])]
        done = subprocess.run([BLUM, *given], capture_output=True, timeout=120, check=False, cwd=tmp_path, text=True)
        assert done.returncode == 0, f"{line}\n{done.stdout}\n{done.stderr}"
        assert "-o" not in words or done.stdout, line


COMMAND = re.compile(r"^(?:\$ )?(blum [^\n#]*?)\s*(?:\s#.*|\s{2,}.*)?$", re.MULTILINE)


def document_commands():
    """The commands in code blocks of the README and the documents: (page, command)."""
    for page in [PROJECT / "README.md", *sorted((PROJECT / "docs").rglob("*.md"))]:
        for block in re.findall(r"^```\w*\n(.*?)^```", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL):
            for line in COMMAND.findall(block.replace("\\\n", " ")):
                for part in re.split(r"\s(?:&&|\||;)\s", line):
                    if part.startswith("blum "):
                        yield page.relative_to(PROJECT), part


def test_commands_in_documents_use_existing_verbs_and_options():
    count = 0
    for page, line in document_commands():
        words = shlex.split(line)[1:]
        verb: tuple[str, ...] = ()
        while words and (*verb, words[0]) in verbs():
            verb = (*verb, words.pop(0))
        assert verb or words[0].startswith("-"), f"{page}: {line}"
        if verb == ("make",):
            continue  # Options depend on the shape; the next test checks them.
        known = set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", help_of(*verb)))
        wrong = [word for word in words if re.match(r"--?[a-z]", word) and word.partition("=")[0] not in known]
        assert not wrong, f"{page}: {line}: {wrong}"
        count += 1
    assert count > 40


def test_shapes_in_documents_exist(tmp_path):
    lines = {line for _, line in document_commands() if line.startswith("blum make ")}
    listed = run("make", "--list")[0]
    for line in lines:
        words = shlex.split(line)[2:]
        if words[0].startswith("-"):
            continue
        assert re.search(rf"^{words[0].replace('-', '_')}(?:_image)? \(", listed, re.MULTILINE), line
        own = run("make", words[0], "--list")[0]
        given = [word for word in words if re.match(r"--[a-z]", word) and word not in ("--list", "--json", "--quiet")]
        assert all(word.partition("=")[0] in own for word in given), line
    assert len(lines) > 10
