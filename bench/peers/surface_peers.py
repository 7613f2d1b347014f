#!/usr/bin/env python3
"""Times certified Hausdorff distances against MeshLab's sampling (PyMeshLab) on the same two meshes, in one run.

    PYTHONPATH=build/release/python bench/peers/surface_peers.py MESH OTHER [--tolerance PART] [--samples N] [--json FILE]

Sampling finds a lower bound. The bound is certainly within a tolerance if each point of the surface has a sample within
the tolerance. Hexagons with this radius cover the surface with the fewest samples. MeshLab is timed with N samples per
side, and its time is scaled to this number. --fit moves and scales OTHER to the centre and diagonal of MESH.
"""

import argparse
import json
import math
import pathlib
import sys

import blum
import numpy as np
from timing import best_of


def fitted(vertices, goal):
    """Vertices, moved and scaled so that their bounds have the centre and the diagonal of the goal's bounds."""
    lower, upper = vertices.min(0), vertices.max(0)
    to_lower, to_upper = goal.min(0), goal.max(0)
    scale = np.linalg.norm(to_upper - to_lower) / np.linalg.norm(upper - lower)
    return (vertices - (lower + upper) / 2) * scale + (to_lower + to_upper) / 2


def area_of(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def time_meshlab(meshes, samples, out):
    """Times the larger of both one-sided distances, with this many samples of faces per side."""
    try:
        import pymeshlab
    except ImportError as error:
        out["meshlab"] = f"not there: {error}"
        return
    meshset = pymeshlab.MeshSet()
    for vertices, triangles in meshes:
        meshset.add_mesh(pymeshlab.Mesh(vertices, triangles))

    def both_sides():
        found = [
            meshset.get_hausdorff_distance(
                sampledmesh=k,
                targetmesh=1 - k,
                savesample=False,
                samplevert=False,
                sampleedge=False,
                sampleface=True,
                samplenum=samples,
                maxdist=pymeshlab.PercentageValue(100),
            )
            for k in range(2)
        ]
        return max(side["max"] for side in found)

    out["meshlab_s"], out["meshlab_distance"] = best_of(2, both_sides)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("other")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="part of the diagonal of both")
    parser.add_argument("--samples", type=int, default=1_000_000, help="of each side, for MeshLab")
    parser.add_argument("--fit", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    first = blum.read_mesh(options.mesh)
    second = blum.read_mesh(options.other)
    meshes = [(np.asarray(m.vertices), np.asarray(m.triangles)) for m in (first, second)]
    if options.fit:
        meshes[1] = (fitted(meshes[1][0], meshes[0][0]), meshes[1][1])
    corners = np.vstack([vertices for vertices, _ in meshes])
    tolerance = options.tolerance * np.linalg.norm(corners.max(0) - corners.min(0))
    out = {"triangles": [len(t) for _, t in meshes], "tolerance": tolerance}
    out["blum_s"], found = best_of(5, lambda: blum.hausdorff_distance(meshes[0], meshes[1], tolerance=tolerance))
    out["blum_interval"] = [found.lower, found.upper]
    time_meshlab(meshes, options.samples, out)
    if "meshlab_s" in out:
        needed = sum(area_of(*mesh) for mesh in meshes) * 2 / (1.5 * math.sqrt(3) * tolerance**2)
        out["meshlab_samples_needed"] = needed
        out["meshlab_s_as_certain"] = out["meshlab_s"] * needed / (2 * options.samples)
        out["times_as_fast"] = out["meshlab_s_as_certain"] / out["blum_s"]
        if out["meshlab_distance"] > found.upper * (1 + 1e-6) + tolerance:
            sys.exit(f"MeshLab found {out['meshlab_distance']}, above the interval")
    text = json.dumps(out, indent=1)
    print(text)
    if options.json:
        options.json.write_text(text + "\n")


if __name__ == "__main__":
    main()
