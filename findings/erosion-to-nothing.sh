#!/usr/bin/env bash
# Manifold 3.5.4: minkowski_difference() of a cube and an L-shaped tool is empty, and a.minkowski_sum(b) may
# differ from b.minkowski_sum(a).
#
# Versions: manifold3d 3.5.4.
# The documentation calls the two functions morphological erosion and dilation. 3.4.0 has them too.
# Internally, a convex part and a tool that is not convex change places, also for the difference.
# Otherwise the tool is swept over the surface of the part, and the part itself is then added.
#
# Expected, difference: the erosion by a union is the common part of the erosions. Here it has the volume 12.
# Expected, sum: the order of a sum does not matter. A tool that is moved moves the result.
# Seen, difference: a cube of size 4, eroded by an L of size 2, is empty. Its status is NoError.
# A cross and a pair of boxes also give nothing. The convex hulls of all three give 12, as do the two boxes of the L.
# Seen, sum: a large L plus a small one has the volume 890; the small one plus the large one has 734 and a void.
# Seen, place: a cube of size 2 plus a cube of size 1 has the volume 27 if the tool contains the origin.
# With the tool 10 away, the sum also contains the first cube (35), and the difference removes nothing (8, not 1).
#
# Affected: users who shrink parts for clearance, test whether a tool fits into a pocket, or compute the places
# where a robot collides. An empty result means "does not fit", so nothing looks wrong.
# Workaround: erode a convex part by the hull() of the tool. Else split the tool into convex parts that all contain
# the origin. Call the functions of the part with each of them, unite the sums, and intersect the differences.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check manifold3d==3.5.4 numpy==2.4.6
cat >look.py <<'END'
from importlib.metadata import version

import manifold3d

Manifold = manifold3d.Manifold


def box(low, high):
    return Manifold.cube([b - a for a, b in zip(low, high)]).translate(low)


def volume(body):
    assert body.status() == manifold3d.Error.NoError, "changed: there is an error now"
    return round(body.volume(), 6)


print("manifold3d", version("manifold3d"))

part = box((-2, -2, -2), (2, 2, 2))
tools = {
    "L": [box((-1, -1, -0.5), (1, 0, 0.5)), box((-1, -1, -0.5), (0, 1, 0.5))],
    "cross": [box((-1, -0.25, -0.5), (1, 0.25, 0.5)), box((-0.25, -1, -0.5), (0.25, 1, 0.5))],
    "pair": [box((-1, -1, -0.5), (-0.5, 1, 0.5)), box((0.5, -1, -0.5), (1, 1, 0.5))],
}
for name, (first, second) in tools.items():
    tool = first + second
    direct = volume(part.minkowski_difference(tool))
    hull = volume(part.minkowski_difference(tool.hull()))
    print(f"cube eroded by the {name}: {direct}; by its hull: {hull}")
    assert direct == 0 and hull == 12, "changed: the erosion of a convex part"
first, second = tools["L"]
both = volume(part.minkowski_difference(first) ^ part.minkowski_difference(second))
print("common part of the erosions by the two boxes of the L:", both)
assert both == 12, "changed: the erosion by convex tools"

small = first + second
large = box((0, 0, 0), (16, 4, 4)) + box((0, 0, 0), (4, 16, 4))
sums = volume(large.minkowski_sum(small)), volume(small.minkowski_sum(large))
boxes = volume(large.minkowski_sum(first) + large.minkowski_sum(second))
print(f"large L plus small L: {sums[0]}; small plus large: {sums[1]}; by the boxes of the small L: {boxes}")
assert sums == (890, 734) and boxes == 890, "changed: the order of a sum"

part = box((-1, -1, -1), (1, 1, 1))
for offset, expected in ((0, (27, 27, 1)), (10, (35, 27, 8))):
    tool = box((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)).translate((offset, 0, 0))
    found = (
        volume(part.minkowski_sum(tool)),
        volume(tool.minkowski_sum(part)),
        volume(part.minkowski_difference(tool)),
    )
    print(f"tool at x = {offset}: part plus tool {found[0]}, tool plus part {found[1]}, difference {found[2]}")
    assert found == expected, "changed: the place of the tool"
END
env/bin/python look.py
