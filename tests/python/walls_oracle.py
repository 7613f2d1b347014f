"""Areas of the walls of the Voronoi diagram inside a polyhedron, by an integral over normals. It does not use Blum.

    python tests/python/walls_oracle.py FILE.off [--count N] [--seed N] [--tolerance T]    prints all walls

Sites are faces (coplanar triangles that share edges), reflex edges (of the mesh: one site each) and reflex vertices.
They have the numbers of `blum voronoi`: faces by their first triangle, edges by their vertices, then vertices.

Every point inside is p + r m. Here p is its closest point of the border, on site i, and m a unit vector from p. All
(p, m) of a site are its bundle:

    site    k   bundle                                                      measure
    face    0   points p of the face, m its inward normal                   area
    edge    1   points p of the edge, m between the normals of its faces    length times angle
    vertex  2   m in the dual cone of the edges at the vertex               solid angle

From p, a ball grows along m. At r = R(p, m) it touches a site j that stops it, at the contact q. Its centre c lies on
the wall of i and j. All of the segment from p to c lies in the region of i.

The volume of the region of i is the integral of R^(k+1) / (k+1) over the bundle. The area of the wall of i and j is the
integral of R^k / cos over the part of the bundle that j stops.

R^k is the area that the parallel surface through c has for a unit of the bundle. The wall is orthogonal to the gradient
m - u of the difference of both distances, where u = (c - q) / R. So the cosine between m and the wall's normal is
m . (m - u) / |m - u| = |m - u| / 2. Bundles of i and of j give the same area twice.

No bundle sees walls at which both sites have the same closest point, because m = u there. These are found alone:

- A face and its own reflex edge e share the points p + r m with r <= R(p, m). Here p is in e, and m is the face's
  normal. The area is the integral of R over e.
- An edge e and its end v share the points v + r m with r <= R. Here m is in the dual cone of v and orthogonal to e. The
  area is the integral of R^2 / 2 over the angle of m. Two edges in one line that meet in v share such points, too.

Bundles are cut into small triangles of equal measure, with two random points in each. Differences of the two give the
standard error. It falls faster than that of independent points, about as N^(-3/4). Sites whose walls are larger get
more points.

Cost: about 1 s for a million points and 10 sites, 3 s for 70 sites, 20 s for 550 sites.
"""

import argparse
import itertools
import math
import pathlib
import sys
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from exact_signs import cross, dot, integers, minus

FIRST = 12  # Sites that all balls of a block try. Further ones are tried if they are near the ball.
BLOCK = 4096  # Points that grow together, all close to each other.
ROUNDING = 1e-12  # Fraction of an area.
INSIDE = 1e-12  # Fraction of an edge by which contacts may lie outside their triangle: rounding.


class Site(NamedTuple):
    kind: str  # "face", "edge" or "vertex".
    members: tuple  # Ids of the triangles of a face, otherwise of vertices, ascending.


class Own(NamedTuple):
    """A wall whose points have one closest point: on the edge from `points[0]` to `points[1]`, or at `points[0]`."""

    pair: tuple
    points: np.ndarray
    rays: np.ndarray  # The direction from an edge, or the two that bound those from a vertex.


class Sites(NamedTuple):
    """Sites of a polyhedron. Coordinates are relative to vertex 0."""

    sites: list
    points: np.ndarray
    triangles: np.ndarray
    face_of: np.ndarray  # [triangles]
    normals: np.ndarray  # [faces, 3] outward.
    offsets: np.ndarray  # [faces] normal.x of the face's points.
    bundles: list  # For each site, base triangles [n, 3, d] of the parameters of its bundle.
    faces_of_edge: list  # For each reflex edge, the two faces (f, g).
    own: list  # Walls whose points have one closest point.
    own_seams: list  # Sets of sites of the seams whose points have one closest point, which is a vertex.
    hidden: np.ndarray  # [i, j]: site i lies in the plane, on the line or at the point of site j.

    def name(self, k):
        kind, members = self.sites[k]
        return f"{kind} {k}" if kind == "face" else f"{kind} {'-'.join(map(str, members))}"


class Wall(NamedTuple):
    """`sides` are the areas seen from the first and the second site of the pair; (area, area) for own walls.

    The area is a mean of both, with a weight that does not depend on them.
    """

    area: float
    error: float  # Standard error of the area.
    hits: int
    sides: tuple
    errors: tuple


