# Fixtures that the tests of the command-line tool share.
import re
import signal

import pytest

from tool import FORMATS, run

# A script's background jobs ignore SIGINT, and the tools that the tests start would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def shapes(tmp_path_factory):
    """A folder with a sphere, a torus, a ball image, an image of labelled balls, and fields of the sphere."""
    folder = tmp_path_factory.mktemp("shapes")
    run("make", "sphere", "-o", folder / "sphere.ply", "--frequency", 6)
    run("make", "torus", "-o", folder / "torus.obj", "--ring-segments", 24, "--tube_segments=12")
    run("make", "ball", "-o", folder / "ball.nrrd", "--size", 24)
    run("make", "balls", "-o", folder / "balls.npy", "--count", 3)
    run("field", folder / "sphere.ply", "-o", folder / "sphere.nrrd", "--resolution", 24)
    run("field", folder / "sphere.ply", "-o", folder / "sphere.npz", "--resolution", 24, "--band", "3v")
    return folder


@pytest.fixture(scope="session")
def solids(shapes):
    """The folder of `shapes` with a box, a reversed box, an open box and a plate with narrow holes added."""
    run("make", "box", "-o", shapes / "box.obj")
    lines = (shapes / "box.obj").read_text().splitlines()
    turned = [re.sub(r"^f (\S+) (\S+) (\S+)$", r"f \1 \3 \2", line) for line in lines]
    (shapes / "inverted.obj").write_text("\n".join(turned) + "\n")
    (shapes / "open.obj").write_text("\n".join(lines[:-1]) + "\n")
    (shapes / "axis.ma").write_text("2 0 0\nv 0 0 0 1\nv 1 0 0 1\n")
    run("make", "plate", "-o", shapes / "plate.obj", "--hole-radius", 0.02)
    return shapes


@pytest.fixture(scope="session")
def axes(solids, tmp_path_factory):
    """Axes, not decimated: of the box in every format, of the torus and of the open box."""
    folder = tmp_path_factory.mktemp("axes")
    for end in FORMATS:
        run("medial", solids / "box.obj", "-o", folder / f"box.{end}", "--resolution", 16, "--decimate", 0)
    run("medial", solids / "torus.obj", "-o", folder / "torus.npz", "--resolution", 40)
    run("medial", solids / "open.obj", "-o", folder / "open.npz", "--resolution", 16, warns=True)
    return folder
