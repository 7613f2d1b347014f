"""Walls of the medial axis of a solid with flat faces, by a search of random maximal balls. It does not use Blum.

Sites are faces, reflex edges and reflex vertices. Only these touch a ball inside at an open set of its places: near a
convex edge, the ball touches the faces first. Sites have names: ("face", f), ("edge", f, g) for the line in which the
faces f < g meet, and ("vertex", v). Triangles that meet at less than `FLAT` radians form one face, and the number of a
face follows its first triangle, as in exact_structure.py.

A random ball touches a random place of a site. It grows along the inward normal there until it touches a second site.
The largest ball has a closed form for planes, lines and points. The centre lies on the wall of the two sites. The walls
between a face and the reflex edge or vertex that borders it are not part of the axis, and no ball of two contacts finds
them. Each wall of the pair (A, B) is found from A and from B. Areas are the means of both estimates.
"""

from typing import NamedTuple

import numpy as np
from exact_structure import neighbours

FLAT = 1e-5
NEAR = 1e-9  # Fraction of the solid's size. Contacts this close to another plane do not see it.


class Sites(NamedTuple):
    names: list
    face_of: np.ndarray  # [triangles].
    normals: np.ndarray  # [faces, 3], outward.
    offsets: np.ndarray  # [faces].
    areas: np.ndarray  # [faces].
    edges: list  # For each reflex line: faces (f, g), and its segments as pairs of vertex ids.
    reflex: list  # Ids of the vertices that can be nearest.
    directions: dict  # For each of these: unit vectors [n, 3] along its mesh edges, and its outward normal.
    around: dict  # For each of these: ids of its faces.


class Balls(NamedTuple):
    """Maximal balls. `first` and `second` are indices of `Sites.names`."""

    centres: np.ndarray
    radii: np.ndarray
    first: np.ndarray
    second: np.ndarray
    gaps: np.ndarray  # How far the ball could grow until a third site stops it; near 0 at a seam.
    weights: np.ndarray  # Area of wall for which each ball stands.
    volumes: np.ndarray  # Volume of the region of `first` for which each ball stands.
    tries: np.ndarray  # [sites] contacts tried per site.


def sites_of(vertices, triangles):
    """The sites of a closed solid with outward triangles."""
    vertices, triangles = np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    vectors = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(vectors, axis=1)
    units = vectors / areas[:, None]
    pairs = neighbours(triangles)
    parent = np.arange(len(triangles))
    for s, t in pairs * 2:  # Union by the lowest id of the sets.
        if np.linalg.norm(np.cross(units[s], units[t])) < FLAT and units[s] @ units[t] > 0:
            parent[parent == max(parent[s], parent[t])] = min(parent[s], parent[t])
    face_of = np.unique(parent, return_inverse=True)[1]
    sums = np.array([vectors[face_of == f].sum(axis=0) for f in range(face_of.max() + 1)])
    normals = sums / np.linalg.norm(sums, axis=1)[:, None]
    heights = areas * np.einsum("ij,ij->i", (a + b + c) / 3, normals[face_of])
    offsets = np.bincount(face_of, heights) / np.bincount(face_of, areas)
    lines = {}
    for s, t in pairs:
        f, g = sorted((face_of[s], face_of[t]))
        ends = np.intersect1d(triangles[s], triangles[t])
        beyond = np.setdiff1d(triangles[t], ends)[0]
        if f != g and units[s] @ (vertices[beyond] - vertices[ends[0]]) > 0:
            lines.setdefault((int(f), int(g)), []).append(tuple(ends.tolist()))
    held = sorted({v for own in lines.values() for segment in own for v in segment})
    directions = {v: _star(vertices, triangles, units, v) for v in held}
    around = {v: sorted(set(face_of[(triangles == v).any(axis=1)].tolist())) for v in held}
    reflex = [v for v in held if len(around[v]) > 2 and _open(*directions[v])]
    names = [("face", f) for f in range(len(normals))] + [("edge", *pair) for pair in sorted(lines)]
    names += [("vertex", v) for v in reflex]
    sizes = np.bincount(face_of, areas)
    return Sites(names, face_of, normals, offsets, sizes, sorted(lines.items()), reflex, directions, around)