class Walls(NamedTuple):
    sites: Sites
    walls: dict  # Wall by pair of sites (i, j), i < j.
    own: dict  # The same for walls whose points have one closest point.
    volumes: np.ndarray  # [sites] of the regions.
    errors: np.ndarray  # [sites] standard errors of the volumes.
    grains: np.ndarray  # [sites] mean area of wall for which a ball of the site stands.

    def smallest(self, pair):
        """Walls of the pair that are smaller may be missed: less than 20 balls are expected on them."""
        return 20 * min(self.grains[list(pair)])

    def areas(self):
        """Areas and standard errors of all walls, own ones too, by pair."""
        return {pair: (wall.area, wall.error) for part in (self.walls, self.own) for pair, wall in part.items()}


# Sites


def sites_of(vertices, triangles, tolerance=0.0):
    """The sites of a closed polyhedron with outward triangles.

    With a tolerance of 0, coordinates count as exact, and integers decide about faces, reflex edges and vertices. With
    a tolerance above 0, in units of the vertices, triangles form a face if they are flat up to errors of that size.
    Features must then be larger than some hundred tolerances.
    """
    vertices, triangles = np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64)
    whole, scale = integers(vertices)
    whole = [minus(p, whole[0]) for p in whole]
    points = np.array([[x / scale for x in p] for p in whole])
    edges = _edges(triangles)
    vectors = [cross(minus(whole[b], whole[a]), minus(whole[c], whole[a])) for a, b, c in triangles.tolist()]
    if (0, 0, 0) in vectors:
        raise ValueError(f"triangle {vectors.index((0, 0, 0))} has no area; expected triangles with an area")
    turns = {edge: _turn(whole, triangles, vectors, *edge, *pair) for edge, pair in edges.items()}
    flat = {edge for edge, turn in turns.items() if turn == 0}
    if tolerance:
        flat |= {edge for edge, pair in edges.items() if _is_flat(points, triangles, *pair, tolerance)}
    face_of = _numbered(len(triangles), [edges[edge] for edge in flat])
    normals = _unit([_sum(vectors[t] for t in np.flatnonzero(face_of == f)) for f in range(face_of.max() + 1)])
    areas = np.linalg.norm(_area_vectors(points[triangles]), axis=1)
    heights = np.einsum("ij,ij->i", points[triangles].mean(axis=1), normals[face_of])
    offsets = np.bincount(face_of, areas * heights) / np.bincount(face_of, areas)
    reflex = sorted(edge for edge, turn in turns.items() if turn > 0 and edge not in flat)
    faces_of_edge = [tuple(sorted(face_of[list(edges[edge])].tolist())) for edge in reflex]
    cones = {}
    for v in sorted({v for edge in reflex for v in edge}):
        rays, full, inside = _dual_cone(whole, points, triangles, vectors, v, tolerance)
        if inside:
            cones[v] = rays, full
    corners = [v for v, (_, full) in cones.items() if full]
    sites = [Site("face", tuple(np.flatnonzero(face_of == f).tolist())) for f in range(len(normals))]
    sites += [Site("edge", edge) for edge in reflex] + [Site("vertex", (v,)) for v in corners]
    bundles = [points[triangles[face_of == f]] for f in range(len(normals))]
    bundles += [_edge_bundle(points, normals, *both) for both in zip(reflex, faces_of_edge, strict=True)]
    bundles += [_fan(cones[v][0]) for v in corners]
    own = _own_walls(points, normals, reflex, faces_of_edge, cones, corners)
    hidden = _hidden(sites, whole, points, triangles, vectors, tolerance)
    own_seams = _own_seams(normals, reflex, faces_of_edge, points, cones, corners)
    return Sites(sites, points, triangles, face_of, normals, offsets, bundles, faces_of_edge, own, own_seams, hidden)


def _edges(triangles):
    """The two triangles of each edge (a, b), a < b. The first one runs from a to b."""
    found = {}
    for t, corners in enumerate(triangles.tolist()):
        for k in range(3):
            side = corners[k], corners[(k + 1) % 3]
            if side in found:
                raise ValueError(f"edge {side} has two triangles on one side; expected a closed oriented mesh")
            found[side] = t
    for a, b in found:
        if (b, a) not in found:
            raise ValueError(f"edge {(a, b)} has one triangle; expected a closed oriented mesh")
    return {(a, b): (t, found[b, a]) for (a, b), t in found.items() if a < b}


def _turn(whole, triangles, vectors, a, b, s, t):
    """Above 0 if the edge is reflex, 0 if it is flat."""
    far = next(v for v in triangles[t].tolist() if v not in (a, b))
    return dot(vectors[s], minus(whole[far], whole[a]))


