"""Computes the exact clearance of a moving point robot from the obstacles of a scene, without a grid.

    python clearance_of_scene.py [MESH] [-o CLEARANCE.csv] [--steps N]

Without a mesh, the scene is a generated chain of linked rings. The way is a helix through the scene.
"""

import argparse
import os
import pathlib
import sys

import blum
import numpy as np


def helix(bounds, steps):
    """(steps, 3): three turns around the middle of a box, from end to end of its longest axis."""
    lower, upper = np.array(bounds)
    size = upper - lower
    axis = int(np.argmax(size))
    part = np.linspace(0, 1, steps)
    turn = 6 * np.pi * part
    way = np.tile((lower + upper) / 2, (steps, 1))
    way[:, axis] = lower[axis] + part * size[axis]
    way[:, (axis + 1) % 3] += 0.3 * size[(axis + 1) % 3] * np.cos(turn)
    way[:, (axis + 2) % 3] += 0.3 * size[(axis + 2) % 3] * np.sin(turn)
    return way


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("-o", "--output", default="clearance.csv")
    parser.add_argument("--steps", type=int, default=1000)
    arguments = parser.parse_args()
    if arguments.steps < 1:
        parser.error(f"--steps is {arguments.steps}, but must be at least 1")
    output = pathlib.Path(arguments.output)
    if output.is_dir() or not os.access(output.resolve().parent, os.W_OK):
        parser.error(f"-o {output}: its folder is not there or may not be written, or it is a folder itself")

    scene = blum.read_mesh(arguments.mesh) if arguments.mesh else blum.generate("linked_tori", count=3)
    way = helix(scene.bounds, arguments.steps)
    found = blum.closest_points(scene, way)
    closest = int(np.argmin(found.distance))
    print(
        f"{scene}: clearance {found.distance[closest]:.4g} at {way[closest].round(3).tolist()}, "
        f"{np.mean(found.distance < 0):.1%} of the way in an obstacle"
    )
    header = "x,y,z,clearance,closest x,closest y,closest z,triangle"
    rows = np.column_stack([way, found.distance, found.closest, found.triangle])
    lines = [header, *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    output.write_text("\n".join(lines) + "\n")
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    try:
        main()
    except (OSError, blum.Error) as error:
        sys.exit(f"clearance_of_scene: error: {error}")
