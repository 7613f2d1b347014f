#!/usr/bin/env python3
"""Times continuous collisions against ipctk: broad phase LBVH, narrow phase Tight-Inclusion.

    bench/peers/collision_peers.py BLUM_PROGRAM START END [--queries FOLDER] [--sample N] [--json FILE]

Both programs get the same input, in one run, on one thread. They find all colliding pairs of a mesh between two
frames. ipctk has no call for that, so its test is called for each candidate. With --sample N, N random candidates of
each kind are tested, and the time is scaled to all. The overhead of a call from Python is measured with features that
are far apart, and subtracted. With --queries, both programs run each query of a folder of files for `blum ccd`.
"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import time
from fractions import Fraction

import ipctk
import numpy as np

FAR = np.array([1e3, 0, 0])


def ours(blum, *arguments):
    done = subprocess.run([blum, *map(str, arguments), "--json", "-"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def read_ply(path):
    """Vertices and triangles of a mesh file, read by trimesh."""
    import trimesh

    mesh = trimesh.load(path, process=False)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int32)


class Peer:
    """Tight-Inclusion of ipctk, without its rescaling of times."""

    def __init__(self):
        ipctk.set_num_threads(1)
        self.ccd = ipctk.TightInclusionCCD(1e-6, 1_000_000, 1.0)

    def test(self, kind):
        return self.ccd.point_triangle_ccd if kind == "vertex_face" else self.ccd.edge_edge_ccd

    def overhead(self, kind):
        """Seconds of a call that returns at once, because the features are far apart."""
        test, points = self.test(kind), [np.zeros(3), FAR, FAR + [1, 0, 0], FAR + [0, 1, 0]]
        if kind == "edge_edge":
            points[1] = np.array([0, 0, 1.0])
        rounds = 20000
        start = time.perf_counter()
        for _ in range(rounds):
            test(*points, *points)
        return (time.perf_counter() - start) / rounds


def time_peer(start, end, triangles, sample, peer):
    mesh = ipctk.CollisionMesh(start, ipctk.edges(triangles), triangles)
    candidates = ipctk.Candidates()
    begin = time.perf_counter()
    candidates.build(mesh, start, end, 0.0, ipctk.LBVH())
    broad = time.perf_counter() - begin
    edges, faces = mesh.edges, mesh.faces
    random = np.random.default_rng(1)
    out = {"broad_phase": broad, "candidates": {}, "seconds": {}, "colliding": {}}
    for kind, found in (("vertex_face", candidates.fv_candidates), ("edge_edge", candidates.ee_candidates)):
        count = len(found)
        chosen = random.choice(count, min(sample or count, count), replace=False)
        test, hits = peer.test(kind), 0
        rows = []
        for k in chosen:
            one = found[k]
            if kind == "vertex_face":
                rows.append([one.vertex_id, *faces[one.face_id]])
            else:
                rows.append([*edges[one.edge0_id], *edges[one.edge1_id]])
        begin = time.perf_counter()
        for row in rows:
            hits += test(*start[row], *end[row])[0]
        seconds = time.perf_counter() - begin
        gather = time.perf_counter()
        for row in rows:
            start[row], end[row]
        seconds -= time.perf_counter() - gather + peer.overhead(kind) * len(rows)
        out["candidates"][kind] = count
        out["seconds"][kind] = seconds * count / len(rows)
        out["colliding"][kind] = hits * count / len(rows)
    out["total"] = broad + sum(out["seconds"].values())
    return out


def read_queries(path):
    with path.open() as file:
        rows = [[float(Fraction(int(row[k]), int(row[k + 1]))) for k in (0, 2, 4)] + [row[6] == "1"] for row in csv.reader(file)]
    values = np.array([row[:3] for row in rows]).reshape(-1, 8, 3)
    return values, [row[3] for row in rows[::8]]


def time_queries(folder, peer):
    counts = {"queries": 0, "false_negatives": 0, "false_positives": 0}
    microseconds = []
    for path in sorted(folder.rglob("*.csv")):
        kind = "vertex_face" if "vertex-face" in str(path) else "edge_edge"
        test, overhead = peer.test(kind), peer.overhead(kind)
        points, truths = read_queries(path)
        for query, truth in zip(points, truths, strict=True):
            begin = time.perf_counter()
            hit = test(*query)[0]
            microseconds.append(1e6 * max(time.perf_counter() - begin - overhead, 0))
            counts["queries"] += 1
            counts["false_negatives"] += truth and not hit
            counts["false_positives"] += hit and not truth
    return {**counts, "mean_us": np.mean(microseconds), "median_us": np.median(microseconds),
            "p99_us": np.quantile(microseconds, 0.99)}  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("blum")
    parser.add_argument("start", type=pathlib.Path)
    parser.add_argument("end", type=pathlib.Path)
    parser.add_argument("--queries", type=pathlib.Path)
    parser.add_argument("--sample", type=int, default=50000, help="candidates of either kind that are tested; 0: all")
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    peer = Peer()
    result = {}
    with tempfile.TemporaryDirectory() as folder:
        pairs = pathlib.Path(folder) / "pairs.npz"
        runs = [ours(given.blum, "proximity", "continuous", given.start, given.end, "--self", "-o", pairs,
                     "--threads", 1) for _ in range(3)]  # fmt: skip
    spent = [sum(s for phase, s in run["seconds"].items() if phase not in ("read", "write")) for run in runs]
    pairs_found = runs[0]["vertex_face"] + runs[0]["edge_edge"]
    result["blum"] = {"seconds": min(spent), "vertex_face": runs[0]["vertex_face"], "edge_edge": runs[0]["edge_edge"],
                      "tests_per_pair": runs[0]["exact_tests"] / pairs_found}  # fmt: skip
    start, triangles = read_ply(given.start)
    end, _ = read_ply(given.end)
    result["ipctk"] = time_peer(np.asfortranarray(start), np.asfortranarray(end), triangles, given.sample, peer)
    result["ratio"] = result["ipctk"]["total"] / result["blum"]["seconds"]
    if given.queries:
        files = sorted(given.queries.rglob("*.csv"))
        answer = ours(given.blum, "ccd", *files)
        names = ("queries", "false_negatives", "false_positives", "mean_us", "median_us", "p99_us")
        result["queries"] = {"blum": {name: answer[name] for name in names}, "ipctk": time_queries(given.queries, peer)}
    text = json.dumps(result, indent=1)
    if given.json:
        given.json.write_text(text + "\n")
    print(text)


if __name__ == "__main__":
    sys.exit(main())
