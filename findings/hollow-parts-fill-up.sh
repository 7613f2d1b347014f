#!/usr/bin/env bash
# Manifold 3.5.4: decompose() of a hollow part returns a full part and a solid of negative volume.
#
# Versions: manifold3d 3.5.4.
# decompose() returns "a vector of Manifolds that are topologically disconnected", and its documentation
# calls it "the inverse operation of Compose". It separates surfaces, not bodies.
#
# Expected: a box with a void is one body, so the list has one entry with volume 7.
# Expected: compose(decompose(x)), and the union of the parts, is x.
# Seen: the list has two entries with the volumes 8 and -1, both without an error.
# Two such boxes give four entries; nothing in the list assigns a void to its box.
# compose() of the list gives the volume 8, so the void is filled. So does batch_boolean() with Add, which
# compose's deprecation recommends.
# Subtracting the void from the box gives 9.
#
# Affected: users who split build plates or assemblies into parts. Hollow parts print full, and counts of
# parts are too large. Sums of volumes are right only because the errors cancel.
# Workaround: assign each part of negative volume to the smallest part of positive volume around it, and
# subtract its complement, the same surface reversed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check manifold3d==3.5.4 numpy==2.4.6
cat >look.py <<'END'
import warnings

import manifold3d

warnings.simplefilter("ignore")
Manifold = manifold3d.Manifold
hollow = Manifold.cube((2, 2, 2), True) - Manifold.cube((1, 1, 1), True)


def volumes(parts):
    return sorted(round(part.volume(), 6) for part in parts)


parts = hollow.decompose()
print("hollow box:", round(hollow.volume(), 6), "its parts:", volumes(parts))
assert round(hollow.volume(), 6) == 7 and all(part.status() == manifold3d.Error.NoError for part in parts)
assert volumes(parts) == [-1, 8], "changed: the parts of a hollow box"

pair = hollow + hollow.translate((5, 0, 0))
print("two hollow boxes:", round(pair.volume(), 6), "their parts:", volumes(pair.decompose()))
assert round(pair.volume(), 6) == 14 and volumes(pair.decompose()) == [-1, -1, 8, 8]

composed = Manifold.compose(parts).volume()
united = Manifold.batch_boolean(parts, manifold3d.OpType.Add).volume()
less = (max(parts, key=Manifold.volume) - min(parts, key=Manifold.volume)).volume()
print(f"composed {composed:.6g}, united {united:.6g}, one less the other {less:.6g}")
assert [round(v, 6) for v in (composed, united, less)] == [8, 8, 9], "changed: parts put together again"
END
env/bin/python look.py
