# What the tests of the command-line tool share.
import pytest

from tool import run


@pytest.fixture(scope="session")
def shapes(tmp_path_factory):
    """A folder with a sphere, a torus, a ball image, labelled balls, and fields of the first."""
    folder = tmp_path_factory.mktemp("shapes")
    run("make", "sphere", "-o", folder / "sphere.ply", "--frequency", 6)
    run("make", "torus", "-o", folder / "torus.obj", "--ring-segments", 24, "--tube_segments=12")
    run("make", "ball", "-o", folder / "ball.nrrd", "--size", 24)
    run("make", "balls", "-o", folder / "balls.npy", "--count", 3)
    run("field", folder / "sphere.ply", "-o", folder / "sphere.nrrd", "--resolution", 24)
    run("field", folder / "sphere.ply", "-o", folder / "sphere.npz", "--resolution", 24, "--band", "3v")
    return folder
