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
    cones: dict  # For each of these: unit rays [n, 3] around the directions of the points nearest to it.
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
    for s, t in pairs:  # The lowest id of a set names it.
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
    around = {v: sorted(set(face_of[(triangles == v).any(axis=1)].tolist())) for v in held}
    cones = {v: _cone(*_star(vertices, triangles, units, v)) for v in held if len(around[v]) > 2}
    reflex = [v for v, cone in cones.items() if len(cone)]
    names = [("face", f) for f in range(len(normals))] + [("edge", *pair) for pair in sorted(lines)]
    names += [("vertex", v) for v in reflex]
    sizes = np.bincount(face_of, areas)
    return Sites(names, face_of, normals, offsets, sizes, sorted(lines.items()), reflex, cones, around)


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


def _cone(along, normal):
    """The cone of the points near a vertex that are nearest to it: unit rays [n, 3] in order, or none if it is flat.

    Its points m have no positive component along any edge of the mesh. `normal` points outward.
    """
    i, j = np.triu_indices(len(along), 1)
    across = np.cross(along[i], along[j])
    lengths = np.linalg.norm(across, axis=1)
    across = across[lengths > 1e-9] / lengths[lengths > 1e-9, None]
    rays = np.vstack([across, -across])
    rays = rays[(rays @ along.T < 1e-9).all(axis=1)]
    rays = rays[np.unique(rays.round(8), axis=0, return_index=True)[1]]
    middle = rays.sum(axis=0)
    if len(rays) < 3 or middle @ normal >= 0 or np.linalg.svd(rays)[1][2] < 1e-6:
        return rays[:0]
    u = np.cross(middle, rays[0])
    return rays[np.argsort(np.arctan2(rays @ u, rays @ np.cross(u, middle)))]


def maximal_balls(vertices, triangles, count, seed=1):
    """About `count` maximal balls at random contacts, and the sites. A million balls of 30 sites take some 3 s."""
    vertices, triangles = np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64)
    sites, rng = sites_of(vertices, triangles), np.random.default_rng(seed)
    shares = np.full(len(sites.names), 0.3 / len(sites.names))
    shares[: len(sites.areas)] += 0.7 * sites.areas / sites.areas.sum()
    tries = np.maximum(100, (shares * count).astype(int))
    contacts = [_contacts(vertices, triangles, sites, k, n, rng) for k, n in enumerate(tries)]
    own = np.repeat(np.arange(len(contacts)), [len(p) for p, _, _ in contacts])
    p, m = (np.concatenate([part[k] for part in contacts]) for k in (0, 1))
    measure = np.concatenate([np.broadcast_to(part[2], len(part[0])) for part in contacts]) / tries[own]
    hidden, blocks = _hidden(sites), range(0, len(p), 50_000)
    grown = [_grow(vertices, triangles, sites, hidden, *(x[k : k + 50_000] for x in (p, m, own))) for k in blocks]
    radii, second, gaps, other = (np.concatenate(column) for column in zip(*grown, strict=True))
    centres = p + radii[:, None] * m
    slope = np.linalg.norm(m - (centres - other) / radii[:, None], axis=1) / 2  # Cosine of m and the wall's normal.
    power = np.array([("face", "edge", "vertex").index(name[0]) for name in sites.names])[own]
    weights, volumes = measure * radii**power / slope, measure * radii ** (power + 1) / (power + 1)
    return Balls(centres, radii, own, second, gaps, weights, volumes, tries), sites


def _contacts(vertices, triangles, sites, k, count, rng):
    """Random places of site k, unit vectors from there to the centres, and the measure of the set of all of these."""
    name = sites.names[k]
    if name[0] == "face":
        return *_on_face(vertices, triangles, sites, name[1], count, rng), sites.areas[name[1]]
    if name[0] == "edge":
        return _on_edge(vertices, sites, k - len(sites.areas), count, rng)
    return _at_vertex(vertices[name[1]], sites.cones[name[1]], count, rng)


def _hidden(sites):
    """If balls at site i cannot be stopped by site j [i, j]: its own planes and lines, which they touch at once."""
    faces, lines = len(sites.areas), [pair for pair, _ in sites.edges]
    around = [{f} for f in range(faces)] + [set(pair) for pair in lines] + [set(sites.around[v]) for v in sites.reflex]
    hidden = np.eye(len(sites.names), dtype=bool)
    for i, own in enumerate(around):
        hidden[i, sorted(own)] = True
        hidden[i, [faces + e for e, pair in enumerate(lines) if own.issuperset(pair)]] = True
    return hidden