def _is_flat(points, triangles, s, t, tolerance):
    """If two triangles that share an edge lie in one plane, up to errors of the vertices."""
    corners = points[triangles[[s, t]]]
    vectors = _area_vectors(corners)
    areas = np.linalg.norm(vectors, axis=1)
    large = int(areas[1] > areas[0])
    seen = corners[1 - large] - corners[large].mean(axis=0)
    width = 2 * areas[large] / np.linalg.norm(corners[large] - np.roll(corners[large], 1, axis=0), axis=1).max()
    bound = 8 * tolerance * (1 + np.linalg.norm(seen, axis=1) / width)
    facing = vectors[0] @ vectors[1] > 0 or areas.min() < bound.max() * width
    return facing and (np.abs(seen @ vectors[large] / areas[large]) <= bound).all()


def _numbered(count, pairs):
    """Numbers of the sets that the pairs join, in the order of their smallest members."""
    parent = list(range(count))

    def root(t):
        while parent[t] != t:
            t = parent[t]
        return t

    for s, t in pairs:
        low, high = sorted((root(s), root(t)))
        parent[high] = low
    return np.unique([root(t) for t in range(count)], return_inverse=True)[1]


def _sum(vectors):
    return tuple(map(sum, zip(*vectors, strict=True)))


def _unit(vectors):
    """Unit vectors of integer vectors, which may be too large for floats."""
    rows = [np.array([float(x / max(map(abs, v))) if max(map(abs, v)) else 0.0 for x in v]) for v in vectors]
    return np.array([row / np.linalg.norm(row) for row in rows])


def _area_vectors(corners):
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def _dual_cone(whole, points, triangles, vectors, v, tolerance):
    """The directions m with m.w <= 0 for all edges w at v: its rays in order, if it has an interior, if it is inside.

    Its rays are orthogonal to two edges each. It lies on one side of the border, and that is known from the sum of the
    normals at v, weighted by angles: it decides for each point that is closest to v (Baerentzen and Aanaes 2005).
    """
    around = np.flatnonzero((triangles == v).any(axis=1))
    ends = sorted(set(triangles[around].ravel().tolist()) - {v})
    along = [minus(whole[w], whole[v]) for w in ends]
    unit = _unit(along)
    normal = np.zeros(3)
    for t in around:
        p, q = (unit[ends.index(w)] for w in triangles[t].tolist() if w != v)
        normal += _unit([vectors[t]])[0] * np.arctan2(np.linalg.norm(np.cross(p, q)), p @ q)
    if tolerance:
        slack = 16 * tolerance / np.linalg.norm(points[ends] - points[v], axis=1).min()
        rays = _loose_rays(unit, slack)
        full = len(rays) > 2 and (unit @ rays.sum(axis=0) < -8 * slack).all()
    else:
        candidates = (cross(a, b) for a, b in itertools.combinations(along, 2))
        candidates = (side for c in candidates for side in (c, minus((0, 0, 0), c)) if c != (0, 0, 0))
        exact = {_primitive(c) for c in candidates if all(dot(c, w) <= 0 for w in along)}
        rays = _unit(sorted(exact)) if exact else np.zeros((0, 3))
        full = len(rays) > 2 and all(any(dot(c, w) < 0 for c in exact) for w in along)
    middle = rays.sum(axis=0)
    if len(rays) > 2:
        u = np.cross(middle, rays[np.abs(rays @ middle).argmin()])
        rays = rays[np.argsort(np.arctan2(rays @ u, rays @ np.cross(u, middle) / np.linalg.norm(middle)))]
    return rays, bool(full), len(rays) > 1 and middle @ normal < 0


