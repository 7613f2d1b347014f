"""Proves the oracles of solids that are not convex: walls_oracle.py, profile_diagrams.py and nonconvex_families.py.

Areas and counts that are known by hand, the exact structure of convex solids, distances by brute force, volumes, and
both sides of each wall check them. Random balls and exact diagrams of profiles share no code, so they check each other.
"""

import decimal
import math
import pathlib
import subprocess
import sys

import nonconvex_families as families
import numpy as np
import pytest
import walls_oracle
from amount import EVERYTHING, some
from exact_structure import structure
from exact_structure_families import named_convex, notched_box, triangulate
from profile_diagrams import Diagram, _Levels, prism
from scipy import integrate
from walls_oracle import seams, sites_of, walls

# A part of all families: the whole takes four minutes.
SYMMETRIC = families.symmetric_profiles()
PROFILES = some(families.profiles()[::6], 5)
SOLIDS = [*families.named_blocks(), *families.dented_tetrahedra(), *families.spiked(), *families.with_voids()]
SOLIDS += [families.sheared(solid) for solid in families.named_blocks()] + families.random_blocks(6)
SOLIDS += [*(families.star_shapes()[:1] if EVERYTHING else []), notched_box()]


def by_name(items):
    return {"argvalues": items, "ids": lambda item: item.name}


def volume_of(solid):
    a, b, c = (solid.vertices[solid.triangles[:, k]] - solid.vertices[0] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def kinds_of(sites):
    kinds = [site.kind for site in sites.sites]
    return tuple(kinds.count(kind) for kind in ("face", "edge", "vertex"))


# Sites


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("box with a box boss", (11, 4, 0)),  # The boss stands on four reflex edges; no corner of it is closest.
        ("plate with a pocket", (11, 8, 4)),  # Four edges around the bottom, four upright; reflex corners below only.
        ("corner steps", (9, 3, 1)),
        ("box with a void", (12, 12, 8)),
        ("chair", (9, 3, 1)),
        ("table", (18, 8, 0)),
        ("cross of three bars", (30, 12, 0)),  # At the corners of the middle, three reflex and three convex sides meet.
    ],
)
def test_sites_of_known_solids(name, expected):
    for solid in families.named_blocks():
        if solid.name == name:
            assert kinds_of(sites_of(solid.vertices, solid.triangles)) == expected
            sheared = families.sheared(solid)
            assert kinds_of(sites_of(sheared.vertices, sheared.triangles)) == expected
            return
    pytest.fail(f"no solid is named {name}")


@pytest.mark.parametrize("solid", **by_name([*SOLIDS[::3], *(families.extruded(p, 0.5) for p in PROFILES[::3])]))
def test_variants_have_the_same_sites(solid):
    made, *others = families.variants(solid)
    sites = sites_of(made.vertices, made.triangles, made.tolerance)
    for other in others:
        again = sites_of(other.vertices, other.triangles, other.tolerance)
        assert again.sites == sites.sites, other.name
        assert [wall.pair for wall in again.own] == [wall.pair for wall in sites.own], other.name
        assert (again.hidden == sites.hidden).all(), other.name


def test_sites_have_the_numbers_of_blum():
    blum = pytest.importorskip("blum")
    for solid in SOLIDS[::4]:
        found = blum.voronoi_complex(solid.vertices, solid.triangles, method="cubes", resolution=2, depth=1).sites()
        numbers = [
            (site.kind, tuple((site.triangles if site.kind == "face" else site.vertices).tolist())) for site in found
        ]
        assert numbers == [tuple(site) for site in sites_of(solid.vertices, solid.triangles).sites], solid.name


def test_solids_are_refused():
    solid = SOLIDS[0]
    with pytest.raises(ValueError, match="has one triangle"):
        sites_of(solid.vertices, solid.triangles[1:])
    with pytest.raises(ValueError, match="on one side"):
        sites_of(solid.vertices, np.vstack([solid.triangles, solid.triangles[:1]]))
    with pytest.raises(ValueError, match="grows without end"):
        walls(solid.vertices, solid.triangles[:, ::-1], 1000)
    flat = solid.vertices.copy()
    flat[:] = flat[0]
    with pytest.raises(ValueError, match="has no area"):
        sites_of(flat, solid.triangles)


# Walls of solids that are known by hand


