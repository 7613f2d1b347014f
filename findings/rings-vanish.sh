#!/usr/bin/env bash
# kimimaro 5.8.5: the skeleton of a ring that was cut into blocks is empty after postprocess().
#
# Versions: kimimaro 5.8.5, osteoid 0.7.4.
# Large images are skeletonized in blocks that overlap by one voxel. The documentation then joins the parts with
# simple_merge() and consolidate(), and cleans the result with postprocess(). The joined ring is a closed loop.
# The documentation says that loops are collapsed to their centroid or broken somewhere.
#
# Expected: a tree that follows the ring, one edge shorter than the loop. In one block the ring gets such a tree.
# Seen, ring: no vertex and no edge are left of 184 units, for two blocks and for three. Both thresholds are 0.
# Seen, ring with a rod: one straight edge through the hole replaces the loop, and 50 units of it are outside.
# The cable length falls from 234 to 107. Neither case causes a warning.
# So the result depends on where the borders of the blocks lie.
#
# Affected: users who measure rings and loops in volumes that need blocks, for example ring-shaped mitochondria,
# vessels and struts of lattices. Such objects are missing from tables, or are too short with edges outside.
# Workaround: remove one edge of each loop before postprocess(), as spanning_tree() below does.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check kimimaro==5.8.5 osteoid==0.7.4 edt==3.1.2 dijkstra3d==1.15.2 \
  networkx==3.6.1 numpy==2.4.6 scipy==1.17.1
cat >look.py <<'END'
from importlib.metadata import version

import kimimaro
import networkx as nx
import numpy as np
from osteoid import Skeleton

print("kimimaro", version("kimimaro"), "osteoid", version("osteoid"))
x, y, z = np.mgrid[:121, :81, :9]
layer = (z > 1) & (z < 7)
radius = np.hypot(x - 40, y - 40)
ring = layer & (radius > 26) & (radius < 31)
shapes = {"ring": ring, "ring with a rod": ring | (layer & (x >= 66) & (x < 116) & (abs(y - 40) < 3))}


def skeleton(image, borders):
    """The joined skeletons of blocks between borders along x, which overlap by one voxel."""
    parts = []
    for low, high in zip(borders, borders[1:]):
        block = image[low : high + 1].astype(np.uint8)
        part = kimimaro.skeletonize(
            block, teasar_params={"scale": 1.5, "const": 10}, dust_threshold=10, fix_borders=True, progress=False
        )[1]
        part.vertices = part.vertices + np.array([low, 0, 0], np.float32)
        parts.append(part)
    return Skeleton.simple_merge(parts).consolidate()


def clean(skeleton):
    return kimimaro.postprocess(skeleton.clone(), dust_threshold=0, tick_threshold=0)


def length(skeleton):
    return round(float(skeleton.cable_length()))


def length_outside(skeleton, image):
    """The length of the parts of edges that lie in voxels of the background."""
    total = 0.0
    for edge in skeleton.edges:
        a, b = skeleton.vertices[edge].astype(float)
        points = np.rint(np.linspace(a, b, 101)).astype(int)
        total += np.linalg.norm(b - a) * np.mean(~image[tuple(points.T)])
    return round(total)


def spanning_tree(skeleton):
    graph = nx.Graph(skeleton.edges.tolist())
    tree = skeleton.clone()
    tree.edges = np.array(list(nx.minimum_spanning_edges(graph, data=False)), np.uint32)
    return tree


found = {}
for name, image in shapes.items():
    for borders in ([0, 121], [0, 41, 121], [0, 31, 61, 121]):
        joined = skeleton(image, borders)
        cleaned = clean(joined)
        around = clean(spanning_tree(joined))
        loops = len(joined.edges) - len(joined.vertices) + len(joined.components())
        found[name, len(borders) - 1] = loops, length(joined), length(cleaned), length_outside(cleaned, image)
        print(f"{name}, blocks: {len(borders) - 1}, loops: {loops}, length {length(joined)}; ", end="")
        print(f"after postprocess() {length(cleaned)}, outside the object {length_outside(cleaned, image)}; ", end="")
        print(f"with the workaround {length(around)}")
        assert length_outside(joined, image) == 0 and length(joined) - length(around) <= 2, "changed: the workaround"
for blocks in (1, 2, 3):
    loops, before, after, _ = found["ring", blocks]
    assert (loops, after) == ((0, before) if blocks == 1 else (1, 0)), "changed: the ring"
    loops, before, after, outside = found["ring with a rod", blocks]
    if blocks == 1:
        assert loops == 0 and after == before and outside == 0, "changed: the ring with a rod in one block"
    else:
        assert loops == 1 and after < before / 2 and outside > 40, "changed: the ring with a rod"
END
env/bin/python look.py