def _star(vertices, triangles, units, v):
    """Unit vectors from a vertex along its mesh edges, and its outward normal weighted by angles (Baerentzen 2005)."""
    ends, normal = set(), np.zeros(3)
    for t in np.flatnonzero((triangles == v).any(axis=1)):
        others = [i for i in triangles[t].tolist() if i != v]
        p, q = (vertices[i] - vertices[v] for i in others)
        normal += units[t] * np.arccos(np.clip(p @ q / np.linalg.norm(p) / np.linalg.norm(q), -1, 1))
        ends.update(others)
    along = vertices[sorted(ends)] - vertices[v]
    return along / np.linalg.norm(along, axis=1)[:, None], normal


def _nearest_to_vertex(along, normal, m):
    """If a short step m from a vertex leads to points inside that are nearest to the vertex."""
    return (m @ along.T < -1e-9).all(axis=1) & (m @ normal < 0)


def _open(along, normal):
    """If a vertex is nearest to an open set inside. Sets seen under less than about 0.002 steradians are missed."""
    m = np.random.default_rng(0).normal(size=(40000, 3))
    return bool(_nearest_to_vertex(along, normal, m / np.linalg.norm(m, axis=1)[:, None]).any())


def maximal_balls(vertices, triangles, count, seed=1):
    """About `count` maximal balls at random contacts, and the sites. A million balls of 30 faces take some 10 s."""
    vertices, triangles = np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64)
    sites, rng = sites_of(vertices, triangles), np.random.default_rng(seed)
    shares = np.full(len(sites.names), 0.3 / len(sites.names))
    shares[: len(sites.areas)] += 0.7 * sites.areas / sites.areas.sum()
    parts = [_from_site(vertices, triangles, sites, k, max(100, int(n)), rng) for k, n in enumerate(shares * count)]
    joined = [np.concatenate(column) for column in zip(*(part[:-1] for part in parts), strict=True)]
    return Balls(*joined, np.array([part[-1] for part in parts])), sites


def _from_site(vertices, triangles, sites, k, count, rng):
    """Balls whose first contact is site k."""
    name = sites.names[k]
    if name[0] == "face":
        p, m = _on_face(vertices, triangles, sites, name[1], count, rng)
        measure, power, hidden = sites.areas[name[1]], 0, {name[1]}
    elif name[0] == "edge":
        p, m, measure = _on_edge(vertices, sites, k - len(sites.areas), count, rng)
        power, hidden = 1, {name[1], name[2]}
    else:
        m = rng.normal(size=(count, 3))
        m /= np.linalg.norm(m, axis=1)[:, None]
        m = m[_nearest_to_vertex(*sites.directions[name[1]], m)]
        p = np.tile(vertices[name[1]], (len(m), 1))
        measure, power, hidden = 4 * np.pi, 2, set(sites.around[name[1]])
    radii, second, gaps, other = _grow(vertices, triangles, sites, p, m, k, hidden)
    centres = p + radii[:, None] * m
    away = (centres - other) / radii[:, None]
    slope = np.linalg.norm(m - away, axis=1) / 2  # The cosine between the normal of the wall and m.
    weights = measure / count * radii**power / slope
    volumes = measure / count * radii ** (power + 1) / (power + 1)
    return centres, radii, np.full(len(p), k), second, gaps, weights, volumes, count