def check(found, pair, area, relative=0.01):
    """A wall has an area, within five standard errors and at least a stated fraction of it."""
    measured, error = found.areas()[pair]
    assert error < relative * area, pair
    assert measured == pytest.approx(area, abs=5 * error), pair


@pytest.mark.parametrize("name", ["box 3 x 2 x 1", "wedge 0.5, 1", "wedge 3, 0.1", "octahedron", "pyramid 4, 1"])
def test_walls_of_convex_solids(name):
    """Areas of planes: the exact sheets."""
    solid = triangulate(next(shape for shape in named_convex() if shape.name == name))
    exact, found = structure(solid.vertices, solid.triangles), walls(solid.vertices, solid.triangles, 50_000)
    assert sorted(found.areas()) == sorted(tuple(sorted(sheet.faces)) for sheet in exact.sheets)
    for sheet in exact.sheets:
        check(found, tuple(sorted(sheet.faces)), sheet.area, 0.03)
    assert found.volumes == pytest.approx(exact.regions, rel=0.01)


def test_walls_of_the_angle():
    """The L of widths 1 with legs of 3 and 2.5 and the length 4: planes and parabolic cylinders in closed form.

    The bottom (0, x = 0..3), the left side and the corner (1, 1) are equally far from (a, a) with a = 2 - sqrt(2).
    Between (a, a) and (1, 1/2) runs the parabola y = (u^2 + 1) / 2 with u = x - 1. Its wall has the height 4 - 2 y.
    """
    solid, height, root = families.extruded(families.angle(), 4.0), 4.0, math.sqrt(2)
    found = walls(solid.vertices, solid.triangles, 400_000)
    bottom, right, under, inner, top, left, edge = range(2, 9)
    a, c = 2 - root, root - 1
    slope = math.sqrt(1 + c * c)
    length = (c * slope + math.asinh(c)) / 2
    moment = (c * (2 * c * c + 1) * slope - math.asinh(c)) / 8  # The integral of u^2 sqrt(1 + u^2).
    parabola = (height - 1) * length - moment
    below = a * a / 2 + (c + c**3 / 3) / 2  # The part of the bottom's region left of x = 1.
    known = {
        (bottom, edge): parabola,
        (left, edge): parabola,
        (bottom, left): root * (height * a - a * a),
        (bottom, under): (height - 1) * 1.5,
        (inner, left): (height - 1) * 1.0,
        (under, edge): height / 2 - 1 / 4,
        (inner, edge): height / 2 - 1 / 4,
    }
    known |= dict.fromkeys(((bottom, right), (right, under), (inner, top), (top, left)), root * (height / 2 - 1 / 4))
    regions = {
        bottom: below + 1.5 / 2 + 1 / 8,
        right: 1 / 4,
        under: 1.5 / 2 + 1 / 8,
        inner: 1.0 / 2 + 1 / 8,
        top: 1 / 4,
        left: below + 1.0 / 2 + 1 / 8,
        edge: 1 - 2 * below,
    }
    known |= {(cap, side): root * area for side, area in regions.items() for cap in (0, 1)}
    assert sorted(found.areas()) == sorted(known)
    for pair, area in known.items():
        check(found, pair, area, 0.004)
    exact = prism(Diagram(families.angle().loops), height)
    assert exact.areas == pytest.approx(known, rel=1e-12)


def test_walls_of_a_corner():
    """Around the reflex vertex of a notched cube: paraboloids, parabolic cylinders, and own walls in closed form."""
    solid = notched_box(4.0, 2.0)  # The cube of side 4 without the one of side 2 whose inner corner is (2, 2, 2).
    found = walls(solid.vertices, solid.triangles, 300_000)
    sites = found.sites
    edges, corner = (9, 10, 11), 12
    assert kinds_of(sites) == (9, 3, 1)

    # The vertex and the plane z = 0: z = 1 + (u^2 + w^2) / 4 with u = 2 - x and w = 2 - y, while x and y are above z.
    def area(u, w):
        return math.sqrt(1 + (u * u + w * w) / 4)

    paraboloid = 2 * integrate.dblquad(area, 0, math.sqrt(3) - 1, lambda w: w, lambda w: math.sqrt(8 - w * w) - 2)[0]
    far = np.flatnonzero(np.abs(sites.normals @ (2 - solid.vertices[0]) - sites.offsets) < 2 + 1e-9)
    far = [f for f in far.tolist() if sites.normals[f].sum() < 0 and abs(sites.offsets[f]) < 1e-9]
    assert len(far) == 3
    # In the plane across an edge through the vertex, the points of the square (0, 2)^2 closest to (2, 2).
    sector = integrate.quad(lambda turn: (2 / (1 + math.cos(turn))) ** 2, 0, math.pi / 4)[0]
    for f in far:
        check(found, (f, corner), paraboloid)
    for e in edges:
        check(found, (e, corner), sector, 1e-3)
        for f in sites.faces_of_edge[e - 9]:
            check(
                found, (f, e), 1.5, 1e-3
            )  # Up to the middle between the edge and the far side, but for the edge's end.


