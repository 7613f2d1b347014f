"""Compares Voronoi diagrams of convex solids with an oracle that does not use Blum, sheet by sheet and seam by seam."""

import itertools

import blum
import numpy as np
import pytest
from amount import number, some
from exact_structure import structure
from exact_structure_families import named_convex, random_convex, triangulate, variants

# Coordinates with errors of `tolerance` determine no structure of parts smaller than this many tolerances.
UNCLEAR = 200


def walls_of(solid):
    """If all coordinates are intended, nothing may be joined."""
    options = {"flatness": 0.0} if solid.tolerance == 0 else {}
    made = blum.voronoi_complex((solid.vertices, solid.triangles), part="walls", **options)
    assert made.report.exact, solid.name
    assert made.report.certified, solid.name
    return made


def is_clear(solid, exact):
    """If the oracle is certain, and no junctions are so close that rounding may have joined or parted them."""
    if exact.unclear:
        return False
    places = np.array([junction.position for junction in exact.junctions])
    if solid.tolerance == 0:
        return True
    distances = np.linalg.norm(places[:, None] - places[None], axis=2)
    return (distances + np.eye(len(places))).min() > UNCLEAR * solid.tolerance


def check(solid):
    """Compares all sheets, seams and junctions. Returns false if the solid's structure is not clear."""
    exact = structure(solid.vertices, solid.triangles, solid.tolerance)
    if not is_clear(solid, exact):
        return False
    made = walls_of(solid)
    graph = made.graph()
    found = len(graph.walls), len(graph.seams), len(graph.junctions)
    assert found == tuple(exact.counts()), solid.name
    size = np.ptp(solid.vertices, axis=0).max()
    # A face that was joined to another has no triangles of its own.
    face = {k: exact.face_of[site.triangles[0]] for k, site in enumerate(made.sites()) if len(site.triangles)}
    areas = {frozenset((face[wall.site_a], face[wall.site_b])): wall.area for wall in graph.walls}
    assert areas.keys() == {frozenset(sheet.faces) for sheet in exact.sheets}, solid.name
    for sheet in exact.sheets:
        assert areas[frozenset(sheet.faces)] == pytest.approx(sheet.area, rel=1e-6, abs=1e-6 * size**2), solid.name
    lengths = sorted((sorted({face[s] for s in seam.sites}), seam.length) for seam in graph.seams)
    expected = sorted((sorted(seam.faces), seam.length) for seam in exact.seams)
    for (faces, length), (expected_faces, expected_length) in zip(lengths, expected, strict=True):
        assert faces == expected_faces, solid.name
        assert length == pytest.approx(expected_length, rel=1e-6, abs=1e-6 * size), solid.name
    return True


def test_random_polyhedra_have_the_exact_structure():
    for shape in some(random_convex(1000, seed=47), 200):
        assert check(triangulate(shape)), shape.name


def test_random_polyhedra_keep_their_structure_when_they_move():
    solids = [solid for shape in random_convex(number(100, 30), seed=48) for solid in variants(shape)]
    clear = sum(check(solid) for solid in solids)
    assert clear > 0.95 * len(solids)


@pytest.mark.parametrize("way", ["fan", "refined"])
def test_named_solids_have_the_exact_structure_however_they_lie(way):
    shapes = some(named_convex(), 50 if way == "fan" else 20)
    solids = list(itertools.chain.from_iterable(variants(shape, way) for shape in shapes))
    clear = sum(check(solid) for solid in solids)
    assert clear > 0.95 * len(solids)
