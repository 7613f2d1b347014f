#!/usr/bin/env python3
"""Times distances between bodies, contacts and close pairs against coal, python-fcl and ipctk.

    PYTHONPATH=build/release/python bench/peers/body_peers.py FIRST SECOND [--json FILE]

All programs get the same input, in one run, on one thread. FIRST and SECOND are meshes, scaled to unit size.

Distances are between bodies of constant shape: the mean over ten poses for each of a few gaps.

Questions whether two bodies meet are asked at 500 random poses, one after the other and all in one call. Half of the
poses are anywhere in a box around the first body, half are deep in it.

Close pairs are all pairs closer than a hundredth of the size. Both bodies are in one mesh and overlap. Blum finds
pairs of triangles. ipctk finds pairs of a vertex and a face or of two edges, with its exact distances and candidates
by LBVH.
"""

import argparse
import json
import pathlib
import sys
import time

import blum
import coal
import fcl
import ipctk
import numpy as np
from timing import best_of


def read(path):
    mesh = blum.read_mesh(path)
    vertices = np.array(mesh.vertices)
    lower, upper = vertices.min(0), vertices.max(0)
    return np.ascontiguousarray((vertices - (lower + upper) / 2) / (upper - lower).max()), np.array(mesh.triangles)


def turned(angle, axis):
    axis = np.array(axis, float) / np.linalg.norm(axis)
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def poses(scene, gap):
    """Ten rotations, each with a translation along x that makes the distance of the bodies about `gap`."""
    out = []
    for k in range(10):
        rotation, low, high = turned(0.6 * k, [1, 0.3 * k, 0.5]), 0.0, 3.0
        for _ in range(14):
            middle = (low + high) / 2
            scene.update(1, transform=(rotation, [middle, 0.1, 0.05]))
            low, high = (low, middle) if scene.separation(0, 1).distance > gap else (middle, high)
        out.append((rotation, np.array([high, 0.1, 0.05])))
    return out


def coal_model(vertices, triangles):
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(triangles), len(vertices))
    model.addVertices(vertices)
    model.addTriangles(np.asarray(triangles, dtype=np.int64))
    model.endModel()
    return model


def fcl_model(vertices, triangles):
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(triangles))
    model.addSubModel(vertices, triangles)
    model.endModel()
    return model


def coal_distances(models, places):
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    rest = coal.Transform3s.Identity()
    out = []
    for rotation, translation in places:
        result.clear()
        out.append(coal.distance(models[0], rest, models[1], coal.Transform3s(rotation, translation), request, result))
    return out


def fcl_distances(models, places):
    out = []
    for rotation, translation in places:
        objects = [fcl.CollisionObject(models[0]), fcl.CollisionObject(models[1], fcl.Transform(rotation, translation))]
        start = time.perf_counter()
        distance = fcl.distance(*objects, fcl.DistanceRequest(), fcl.DistanceResult())
        out.append((distance, time.perf_counter() - start))
    return out


def rigid(bodies):
    scene = blum.ProximityScene()
    for vertices, triangles in bodies:
        scene.add((vertices, triangles))
    models = [coal_model(*body) for body in bodies]
    fcl_models = [fcl_model(*body) for body in bodies]
    out = {}

    def ours(places):
        distances = []
        for rotation, translation in places:
            scene.update(1, transform=(rotation, translation))
            distances.append(scene.separation(0, 1, threads=1).distance)
        return distances

    for gap in (0.3, 0.1, 0.03, 0.01, 0.002):
        places = poses(scene, gap)
        seconds, distances = best_of(7, lambda places=places: ours(places))
        theirs, coal_found = best_of(7, lambda places=places: coal_distances(models, places))
        runs = [fcl_distances(fcl_models, places) for _ in range(7)]
        fcl_seconds = min(sum(s for _, s in run) for run in runs)
        worst = max(np.abs(np.array(distances) - coal_found).max(),
                    np.abs(np.array(distances) - [d for d, _ in runs[0]]).max())  # fmt: skip
        out[str(gap)] = {"blum_ms": 100 * seconds, "coal_ms": 100 * theirs, "python_fcl_ms": 100 * fcl_seconds,
                         "largest_difference": worst}  # fmt: skip
    return out