def _on_face(vertices, triangles, sites, f, count, rng):
    own = triangles[sites.face_of == f]
    a, b, c = (vertices[own[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    t = rng.choice(len(own), size=count, p=areas / areas.sum())
    return _in_triangles(a, b, c, t, rng), np.tile(-sites.normals[f], (count, 1))


def _at_vertex(corner, rays, count, rng):
    """Directions in a cone, from flat triangles between its rays. Their weights make them even on the sphere."""
    a, b, c = np.tile(rays[0], (len(rays) - 2, 1)), rays[1:-1], rays[2:]
    vectors = np.cross(b - a, c - a) / 2
    areas = np.linalg.norm(vectors, axis=1)
    t = rng.choice(len(areas), size=count, p=areas / areas.sum())
    q = _in_triangles(a, b, c, t, rng)
    lengths = np.linalg.norm(q, axis=1)
    solid_angles = areas.sum() * np.abs(np.einsum("ij,ij->i", q, vectors[t] / areas[t, None])) / lengths**3
    return np.tile(corner, (count, 1)), q / lengths[:, None], solid_angles


def _in_triangles(a, b, c, t, rng):
    """Random points, even in the triangles t."""
    u, v = rng.uniform(size=(2, len(t), 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    return a[t] + u * (b - a)[t] + v * (c - a)[t]


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

    def add(self, site, rows, radii, contacts):
        """Offers radii with their contacts [n, 3] for some of the balls."""
        old, other = self.radii[rows], self.site[rows] != site
        self.next[rows] = np.minimum(self.next[rows], np.where(other, np.maximum(radii, old), np.inf))
        better = radii < old
        rows = rows[better]
        self.radii[rows], self.site[rows], self.contact[rows] = radii[better], site, contacts[better]


def _grow(vertices, triangles, sites, hidden, p, m, own):
    """Radii of the largest balls with centres p + r m, the sites that stop them, gaps, and contacts."""
    first, faces = _First(len(p)), len(sites.areas)
    near = NEAR * np.ptp(vertices, axis=0).max()
    for f in range(faces):
        slack, slope = sites.offsets[f] - p @ sites.normals[f], 1 + m @ sites.normals[f]
        with np.errstate(all="ignore"):
            radii = np.where((slack > near) & (slope > 0) & ~hidden[own, f], slack / slope, np.inf)
        tried = np.flatnonzero(radii < first.next)
        foot = p[tried] + radii[tried, None] * (m[tried] + sites.normals[f])
        inside = np.zeros(len(tried), dtype=bool)
        for t in triangles[sites.face_of == f]:
            inside |= _in_triangle(foot, vertices[t], sites.normals[f])
        first.add(f, tried[inside], radii[tried[inside]], foot[inside])
    for e, (_, segments) in enumerate(sites.edges):
        for segment in segments:
            a, b = vertices[list(segment)]
            along = (b - a) / np.linalg.norm(b - a)
            w, slope = a - p, m @ along
            w = w - np.outer(w @ along, along)  # From p across to the line.
            square, half = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m)
            with np.errstate(all="ignore"):
                below = half + np.sqrt(half**2 + slope**2 * square)
                radii = np.where((below > 1e-12 * np.sqrt(square)) & ~hidden[own, faces + e], square / below, np.inf)
                place = (p - a) @ along + radii * slope
            tried = np.flatnonzero((radii < first.next) & (place >= 0) & (place <= np.linalg.norm(b - a)))
            first.add(faces + e, tried, radii[tried], a + np.outer(place[tried], along))
    for k, v in enumerate(sites.reflex, faces + len(sites.edges)):
        w = vertices[v] - p
        square, half = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m)
        with np.errstate(all="ignore"):
            radii = np.where((half > 1e-12 * np.sqrt(square)) & ~hidden[own, k], square / (2 * half), np.inf)
        tried = np.flatnonzero(radii < first.next)
        first.add(k, tried, radii[tried], np.tile(vertices[v], (len(tried), 1)))
    return first.radii, first.site, first.next - first.radii, first.contact


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
    error: float  # Standard error of the area.
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
