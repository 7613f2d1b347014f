"""Families of solids with flat faces, for tests of the structure of medial axes. All of them are seeded.

A `Shape` has polygons. `triangulate()` makes it a `Solid`, in several ways. `variants()` returns a solid as made, and
turned, rounded to float32, far off and tiny. A solid's tolerance is that of exact_structure.structure(): zero if its
coordinates count as exact, otherwise a bound on their errors.
"""

import itertools
from typing import NamedTuple

import numpy as np
from exact_signs import dot, exact_plane, integers
from scipy.spatial import ConvexHull, HalfspaceIntersection

EPS = np.finfo(float).eps
THICKNESSES = (2.0, 1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5)
TRIANGULATIONS = ("fan", "other fan", "centre", "refined")


class Shape(NamedTuple):
    """A polyhedron with polygons, each with its vertices in order as seen from outside.

    `kind` states how to read its coordinates. If it is "exact", they are as made those of the intended solid.
    If it is "rounded", they only approximate the intended solid. If it is "generic", any coordinates are intended.
    """

    name: str
    vertices: np.ndarray
    polygons: list
    kind: str


class Solid(NamedTuple):
    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    tolerance: float


# Triangulations and variants


def flat(vertices, polygons):
    """If the vertices of each polygon lie in one plane, exactly."""
    points, _ = integers(vertices)
    for polygon in polygons:
        planes = (
            exact_plane(points[polygon[0]], *(points[i] for i in pair)) for pair in itertools.pairwise(polygon[1:])
        )
        normal, offset = next(plane for plane in planes if plane[0] != (0, 0, 0))
        if any(dot(normal, points[i]) != offset for i in polygon):
            return False
    return True


def _middles(vertices, polygons):
    """Polygons with an additional vertex in the middle of each edge."""
    vertices, found, out = list(vertices), {}, []
    for polygon in polygons:
        longer = []
        for a, b in zip(polygon, np.roll(polygon, -1).tolist(), strict=True):
            key = min(a, b), max(a, b)
            if key not in found:
                found[key] = len(vertices)
                vertices.append((vertices[a] + vertices[b]) / 2)
            longer += [a, found[key]]
        out.append(longer)
    return np.array(vertices), out


