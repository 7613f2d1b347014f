"""Computes the local thickness of an image: at each voxel, the diameter of the largest medial ball around it.

    python thickness_of_image.py [IMAGE] [-o THICKNESS.nrrd] [--threshold T]

Without an image, generates a network of tubes. The file provides the spacing.
"""

import argparse

import blum
import numpy as np


def local_thickness(image: blum.Image, threshold: float | None) -> np.ndarray:
    """The diameter of the largest ball around each voxel, in the units of the spacing; 0 outside the solid."""
    piece = blum.medial_axis(image, threshold=threshold).simplify(0)
    solid = blum.selected_voxels(image, threshold=threshold)
    positions = image.grid.positions()
    thickness = np.zeros(solid.shape, dtype=np.float32)
    spacing = np.array(image.spacing)
    # Writes the balls from small to large, so that larger balls replace smaller ones.
    for v in np.argsort(piece.radius):
        centre, radius = piece.vertices[v], piece.radius[v]
        at = image.grid.direction.T @ (centre - image.grid.origin) / spacing
        first = np.maximum(np.floor(at - radius / spacing).astype(int), 0)
        last = np.minimum(np.ceil(at + radius / spacing).astype(int) + 1, image.grid.size)
        box = tuple(slice(first[axis], last[axis]) for axis in (2, 1, 0))
        inside = ((positions[box] - centre) ** 2).sum(axis=-1) <= radius**2
        thickness[box][inside] = 2 * radius
    return np.where(solid, thickness, 0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("image", nargs="?")
    parser.add_argument("-o", "--output", default="thickness.nrrd")
    parser.add_argument("--threshold", type=float)
    arguments = parser.parse_args()

    image = blum.read_image(arguments.image) if arguments.image else blum.generate("tube_image", nodes=2, pitch=24)
    thickness = local_thickness(image, arguments.threshold)
    inside = thickness[thickness > 0]
    print(f"{image}: thickness {inside.min():.3g} to {inside.max():.3g}, mean {inside.mean():.3g}")
    grid = image.grid
    blum.Image(thickness, grid.spacing, grid.origin, grid.direction, space=image.space).write(arguments.output)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