def _on_face(vertices, triangles, sites, f, count, rng):
    own = triangles[sites.face_of == f]
    a, b, c = (vertices[own[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    t = rng.choice(len(own), size=count, p=areas / areas.sum())
    u, v = rng.uniform(size=(2, count, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[t] + u * (b - a)[t] + v * (c - a)[t], np.tile(-sites.normals[f], (count, 1))


def _on_edge(vertices, sites, e, count, rng):
    (f, g), segments = sites.edges[e]
    a, b = (vertices[[segment[k] for segment in segments]] for k in (0, 1))
    lengths = np.linalg.norm(b - a, axis=1)
    s = rng.choice(len(segments), size=count, p=lengths / lengths.sum())
    p = a[s] + rng.uniform(size=(count, 1)) * (b - a)[s]
    start, end = -sites.normals[f], -sites.normals[g]
    angle = np.arctan2(np.linalg.norm(np.cross(start, end)), start @ end)
    across = end - (end @ start) * start
    turn = angle * rng.uniform(size=(count, 1))
    m = np.cos(turn) * start + np.sin(turn) * across / np.linalg.norm(across)
    return p, m, lengths.sum() * angle


class _First:
    """The smallest radii so far, with their sites and contacts, and the next radii of other sites."""

    def __init__(self, count):
        self.radii, self.next = np.full(count, np.inf), np.full(count, np.inf)
        self.site, self.contact = np.full(count, -1), np.zeros((count, 3))

    def add(self, site, radii, contact):
        """Offers radii (infinite where the site is not touched) with contacts [n, 3]."""
        other = self.site != site
        self.next = np.minimum(self.next, np.where(other, np.maximum(radii, self.radii), np.inf))
        better = radii < self.radii
        self.radii = np.where(better, radii, self.radii)
        self.site[better], self.contact[better] = site, contact[better]


def _grow(vertices, triangles, sites, p, m, own, hidden):
    """Radii of the largest balls with centres p + r m, the sites that stop them, gaps, and contacts."""
    first, faces = _First(len(p)), len(sites.areas)
    near = NEAR * np.ptp(vertices, axis=0).max()
    for f in range(faces):
        if f in hidden:
            continue
        slack, slope = sites.offsets[f] - p @ sites.normals[f], 1 + m @ sites.normals[f]
        with np.errstate(all="ignore"):
            radii = np.where((slack > near) & (slope > 0), slack / slope, np.inf)
        tried = np.flatnonzero(radii < first.next)
        foot = p[tried] + radii[tried, None] * (m[tried] + sites.normals[f])
        inside = np.zeros(len(tried), dtype=bool)
        for t in triangles[sites.face_of == f]:
            inside |= _in_triangle(foot, vertices[t], sites.normals[f])
        _offer(first, f, tried[inside], radii[tried[inside]], foot[inside])
    for e, ((f, g), segments) in enumerate(sites.edges):
        k = faces + e
        if k == own or {f, g} <= hidden:
            continue
        for segment in segments:
            a, b = vertices[list(segment)]
            along = (b - a) / np.linalg.norm(b - a)
            w, slope = a - p, m @ along
            w = w - np.outer(w @ along, along)  # From p across to the line.
            square, half = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m)
            with np.errstate(all="ignore"):
                below = half + np.sqrt(half**2 + slope**2 * square)
                radii = np.where(below > 1e-12 * np.sqrt(square), square / below, np.inf)
                place = (p - a) @ along + radii * slope
            tried = np.flatnonzero((radii < first.next) & (place >= 0) & (place <= np.linalg.norm(b - a)))
            _offer(first, k, tried, radii[tried], a + np.outer(place[tried], along))
    for i, v in enumerate(sites.reflex):
        k = faces + len(sites.edges) + i
        if k == own:
            continue
        w = vertices[v] - p
        square, half = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m)
        with np.errstate(all="ignore"):
            radii = np.where(half > 1e-12 * np.sqrt(square), square / (2 * half), np.inf)
        tried = np.flatnonzero(radii < first.next)
        _offer(first, k, tried, radii[tried], np.tile(vertices[v], (len(tried), 1)))
    return first.radii, first.site, first.next - first.radii, first.contact


def _offer(first, site, rows, radii, contacts):
    whole, places = np.full(len(first.radii), np.inf), np.zeros((len(first.radii), 3))
    whole[rows], places[rows] = radii, contacts
    first.add(site, whole, places)


def _in_triangle(points, corners, normal):
    inside = np.ones(len(points), dtype=bool)
    for k in range(3):
        a, b = corners[k], corners[(k + 1) % 3]
        across = np.cross(normal, b - a)
        across /= np.linalg.norm(across)
        inside &= (points - a) @ across >= -1e-12 * np.linalg.norm(b - a)
    return inside


class Wall(NamedTuple):
    area: float
    error: float  # standard error of the area
    hits: int


def walls_of(balls, sites):
    """Areas of the walls, by pairs of names in order."""
    count, out = len(sites.names), {}
    key = np.minimum(balls.first, balls.second) * count + np.maximum(balls.first, balls.second)
    for pair in np.unique(key):
        low, high = divmod(int(pair), count)
        area = variance = hits = 0
        for site in {low, high}:
            own = balls.weights[(key == pair) & (balls.first == site)]
            tries = balls.tries[site]
            area += own.sum() / 2
            variance += ((own**2).sum() - own.sum() ** 2 / tries) / 4
            hits += len(own)
        out[sites.names[low], sites.names[high]] = Wall(area, float(np.sqrt(variance)), hits)
    return out
