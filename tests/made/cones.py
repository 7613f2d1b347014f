"""Closed solids that are hard for Voronoi diagrams, by seed.

The families are cones over polygons, such cones cut out of blocks, saddles, terrains, separate coplanar faces, and thin
wedges. One corner may have any mix of convex and reflex edges. Each solid is kept as made, turned, rounded to single
precision, tiny, or far from the origin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FAMILIES = (
    "pyramid",
    "fine_pyramid",
    "dent",
    "fine_dent",
    "saddle",
    "bent_saddle",
    "terrain",
    "coplanar",
    "void",
    "thin",
)
WAYS = ("made", "turned", "single", "tiny", "far")
#: A plus, whose sides are collinear in pairs.
PLUS = np.array(
    [[1, 0], [3, 0], [3, 1], [4, 1], [4, 3], [3, 3], [3, 4], [1, 4], [1, 3], [0, 3], [0, 1], [1, 1]], dtype=float
)


@dataclass(frozen=True)
class ConeSolid:
    family: str
    way: str
    vertices: np.ndarray
    triangles: np.ndarray


def _star(random, count, least=0.3):
    angles = (np.arange(count) + random.uniform(-0.3, 0.3, count)) * 2 * np.pi / count
    return random.uniform(least, 1, count)[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _cut(polygon, parts):
    """Divides each side into equal parts, so that corners are collinear."""
    ends = np.roll(polygon, -1, axis=0)
    return np.concatenate(
        [polygon[k] + (ends[k] - polygon[k]) * np.arange(parts)[:, None] / parts for k in range(len(polygon))]
    )


def _ears(points):
    """Counterclockwise triangles of a polygon without crossings; corners may occur twice, for example along a slit."""
    left, out = list(range(len(points))), []

    def turn(a, b, c):
        (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def is_in(p, a, b, c):
        return all(not np.array_equal(points[p], points[x]) for x in (a, b, c)) and (
            turn(a, b, p) >= 0 and turn(b, c, p) >= 0 and turn(c, a, p) >= 0
        )

    while len(left) > 3:
        best = None
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            area = turn(a, b, c)
            if area > 1e-12 and (best is None or area > best[0]) and not any(is_in(p, a, b, c) for p in left):
                best = (area, k)
        if best is None:
            return None
        k = best[1]
        out.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
        left.pop(k)
    return [*out, tuple(left)]


def _pyramid(polygon, apex):
    count, base = len(polygon), _ears(polygon)
    if base is None:
        return None
    sides = [(k, (k + 1) % count, count) for k in range(count)]
    return np.vstack([np.c_[polygon, np.zeros(count)], [apex]]), np.array(sides + [(a, c, b) for a, b, c in base])


def _dent(polygon, apex, half=2.0):
    """A block with a pyramid cut out from below."""
    count = len(polygon)
    square = half * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    low, high = count + 1, count + 5
    vertices = np.vstack(
        [np.c_[polygon, np.zeros(count)], [apex], np.c_[square, np.zeros(4)], np.c_[square, np.full(4, 2 * half)]]
    )
    first = int(np.argmax(polygon.sum(axis=1)))
    ring = [low + 2, low + 3, low, low + 1, low + 2, *((first - k) % count for k in range(count + 1))]
    below = _ears(vertices[ring, :2])
    if below is None:
        return None
    triangles = [(k, count, (k + 1) % count) for k in range(count)]
    triangles += [(ring[a], ring[c], ring[b]) for a, b, c in below]
    triangles += [(high, high + 1, high + 2), (high, high + 2, high + 3)]
    for k in range(4):
        n = (k + 1) % 4
        triangles += [(low + k, low + n, high + n), (low + k, high + n, high + k)]
    return vertices, np.array(triangles)


def _saddle(folds, height, bend):
    """A prism whose top is a fan with equal numbers of convex and reflex edges."""
    count = 2 * folds
    angles = np.arange(count) * 2 * np.pi / count
    ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    top = np.where(np.arange(count) % 2 == 0, height, -height) + bend
    vertices = np.vstack([np.c_[ring, top], np.c_[ring, np.full(count, -2.0)], [[0, 0, 0]]])
    triangles = [(k, (k + 1) % count, 2 * count) for k in range(count)]
    for k in range(count):
        n = (k + 1) % count
        triangles += [(count + k, count + n, n), (count + k, n, k)]
    triangles += [(count, count + k + 1, count + k) for k in range(1, count - 1)]
    return vertices, np.array(triangles)


def _terrain(n, random):
    """A block with random heights, sometimes equal ones, over a grid."""
    heights = random.uniform(0, 0.4, (n + 1, n + 1))
    if random.random() < 0.5:
        heights = np.round(heights * 4) / 4
    at = np.arange(n + 1) / n
    top = np.stack([*np.meshgrid(at, at, indexing="ij"), 1 + heights], axis=2).reshape(-1, 3)
    triangles = []
    for i in range(n):
        for j in range(n):
            a, b, c, d = (p * (n + 1) + q for p, q in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            triangles += [(a, b, c), (a, c, d)] if random.random() < 0.5 else [(a, b, d), (b, c, d)]
    ways = [(i, 0) for i in range(n)] + [(n, j) for j in range(n)]
    ways += [(i, n) for i in range(n, 0, -1)] + [(0, j) for j in range(n, 0, -1)]
    rim = [i * (n + 1) + j for i, j in ways]
    base, middle = len(top), len(top) + len(rim)
    for k in range(len(rim)):
        m = (k + 1) % len(rim)
        triangles += [(base + k, base + m, rim[m]), (base + k, rim[m], rim[k]), (base + m, base + k, middle)]
    return np.vstack([top, top[rim] * [1, 1, 0], [[0.5, 0.5, 0]]]), np.array(triangles)


def _made(family, random):
    whole = random.integers
    if family in ("pyramid", "fine_pyramid", "dent", "fine_dent"):
        is_fine = family.startswith("fine")
        polygon = _star(random, int(whole(3, 7 if is_fine else 12)))
        if is_fine:
            polygon = _cut(polygon, int(whole(2, 8)))
        apex = (*random.uniform(-0.1, 0.1, 2), random.uniform(0.2, 1.5))
        return (_dent if family.endswith("dent") else _pyramid)(polygon, apex)
    if family in ("saddle", "bent_saddle"):
        folds = int(whole(2, 9))
        bend = random.uniform(-0.2, 0.2, 2 * folds) if family == "bent_saddle" else 0
        return _saddle(folds, random.uniform(0.1, 1.5), bend)
    if family == "terrain":
        return _terrain(int(whole(2, 7)), random)
    if family == "coplanar":
        apex = (0, 0, random.uniform(0.5, 3))
        return _pyramid(PLUS - 2, apex) if random.random() < 0.5 else _dent((PLUS - 2) * 0.8, apex, 3.0)
    if family == "void":
        vertices, triangles = _saddle(3, 0.5, 0)
        inner, faces = _pyramid(_star(random, 5) * 0.3, (0, 0, 0.4))
        return np.vstack([vertices, inner - [0, 0, 1.5]]), np.vstack([triangles, faces[:, ::-1] + len(vertices)])
    return _pyramid(_star(random, int(whole(3, 7)), 0.2) * [1, 10 ** random.uniform(-3, -1)], (0, 0, 1.0))


def _turned(vertices, random):
    q = random.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return vertices @ np.array(rows).T


def cone_solid(seed: int) -> ConeSolid | None:
    """The solid of a seed; None if a polygon was not triangulated."""
    random = np.random.default_rng(seed)
    family, way = FAMILIES[seed % len(FAMILIES)], WAYS[seed // len(FAMILIES) % len(WAYS)]
    made = _made(family, random)
    if made is None:
        return None
    vertices, triangles = made
    if way != "made":
        vertices = _turned(vertices, random)
    if way == "single":
        vertices = vertices.astype(np.float32).astype(float)
    if way == "tiny":
        vertices = vertices * 1e-30
    if way == "far":
        vertices = vertices + np.array([1e6, -1e6, 3e5])
    return ConeSolid(family, way, vertices, triangles)