def triangulate(shape, way="fan"):
    """The shape's triangles: fans from a corner or another one, from a vertex inside, or that with halved edges."""
    vertices, polygons = np.array(shape.vertices, dtype=float), [list(p) for p in shape.polygons]
    if way == "refined":
        vertices, polygons = _middles(vertices, polygons)
    if way in ("centre", "refined"):
        centres = [
            (vertices[p[0]] + vertices[p[len(p) // 2]]) / 2 if len(p) > 3 else vertices[p].mean(0) for p in polygons
        ]
        fans = [[len(vertices) + k, *p, p[0]] for k, p in enumerate(polygons)]
        polygons = [[len(vertices) + k, *p] for k, p in enumerate(polygons)]
        vertices = np.vstack([vertices, centres])
    else:
        shift = 0 if way == "fan" else 1
        fans = [p[-shift:] + p[:-shift] if shift else p for p in polygons]
    triangles = [(fan[0], a, b) for fan in fans for a, b in itertools.pairwise(fan[1:])]
    exact = shape.kind != "rounded" and flat(vertices, polygons)
    tolerance = 0.0 if exact else 8 * EPS * np.abs(vertices).max()
    name = shape.name if way == "fan" else f"{shape.name}, {way}"
    return Solid(name, vertices, np.array(triangles, dtype=np.int64), tolerance)


def rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.linalg.det(q)


def variants(shape, way="fan"):
    """The triangulated shape as made, turned by four rotations, as float32, moved by 1e6, and scaled by 1e-6."""
    solid = triangulate(shape, way)
    stays = shape.kind == "generic" and all(len(p) == 3 for p in shape.polygons) and solid.tolerance == 0
    return moved(solid, stays)


def moved(solid, stays=False):
    """The solid and its seven variants. With `stays`, their tolerances stay zero: their own coordinates are meant."""

    def changed(what, vertices, error, factor=1.0):
        tolerance = 0.0 if stays else solid.tolerance * factor + error
        return Solid(f"{solid.name}, {what}", vertices, solid.triangles, tolerance)

    vertices, size = solid.vertices, np.abs(solid.vertices).max()
    out = [solid]
    for seed in range(1, 5):
        out.append(changed(f"turned {seed}", vertices @ rotation(seed).T, 8 * EPS * size))
    single, far = vertices.astype(np.float32).astype(float), vertices + 1e6
    # Differences of neighbouring floats are exact, so these errors are the true ones. The solid may be exact still.
    out.append(changed("float32", single, 2 * np.abs(single - vertices).max()))
    out.append(changed("far", far, 2 * np.abs((far - 1e6) - vertices).max()))
    out.append(changed("tiny", vertices * 1e-6, 4 * EPS * 1e-6 * size, 1e-6))
    return out


# Convex shapes


def _outward(vertices, polygons):
    """The polygons of a convex solid, each turned to show its outside."""
    middle, out = vertices.mean(axis=0), []
    for polygon in polygons:
        points = vertices[polygon]
        normal = np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)
        out.append(list(polygon) if normal @ (points.mean(axis=0) - middle) > 0 else list(polygon)[::-1])
    return out


def _hull(name, points, kind):
    """The convex hull of points, with one polygon for each plane."""
    hull = ConvexHull(points)
    planes = []
    for plane in hull.equations:
        if not any(np.abs(plane - other).max() < 1e-9 for other in planes):
            planes.append(plane)
    polygons = []
    for plane in planes:
        held = np.flatnonzero(np.abs(points @ plane[:3] + plane[3]) < 1e-9)
        u = points[held[0]] - points[held].mean(axis=0)
        v = np.cross(plane[:3], u)
        around = points[held] - points[held].mean(axis=0)
        polygons.append(held[np.argsort(np.arctan2(around @ v, around @ u))].tolist())
    return Shape(name, points, _outward(points, polygons), kind)


def random_hulls(count, seed=1, fewest=4, most=40):
    """Convex hulls of random points near a sphere: 4 to 40 triangles."""
    rng, out = np.random.default_rng(seed), []
    for k in range(count):
        corners = int(rng.integers((fewest + 5) // 2, most // 2 + 3))  # n corners have 2 n - 4 triangles
        while True:
            points = rng.normal(size=(corners, 3))
            points *= rng.uniform(0.9, 1.1, size=(corners, 1)) / np.linalg.norm(points, axis=1)[:, None]
            if len(ConvexHull(points).vertices) == corners:
                break
        out.append(_hull(f"hull {seed}.{k} of {corners}", points, "generic"))
    return out


def random_cuts(count, seed=2, fewest=4, most=40):
    """Intersections of random half-spaces around the origin: 4 to 40 polygons."""
    rng, out = np.random.default_rng(seed), []
    while len(out) < count:
        faces = int(rng.integers(fewest, most + 1))
        normals = rng.normal(size=(faces, 3))
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        planes = np.c_[normals, -rng.uniform(0.9, 1.1, size=faces)]
        dual = ConvexHull(-normals / planes[:, 3:])
        if (dual.equations[:, 3] > -0.05).any() or len(dual.vertices) < fewest:
            continue  # Open, or more than about 20 times as long as wide.
        cut = HalfspaceIntersection(planes, np.zeros(3))
        points = np.array([np.linalg.solve(planes[f, :3], -planes[f, 3]) for f in cut.dual_facets])
        polygons = []
        for f in dual.vertices:
            held = np.array([v for v, own in enumerate(cut.dual_facets) if f in own])
            around = points[held] - points[held].mean(axis=0)
            u = around[0]
            polygons.append(held[np.argsort(np.arctan2(around @ np.cross(normals[f], u), around @ u))].tolist())
        name = f"cut {seed}.{len(out)} of {len(polygons)}"
        out.append(Shape(name, points, _outward(points, polygons), "generic"))
    return out


def _between(name, low, high, kind):
    """The solid between two polygons with as many corners each; `high` may be one apex."""
    n, apex = len(low), len(high) == 1
    vertices = np.vstack([low, high]).astype(float)
    sides = [[k, (k + 1) % n, n] if apex else [k, (k + 1) % n, n + (k + 1) % n, n + k] for k in range(n)]
    caps = [list(range(n))] + ([] if apex else [list(range(n, 2 * n))])
    return Shape(name, vertices, _outward(vertices, sides + caps), kind)


def _at(outline, height):
    return np.c_[outline, np.full(len(outline), float(height))]


def _regular(n, radius=1.0):
    turn = 2 * np.pi * (np.arange(n) + 0.5) / n
    return radius * np.c_[np.cos(turn), np.sin(turn)]


def box(a, b, c, name=None):
    outline = np.array([[0, 0], [a, 0], [a, b], [0, b]], dtype=float)
    return _between(name or f"box {a:g} x {b:g} x {c:g}", _at(outline, 0), _at(outline, c), "exact")


def boxes():
    """Boxes of all proportions down to 1e-4."""
    sides = (1.0, 0.7, 0.5, 0.1, 1e-2, 1e-3, 1e-4)
    return [box(3, 2, 1)] + [box(1.0, b, c) for b, c in itertools.combinations_with_replacement(sides, 2)]


def triangular_prism(t):
    """The prism of length 10 over the triangle (0, -t/2), (0, t/2), (8, 0)."""
    outline = np.array([[0, -t / 2], [0, t / 2], [8, 0]])
    return _between(f"triangular prism {t:g}", _at(outline, 0), _at(outline, 10), "exact")


def triangular_prisms():
    return [triangular_prism(t) for t in THICKNESSES]


def regular_prisms():
    """Prisms of regular polygons. If the height is twice the inner radius, all faces are nearest to one point."""
    out = []
    for n in (3, 5, 6, 8, 12):
        inner = np.cos(np.pi / n)
        for height in (0.1, 2 * inner, 10):
            out.append(_between(f"prism {n}, {height:.3g}", _at(_regular(n), 0), _at(_regular(n), height), "rounded"))
    return out


def wedges():
    """A rectangle and a ridge above it, as long as the rectangle, shorter or longer."""
    out = []
    for ridge in (0.5, 2.0, 3.0):
        for t in (1.0, 0.1, 1e-2, 1e-4):
            vertices = np.array([[-2, -t, 0], [2, -t, 0], [2, t, 0], [-2, t, 0], [-ridge, 0, 3], [ridge, 0, 3]])
            polygons = [[0, 1, 2, 3], [0, 1, 5, 4], [2, 3, 4, 5], [1, 2, 5], [3, 0, 4]]
            out.append(Shape(f"wedge {ridge:g}, {t:g}", vertices, _outward(vertices, polygons), "exact"))
    return out


def pyramids():
    """Right pyramids over regular polygons, and slanting ones over random polygons."""
    rng = np.random.default_rng(3)
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    out = [_between(f"pyramid 4, {h:g}", _at(square, 0), [[0, 0, h]], "exact") for h in (0.1, 1, 5)]
    for n in (3, 5, 6, 8):
        out += [_between(f"pyramid {n}, {h:g}", _at(_regular(n), 0), [[0, 0, h]], "rounded") for h in (0.1, 1, 5)]
        turn = 2 * np.pi * (np.arange(n) + rng.uniform(0.1, 0.9, size=n)) / n
        outline = np.c_[np.cos(turn), 0.8 * np.sin(turn)]
        apex = [[*rng.uniform(-1.5, 1.5, size=2), rng.uniform(0.5, 2)]]
        out.append(_between(f"slanting pyramid {n}", _at(outline, 0), apex, "generic"))
    return out


def frusta():
    square, out = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]), []
    for top in (0.25, 0.75):
        for height in (0.01, 0.5, 4):
            name = f"frustum 4, {top:g}, {height:g}"
            out.append(_between(name, _at(square, 0), _at(top * square, height), "exact"))
            for n in (3, 5, 6):
                low, high = _at(_regular(n), 0), _at(_regular(n, top), height)
                out.append(_between(f"frustum {n}, {top:g}, {height:g}", low, high, "rounded"))
    return out


def platonic():
    g = (1 + 5**0.5) / 2
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    unit = np.vstack([np.eye(3), -np.eye(3)])
    golden = np.array([[0, a, b * g] for a in (-1, 1) for b in (-1, 1)])
    icosahedron = np.vstack([np.roll(golden, k, axis=1) for k in range(3)])
    small = np.array([[0, a / g, b * g] for a in (-1, 1) for b in (-1, 1)])
    dodecahedron = np.vstack([signs, *(np.roll(small, k, axis=1) for k in range(3))])
    return [
        _hull("tetrahedron", signs[signs.prod(axis=1) > 0], "exact"),
        _hull("cube", signs, "exact"),
        _hull("octahedron", unit, "exact"),
        _hull("dodecahedron", dodecahedron, "rounded"),
        _hull("icosahedron", icosahedron, "rounded"),
    ]


def named_convex():
    """All convex shapes that are not random."""
    return [
        *boxes(),
        *triangular_prisms(),
        *regular_prisms(),
        *wedges(),
        *pyramids(),
        *frusta(),
        *platonic(),
    ]


def random_convex(count=1000, seed=1):
    """Random convex shapes of 4 to 40 faces: hulls and cuts in equal number."""
    return random_hulls(count - count // 2, seed) + random_cuts(count // 2, seed + 1)


# Solids that are not convex


def _ears(outline):
    """Triangles of a simple polygon that runs anticlockwise, by cutting the ear of the best form."""
    left, out = list(range(len(outline))), []

    def turn(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = outline[a], outline[b], outline[c]
        return float((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))

    def form(a, b, c):
        longest = max(np.linalg.norm(outline[i] - outline[j]) for i, j in ((a, b), (b, c), (c, a)))
        return turn(a, b, c) / longest**2

    while len(left) > 2:
        ears = []
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            inside = (p for p in left if p not in (a, b, c))
            if turn(a, b, c) > 0 and not any(min(turn(a, b, p), turn(b, c, p), turn(c, a, p)) >= 0 for p in inside):
                ears.append((form(a, b, c), k, (a, b, c)))
        if not ears:
            raise ValueError("the outline has no ear; expected a simple anticlockwise polygon")
        _, k, triangle = max(ears)
        out.append(triangle)
        del left[k]
    return out


def extruded(name, outline, height):
    """The prism over a simple polygon that runs anticlockwise."""
    outline, n = np.asarray(outline, dtype=float), len(outline)
    caps = _ears(outline)
    triangles = [(c, b, a) for a, b, c in caps] + [(a + n, b + n, c + n) for a, b, c in caps]
    for k in range(n):
        j = (k + 1) % n
        triangles += [(k, j, j + n), (k, j + n, k + n)]
    return Solid(name, np.vstack([_at(outline, 0), _at(outline, height)]), np.array(triangles), 0.0)


def plate_with_hole(side=4.0, hole=1.5, thickness=0.5):
    """A square plate with a square hole in its middle."""
    square = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2
    rings = [_at(side * square, 0), _at(hole * square, 0), _at(side * square, thickness), _at(hole * square, thickness)]
    triangles = []
    for k in range(4):
        j = (k + 1) % 4
        quads = [
            (k + 4, j + 4, j, k),
            (k + 8, j + 8, j + 12, k + 12),
            (k, j, j + 8, k + 8),
            (k + 12, j + 12, j + 4, k + 4),
        ]
        for a, b, c, d in quads:
            triangles += [(a, b, c), (a, c, d)]
    return Solid(f"plate with hole {hole:g}", np.vstack(rings), np.array(triangles), 0.0)


def steps(count=3, tread=1.0, rise=0.6, width=3.0):
    outline = [(0.0, 0.0), (count * tread, 0.0)]
    for k in range(count):
        outline += [((count - k) * tread, (k + 1) * rise), ((count - k - 1) * tread, (k + 1) * rise)]
    return extruded(f"steps {count}", outline, width)


def notched_box(side=3.0, notch=1.0):
    """A cube without a smaller cube at one corner: three reflex edges meet at a reflex vertex."""
    s, k = float(side), float(side - notch)
    polygons = [
        [(0, 0, 0), (0, s, 0), (s, s, 0), (s, 0, 0)],
        [(0, 0, 0), (s, 0, 0), (s, 0, s), (0, 0, s)],
        [(0, 0, 0), (0, 0, s), (0, s, s), (0, s, 0)],
        [(k, s, s), (0, s, s), (0, 0, s), (s, 0, s), (s, k, s), (k, k, s)],
        [(s, k, s), (s, 0, s), (s, 0, 0), (s, s, 0), (s, s, k), (s, k, k)],
        [(s, s, k), (s, s, 0), (0, s, 0), (0, s, s), (k, s, s), (k, s, k)],
        [(k, k, k), (s, k, k), (s, s, k), (k, s, k)],
        [(k, k, k), (k, s, k), (k, s, s), (k, k, s)],
        [(k, k, k), (k, k, s), (s, k, s), (s, k, k)],
    ]
    corners = sorted({p for polygon in polygons for p in polygon})
    vertices, triangles = np.array(corners), []
    for polygon in polygons:
        ids = [corners.index(p) for p in polygon]
        # The inner corner of an L comes last, so rotate it to the front: a fan from there covers the L.
        ids = [ids[-1], *ids[:-1]]
        triangles += [(ids[0], a, b) for a, b in itertools.pairwise(ids[1:])]
    return Solid("notched box", vertices, np.array(triangles), 0.0)


def profiles():
    """Extruded L, T and U."""
    angle = [(0, 0), (3, 0), (3, 1), (1, 1), (1, 2.5), (0, 2.5)]
    tee = [(1, 0), (2, 0), (2, 2), (3, 2), (3, 3), (0, 3), (0, 2), (1, 2)]
    channel = [(0, 0), (4, 0), (4, 2), (3.2, 2), (3.2, 0.7), (1, 0.7), (1, 2), (0, 2)]
    return [extruded("L", angle, 4.0), extruded("T", tee, 5.0), extruded("U", channel, 3.0)]


def not_convex():
    return [*profiles(), plate_with_hole(), plate_with_hole(3.0, 0.5, 0.1), steps(), steps(5), notched_box()]