def _primitive(vector):
    divisor = math.gcd(*vector)
    return tuple(x // divisor for x in vector)


def _loose_rays(unit, slack):
    i, j = np.triu_indices(len(unit), 1)
    across = np.cross(unit[i], unit[j])
    lengths = np.linalg.norm(across, axis=1)
    across = across[lengths > 1e-4] / lengths[lengths > 1e-4, None]
    rays = []
    for ray in np.vstack([across, -across]):
        if (unit @ ray <= slack).all() and all(np.linalg.norm(ray - other) > 8 * slack for other in rays):
            rays.append(ray)
    return np.array(rays).reshape(-1, 3)


def _edge_bundle(points, normals, edge, faces):
    """The rectangle of places along an edge and of angles, scaled to the edge's length, as two triangles."""
    length = np.linalg.norm(points[edge[1]] - points[edge[0]])
    return np.array([[(0, 0), (length, 0), (length, length)], [(0, 0), (length, length), (0, length)]])


def _fan(rays):
    return np.array([(rays[0], b, c) for b, c in itertools.pairwise(rays[1:])])


def _own_walls(points, normals, reflex, faces_of_edge, cones, corners):
    out, faces = [], len(normals)
    for e, (edge, pair) in enumerate(zip(reflex, faces_of_edge, strict=True)):
        out += [Own((f, faces + e), points[list(edge)], -normals[[f]]) for f in pair]
    for v, (rays, full) in cones.items():
        at = [e for e, edge in enumerate(reflex) if v in edge]
        for e in at:
            a, b = points[list(reflex[e])]
            along = (b - a) / np.linalg.norm(b - a)
            held = rays[np.abs(rays @ along) < 1e-6]
            if len(held) != 2 and full:
                continue
            if full:
                pair = faces + e, faces + len(reflex) + corners.index(v)
            else:
                others = [o for o in at if o > e and _in_line(points, reflex[e], reflex[o])]
                if not others:
                    continue
                pair = faces + e, faces + others[0]
            out.append(Own(pair, points[[v]], held))
    return out


def _own_seams(normals, reflex, faces_of_edge, points, cones, corners):
    """A ray of the dual cone of a vertex is the normal of a face. Its edges at the vertex are closest to it, too."""
    out = []
    for v, (rays, full) in cones.items():
        at = [e for e, edge in enumerate(reflex) if v in edge]
        for ray in rays:
            along = {e: points[reflex[e][1]] - points[reflex[e][0]] for e in at}
            held = [e for e in at if abs(ray @ along[e]) < 1e-6 * np.linalg.norm(along[e])]
            faces = {f for e in held for f in faces_of_edge[e] if ray @ normals[f] < -1 + 1e-9}
            own = sorted(faces) + [len(normals) + e for e in held]
            own += [len(normals) + len(reflex) + corners.index(v)] if full else []
            if len(own) > 2 and (full or len(held) > 1):
                out.append(tuple(own))
    return out


def _in_line(points, one, other):
    a, b = (points[edge[1]] - points[edge[0]] for edge in (one, other))
    return np.linalg.norm(np.cross(a, b)) < 1e-6 * np.linalg.norm(a) * np.linalg.norm(b)


def _hidden(sites, whole, points, triangles, vectors, tolerance):
    """If site i lies in the plane, on the line or at the point of site j [i, j]. Its balls are not stopped by j."""
    held = [np.unique(triangles[list(s.members)]).tolist() if s.kind == "face" else list(s.members) for s in sites]
    out = np.zeros((len(sites), len(sites)), dtype=bool)
    for j, site in enumerate(sites):
        if site.kind == "face":
            t = max(site.members, key=lambda t: _length(vectors[t]))
            near = _near_plane(points, points[triangles[t]], tolerance)
            on = {v for v in near if tolerance or dot(vectors[t], minus(whole[v], whole[triangles[t][0]])) == 0}
        elif site.kind == "edge":
            a, b = site.members
            along = minus(whole[b], whole[a])
            if tolerance:
                unit = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
                away = np.linalg.norm(np.cross(points - points[a], unit), axis=1)
                bound = 8 * tolerance * (1 + np.linalg.norm(points - points[a], axis=1) / _length(along))
                on = set(np.flatnonzero(away < bound).tolist())
            else:
                on = {v for v, p in enumerate(whole) if cross(minus(p, whole[a]), along) == (0, 0, 0)}
        else:
            on = set(site.members)
        out[:, j] = [on.issuperset(own) for own in held]
    return out


def _length(vector):
    top = max(map(abs, vector))
    return math.hypot(*(x / top for x in vector)) * float(top)


def _near_plane(points, corners, tolerance):
    """Ids of the points near the plane of a triangle: the candidates for points in it, or all within the tolerance."""
    normal = _area_vectors(corners[None])[0]
    area, seen = np.linalg.norm(normal), points - corners.mean(axis=0)
    width = 2 * area / np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
    bound = max(8 * tolerance, 1e-12 * width) * (1 + np.linalg.norm(seen, axis=1) / width)
    return np.flatnonzero(np.abs(seen @ normal / area) <= bound).tolist()


# Balls


def walls(vertices, triangles, count=1_000_000, seed=1, tolerance=0.0):
    """All walls inside a closed polyhedron, and the volumes of its regions, from about `count` balls."""
    sites, rng = sites_of(vertices, triangles, tolerance), np.random.default_rng(seed)
    search = _Search(sites)
    pilot = max(64, count // (20 * len(sites.sites)))
    sizes = np.array([_measure(sites, search, k, pilot, rng).weight.sum() for k in range(len(sites.sites))])
    shares = 0.3 / len(sizes) + 0.7 * sizes / sizes.sum()
    bundles = [_measure(sites, search, k, int(share * count), rng) for k, share in enumerate(shares)]
    own = {}
    for wall in sites.own:
        area, error = _own_area(search, wall, max(256, count // 500), rng)
        before = own.get(wall.pair, Wall(0.0, 0.0, 0, (0.0, 0.0), (0.0, 0.0)))
        area, error = before.area + area, math.hypot(before.error, error)
        own[wall.pair] = Wall(area, error, before.hits + 1, (area, area), (error, error))
    grains = np.array([bundle.weight.mean() for bundle in bundles])
    return Walls(sites, _by_pair(bundles), dict(sorted(own.items())), *_volumes(bundles), grains)


class _Bundle(NamedTuple):
    """Two balls [cells, 2] for each cell of a site's bundle: area of wall, volume, and the site that stops each."""

    weight: np.ndarray
    volume: np.ndarray
    stop: np.ndarray


def _measure(sites, search, k, count, rng):
    """The balls of site k."""
    cells = _cells(sites.bundles[k], count, rng)
    power = ("face", "edge", "vertex").index(sites.sites[k].kind)
    weight, volume = np.empty((len(cells), 2)), np.empty((len(cells), 2))
    stop = np.empty((len(cells), 2), dtype=np.int64)
    for low in range(0, len(cells), BLOCK // 2):
        part = slice(low, low + BLOCK // 2)
        places = _in_cells(cells[part], rng)
        p, m = _contacts(sites, k, places)
        density = _densities(sites, k, places, cells[part])
        radii, found, contacts = search.grow(k, p, m)
        centres = p + radii[:, None] * m
        cosine = np.linalg.norm(m - (centres - contacts) / radii[:, None], axis=1) / 2
        weight[part] = (density * radii**power / cosine).reshape(-1, 2) / 2
        volume[part] = (density * radii ** (power + 1) / (power + 1)).reshape(-1, 2) / 2
        stop[part] = found.reshape(-1, 2)
    return _Bundle(weight, volume, stop)


def _cells(base, count, rng):
    """About count / 2 triangles [n, 3, d] that cut the base triangles across longest sides. Close ones follow each
    other."""
    sizes = _sizes(base)
    out = []
    for triangle, share in zip(base, sizes / sizes.sum(), strict=True):
        part = triangle[None]
        for _ in range(max(0, math.ceil(math.log2(max(1.0, share * count / 2))))):
            sides = np.linalg.norm(np.roll(part, -1, axis=1) - part, axis=2)
            turned = (sides.argmax(axis=1)[:, None] + np.arange(3)) % 3
            a, b, c = np.moveaxis(part[np.arange(len(part))[:, None], turned], 1, 0)
            middle = a + rng.uniform(0.4, 0.6, size=(len(part), 1)) * (b - a)  # Cells follow no seam of regular solids.
            part = np.stack([np.stack([a, middle, c], 1), np.stack([middle, b, c], 1)], 1).reshape(-1, *base.shape[1:])
        out.append(part)
    return np.concatenate(out)


def _sizes(cells):
    u, v = cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0]
    if cells.shape[2] == 2:
        return np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    return np.linalg.norm(np.cross(u, v), axis=1) / 2


def _in_cells(cells, rng):
    """Two random points in each triangle [2 n, d]."""
    u, v = rng.uniform(size=(2, len(cells), 2, 1))
    u, v = np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v)
    a, b, c = (cells[:, k, None] for k in range(3))
    return (a + u * (b - a) + v * (c - a)).reshape(-1, cells.shape[2])


def _contacts(sites, k, places):
    """Points p and unit vectors m at places of the bundle of site k."""
    kind, members = sites.sites[k]
    if kind == "face":
        return places, np.tile(-sites.normals[k], (len(places), 1))
    if kind == "edge":
        a, b = sites.points[list(members)]
        along = places / np.linalg.norm(b - a)
        return a + along[:, :1] * (b - a), _turned(*_sides_of_edge(sites, k), along[:, 1])
    lengths = np.linalg.norm(places, axis=1)
    return np.tile(sites.points[members[0]], (len(places), 1)), places / lengths[:, None]


def _densities(sites, k, places, cells):
    """The measure of each place's cell, if its density was that of the place."""
    kind, members = sites.sites[k]
    if kind == "face":
        return np.repeat(_sizes(cells), 2)
    if kind == "edge":
        a, b = sites.points[list(members)]
        return np.repeat(_sizes(cells), 2) * _angle(*_sides_of_edge(sites, k)) / np.linalg.norm(b - a)
    # The solid angle of a flat triangle is the integral of the cosine over the square of the distance.
    normals = np.repeat(_area_vectors(cells), 2, axis=0)
    return np.abs(np.einsum("ij,ij->i", places, normals)) / np.linalg.norm(places, axis=1) ** 3


def _sides_of_edge(sites, k):
    return (-sites.normals[f] for f in sites.faces_of_edge[k - len(sites.normals)])


def _angle(first, second):
    return np.arctan2(np.linalg.norm(np.cross(first, second)), first @ second)


def _turned(first, second, parts):
    """Unit vectors at parts of the angle between two of them."""
    across = second - (second @ first) * first
    across /= np.linalg.norm(across)
    turn = _angle(first, second) * parts
    return np.outer(np.cos(turn), first) + np.outer(np.sin(turn), across)


class _Search:
    """Finds what stops a ball that grows from the border, among all sites."""

    def __init__(self, sites):
        self.sites = sites
        held = [
            sites.points[np.unique(sites.triangles[list(s.members)])]
            if s.kind == "face"
            else sites.points[list(s.members)]
            for s in sites.sites
        ]
        self.middles = np.array([(own.min(axis=0) + own.max(axis=0)) / 2 for own in held])
        self.reaches = np.array(
            [np.linalg.norm(own - m, axis=1).max() for own, m in zip(held, self.middles, strict=True)]
        )

    def grow(self, k, p, m, hidden=None):
        """Radii of the largest balls with centres p + r m that hold no site inside, what stops them, and contacts.

        Site k is that of all p. Sites too far away to stop any of these balls are skipped.
        """
        hidden = self.sites.hidden[k] if hidden is None else hidden
        low, high = p.min(axis=0), p.max(axis=0)
        middle, reach = (low + high) / 2, np.linalg.norm(high - low) / 2
        gaps = np.linalg.norm(self.middles - middle, axis=1) - self.reaches - reach
        radii, stop, contacts = np.full(len(p), np.inf), np.full(len(p), -1), np.zeros_like(p)
        order, rows, near = np.argsort(gaps, kind="stable"), np.arange(len(p)), None
        for tried, j in enumerate(order[~hidden[order]]):
            if gaps[j] > 2 * radii.max():
                break
            if tried == FIRST:
                near = self._near(p, m, radii)
            if near is not None:
                rows = np.flatnonzero(near[:, j])
                if not len(rows):
                    continue
            method = getattr(self, f"_{self.sites.sites[j].kind}")
            better, found, touched = method(j, p[rows], m[rows], radii[rows])
            radii[rows[better]], stop[rows[better]], contacts[rows[better]] = found, j, touched
        if (stop < 0).any():
            raise ValueError("a ball grows without end; expected a closed solid with outward triangles")
        return radii, stop, contacts

    def _near(self, p, m, radii):
        """If the ball [i] of the radius so far, which holds all smaller ones, may touch site j [i, j]."""
        known = np.isfinite(radii)
        centres = p + np.where(known, radii, 0.0)[:, None] * m
        squares = np.einsum("ij,ij->i", centres, centres)[:, None] + np.einsum("ij,ij->i", self.middles, self.middles)
        squares -= 2 * centres @ self.middles.T
        bounds = (np.where(known, radii, np.inf)[:, None] + self.reaches) ** 2
        return squares <= bounds + 1e-9 * np.abs(squares).max()

    def _face(self, f, p, m, below):
        """Rows of the balls that face f stops before the radii `below`, with radii and contacts."""
        normal = self.sites.normals[f]
        slack, slope = self.sites.offsets[f] - p @ normal, 1 + m @ normal
        with np.errstate(all="ignore"):
            radii = np.where((slack > 0) & (slope > 0), slack / slope, np.inf)
        rows = np.flatnonzero(radii < below)
        feet = p[rows] + radii[rows, None] * (m[rows] + normal)
        inside = np.zeros(len(rows), dtype=bool)
        for t in self.sites.sites[f].members:
            inside |= _in_triangle(feet, self.sites.points[self.sites.triangles[t]], normal)
        return rows[inside], radii[rows[inside]], feet[inside]

    def _edge(self, j, p, m, below):
        a, b = self.sites.points[list(self.sites.sites[j].members)]
        length = np.linalg.norm(b - a)
        along = (b - a) / length
        w = a - p
        w = w - np.outer(w @ along, along)  # From p across to the line.
        # The distance from the line is r: |w|^2 - 2 r w.m - r^2 (m.along)^2 = 0.
        square, half, slope = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m), m @ along
        with np.errstate(all="ignore"):
            divisor = half + np.sqrt(half**2 + slope**2 * square)
            radii = np.where(divisor > 1e-14 * np.sqrt(square), square / divisor, np.inf)
            place = (p - a) @ along + radii * slope
        rows = np.flatnonzero((radii < below) & (place >= -INSIDE * length) & (place <= (1 + INSIDE) * length))
        return rows, radii[rows], a + np.outer(place[rows], along)

    def _vertex(self, j, p, m, below):
        corner = self.sites.points[self.sites.sites[j].members[0]]
        w = corner - p
        square, half = np.einsum("ij,ij->i", w, w), np.einsum("ij,ij->i", w, m)
        with np.errstate(all="ignore"):
            radii = np.where(half > 1e-14 * np.sqrt(square), square / (2 * half), np.inf)
        rows = np.flatnonzero(radii < below)
        return rows, radii[rows], np.tile(corner, (len(rows), 1))


def _in_triangle(points, corners, normal):
    inside = np.ones(len(points), dtype=bool)
    for k in range(3):
        a, b = corners[k], corners[(k + 1) % 3]
        across = np.cross(normal, b - a)
        across /= np.linalg.norm(across)
        inside &= (points - a) @ across >= -INSIDE * np.linalg.norm(b - a)
    return inside


# Seams


def seams(vertices, triangles, count=200_000, seed=1, tolerance=0.0):
    """How often each set of three or more closest sites was found on seams, and a point of one of them.

    If different sites stop two balls beside each other, bisection leads from one to the other until the stop changes.
    The centre of that ball lies on a seam. Sites whose distances agree to 1e-10 belong to one set. So sets that were
    found once or twice may belong to points near a junction. Seams whose points have one closest point are in
    `sites.own_seams` only. Seams shorter than the cells may be missed, and so are those at the border of all of their
    bundles. An example is the seam at which walls of two reflex edges with their own faces meet.
    """
    sites, rng = sites_of(vertices, triangles, tolerance), np.random.default_rng(seed)
    search, out = _Search(sites), {}
    for k, base in enumerate(sites.bundles):
        pairs = _in_cells(_cells(base, count // len(sites.sites), rng), rng).reshape(-1, 2, base.shape[2])
        pairs = np.concatenate([pairs, _across(base, rng)])
        for low in range(0, len(pairs), BLOCK // 2):
            for own, point in _crossings(sites, search, k, pairs[low : low + BLOCK // 2]):
                times, first = out.get(own, (0, point + np.asarray(vertices, dtype=float)[0]))
                out[own] = times + 1, first
    return dict(sorted(out.items()))


def _across(base, rng, count=64):
    """Pairs of places on both sides of each side that two base triangles share."""
    out = [np.zeros((0, 2, base.shape[2]))]
    for one, other in itertools.combinations(base, 2):
        shared = (one[:, None] == other).all(axis=2)
        if shared.sum() != 2:
            continue
        a, b = one[shared.any(axis=1)]
        place = a + rng.uniform(0.02, 0.98, size=(count, 1)) * (b - a)
        apexes = one[~shared.any(axis=1)][0], other[~shared.any(axis=0)][0]
        reach = max(np.linalg.norm(apex - place, axis=1).max() for apex in apexes)
        step = 0.01 * min(1.0, np.linalg.norm(b - a) / reach)
        out.append(np.stack([place + step * (apex - place) for apex in apexes], axis=1))
    return np.concatenate(out)


def _crossings(sites, search, k, pairs):
    """Sets of sites and centres of balls between the two places [n, 2, d], if different sites stop their balls."""

    def stops(places):
        p, m = _contacts(sites, k, places)
        return p, m, search.grow(k, p, m)

    stop = stops(pairs.reshape(-1, pairs.shape[2]))[2][1].reshape(-1, 2)
    rows = np.flatnonzero(stop[:, 0] != stop[:, 1])
    if not len(rows):
        return
    low, high = pairs[rows].transpose(1, 0, 2)
    for _ in range(45):
        middle = (low + high) / 2
        same = stops(middle)[2][1] == stop[rows, 0]
        low, high = np.where(same[:, None], middle, low), np.where(same[:, None], high, middle)
    p, m, (radii, _, _) = stops(low)
    equal = np.zeros((len(rows), len(sites.sites)), dtype=bool)
    equal[:, k] = True
    equal[np.arange(len(rows)), stops(high)[2][1]] = True
    for j in np.flatnonzero(~sites.hidden[k]):
        found = getattr(search, f"_{sites.sites[j].kind}")(j, p, m, radii * (1 + 1e-10))[0]
        equal[found, j] = True
    for own, point in zip(equal, p + radii[:, None] * m, strict=True):
        yield tuple(np.flatnonzero(own).tolist()), point


# Sums


def _own_area(search, wall, count, rng):
    """The area of a wall whose points have one closest point, and its standard error."""
    places = (np.arange(count)[:, None] + rng.uniform(size=(count, 2))).ravel() / count
    hidden = search.sites.hidden[wall.pair[0]] | search.sites.hidden[wall.pair[1]]
    if len(wall.points) == 2:
        a, b = wall.points
        p, m = a + np.outer(places, b - a), np.tile(wall.rays[0], (2 * count, 1))
        values, whole = search.grow(wall.pair[1], p, m, hidden)[0], np.linalg.norm(b - a)
    else:
        angle, m = _angle(*wall.rays), _turned(*wall.rays, places)
        p = np.tile(wall.points[0], (2 * count, 1))
        values, whole = search.grow(wall.pair[1], p, m, hidden)[0] ** 2 / 2, angle
    values = values.reshape(-1, 2) * whole / count
    area, variance = values.mean(axis=1).sum(), ((values[:, 0] - values[:, 1]) ** 2).sum() / 4
    return float(area), math.sqrt(variance) + ROUNDING * float(area)


def _by_pair(bundles):
    """Walls from the balls of both sites."""
    count, sides = len(bundles), {}
    # Few balls may all agree by chance. So each error is at least that of one more ball. This holds without balls, too.
    least = [float(np.mean(bundle.weight**2)) for bundle in bundles]
    for i, bundle in enumerate(bundles):
        hits = np.bincount(bundle.stop.ravel(), minlength=count)
        areas = np.bincount(bundle.stop.ravel(), bundle.weight.ravel(), minlength=count)
        same = bundle.stop[:, 0] == bundle.stop[:, 1]
        variances = np.bincount(bundle.stop[same, 0], np.diff(bundle.weight[same])[:, 0] ** 2, minlength=count)
        variances += np.bincount(bundle.stop[~same].ravel(), bundle.weight[~same].ravel() ** 2, minlength=count)
        for j in np.flatnonzero(hits):
            error = math.sqrt(variances[j] + least[i]) + ROUNDING * areas[j]
            sides[i, int(j)] = float(areas[j]), error, int(hits[j])
    out = {}
    for i, j in sorted({tuple(sorted(pair)) for pair in sides}):
        one, other = sides.get((i, j), (0.0, least[i] ** 0.5, 0)), sides.get((j, i), (0.0, least[j] ** 0.5, 0))
        part = least[j] / (least[i] + least[j])  # More weight for the side with smaller cells.
        area, error = part * one[0] + (1 - part) * other[0], math.hypot(part * one[1], (1 - part) * other[1])
        out[i, j] = Wall(area, error, one[2] + other[2], (one[0], other[0]), (one[1], other[1]))
    return out


def _volumes(bundles):
    volumes = np.array([bundle.volume.sum() for bundle in bundles])
    errors = np.array([np.linalg.norm(np.diff(bundle.volume)) for bundle in bundles])
    return volumes, errors + ROUNDING * volumes


# By hand


def read_off(path):
    """Vertices and triangles of an OFF file."""
    words = [line.split("#")[0].split() for line in pathlib.Path(path).read_text().splitlines()]
    words = [word for line in words for word in line]
    if not words or words[0] != "OFF":
        raise ValueError(f"{path} does not start with OFF; expected a text file in OFF")
    vertices, faces = int(words[1]), int(words[2])
    points = np.array(words[4 : 4 + 3 * vertices], dtype=float).reshape(-1, 3)
    triangles = np.array(words[4 + 3 * vertices : 4 + 3 * vertices + 4 * faces], dtype=np.int64).reshape(-1, 4)
    if len(triangles) and (triangles[:, 0] != 3).any():
        raise ValueError(f"{path} has faces of more than three corners; expected triangles")
    return points, triangles[:, 1:]


def write_off(path, vertices, triangles):
    lines = ["OFF", f"{len(vertices)} {len(triangles)} 0"]
    lines += [" ".join(repr(float(x)) for x in p) for p in vertices] + ["3 " + " ".join(map(str, t)) for t in triangles]
    pathlib.Path(path).write_text("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description="Prints the walls of the Voronoi diagram inside a polyhedron.")
    parser.add_argument("file")
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerance", type=float, default=0.0)
    options = parser.parse_args()
    found = walls(*read_off(options.file), options.count, options.seed, options.tolerance)
    kinds = [site.kind for site in found.sites.sites]
    print(f"{kinds.count('face')} faces, {kinds.count('edge')} reflex edges, {kinds.count('vertex')} reflex vertices")
    for title, part in (("walls", found.walls), ("walls whose points have one closest point", found.own)):
        print(f"{title}: {len(part)}")
        for (i, j), wall in part.items():
            names = f"{found.sites.name(i)} / {found.sites.name(j)}"
            sides = f"{wall.sides[0]:12.6g} {wall.sides[1]:12.6g}"
            print(f"{names:40} {wall.area:15.9g} +- {wall.error:8.2g}   {sides}  {wall.hits}")
    print("volumes of regions, by site:")
    for k, (volume, error) in enumerate(zip(found.volumes, found.errors, strict=True)):
        print(f"{found.sites.name(k):40} {volume:15.9g} +- {error:8.2g}")
    print(f"{'all':40} {found.volumes.sum():15.9g} +- {np.linalg.norm(found.errors):8.2g}")


if __name__ == "__main__":
    main()