# Walls of all solids


@pytest.mark.parametrize("solid", **by_name(SOLIDS[::5]))
def test_volumes_and_both_sides(solid):
    """Regions fill the solid. Both sites of each wall see the same area, with other weights."""
    found = walls(solid.vertices, solid.triangles, 40_000)
    total, error = found.volumes.sum(), np.linalg.norm(found.errors)
    assert found.volumes.min() > 0
    assert total == pytest.approx(volume_of(solid), abs=5 * error)
    assert error < 0.005 * total
    checked = 0
    for pair, wall in found.walls.items():
        if wall.hits > 40:
            assert wall.sides[0] == pytest.approx(wall.sides[1], abs=6 * math.hypot(*wall.errors)), pair
            checked += 1
    assert 2 * checked > len(found.sites.sites)


def distances(points, solid):
    """Distances from the border, triangle by triangle: from planes, sides and corners."""
    out = np.full(len(points), np.inf)
    for a, b, c in solid.vertices[solid.triangles]:
        normal = np.cross(b - a, c - a) / np.linalg.norm(np.cross(b - a, c - a))
        inside = np.ones(len(points), dtype=bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, points - p) @ normal >= 0
            t = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            out = np.minimum(out, np.linalg.norm(points - p - t[:, None] * (q - p), axis=1))
        out[inside] = np.minimum(out[inside], np.abs((points[inside] - a) @ normal))
    return out


@pytest.mark.parametrize("solid", **by_name(SOLIDS[::4]))
def test_balls_are_maximal(solid):
    """No border lies inside a ball. The contacts with both sites lie on the border."""
    rng = np.random.default_rng(3)
    sites = sites_of(solid.vertices, solid.triangles)
    search, origin = walls_oracle._Search(sites), solid.vertices[0]
    for k, base in enumerate(sites.bundles):
        places = walls_oracle._in_cells(walls_oracle._cells(base, 60, rng), rng)
        p, m = walls_oracle._contacts(sites, k, places)
        radii, stop, contacts = search.grow(k, p, m)
        centres = p + radii[:, None] * m
        assert (stop != k).all()
        assert np.linalg.norm(m, axis=1) == pytest.approx(1)
        assert np.linalg.norm(centres - contacts, axis=1) == pytest.approx(radii)
        assert distances(centres + origin, solid) == pytest.approx(radii, rel=1e-9)
        assert distances(np.concatenate([p, contacts]) + origin, solid) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("solid", **by_name(some([SOLIDS[0], SOLIDS[7], families.sheared(SOLIDS[9]), SOLIDS[20]], 2)))
def test_variants_have_the_same_walls(solid):
    made, *others = families.variants(solid)
    exact = walls(made.vertices, made.triangles, 100_000)
    for other in others:
        found = walls(other.vertices, other.triangles, 20_000, 2, other.tolerance)
        scale = 1e6 if other.name.endswith("tiny") else 1.0
        for pair, (area, error) in exact.areas().items():
            if area > 2 * scale**2 * found.smallest(pair):
                again, spread = (x * scale**2 for x in found.areas()[pair])
                assert again == pytest.approx(area, abs=6 * math.hypot(error, spread)), (other.name, pair)


# Profiles


