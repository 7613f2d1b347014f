"""Draws the signed distance field of a mesh as three slices with contour lines.

    python field_slices.py [MESH] [-o PICTURE]

Without a mesh, generates a gear. Needs Matplotlib.
"""

import argparse

import blum
import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("mesh", nargs="?")
    parser.add_argument("-o", "--output", default="field_slices.png")
    parser.add_argument("--resolution", type=int, default=128)
    arguments = parser.parse_args()

    mesh = blum.read_mesh(arguments.mesh) if arguments.mesh else blum.generate("gear")
    field = blum.distance_field(mesh, resolution=arguments.resolution)
    print(f"{mesh}: {field}, largest depth {-field.distance.min():.4g}")

    lower, upper = np.array(field.grid.bounds)
    nz, ny, nx = field.distance.shape
    slices = [
        ("x", "y", field.distance[nz // 2]),
        ("x", "z", field.distance[:, ny // 2]),
        ("y", "z", field.distance[:, :, nx // 2]),
    ]
    figure, panels = pyplot.subplots(1, 3, figsize=(12, 4), constrained_layout=True)
    limit = np.abs(field.distance).max()
    for panel, (across, up, values) in zip(panels, slices, strict=True):
        a, b = "xyz".index(across), "xyz".index(up)
        extent = (lower[a], upper[a], lower[b], upper[b])
        shown = panel.imshow(values, origin="lower", extent=extent, cmap="RdBu", vmin=-limit, vmax=limit)
        panel.contour(values, levels=[0], colors="black", origin="lower", extent=extent)
        panel.set(xlabel=across, ylabel=up)
    figure.colorbar(shown, ax=panels, label="distance, mesh units")
    figure.savefig(arguments.output, dpi=100)
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
