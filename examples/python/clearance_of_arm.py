"""Computes the exact clearance of a moving robot arm from an obstacle, and from itself, at each step.

    python clearance_of_arm.py [OBSTACLE] [-o CLEARANCE.csv] [--steps N]

Without a mesh, the obstacle is a generated bracket. The arm has four rotating links. Only their transforms change, so a
step costs only the query.
"""

import argparse
import os
import pathlib
import sys
from itertools import pairwise

import blum
import numpy as np

LENGTHS = [1.2, 1.0, 0.8, 0.4]  # lengths of the links
START = np.radians([80, 60, 50, 30])  # angles of the joints: the first around z, the others around y
END = np.radians([240, 75, 45, 60])
BASE = np.array([4.0, 1.5, 0.0])
ARM, OBSTACLE = 1, 2  # layers


def link(length):
    """A beam along z, from joint to joint, with a round end."""
    beam, end = blum.generate("box", size_x=0.2, size_y=0.2, size_z=length), blum.generate("sphere", radius=0.15)
    up = np.array([0, 0, length])
    vertices = np.vstack([beam.vertices + up / 2, end.vertices + up])
    return blum.Mesh(vertices, np.vstack([beam.triangles, end.triangles + len(beam.vertices)]))


def turn(axis, angle):
    """(4, 4): a rotation around an axis of coordinates."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out = np.eye(4)
    out[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
    return out


def move(*offset):
    """(4, 4): a translation."""
    out = np.eye(4)
    out[:3, 3] = offset
    return out


def places(angles):
    """The transform of each link."""
    place = move(*BASE)
    for k, angle in enumerate(angles):
        place = place @ turn(2 if k == 0 else 1, angle)
        yield place
        place = place @ move(0, 0, LENGTHS[k])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("obstacle", nargs="?")
    parser.add_argument("-o", "--output", default="clearance.csv")
    parser.add_argument("--steps", type=int, default=200)
    arguments = parser.parse_args()
    if arguments.steps < 1:
        parser.error(f"--steps is {arguments.steps}, but must be at least 1")
    output = pathlib.Path(arguments.output)
    if output.is_dir() or not os.access(output.resolve().parent, os.W_OK):
        parser.error(f"-o {output}: its folder is not there or may not be written, or it is a folder itself")

    obstacle = blum.read_mesh(arguments.obstacle) if arguments.obstacle else blum.generate("bracket")
    scene = blum.ProximityScene()
    scene.add(obstacle, layers=OBSTACLE)
    links = [scene.add(link(length), layers=ARM) for length in LENGTHS]
    for first, second in pairwise(links):
        scene.exclude(first, second)  # neighbouring links meet at their joint

    rows = []
    for part in np.linspace(0, 1, arguments.steps):
        angles = (1 - part) * START + part * END
        for number, place in zip(links, places(angles), strict=True):
            scene.update(number, transform=place)
        found = scene.separation()
        near = found.object[:, 0] == 0  # the obstacle is the first object, before the links
        outside, own = found.distance[near].min(), found.distance[~near].min()
        pair = found[int(np.flatnonzero(near)[found.distance[near].argmin()])]
        rows.append([part, outside, own, pair.object[1], *pair.closest[1]])

    table = np.array(rows)
    worst = table[table[:, 1].argmin()]
    print(
        f"{obstacle}: clearance {worst[1]:.4g} at {worst[0]:.1%} of the way, link {worst[3]:.0f} at "
        f"{worst[4:].round(3).tolist()}; the arm stays {table[:, 2].min():.4g} from itself; "
        f"{np.mean(table[:, 1] == 0):.1%} of the steps meet the obstacle"
    )
    lines = ["part,clearance,own clearance,link,x,y,z", *(",".join(f"{value:.9g}" for value in row) for row in rows)]
    output.write_text("\n".join(lines) + "\n")
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    try:
        main()
    except (OSError, blum.Error) as error:
        sys.exit(f"clearance_of_arm: error: {error}")