@pytest.mark.parametrize(
    ("loops", "arcs", "nodes"),
    [
        ([[(0, 0), (3, 0), (3, 2), (0, 2)]], 5, 2),
        ([[(0, 0), (2, 0), (2, 2), (0, 2)]], 4, 1),  # All four sides are closest to the middle.
        ([[(0, 0), (8, 0), (0, 6)]], 3, 1),
        # L: the bisector of the corner, two parabolas, two bisectors of legs, four at their ends, two own walls.
        (families.angle().loops, 11, 5),
        # Square ring: four bisectors of outer corners, and four of facing sides. Each inner corner has two parabolas
        # and two own walls.
        (families.frame().loops, 24, 12),
        # Plus: five points with four closest sites, four of them with two own walls.
        (families.plus().loops, 24, 9),
    ],
)
def test_diagrams_of_known_profiles(loops, arcs, nodes):
    assert Diagram(loops).counts() == (arcs, nodes)


@pytest.mark.parametrize("profile", **by_name(PROFILES))
def test_nodes_are_closest_to_their_sites(profile):
    """Floats and samples of the border confirm nodes and arcs."""
    diagram, corners = Diagram(profile.loops), profile.corners()
    t = np.linspace(0, 1, 400, endpoint=False)[:, None]
    border = np.concatenate([corners[k] + t * (corners[diagram.after[k]] - corners[k]) for k in range(len(corners))])
    assert diagram.nodes
    for node in diagram.nodes:
        nearest = np.linalg.norm(border - np.array(node.position, dtype=float), axis=1).min()
        assert float(node.distance) <= nearest + 1e-12
        assert float(node.distance) == pytest.approx(nearest, rel=1e-3)
        assert len(node.sites) > 2
    regions = {s for arc in diagram.arcs for s in arc.sites}
    assert regions == set(range(len(diagram.sites)))


@pytest.mark.parametrize("height", [0.25, 1.0, 1.5, 2.0, 6.0, 20.0])
@pytest.mark.parametrize(
    "outline", [((3, 0), (3, 2), (0, 2)), ((2, 0), (2, 2), (0, 2)), ((8, 0), (0, 6)), ((5, 1), (1, 4))]
)
def test_convex_prisms_have_their_exact_structure(outline, height):
    """Counts, sets of sites and areas are those of the polytope in four dimensions, degenerate or not."""
    profile = families.Profile("convex", [[(0, 0), *outline]])
    solid, found = families.extruded(profile, height), prism(Diagram(profile.loops), height)
    exact = structure(solid.vertices, solid.triangles)
    assert found.counts() == exact.counts()
    assert sorted(found.sheets) == sorted(tuple(sorted(sheet.faces)) for sheet in exact.sheets)
    assert sorted(found.seams.elements()) == sorted(tuple(sorted(seam.faces)) for seam in exact.seams)
    assert sorted(found.junctions.elements()) == sorted(tuple(sorted(junction.faces)) for junction in exact.junctions)
    for sheet in exact.sheets:
        assert found.areas[tuple(sorted(sheet.faces))] == pytest.approx(sheet.area, rel=1e-9, abs=1e-12)


def test_cube():
    assert prism(Diagram([[(0, 0), (2, 0), (2, 2), (0, 2)]]), 2).counts() == (12, 8, 9)


@pytest.mark.parametrize(
    ("profile", "height", "expected"),
    [
        # Long prisms: sheets = 2 sites + arcs, seams = 2 arcs + nodes, junctions = 2 nodes + 2 corners.
        (families.angle(), 8, (14 + 11, 22 + 5, 10 + 12)),
        (families.frame(), 8, (24 + 24, 48 + 12, 24 + 16)),
        (families.plus(), 8, (32 + 24, 48 + 9, 18 + 24)),
        # Thin plates: two sheets for each site and one in the middle; one for each corner, two for a reflex one.
        # Two seams for each of the latter sheets, one at its inner end on the level, and as many junctions there.
        (families.angle(), 0.25, (14 + 5 + 2 + 1, 3 * 7, 7 + 12)),
        (families.frame(), 0.25, (24 + 4 + 8 + 1, 3 * 12, 12 + 16)),
        (families.four_holes(), 0.25, (72 + 4 + 32 + 1, 3 * 36, 36 + 40)),
    ],
    ids=lambda value: getattr(value, "name", str(value)),
)
def test_counts_of_known_prisms(profile, height, expected):
    found = prism(Diagram(profile.loops), height)
    assert found.counts() == expected
    edges = len(Diagram(profile.loops).reflex)
    assert found.counts("seams") == (expected[0], expected[1] + edges, expected[2])
    assert found.counts("joined") == (expected[0], expected[1] - 2 * edges, expected[2] - 2 * edges)


