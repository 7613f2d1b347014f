"""Computes, certifies and writes the medial axis of a CAD part, and prints the range of its thickness.

    python medial_axis_of_part.py [MESH] [-o AXIS] [--theta DEGREES]

Without a mesh, generates a bracket.
"""

import argparse

import blum
import numpy as np


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("-o", "--output", default="axis.vtp")
    parser.add_argument("--theta", type=float, default=60)
    parser.add_argument("--resolution", type=int, default=128)
    arguments = parser.parse_args()

    mesh = blum.read_mesh(arguments.mesh) if arguments.mesh else blum.generate("bracket")
    axis = blum.medial_axis(mesh, resolution=arguments.resolution)
    for theta in (20, arguments.theta, 120):
        print(f"theta {theta:g}: {axis.simplify(theta)}")

    piece = axis.simplify(arguments.theta)
    print(piece.certificate)
    # Rims are left out, because their radius shows the end of the axis and not the thickness of the part.
    inner = np.isin(piece.role, [blum.ROLES.index("sheet"), blum.ROLES.index("curve")])
    thickness = 2 * piece.radius[inner]
    print(f"thickness {thickness.min():.4g} to {thickness.max():.4g}, median {np.median(thickness):.4g}")
    piece.write(arguments.output)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
