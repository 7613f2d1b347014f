"""Proves that certified Voronoi diagrams of hostile solids are correct, and that their medial axes are certified.

The volume of a region agrees with searches of closest sites at random points. The Euler number agrees with the Betti
numbers. Half of the pairs of families and ways are tested, all if BLUM_TESTS is "all". The environment variable
BLUM_CONE_SOLIDS sets the number of solids (default 50), of which all are then tested."""

import os

import blum
import numpy as np
import pytest
from amount import EVERYTHING
from made.cones import FAMILIES, WAYS, cone_solid

CHOSEN = range(int(os.environ.get("BLUM_CONE_SOLIDS", "50")))
if "BLUM_CONE_SOLIDS" not in os.environ and not EVERYTHING:
    CHOSEN = [seed for seed in CHOSEN if (seed + seed // 10) % 2 == 0]
#: Needles that need smaller cubes than the limits allow.
MAY_FAIL = {("fine_pyramid", way) for way in WAYS} | {("fine_dent", way) for way in WAYS} | {("thin", way) for way in WAYS}


def euler_number(complex):
    t = complex.triangles
    edges = np.unique(np.sort(np.vstack([t[:, :2], t[:, 1:], t[:, ::2]]), axis=1), axis=0)
    return len(np.unique(t)) - len(edges) + len(t)


def closest_sites(mesh, sites, points):
    """The number of each point's closest site; -1 if a vertex is closest that is not a site of the diagram."""
    of = {("face", int(t)): number for number, site in enumerate(sites) for t in site.triangles}
    beside = {}
    for t, corners in enumerate(mesh.triangles.tolist()):
        for k in range(3):
            beside.setdefault(tuple(sorted((corners[k - 1], corners[k]))), set()).add(of["face", t])
    for number, site in enumerate(sites):
        ends = tuple(sorted(map(int, site.vertices)))
        if site.kind == "edge" and len(beside[ends]) == 2:  # an edge inside a joined face is not a site of the diagram
            of["edge", ends] = number
        if site.kind == "vertex":
            of["vertex", int(site.vertices[0])] = number
    table, found = blum.Sites(mesh), blum.closest_points(mesh, points)
    kinds, places = table.kind(found.site), table.index(found.site)
    out = np.full(len(points), -1)
    for k, (kind, place) in enumerate(zip(kinds, places, strict=True)):
        face = of["face", int(found.triangle[k])]
        if kind == "vertex":
            out[k] = of.get(("vertex", int(place)), -1)
        elif kind == "edge":  # an edge inside a flat face is not a site of the diagram
            out[k] = of.get(("edge", tuple(sorted(map(int, table.edges[place])))), face)
        else:
            out[k] = face
    return out


def valid_solid(seed):
    """The first solid of the seed's family, from the seed on, that was triangulated and does not cross itself."""
    for further in range(20):
        made = cone_solid(seed + 50 * further)
        mesh = made and blum.Mesh(made.vertices, made.triangles)
        if made and blum.topology(mesh).betti and not len(blum.self_intersections(mesh).pairs):
            return made, mesh
    raise AssertionError(f"no solid of seed {seed}")


@pytest.mark.parametrize("seed", CHOSEN, ids=lambda s: f"{FAMILIES[s % 10]}-{WAYS[s // 10 % 5]}-{s}")
def test_certified_diagrams_are_correct(seed):
    made, mesh = valid_solid(seed)
    expected = blum.topology(mesh).betti
    found = blum.voronoi_complex(mesh, max_cubes=60_000)
    if not found.report.certified:
        assert (made.family, made.way) in MAY_FAIL
        return
    betti = found.homology()
    assert euler_number(found) == betti[0] - betti[1] + betti[2]
    low, high = made.vertices.min(axis=0), made.vertices.max(axis=0)
    points = np.random.default_rng(seed).uniform(low, high, (10_000, 3))
    points = points[blum.Solid(mesh).inside(points)]
    sites = found.sites()
    closest = closest_sites(mesh, sites, points)
    assert (closest < 0).mean() < 0.02
    part = np.prod((high - low) / (high - low).max()) / 10_000  # volume for each point, if the largest side is 1
    size = (high - low).max()
    counts = np.bincount(closest[closest >= 0], minlength=len(sites))
    bound = found.report.chord if found.report.traced else found.report.hausdorff_bound
    for region in found.regions():
        count = counts[region.site]
        area = (region.surface_area + sum(other.area for other in region.neighbours)) / size**2
        expected_count = max(region.volume / size**3 / part, count)
        allowed = part * (5 * np.sqrt(expected_count + 1) + (closest < 0).sum()) + area * bound / size / 2
        assert abs(region.volume / size**3 - count * part) <= allowed, region.site

    axis = blum.voronoi_complex(mesh, part="medial", max_cubes=60_000)
    if not axis.report.certified:
        assert (made.family, made.way) in MAY_FAIL
        return
    assert axis.homology() == expected
    thinned = axis.medial_axis(1)
    assert thinned.certificate.holds, thinned.certificate.mismatches