def euler_of_middle(diagram, height):
    """The Euler number of the open middle sheets. They retract to the nodes and arcs above the level."""
    with decimal.localcontext(prec=60):
        levels = _Levels(diagram, decimal.Decimal(height))
        above = [a for a in diagram.arcs if levels.compared(a.least) > 0 and min(map(levels.compared, a.distances)) > 0]
        return sum(side > 0 for side in levels.side) - len(above)


@pytest.mark.parametrize("height", [8.0, 1.0, 0.25, 0.8125])
@pytest.mark.parametrize("profile", **by_name(PROFILES))
def test_counts_of_prisms_obey_euler(profile, height):
    """Regions, sheets, seams, junctions and parts of the surface cut the solid, so their Euler numbers add up.

    These are numbers with compact supports. An open curve has -1, a disc 1 and a ball -1. The caps have holes, and with
    them their regions and the middle sheet.
    """
    diagram = Diagram(profile.loops)
    found, n, reflex, cap = prism(diagram, height), len(diagram.corners), len(diagram.reflex), 1 - diagram.holes
    sheets, curves, points = found.counts()
    sheets += euler_of_middle(diagram, height) - found.sheets[0, 1]
    curves += 3 * n  # Edges of the polyhedron.
    faces, regions = n + 2 * cap, n + reflex + 2 * cap
    assert points - curves + sheets + faces - regions == cap


@pytest.mark.parametrize("height", some([1.0, 8.0, 0.25, 0.8125], 2))
@pytest.mark.parametrize("profile", **by_name(PROFILES))
def test_balls_find_the_walls_of_prisms(profile, height):
    """Random balls find the pairs and areas of the exact diagram, and no others."""
    solid, exact = families.extruded(profile, height), prism(Diagram(profile.loops), height)
    found = walls(solid.vertices, solid.triangles, 20_000)
    areas = found.areas()
    assert set(areas) <= set(exact.areas)
    assert set(exact.areas) == set(exact.sheets)
    for pair, area in exact.areas.items():
        measured, error = areas.get(pair, (0.0, 0.0))
        if pair in areas:
            assert measured == pytest.approx(area, abs=6 * error), pair
        else:
            assert area < found.smallest(pair), pair


@pytest.mark.parametrize("height", some([1.0, 8.0], 1))
@pytest.mark.parametrize("profile", **by_name(PROFILES[::3]))
def test_balls_find_the_seams_of_prisms(profile, height):
    """Sets of sites between balls are those of exact seams, or parts of degenerate ones, or of junctions."""
    solid, exact = families.extruded(profile, height), prism(Diagram(profile.loops), height)
    found = seams(solid.vertices, solid.triangles, 20_000)
    known = [set(own) for own in (*exact.seams, *exact.junctions)]
    for own, (_, point) in found.items():
        assert any(set(own) <= other for other in known), own
        assert distances(np.array([point]), solid) > 0
    assert len(set(found) & set(exact.seams)) > 0.6 * len(exact.seams)


def test_degenerate_profiles():
    """Which profiles have points with more than three closest sites."""
    degenerate = {profile.name for profile in SYMMETRIC if Diagram(profile.loops).is_degenerate()}
    assert degenerate == {
        "T",
        "plus",
        "H",
        "comb",
        "stairs",
        "Z, wide web",
        "plate with two holes",
        "plate with four holes",
    }


# Use by hand


def test_script_prints_walls(tmp_path):
    solid = families.named_blocks()[7]
    file, script = tmp_path / "solid.off", pathlib.Path(walls_oracle.__file__)
    walls_oracle.write_off(file, solid.vertices, solid.triangles)
    vertices, triangles = walls_oracle.read_off(file)
    assert (vertices == solid.vertices).all()
    assert (triangles == solid.triangles).all()
    run = subprocess.run([sys.executable, script, file, "--count", "5000"], capture_output=True, text=True, check=True)
    lines = run.stdout.splitlines()
    assert lines[0] == "9 faces, 3 reflex edges, 1 reflex vertices"
    found = walls(vertices, triangles, 5000)
    (pair, wall), *_ = found.walls.items()
    line = next(line for line in lines if line.startswith(f"face {pair[0]} / face {pair[1]} "))
    assert float(line.split()[5]) == pytest.approx(wall.area, rel=1e-6)
    assert any(line.startswith("all ") for line in lines)
