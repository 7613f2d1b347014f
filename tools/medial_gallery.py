#!/usr/bin/env python3
"""Makes the pictures of medial axes in docs/pictures from shapes of `blum make` and of the tests.

Needs VTK, NumPy and Pillow, and manifold3d for shapes of the tests.

    tools/medial_gallery.py BLUM_PROGRAM [FOLDER] [--only NAME ...]      FOLDER is docs/pictures by default

tools/medial_pictures.py draws each picture from files that `blum medial` certified. Large files are reduced to 256
colours.
"""

import argparse
import dataclasses
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[1]
THETAS = (20, 60, 120)
PANEL = 400  # pixels
MOST_BYTES = 150_000


@dataclasses.dataclass
class Picture:
    name: str  # NAME in medial-NAME.png
    shape: list[str]  # arguments of `blum make`; or "made", family and number of a solid of tests/made
    eye: str = "1,-1.6,0.9"
    color: str = "radius"
    thetas: tuple[int, ...] = THETAS
    options: list[str] = dataclasses.field(default_factory=list)  # options of `blum medial`
    panel: int = PANEL


PICTURES = [
    Picture("bracket", ["bracket"]),
    Picture("bracket-sheets", ["bracket"], color="sheet", thetas=(60, 120), panel=500),
    Picture("organic", ["organic"], options=["--resolution", "160"]),
    Picture("knot", ["torus_knot"], eye="0.4,-0.7,1", thetas=(20, 60, 170)),
    Picture("void-cube", ["void_cube"]),
    Picture("tubes", ["tube_image", "--nodes", "2", "--pitch", "61", "--radius", "13.4"], eye="1,-1.9,0.8",
            thetas=(60, 120, 170)),
    Picture("gear", ["gear"], eye="0.6,-1,1.6"),
    Picture("truss", ["made", "trusses", "3"], thetas=(60, 120)),
    Picture("screw", ["made", "screws", "0"]),
    Picture("vessels", ["made", "vessel_trees", "3"], thetas=(60, 120)),
    Picture("spring", ["made", "springs", "1"], thetas=(60, 120)),
]


def voxel_faces(image: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners and squares of the faces between zero and nonzero voxels; voxel (x, y, z) is image[z, y, x]."""
    inside = np.pad(image.transpose(2, 1, 0) != 0, 1)
    step = np.eye(3)
    squares = []
    for axis in range(3):
        u, v = step[(axis + 1) % 3], step[(axis + 2) % 3]
        differs = np.delete(inside, 0, axis) != np.delete(inside, -1, axis)
        # The padding around the image puts the centre of the first voxel at (place - 1).
        first = np.argwhere(differs) - 1 + 0.5 * (step[axis] - u - v)
        squares.append(np.stack([first, first + u, first + u + v, first + v], axis=1))
    vertices, place = np.unique(np.concatenate(squares).reshape(-1, 3), axis=0, return_inverse=True)
    return vertices, place.reshape(-1, 4)


def write_obj(path: pathlib.Path, vertices: np.ndarray, polygons: np.ndarray) -> None:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += ["f " + " ".join(map(str, polygon)) for polygon in polygons + 1]
    path.write_text("\n".join(lines) + "\n")


def call(*command) -> None:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")


def write_shape(picture: Picture, blum: pathlib.Path, path: pathlib.Path) -> None:
    if picture.shape[0] != "made":
        call(blum, "make", *picture.shape, "-o", path, "--quiet")
        return
    sys.path.insert(0, str(ROOT / "tests"))
    from made import made_solid  # noqa: PLC0415  (needs more packages than the other pictures)

    solid = made_solid(picture.shape[1], int(picture.shape[2]))
    write_obj(path, np.asarray(solid.vertices), np.asarray(solid.triangles))


def make(picture: Picture, blum: pathlib.Path, output: pathlib.Path, folder: pathlib.Path) -> None:
    is_image = picture.shape[0].endswith("_image")
    solid = folder / ("solid.npy" if is_image else "solid.obj")
    write_shape(picture, blum, solid)
    axis = folder / "axis.npz"
    call(blum, "medial", solid, "-o", axis, "--theta", ",".join(map(str, picture.thetas)), "--quiet", *picture.options)
    surface = solid
    if is_image:
        surface = folder / "faces.obj"
        write_obj(surface, *voxel_faces(np.load(solid)))
    drawn = folder / "drawn.png"
    axes = [axis] if len(picture.thetas) == 1 else [folder / f"axis-theta{theta}.npz" for theta in picture.thetas]
    call(sys.executable, ROOT / "tools/medial_pictures.py", surface, *axes, "-o", drawn, "--color", picture.color,
         "--views", 1, f"--eye={picture.eye}", "--size", picture.panel)
    with Image.open(drawn) as image:
        image.convert("RGB").save(output, optimize=True)
        if output.stat().st_size > MOST_BYTES:
            few = image.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=3, dither=Image.Dither.NONE)
            few.save(output, optimize=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Makes the pictures of medial axes in the documents.")
    parser.add_argument("blum", type=pathlib.Path, help="the program")
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=ROOT / "docs/pictures")
    parser.add_argument("--only", nargs="+", choices=[picture.name for picture in PICTURES], help="names of pictures")
    options = parser.parse_args()
    for picture in PICTURES:
        if options.only and picture.name not in options.only:
            continue
        output = options.folder / f"medial-{picture.name}.png"
        with tempfile.TemporaryDirectory() as temporary:
            make(picture, options.blum.resolve(), output, pathlib.Path(temporary))
        size = output.stat().st_size
        print(f"{output}: {size:,} bytes", flush=True)
        if size > MOST_BYTES:
            sys.exit(f"{output}: more than {MOST_BYTES:,} bytes")


if __name__ == "__main__":
    main()
