"""Proves the oracles of structures and walls (exact_structure.py, exact_walls.py) without Blum.

Known answers, brute force, Euler's relation, volumes and random maximal balls check the structure of convex polyhedra.
Distances to triangles, volumes, and the two sides of each wall, check the search for walls of other solids.
"""

import decimal
import itertools
import math

import exact_structure_families as families
import numpy as np
import pytest
from amount import EVERYTHING, some
from exact_signs import ExactPlanes, root_sum_sign
from exact_structure import _Exact, _polytope, _walk, structure
from exact_structure_families import TRIANGULATIONS, triangulate, variants
from exact_walls import maximal_balls, sites_of, walls_of
from made import made_solid

CONVEX = families.named_convex()
RANDOM = families.random_convex(60, seed=11)
PLATONIC = {shape.name: shape for shape in families.platonic()}


def structure_of(solid):
    return structure(solid.vertices, solid.triangles, solid.tolerance)


def volume_of(solid):
    a, b, c = (solid.vertices[solid.triangles[:, k]] - solid.vertices[0] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def named(name):
    return next(shape for shape in CONVEX if shape.name == name)


# Exact signs


def test_sums_of_roots_have_exact_signs():
    assert root_sum_sign([1, -2], [8, 2]) == 0
    assert root_sum_sign([1, 1, -1], [2, 8, 18]) == 0
    assert root_sum_sign([1, -1, 3, -3], [2, 3, 3, 2]) == 1
    big = 10**300
    assert root_sum_sign([1, -big], [big * big + 1, 1]) == 1
    assert root_sum_sign([-1, big], [big * big + 1, 1]) == -1
    rng = np.random.default_rng(5)
    with decimal.localcontext(prec=200):
        for _ in range(300):
            factors = [int(x) for x in rng.integers(-20, 21, size=4)]
            radicands = [int(x) for x in rng.integers(1, 40, size=4)]
            total = sum(c * decimal.Decimal(s).sqrt() for c, s in zip(factors, radicands, strict=True))
            expected = 0 if abs(total) < decimal.Decimal("1e-150") else int(total.copy_sign(total).compare(0))
            assert root_sum_sign(factors, radicands) == expected


@pytest.mark.parametrize(("height", "expected"), [(10, 0), (11, 1), (9, -1)])
def test_sides_of_planes_are_exact(height, expected):
    """A box of half widths 10, 10 and `height`: four sides meet in the ball of radius 10 that touches the top."""
    normals = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    planes = ExactPlanes(normals, [10, 10, 10, 10, height, height])
    assert planes.point((0, 2, 3, 4)) == pytest.approx([0, 0, height - 10, 10])
    assert planes.side((0, 2, 3, 4), 1) == 0
    assert planes.side((0, 2, 3, 4), 5) == expected
    assert planes.side((0, 2, 3, 4), 6) == 1
    assert planes.side((0, 2, 3, 5), 4) == expected


# Known answers


KNOWN = {
    "box 3 x 2 x 1": (13, 12, 12),
    "box 1 x 1 x 1": (12, 8, 9),
    "box 1 x 0.5 x 0.5": (12, 9, 10),
    "box 1 x 1 x 0.1": (13, 12, 12),
    "box 1 x 0.0001 x 0.0001": (12, 9, 10),
    **{f"triangular prism {t:g}": (9, 7, 8) for t in families.THICKNESSES},
    "prism 6, 0.1": (19, 18, 18),
    "prism 6, 1.73": (18, 12, 13),
    "prism 6, 10": (18, 13, 14),
    "pyramid 4, 1": (8, 5, 6),
    "tetrahedron": (6, 4, 5),
    "cube": (12, 8, 9),
    "octahedron": (12, 6, 7),
    "dodecahedron": (30, 20, 21),
    "icosahedron": (30, 12, 13),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_counts(name):
    found = structure_of(triangulate(named(name)))
    assert found.counts() == KNOWN[name]
    assert not found.unclear


def test_hull_of_five_points():
    shape = families.random_hulls(1, seed=4, fewest=6, most=6)[0]
    assert len(shape.vertices) == 5
    assert structure_of(triangulate(shape)).counts() == (12, 10, 8)


def test_box_is_measured_right():
    """Box 3 x 2 x 1: a middle rectangle 2 x 1, and trapezoids or triangles at 45 degrees along the edges."""
    found = structure_of(triangulate(families.box(3, 2, 1)))
    half = 0.5**0.5
    areas = sorted(sheet.area for sheet in found.sheets)
    # Edges of length 3 and 2 shrink by 1 over the height 1/2; edges of length 1 shrink to nothing.
    expected = [half / 2] * 4 + [1.5 * half] * 4 + [2] + [2.5 * half] * 4
    assert areas == pytest.approx(sorted(expected), rel=1e-14)
    lengths = sorted(seam.length for seam in found.seams)
    assert lengths == pytest.approx([0.75**0.5] * 8 + [1, 1, 2, 2], rel=1e-14)
    middle = max((sheet for sheet in found.sheets if sheet.area == pytest.approx(2)), key=lambda s: s.area)
    assert middle.centroid == pytest.approx([1.5, 1, 0.5], abs=1e-15)
    # At height h below a side a x b, the region is (a - 2 h) (b - 2 h), up to h = 1/2.
    regions = [a * b / 2 - (a + b) / 4 + 1 / 6 for a, b in ((2, 1), (3, 1), (3, 2))]
    assert sorted(found.regions) == pytest.approx(sorted(regions * 2), rel=1e-13)


@pytest.mark.parametrize("t", families.THICKNESSES)
def test_prism_has_one_long_seam(t):
    """The inscribed cylinder of a triangle has radius 2 area / perimeter. The seam ends that far from the caps."""
    found = structure_of(triangulate(families.triangular_prism(t)))
    radius = 8 * t / (t + 2 * math.hypot(8, t / 2))
    longest = max(found.seams, key=lambda seam: seam.length)
    assert longest.length == pytest.approx(10 - 2 * radius, rel=1e-12)
    assert sorted(j.radius for j in found.junctions) == pytest.approx([0] * 6 + [radius] * 2, rel=1e-9)


def test_exact_coordinates_count_to_the_last_bit():
    """A cube that is longer by one unit in the last place is a square rod, unless a tolerance hides it."""
    solid = triangulate(families.box(1, 1, 1 + 2**-52))
    assert structure(solid.vertices, solid.triangles).counts() == (12, 9, 10)
    assert structure(solid.vertices, solid.triangles, 1e-12).counts() == (12, 8, 9)
    both = triangulate(families.box(1, 1 + 2**-52, 1 + 2**-51))
    assert structure(both.vertices, both.triangles).counts() == (13, 12, 12)


# Obvious and slow, and laws that any structure obeys


def brute_force(found, tolerance):
    """Sets of faces (-1: h = 0) at all vertices, from all fours of half-spaces."""
    rows = np.vstack([np.c_[found.normals, np.ones(len(found.normals))], [0, 0, 0, -1]])
    offsets = np.append(found.offsets, 0)
    vertices = set()
    for four in itertools.combinations(range(len(rows)), 4):
        if abs(np.linalg.det(rows[list(four)])) > 1e-9:
            slack = offsets - rows @ np.linalg.solve(rows[list(four)], offsets[list(four)])
            if slack.min() > -tolerance:
                vertices.add(frozenset(np.flatnonzero(slack < tolerance).tolist()))
    return vertices


SMALL = [
    *families.random_convex(30, seed=21),
    *(
        shape
        for shape in CONVEX
        if shape.name.startswith(("pyramid", "frustum", "wedge", "prism")) and ", 0.0" not in shape.name
    ),
    *PLATONIC.values(),
]
SMALL = [shape for shape in SMALL if len(shape.polygons) <= 12]


@pytest.mark.parametrize("shape", SMALL, ids=lambda shape: shape.name)
def test_brute_force_finds_the_same_vertices(shape):
    found = structure_of(triangulate(shape))
    floor = len(found.normals)
    own = {j.faces | ({floor} if j.radius == 0 else set()) for j in found.junctions}
    assert brute_force(found, 1e-8) == own


def check_laws(found, solid):
    sheets, seams, junctions = found.counts()
    assert junctions - seams + sheets == found.edges + 1
    assert found.regions.sum() == pytest.approx(volume_of(solid), rel=1e-9)
    assert found.regions.min() > 0
    pairs = [sheet.faces for sheet in found.sheets]
    assert len(set(pairs)) == len(pairs) and all(len(pair) == 2 for pair in pairs)
    assert all(len(seam.faces) >= 3 for seam in found.seams)
    assert all(junction.radius == 0 or len(junction.faces) >= 4 for junction in found.junctions)
    size = np.ptp(solid.vertices, axis=0).max()
    for seam in found.seams:  # Each seam lies in three sheets or more, and all of its faces are as near.
        assert sum(pair <= seam.faces for pair in pairs) >= 3
        assert seam.faces <= found.junctions[seam.junctions[0]].faces & found.junctions[seam.junctions[1]].faces
    for junction in found.junctions:
        slack = found.offsets - found.normals @ junction.position
        near = slack[sorted(junction.faces)]
        room = 1e-12 * size + 10 * np.finfo(float).eps * np.abs(solid.vertices).max()
        assert np.abs(near - junction.radius).max() < room
        assert slack.min() > junction.radius - room


@pytest.mark.parametrize("shape", [*CONVEX, *RANDOM], ids=lambda shape: shape.name)
def test_laws_hold(shape):
    solid = triangulate(shape)
    check_laws(structure_of(solid), solid)


def test_degenerate_hulls_of_grid_points():
    """Hulls of small whole points have flat sides and many meetings of five faces or more. Exact and rounded agree."""
    degenerate = 0
    for seed in range(100):
        rng = np.random.default_rng(seed)
        points = np.unique(rng.integers(-3, 4, size=(rng.integers(6, 30), 3)), axis=0).astype(float)
        points = points[np.sort(families.ConvexHull(points).vertices)]
        solid = triangulate(families._hull("grid", points, "exact"))
        assert solid.tolerance == 0
        exact, rounded = structure_of(solid), structure(solid.vertices, solid.triangles, 1e-13)
        check_laws(exact, solid)
        assert not rounded.unclear
        assert [sheet.faces for sheet in exact.sheets] == [sheet.faces for sheet in rounded.sheets]
        assert [seam.faces for seam in exact.seams] == [seam.faces for seam in rounded.seams]
        assert [junction.faces for junction in exact.junctions] == [junction.faces for junction in rounded.junctions]
        degenerate += max(len(junction.faces) for junction in exact.junctions) > 4
    assert degenerate > 50


@pytest.mark.parametrize("name", ["box 3 x 2 x 1", "cube", "octahedron", "triangular prism 0.001", "pyramid 4, 1"])
def test_walk_along_edges_finds_what_qhull_finds(name):
    solid = triangulate(named(name))
    exact = _Exact(solid.vertices, solid.triangles)
    points, passed = _polytope(exact)
    walked, also = _walk(exact, passed)
    assert {tuple(row) for row in passed.tolist()} == {tuple(row) for row in also.tolist()}
    order, other = np.lexsort(passed.T), np.lexsort(also.T)
    assert points[order] == pytest.approx(walked[other], abs=1e-13)


# Variants and triangulations


def faces_by_name(found, first):
    """Face ids of `found` for those of `first`, by the triangles that both have: the variants keep them."""
    return dict(zip(first.face_of.tolist(), found.face_of.tolist(), strict=True))


@pytest.mark.parametrize("way", TRIANGULATIONS)
def test_variants_keep_the_structure(way):
    """Turned, as float32, far off and tiny: the same sheets with the same areas, or unclear cases are named."""
    unclear = []
    for shape in some(CONVEX, len(CONVEX) // 2):
        made, *others = variants(shape, way)
        first = structure_of(made)
        assert not first.unclear, made.name
        for solid in others:
            found = structure_of(solid)
            if found.unclear:
                unclear.append(solid.name)
                continue
            assert faces_by_name(found, first) == {f: f for f in range(len(first.normals))}, solid.name
            assert [sheet.faces for sheet in found.sheets] == [sheet.faces for sheet in first.sheets], solid.name
            assert [seam.faces for seam in found.seams] == [seam.faces for seam in first.seams], solid.name
            assert [junction.faces for junction in found.junctions] == [junction.faces for junction in first.junctions]
            scale = 1e6 if solid.name.endswith("tiny") else 1.0
            room = 1e4 * solid.tolerance * scale + 1e-9
            for own, other in zip(first.sheets, found.sheets, strict=True):
                assert other.area * scale**2 == pytest.approx(own.area, rel=1e-6, abs=room), solid.name
    # Points inside the sides of a prism of thickness 1e-5 move by a tenth of it when they become float32.
    assert set(unclear) <= {"triangular prism 1e-05, centre, float32", "triangular prism 1e-05, refined, float32"}


@pytest.mark.parametrize("shape", CONVEX[::5] + RANDOM[::6], ids=lambda shape: shape.name)
def test_triangulations_keep_the_structure(shape):
    first = structure_of(triangulate(shape))
    for way in TRIANGULATIONS[1:]:
        found = structure_of(triangulate(shape, way))
        assert len(found.normals) == len(shape.polygons)
        assert found.counts() == first.counts()
        assert [s.area for s in found.sheets] == pytest.approx([s.area for s in first.sheets], rel=1e-6, abs=1e-12)


def test_random_polyhedra_in_all_variants():
    """4 to 40 faces. Float32 may change which faces meet, in few of them."""
    unclear = changed = 0
    for shape in some(RANDOM, 30):
        made, *others = variants(shape)
        first = structure_of(made)
        assert len(first.normals) == len(shape.polygons)
        assert not first.unclear, made.name
        for solid in others:
            found = structure_of(solid)
            check_laws(found, solid)
            single = solid.name.endswith("float32")
            assert single or not found.unclear, solid.name
            assert single or [s.faces for s in found.sheets] == [s.faces for s in first.sheets], solid.name
            unclear += bool(found.unclear)
            changed += found.counts() != first.counts()
    assert unclear <= 2 and changed <= 2


def test_a_thousand_polyhedra_are_clear():
    shapes = families.random_convex(1000)
    faces = {len(shape.polygons) for shape in shapes}
    assert min(faces) == 4 and max(faces) == 40 and len(faces) > 30
    for shape in some(shapes, 100):
        assert not structure_of(triangulate(shape)).unclear


# Errors


def test_errors_name_the_fault():
    solid = triangulate(families.box(3, 2, 1))
    with pytest.raises(ValueError, match="has one triangle; expected a closed"):
        structure(solid.vertices, solid.triangles[1:])
    with pytest.raises(ValueError, match="reflex edge"):
        structure(solid.vertices, solid.triangles[:, ::-1])
    flat = np.vstack([solid.triangles, [[0, 1, 1]]])
    with pytest.raises(ValueError, match="expected"):
        structure(solid.vertices, flat)
    with pytest.raises(ValueError, match="expected"):
        structure(solid.vertices, solid.triangles, 10.0)
    profile = families.profiles()[0]
    for tolerance in (0.0, 1e-12):
        with pytest.raises(ValueError, match="expected a convex solid"):
            structure(profile.vertices, profile.triangles, tolerance)


@pytest.mark.parametrize("shift", [1e-6, -1e-6])
def test_bent_sides_are_joined_within_the_tolerance(shift):
    solid = triangulate(families.box(3, 2, 1))
    solid.vertices[6] += [0, 0, shift]
    found = structure(solid.vertices, solid.triangles, 1e-6)
    assert found.counts() == (13, 12, 12) and len(found.normals) == 6
    triangles = solid.triangles.tolist()
    lifted = [t for t, corners in enumerate(triangles) if 6 in corners and min(corners) >= 4]
    if (shift > 0) == (len(lifted) == 2):  # The diagonal of the top ends in the moved corner, and is a ridge.
        assert len(structure(solid.vertices, solid.triangles).normals) == 7
    else:
        with pytest.raises(ValueError, match="reflex edge"):
            structure(solid.vertices, solid.triangles)


def test_too_large_tolerance_is_unclear():
    """A plate of 1e-4 with coordinates known to 1e-5 has no certain structure."""
    solid = triangulate(families.box(1.0, 0.7, 1e-4))
    assert structure(solid.vertices, solid.triangles, 1e-5).unclear
    assert not structure(solid.vertices, solid.triangles, 1e-7).unclear


# The search for walls


def distances(points, solid):
    """Distances from points to the nearest triangle: slow and obvious."""
    out = np.full(len(points), np.inf)
    for a, b, c in solid.vertices[solid.triangles]:
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        inside = np.ones(len(points), dtype=bool)
        for p, q in ((a, b), (b, c), (c, a)):
            t = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            out = np.minimum(out, np.linalg.norm(points - p - np.outer(t, q - p), axis=1))
            inside &= (points - p) @ np.cross(normal, q - p) >= 0
        out[inside] = np.minimum(out[inside], np.abs((points - a) @ normal)[inside])
    return out


@pytest.mark.parametrize("shape", [named("box 3 x 2 x 1"), named("wedge 0.5, 1"), *RANDOM[::8]], ids=lambda s: s.name)
def test_random_balls_find_the_sheets(shape):
    """The walls of random maximal balls are the sheets, and each sheet is found as often as its area demands."""
    solid = triangulate(shape)
    found = structure_of(solid)
    balls, sites = maximal_balls(solid.vertices, solid.triangles, 100_000)
    assert (sites.face_of == found.face_of).all()
    pairs = [tuple(sorted(sheet.faces)) for sheet in found.sheets]
    assert {tuple(sorted(pair)) for pair in zip(balls.first.tolist(), balls.second.tolist(), strict=True)} <= set(pairs)
    walls = walls_of(balls, sites)
    checked = 0
    for pair, sheet in zip(pairs, found.sheets, strict=True):
        f, g = pair
        slope = np.linalg.norm(found.normals[f] - found.normals[g]) / 2  # The sheet's shadow on both faces is so large.
        for one, other in (pair, pair[::-1]):
            expected = balls.tries[one] * sheet.area * slope / found.areas[one]
            hits = ((balls.first == one) & (balls.second == other)).sum()
            assert abs(hits - expected) < 5 * expected**0.5 + 3, pair
        wall = walls.get((("face", f), ("face", g)))
        if wall and wall.hits > 400:
            assert wall.area == pytest.approx(sheet.area, abs=5 * wall.error), pair
            checked += 1
    assert checked > 5


NOT_CONVEX = families.not_convex()
MADE = [("crossed_plates", 0), ("cut_needles", 1), ("slots", 0), ("thin_shells", 7), ("wedges", 7)]
MADE += [("nested_voids", 3)] if EVERYTHING else []
MADE = [families.Solid(made.name, made.vertices, made.triangles, 0.0) for made in itertools.starmap(made_solid, MADE)]


@pytest.mark.parametrize("solid", [*NOT_CONVEX, *MADE], ids=lambda solid: solid.name)
def test_balls_are_maximal(solid):
    balls, _ = maximal_balls(solid.vertices, solid.triangles, 5_000)
    assert np.isfinite(balls.radii).all() and (balls.gaps >= 0).all() and (balls.first != balls.second).all()
    assert distances(balls.centres, solid) == pytest.approx(balls.radii, rel=1e-9, abs=1e-9)


def sums(balls, site, values):
    """The sum of an estimate over the balls of a site, and its variance."""
    own = values[balls.first == site]
    return own.sum(), (own**2).sum() - own.sum() ** 2 / balls.tries[site]


@pytest.mark.parametrize("solid", [*NOT_CONVEX, *MADE], ids=lambda solid: solid.name)
def test_regions_fill_the_solid(solid):
    balls, sites = maximal_balls(solid.vertices, solid.triangles, 200_000)
    parts = np.array([sums(balls, k, balls.volumes) for k in range(len(sites.names))])
    assert parts[:, 0].min() > 0
    total, error = parts[:, 0].sum(), parts[:, 1].sum() ** 0.5
    assert total == pytest.approx(volume_of(solid), abs=5 * error)
    assert error < 0.01 * total


@pytest.mark.parametrize("solid", NOT_CONVEX, ids=lambda solid: solid.name)
def test_both_sides_of_a_wall_agree(solid):
    """Each area is estimated from both sites of the wall, with other weights. The estimates agree."""
    balls, sites = maximal_balls(solid.vertices, solid.triangles, 200_000)
    checked = 0
    for a, b in itertools.combinations(range(len(sites.names)), 2):
        sides = [
            sums(balls, site, np.where(balls.second == other, balls.weights, 0)) for site, other in ((a, b), (b, a))
        ]
        hits = [((balls.first == site) & (balls.second == other)).sum() for site, other in ((a, b), (b, a))]
        if min(hits) > 40:
            (one, spread), (two, also) = sides
            assert one == pytest.approx(two, abs=5 * (spread + also) ** 0.5), (sites.names[a], sites.names[b])
            checked += 1
    assert checked >= len(sites.names)


@pytest.mark.parametrize("solid", NOT_CONVEX, ids=lambda solid: solid.name)
def test_variants_have_the_same_walls(solid):
    """Turned, as float32, far off and tiny: the same sites, and walls of the same areas."""
    made, *others = families.moved(solid)
    balls, sites = maximal_balls(made.vertices, made.triangles, 50_000)
    walls = walls_of(balls, sites)
    for other in others:
        again, same = maximal_balls(other.vertices, other.triangles, 50_000, seed=2)
        assert same.names == sites.names, other.name
        scale = 1e6 if other.name.endswith("tiny") else 1.0
        found = walls_of(again, same)
        for pair in set(walls) | set(found):
            if pair in walls and pair in found and min(walls[pair].hits, found[pair].hits) > 40:
                error = (walls[pair].error ** 2 + (found[pair].error * scale**2) ** 2) ** 0.5
                assert found[pair].area * scale**2 == pytest.approx(walls[pair].area, abs=5.5 * error), pair
            else:
                assert pair not in walls or walls[pair].hits < 120, pair
                assert pair not in found or found[pair].hits < 120, pair


@pytest.mark.parametrize(("side", "hole", "thickness"), [(4.0, 1.5, 0.5), (3.0, 0.5, 0.1)])
def test_middle_of_a_plate_with_a_hole(side, hole, thickness):
    """The middle sheet ends half a thickness from the rim and from the hole, with rounded corners around the hole."""
    solid = families.plate_with_hole(side, hole, thickness)
    balls, sites = maximal_balls(solid.vertices, solid.triangles, 200_000)
    caps = tuple(("face", f) for f in np.flatnonzero(np.abs(sites.normals[:, 2]) > 0.5))
    wall = walls_of(balls, sites)[caps]
    expected = (side - thickness) ** 2 - (hole**2 + 2 * hole * thickness + math.pi * thickness**2 / 4)
    assert wall.area == pytest.approx(expected, abs=5 * wall.error)
    assert wall.error < 0.01 * expected


def test_reflex_sites_are_found():
    count = {solid.name: len(sites_of(solid.vertices, solid.triangles).edges) for solid in NOT_CONVEX}
    assert count == {
        "L": 1,
        "T": 2,
        "U": 2,
        "plate with hole 1.5": 4,
        "plate with hole 0.5": 4,
        "steps 3": 2,
        "steps 5": 4,
        "notched box": 3,
    }
    notched = NOT_CONVEX[-1]
    sites = sites_of(notched.vertices, notched.triangles)
    assert [notched.vertices[v].tolist() for v in sites.reflex] == [[2, 2, 2]]
    walls = walls_of(*maximal_balls(notched.vertices, notched.triangles, 200_000))
    corner = ("vertex", sites.reflex[0])
    # By symmetry, the vertex has equal walls with the three far sides, and others with the three sides beside it.
    groups = {False: [], True: []}
    for (one, other), wall in walls.items():
        if other == corner:
            groups[bool(sites.offsets[one[1]] > 1)].append(wall)
    for first, *others in groups.values():
        assert len(others) == 2
        for wall in others:
            assert wall.area == pytest.approx(first.area, abs=5 * (wall.error**2 + first.error**2) ** 0.5)