def random_poses(count, reach, seed):
    """Rotations, and translations by up to `reach` along each axis."""
    random = np.random.default_rng(seed)
    axes, angles = random.normal(size=(count, 3)), random.uniform(0, 2 * np.pi, count)
    return [(turned(angle, axis), random.uniform(-reach, reach, 3)) for angle, axis in zip(angles, axes, strict=True)]


def meeting(bodies):
    """Microseconds per pose, and the number of poses at which the bodies meet."""
    scene = blum.ProximityScene()
    for body in bodies:
        scene.add(body)
    models = [coal_model(*body) for body in bodies]
    fcl_models = [fcl_model(*body) for body in bodies]
    request, result, rest = coal.CollisionRequest(), coal.CollisionResult(), coal.Transform3s.Identity()
    out = {}

    def ours(places):
        found = []
        for rotation, translation in places:
            scene.update(1, transform=(rotation, translation))
            found.append(scene.meets(0, 1, threads=1))
        return found

    def theirs(places):
        found = []
        for rotation, translation in places:
            result.clear()
            place = coal.Transform3s(rotation, translation)
            found.append(coal.collide(models[0], rest, models[1], place, request, result) > 0)
        return found

    def of_fcl(places):
        found = []
        for rotation, translation in places:
            there = fcl.CollisionObject(fcl_models[1], fcl.Transform(rotation, translation))
            found.append(fcl.collide(fcl.CollisionObject(fcl_models[0]), there, fcl.CollisionRequest(),
                                     fcl.CollisionResult()) > 0)  # fmt: skip
        return found

    for kind, reach in (("random", 1.0), ("deep", 0.15)):
        places = random_poses(500, reach, 1)
        matrices = np.array([np.column_stack(place) for place in places])
        timed = {"blum": best_of(7, lambda: ours(places)), "coal": best_of(7, lambda: theirs(places)),
                 "python_fcl": best_of(7, lambda: of_fcl(places)),
                 "blum_in_one_call": best_of(7, lambda: scene.meets(0, 1, matrices, threads=1).tolist())}  # fmt: skip
        assert all(found == timed["coal"][1] for _, found in timed.values()), "programs disagree"
        out[kind] = {f"{name}_us": 1e6 * seconds / len(places) for name, (seconds, _) in timed.items()}
        out[kind]["meeting"] = sum(timed["blum"][1])
    return out


def close(bodies, distance=0.01):
    (a, ta), (b, tb) = bodies
    vertices = np.vstack([a, b + [0.05, 0.02, 0.01]])
    triangles = np.vstack([ta, tb + len(a)]).astype(np.int32)
    scene = blum.ProximityScene()
    scene.add((vertices, triangles), compare_self=True)
    seconds, pairs = best_of(3, lambda: scene.closer_than(distance, threads=1))
    anew = best_of(3, lambda: blum.ProximityScene().add((vertices, triangles), compare_self=True, threads=1))[0]
    ipctk.set_num_threads(1)
    mesh = ipctk.CollisionMesh(vertices, ipctk.edges(triangles), triangles)
    positions = np.asfortranarray(vertices)

    def theirs():
        found = ipctk.NormalCollisions()
        found.build(mesh, positions, distance, 0.0, ipctk.LBVH())
        return len(found)

    peer, count = best_of(3, theirs)
    return {"blum_s": seconds, "blum_build_s": anew, "blum_pairs": len(pairs.distance), "ipctk_s": peer,
            "ipctk_pairs": count, "blum_pairs_per_s": len(pairs.distance) / (seconds + anew),
            "ipctk_pairs_per_s": count / peer}  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("first", type=pathlib.Path)
    parser.add_argument("second", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    bodies = [read(given.first), read(given.second)]
    text = json.dumps({"rigid": rigid(bodies), "meeting": meeting(bodies), "close": close(bodies)}, indent=1)
    if given.json:
        given.json.write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(main())
