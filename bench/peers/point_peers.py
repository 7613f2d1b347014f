#!/usr/bin/env python3
"""Times closest points and signed distances of scattered points against Open3D (Embree), FCPW and libigl.

    PYTHONPATH=build/release/python bench/peers/point_peers.py MESH [--points N] [--threads N] [--json FILE]

All programs get the same input, in one run. MESH is a closed mesh. Points lie in a box 1.2 times the mesh's bounds,
and within some hundredths of the diagonal from its surface. Times are the best of a few runs. They exclude building
the hierarchies, except for libigl, which builds its own in each call. The time of Blum's first call, which builds
structures for many points, is a separate figure. Open3D and FCPW compute in single precision. Results of Open3D are
compared with Blum's.
"""

import argparse
import json
import pathlib
import sys
import time

import blum
import numpy as np
from timing import best_of


def points_about(vertices, triangles, count):
    rng = np.random.default_rng(1)
    lower, upper = vertices.min(0), vertices.max(0)
    diagonal = np.linalg.norm(upper - lower)
    in_box = (lower + upper) / 2 + 1.2 * (upper - lower) * (rng.random((count, 3)) - 0.5)
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[rng.choice(len(triangles), count, p=area / area.sum())]
    weights = rng.dirichlet([1, 1, 1], count)
    near = (chosen * weights[:, :, None]).sum(1) + rng.normal(size=(count, 3)) * (0.005 * diagonal)
    return {"in a box of 1.2": in_box, "near the surface": near}


def time_open3d(vertices, triangles, points, threads, out):
    try:
        import open3d as o3d
    except (ImportError, OSError) as error:
        out["open3d"] = f"not there: {error}"
        return None
    scene = o3d.t.geometry.RaycastingScene(nthreads=threads)
    scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
    queries = o3d.core.Tensor(points.astype(np.float32))
    out["open3d_closest_s"], found = best_of(2, lambda: scene.compute_closest_points(queries))
    out["open3d_signed_s"], _ = best_of(2, lambda: scene.compute_signed_distance(queries))
    return np.linalg.norm(found["points"].numpy() - points, axis=1)


def time_fcpw(vertices, triangles, points, out):
    try:
        import fcpw
    except ImportError as error:
        out["fcpw"] = f"not there: {error}"
        return
    scene = fcpw.scene_3D()
    scene.set_object_count(1)
    scene.set_object_vertices(vertices.astype(np.float32), 0)
    scene.set_object_triangles(triangles.astype(np.int32), 0)
    scene.build(fcpw.aggregate_type.bvh_surface_area, True, True, True)
    queries, squared = points.astype(np.float32), np.full(len(points), np.inf, np.float32)
    found = fcpw.interaction_3D_list()
    out["fcpw_closest_s"], _ = best_of(2, lambda: scene.find_closest_points(queries, squared, found, True))


def time_libigl(vertices, triangles, points, out):
    try:
        import igl
    except ImportError as error:
        out["libigl"] = f"not there: {error}"
        return
    kind = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
    out["libigl_signed_s"], _ = best_of(1, lambda: igl.signed_distance(points, vertices, triangles, sign_type=kind))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh", help="a closed mesh")
    parser.add_argument("--points", type=int, default=1_000_000, metavar="N", help="how many (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=2, metavar="N", help="of all but libigl and FCPW, which take all")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="writes the figures here, too")
    args = parser.parse_args()
    mesh = blum.read_mesh(args.mesh)
    vertices, triangles = np.array(mesh.vertices), np.array(mesh.triangles)
    result = {"mesh": args.mesh, "triangles": len(triangles), "points": args.points, "threads": args.threads}
    for name, points in points_about(vertices, triangles, args.points).items():
        out = result[name] = {}
        for kind, sign in (("closest", "none"), ("signed", "auto")):
            start = time.perf_counter()
            query = blum.ClosestPointQuery(mesh, sign=sign, threads=args.threads)
            out[f"blum_{kind}_build_s"] = time.perf_counter() - start
            start = time.perf_counter()
            query(points, threads=args.threads)
            out[f"blum_{kind}_first_s"] = time.perf_counter() - start
            out[f"blum_{kind}_s"], found = best_of(4, lambda q=query: q(points, threads=args.threads))
        theirs = time_open3d(vertices, triangles, points, args.threads, out)
        if theirs is not None:
            out["open3d_largest_difference"] = float(np.abs(theirs - np.abs(found.distance)).max())
        time_fcpw(vertices, triangles, points, out)
        time_libigl(vertices, triangles, points, out)
    text = json.dumps(result, indent=1)
    print(text)
    if args.json:
        args.json.write_text(text + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
