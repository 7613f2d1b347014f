"""Proves that the made solids (tests/made) are embedded and have the stated Betti numbers.

Manifold, their shells, their construction and Blum agree on these numbers. Tests the first 40, one of each family, or
all 300 if the environment variable BLUM_MADE_SOLIDS is 300 (two minutes)."""

import json
import os
import subprocess
import sys
from pathlib import Path

import blum
import numpy as np
import pytest
from made import made_solid, made_solids, names
from made.embedded import bad_pairs
from made.shapes import FAMILIES, arrays_of, block, joined, manifold_of

COUNT = int(os.environ.get("BLUM_MADE_SOLIDS", "40"))
TESTS = Path(__file__).resolve().parents[1]
CHOSEN = names()[:COUNT]


def betti_of_manifold(vertices, triangles):
    parts = manifold_of(vertices, triangles).decompose()
    volumes = [part.volume() for part in parts]
    return sum(v > 0 for v in volumes), sum(part.genus() for part in parts), sum(v < 0 for v in volumes)


def test_there_are_300_solids_of_all_families():
    assert len(names()) == len(set(names())) == 300
    assert {family for family, _ in names()[:40]} == set(FAMILIES)
    some = list(made_solids(5))
    assert [solid.name for solid in some] == [f"{family}-{variant}" for family, variant in names()[:5]]


@pytest.mark.parametrize("family, variant", CHOSEN, ids=[f"{family}-{variant}" for family, variant in CHOSEN])
def test_betti_numbers_agree_between_all_methods(family, variant):
    made = made_solid(family, variant)
    assert made.vertices.dtype == np.float64 and np.isfinite(made.vertices).all()
    assert made.stated in (None, made.betti)
    assert betti_of_manifold(made.vertices, made.triangles) == made.betti
    solid = blum.Solid(made.vertices, made.triangles)
    assert (solid.rule, solid.betti) == ("polyhedron", made.betti), solid.reason
    assert (solid.reversed_shells, solid.reversed_triangles) == (0, 0)
    if COUNT == 300 or len(made.triangles) < 500:
        assert bad_pairs(made.vertices, made.triangles) == []


@pytest.mark.parametrize("family, variant", CHOSEN[::8])
def test_solids_are_reproducible(family, variant):
    first, second = made_solid(family, variant), made_solid(family, variant)
    assert first.vertices.tobytes() == second.vertices.tobytes()
    assert first.triangles.tobytes() == second.triangles.tobytes()


def octahedron(at):
    vertices = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]) / 2 + at
    ring = [(0, 2), (2, 1), (1, 3), (3, 0)]
    return vertices, np.array([(a, b, 4) for a, b in ring] + [(b, a, 5) for a, b in ring])


@pytest.mark.parametrize(
    "other",
    [
        octahedron((0, 0, 0.5)),  # A corner on a face, from inside.
        octahedron((1.5, 0.5, 0.5)),  # A corner on a face, from outside.
        octahedron((1, 0.1, 0.2)),  # A corner through a face.
        arrays_of(block((1, 0, -0.5), (2, 2, 0.5))),  # Face on face.
        arrays_of(block((1, 1, 0.5), (2, 2, 2))),  # Edge across edge.
        arrays_of(block((1, 1, 1), (2, 2, 2))),  # Corner on corner.
    ],
)
def test_solids_that_touch_are_not_embedded(other):
    one = arrays_of(block((-1, -1, -1), (1, 1, 1)))
    assert bad_pairs(*one) == []
    apart = joined(one, (other[0] + [3, 3, 3], other[1]))
    assert bad_pairs(*apart) == []
    assert bad_pairs(*joined(one, other)) != []


def test_blum_and_the_exact_test_agree_on_contacts():
    rng = np.random.default_rng(7)
    found = []
    for _ in range(300):
        vertices, triangles = octahedron((0, 0, 0))
        vertices = 4 * vertices + rng.integers(-2, 3, vertices.shape)  # small integers give coplanar points
        if len(np.unique(vertices, axis=0)) == len(vertices):
            solid = blum.Solid(vertices, triangles)
            found.append((bad_pairs(vertices, triangles) == [], solid.rule == "polyhedron" and solid.resolved is None))
    assert all(ours == blums for ours, blums in found)
    assert 0.1 < np.mean([ours for ours, _ in found]) < 0.9


def test_the_program_writes_the_solids_exactly(tmp_path):
    command = [sys.executable, "-m", "made", str(tmp_path), "--count", "3"]
    paths = os.pathsep.join([str(Path(blum.__file__).parents[1]), str(TESTS)])
    done = subprocess.run(command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("3 solids")
    manifest = json.loads((tmp_path / "manifest.json").read_text())
    for made, entry in zip(made_solids(3), manifest, strict=True):
        read = blum.read_mesh(tmp_path / entry["file"])
        assert np.array_equal(read.vertices, made.vertices) and np.array_equal(read.triangles, made.triangles)
        assert (entry["name"], entry["family"], tuple(entry["betti"])) == (made.name, made.family, made.betti)
