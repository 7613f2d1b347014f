"""The exact Voronoi diagram inside a polygon, and with it that inside each prism over the polygon. It uses no Blum.

In the plane, sites are the sides of the polygon and its reflex corners. A node is a point with three or more closest
sites. An arc is a connected part of the wall of two sites between nodes or corners. All triples of sites are tried. A
node must have no closer site. Numbers have 60 digits. Two distances count as equal if they differ by less than 1e-30 of
the size, and none may differ by 1e-30 to 1e-18. Two independent counts of the arcs prove that no node is missing
(`_count_arcs`).

In a prism of height H, sites are the two caps, a face for each side and a reflex edge for each reflex corner. The
distance from the side faces and edges is d, that in the plane; the distance from the caps is z or H - z. So the caps'
regions lie below the graph of min(d, t) and above its mirror image, where t = H / 2. All of the structure follows from
arcs and nodes and from the level d = t (`prism()`).

How sheets, seams and junctions are counted: A sheet is a connected part of the wall of one pair of sites. To its
points, no third site is as close. Walls between a face and its own reflex edge have sheets, too. A seam is a connected
curve of points with the same three or more closest sites. In a junction, seams end. It has four or more closest sites,
or is a vertex of the polyhedron.

- At a convex edge of the polyhedron, the sheet of its two faces ends. The edge does not count as a seam.
- At a reflex edge e of faces f and g, the sheets f/e and g/e end. The edge does not count as a seam by default.
- One seam ends in a convex vertex of a prism. Two seams end in a reflex one: cap/f/e and cap/g/e. Both vertices are
  junctions.

Other counts treat reflex edges differently. `counts("seams")` counts them as seams, with the sites f, e and g.
`counts("joined")` counts cap/f/e and cap/g/e as one seam, which passes the vertex without a junction.
"""

import decimal
import itertools
import math
from collections import Counter
from typing import NamedTuple

import numpy as np

D = decimal.Decimal
DIGITS = 60
SAME, CLOSE = D("1e-30"), D("1e-18")  # Fractions of the size.


class Site(NamedTuple):
    """A side, or a reflex corner. Sides are numbered by their first corners, reflex corners follow."""

    corner: int  # The first corner of a side.
    is_side: bool


class Node(NamedTuple):
    position: tuple  # Two Decimals.
    distance: D
    sites: tuple  # Anticlockwise, by the directions to their closest points. The smallest one comes first.


class Arc(NamedTuple):
    """`ends` are numbers of nodes, or -1 - k for corner k of the polygon."""

    sites: tuple  # In order.
    ends: tuple
    distances: tuple  # From the border to the ends.
    least: D  # The least distance along the arc.
    is_own: bool  # If the arc lies between a side and its own reflex corner.


class Diagram:
    """The diagram of a profile: loops of corners, the outline anticlockwise, holes clockwise."""

    def __init__(self, loops):
        with decimal.localcontext(prec=DIGITS):
            self._read(loops)
            self.nodes = self._nodes()
            self.arcs = self._arcs()
            self._count_arcs()

    # Sites

    def _read(self, loops):
        self.corners, self.after, self.before = [], [], []
        for loop in loops:
            start, n = len(self.corners), len(loop)
            self.corners += [(D(float(x)), D(float(y))) for x, y in np.asarray(loop, dtype=float)]
            self.after += [start + (k + 1) % n for k in range(n)]
            self.before += [start + (k - 1) % n for k in range(n)]
        self.holes = len(loops) - 1
        n = len(self.corners)
        turns = [_cross(self._side(self.before[k]), self._side(k)) for k in range(n)]
        if any(turn == 0 for turn in turns):
            raise ValueError("two sides of the profile lie in one line; expected a corner between them")
        self.reflex = [k for k in range(n) if turns[k] < 0]
        self.convex = [k for k in range(n) if turns[k] > 0]
        self.sites = [Site(k, True) for k in range(n)] + [Site(k, False) for k in self.reflex]
        self.site_of_reflex = {k: n + i for i, k in enumerate(self.reflex)}
        self.lengths = [_length(self._side(k)) for k in range(n)]
        self.along = [tuple(x / self.lengths[k] for x in self._side(k)) for k in range(n)]
        self.normals = [(-y, x) for x, y in self.along]  # Inward.
        self.size = max(abs(x - y) for a in self.corners for x, y in zip(a, self.corners[0], strict=True))
        self.float_corners = np.array(self.corners, dtype=float)
        self.float_along = np.array(self.along, dtype=float)
        self.float_lengths = np.array(self.lengths, dtype=float)

    def _side(self, k):
        return _minus(self.corners[self.after[k]], self.corners[k])

    def _own(self, s, t):
        """If s is a side and t a reflex corner at one of its ends."""
        a, b = self.sites[s], self.sites[t]
        return a.is_side and not b.is_side and b.corner in (a.corner, self.after[a.corner])

    # Nodes

    def _nodes(self):
        nodes, seen = [], []
        for triple in itertools.combinations(range(len(self.sites)), 3):
            for x, y, r in self._equidistant(triple):
                if r <= SAME * self.size or not self._may_be_node(float(x), float(y), float(r)):
                    continue
                if any(_length(_minus((x, y), p)) < SAME * self.size for p in seen):
                    continue
                sites = self.closest((x, y))
                if len(sites) > 2 and self.contains((x, y)):
                    seen.append((x, y))
                    nodes.append(Node((x, y), self.distance((x, y)), self._around((x, y), sites)))
        return sorted(nodes, key=lambda node: (sorted(node.sites), node.position))

    def _equidistant(self, triple):
        """Points (x, y, r) at the distance r from three sites. Rows (a, b, c, d) mean a x + b y + c r = d."""
        sides = [s for s in triple if self.sites[s].is_side]
        points = [s for s in triple if not self.sites[s].is_side]
        rows = [self._row(s) for s in sides]
        own = [(s, t) for s in sides for t in points if self._own(s, t)]
        if points:
            first = self.corners[self.sites[points[0]].corner]
            for t in points[1:]:
                other = self.corners[self.sites[t].corner]
                w = _minus(other, first)
                rows.append((2 * w[0], 2 * w[1], D(0), _dot(other, other) - _dot(first, first)))
            for s, t in own:  # Both are closest on the normal at the corner only: linear, instead of a double root.
                u = self.along[self.sites[s].corner]
                rows.append((u[0], u[1], D(0), _dot(u, self.corners[self.sites[t].corner])))
        if len(rows) >= 3:
            return [found for three in itertools.combinations(rows, 3) for found in _solved(three)]
        return _on_cone(rows, first)

    def _row(self, s):
        k = self.sites[s].corner
        n = self.normals[k]
        return n[0], n[1], D(-1), _dot(n, self.corners[k])

    def _float_distances(self, x, y):
        w = np.array([x, y]) - self.float_corners
        along = np.clip(np.einsum("ij,ij->i", w, self.float_along), 0, self.float_lengths)
        return np.hypot(*(w - along[:, None] * self.float_along).T)

    def _may_be_node(self, x, y, r):
        return abs(self._float_distances(x, y).min() - r) < 1e-9 * float(self.size)

    def distance(self, p):
        return min(self._distance_of(s, p, clamped=True) for s in range(len(self.lengths)))

    def _distance_of(self, s, p, clamped=False):
        """The distance from a site, or None if the closest point of its line lies outside the side."""
        site = self.sites[s]
        w = _minus(p, self.corners[site.corner])
        if not site.is_side:
            return _length(w)
        along, length = _dot(w, self.along[site.corner]), self.lengths[site.corner]
        if clamped:
            along = min(max(along, D(0)), length)
            u = self.along[site.corner]
            return _length((w[0] - along * u[0], w[1] - along * u[1]))
        self._clear(along)
        self._clear(along - length)
        bound = SAME * self.size
        return _dot(w, self.normals[site.corner]) if -bound <= along <= length + bound else None

    def _clear(self, difference):
        if SAME * self.size < abs(difference) < CLOSE * self.size:
            raise ValueError("two distances of the profile differ by less than 1e-18 of its size; this is unclear")

    def closest(self, p):
        """The sites closest to a point."""
        r, out = self.distance(p), []
        for s in range(len(self.sites)):
            d = self._distance_of(s, p)
            if d is None:
                continue
            self._clear(d - r)
            if abs(d - r) <= SAME * self.size:
                out.append(s)
        return out

    def contains(self, p):
        """If a point that is not on the border is inside: by the winding of all sides around it."""
        w = self.float_corners - np.array(p, dtype=float)
        after = w[self.after]
        turns = np.arctan2(w[:, 0] * after[:, 1] - w[:, 1] * after[:, 0], np.einsum("ij,ij->i", w, after))
        return turns.sum() > np.pi

    def _foot(self, s, p):
        site = self.sites[s]
        a = self.corners[site.corner]
        if not site.is_side:
            return a
        u = self.along[site.corner]
        along = _dot(_minus(p, a), u)
        return a[0] + along * u[0], a[1] + along * u[1]

    def _around(self, p, sites):
        """Sites by the directions to their closest points. A side that ends in a closest corner lies beside it."""

        def direction(s):
            foot = self._foot(s, p)
            away = _minus(foot, p)
            site, beside = self.sites[s], 0
            if site.is_side:
                w = _minus(foot, self.corners[site.corner])
                along = _dot(w, self.along[site.corner])
                inner = self.along[site.corner]
                if abs(along) <= SAME * self.size:
                    beside = 1 if _cross(away, inner) > 0 else -1
                elif abs(along - self.lengths[site.corner]) <= SAME * self.size:
                    beside = -1 if _cross(away, inner) > 0 else 1
            return math.atan2(float(away[1]), float(away[0])) + 1e-10 * beside

        # Directions that differ by less than 1e-10 but are not equal would be unclear.
        turns = sorted((direction(s), s) for s in sites)
        gaps = [b[0] - a[0] for a, b in itertools.pairwise([*turns, (turns[0][0] + 2 * math.pi, 0)])]
        if min(gaps) < 5e-11:
            raise ValueError("two closest points of a node are too close to be told apart")
        order = [s for _, s in turns]
        k = order.index(min(order))
        return tuple(order[k:] + order[:k])

    # Arcs

    def _arcs(self):
        ends = {}
        for k, node in enumerate(self.nodes):
            for s, t in zip(node.sites, [*node.sites[1:], node.sites[0]], strict=True):
                ends.setdefault((min(s, t), max(s, t)), []).append((node.position, k))
        for k in self.convex:
            ends.setdefault(tuple(sorted((self.before[k], k))), []).append((self.corners[k], -1 - k))
        for k in self.reflex:
            for s in (self.before[k], k):
                ends.setdefault((s, self.site_of_reflex[k]), []).append((self.corners[k], -1 - k))
        out = []
        for pair, found in sorted(ends.items()):
            found.sort(key=lambda end: self._place(pair, end[0]))
            if len(found) % 2:
                raise ValueError(f"a wall of sites {pair} of the profile has an odd number of ends")
            out += [self._arc(pair, *found[k : k + 2]) for k in range(0, len(found), 2)]
        return out

    def _place(self, pair, p):
        """A coordinate along the line or parabola of two sites."""
        s, t = pair
        a, b = self.sites[s], self.sites[t]
        if self._own(s, t):
            return _dot(p, self.normals[a.corner])
        if a.is_side and b.is_side:
            n = _minus(self.normals[a.corner], self.normals[b.corner])
            return _dot(p, (-n[1], n[0]))
        if a.is_side:
            return _dot(p, self.along[a.corner])
        w = _minus(self.corners[a.corner], self.corners[b.corner])
        return _dot(p, (-w[1], w[0]))

    def point(self, pair, one, other, t):
        """The point of the arc at the parameter 0 <= t <= 1 between its ends, in floats or Decimals."""
        s, second = pair
        x = tuple(a + t * (b - a) for a, b in zip(one, other, strict=True))
        if not self.sites[s].is_side or self.sites[second].is_side or self._own(s, second):
            return x
        # The parabola of a side and a corner v: at the foot, |x - v| = distance, so distance = |foot - v|^2 / (2 h).
        number = type(x[0])
        k = self.sites[s].corner
        a, u, n = ([number(c) for c in v] for v in (self.corners[k], self.along[k], self.normals[k]))
        v = [number(c) for c in self.corners[self.sites[second].corner]]
        along = _dot(_minus(x, a), u)
        foot = a[0] + along * u[0], a[1] + along * u[1]
        w = _minus(v, foot)
        distance = _dot(w, w) / (2 * _dot(w, n))
        return foot[0] + distance * n[0], foot[1] + distance * n[1]

    def _arc(self, pair, first, second):
        middle = self.point(pair, first[0], second[0], D(1) / 2)
        if tuple(self.closest(middle)) != pair:
            raise ValueError(f"the wall of sites {pair} of the profile does not reach from node to node")
        distances = tuple(D(0) if k < 0 else self.nodes[k].distance for _, k in (first, second))
        return Arc(
            pair, (first[1], second[1]), distances, self._least(pair, first, second, distances), self._own(*pair)
        )

    def _least(self, pair, first, second, distances):
        """The least distance along an arc. It is convex, and least inside only across from two facing points."""
        s, t = pair
        b = self.sites[t]
        if b.is_side or self._own(s, t):
            return min(distances)
        v = self.corners[b.corner]
        foot = self._foot(s, v)
        top = (v[0] + foot[0]) / 2, (v[1] + foot[1]) / 2
        low, high = (self._place(pair, end[0]) for end in (first, second))
        inside = low < self._place(pair, top) < high
        return _length(_minus(v, foot)) / 2 if inside else min(distances)

    def _count_arcs(self):
        """Arcs by their ends must be as many as by Euler's relation. So all nodes are found.

        Walls and border form a connected planar graph: nodes and corners, arcs and sides, and one region per site,
        per hole, and outside. A missing node of k arcs would change the ends by k, but Euler's relation by 1.
        """
        n, r = len(self.corners), len(self.reflex)
        ends = sum(len(node.sites) for node in self.nodes) + len(self.convex) + 2 * r
        euler = len(self.nodes) + n + r + self.holes - 1
        if ends != 2 * euler or len(self.arcs) != euler:
            raise ValueError(f"the arcs of the profile have {ends} ends, but Euler's relation demands {2 * euler}")

    def counts(self):
        return len(self.arcs), len(self.nodes)

    def is_degenerate(self):
        return any(len(node.sites) > 3 for node in self.nodes)


def _minus(a, b):
    return a[0] - b[0], a[1] - b[1]


def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def _length(a):
    return _dot(a, a).sqrt()


def _cross3(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _dot3(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


SINGULAR = D("1e-25")


def _solved(rows):
    """The point on three planes, if there is one."""
    (a, b, c), (p, q, s) = (row[:3] for row in rows), (row[3] for row in rows)
    bc, ca, ab = _cross3(b, c), _cross3(c, a), _cross3(a, b)
    determinant = _dot3(a, bc)
    if abs(determinant) < SINGULAR * (_dot3(a, a) * _dot3(b, b) * _dot3(c, c)).sqrt():
        return []
    return [tuple((p * x + q * y + s * z) / determinant for x, y, z in zip(bc, ca, ab, strict=True))]


def _on_cone(rows, corner):
    """The points (x, y, r) on the line of two planes and on the cone |(x, y) - corner| = r."""
    (a, b), (p, q) = (row[:3] for row in rows), (row[3] for row in rows)
    d = _cross3(a, b)
    square = _dot3(d, d)
    if square < SINGULAR * SINGULAR * _dot3(a, a) * _dot3(b, b):
        return []
    start = [(p * x + q * y) / square for x, y in zip(_cross3(b, d), _cross3(d, a), strict=True)]
    w = start[0] - corner[0], start[1] - corner[1], start[2]
    # |w + s d|^2 with the last square negative is 0: A s^2 + 2 B s + C = 0.
    aa = d[0] * d[0] + d[1] * d[1] - d[2] * d[2]
    bb = w[0] * d[0] + w[1] * d[1] - w[2] * d[2]
    cc = w[0] * w[0] + w[1] * w[1] - w[2] * w[2]
    scale = _dot3(w, w) + square
    if abs(aa) <= SINGULAR * square:
        roots = [-cc / (2 * bb)] if abs(bb) > SINGULAR * scale else []
    else:
        inner = bb * bb - aa * cc
        if abs(inner) <= D("1e-50") * (bb * bb + abs(aa * cc)):
            inner = D(0)
        roots = [] if inner < 0 else [(-bb + sign * inner.sqrt()) / aa for sign in (1, -1)]
    return [tuple(x + s * y for x, y in zip(start, d, strict=True)) for s in roots]


# Prisms


class Prism(NamedTuple):
    """The structure inside a prism. Sites have the numbers of nonconvex_families.extruded(): bottom, top, sides, reflex
    edges. `sheets` counts the sheets of each pair, `seams` the seams of each set of sites, `junctions` those of each
    set. Junctions at vertices have the sites of the vertex: faces, and its reflex edge."""

    sheets: Counter
    seams: Counter
    reflex: Counter  # Reflex edges, as the sites (face, edge, face).
    junctions: Counter
    areas: dict  # Area of all sheets of each pair, to about 1e-12 of the square of the size.
    is_degenerate: bool  # A seam has more than three sites, or a junction more than four.

    def counts(self, reflex="ends"):
        """Sheets, seams and junctions. `reflex` is "ends", "seams" or "joined", as the top of this file explains."""
        sheets, seams, junctions = self.sheets.total(), self.seams.total(), self.junctions.total()
        edges = self.reflex.total()
        changes = {"ends": (0, 0), "seams": (edges, 0), "joined": (-2 * edges, -2 * edges)}[reflex]
        return sheets, seams + changes[0], junctions + changes[1]


def prism(diagram, height):
    """The structure inside the prism of this height."""
    with decimal.localcontext(prec=DIGITS):
        return _Levels(diagram, D(float(height))).prism()


class _Levels:
    def __init__(self, diagram, height):
        self.diagram, self.height, self.level = diagram, height, height / 2
        self.side = [self.compared(node.distance) for node in diagram.nodes]

    def compared(self, distance):
        """-1, 0 or 1: below, at or above the level."""
        difference = distance - self.level
        self.diagram._clear(difference)
        return 0 if abs(difference) <= SAME * self.diagram.size else int(difference.copy_sign(1) == difference) * 2 - 1

    def prism(self):
        diagram = self.diagram
        name = {s: s + 2 for s in range(len(diagram.sites))}
        sheets, seams, junctions = Counter(), Counter(), Counter()
        for s in name:
            sheets[0, name[s]] += 1
            sheets[1, name[s]] += 1
        for node, side in zip(diagram.nodes, self.side, strict=True):
            own = tuple(sorted(name[s] for s in node.sites))
            if side < 0:
                seams[own] += 1
                junctions[0, *own] += 1
                junctions[1, *own] += 1
            elif side == 0:
                junctions[0, 1, *own] += 1
        level_ends = Counter()  # Ends of curves on the level, by site.
        for arc in diagram.arcs:
            own = tuple(name[s] for s in arc.sites)
            ends = [self.compared(d) for d in arc.distances]
            least = self.compared(arc.least)
            if least < 0:
                sheets[own] += 1
                seams[0, *own] += 1
                seams[1, *own] += 1
                for end in ends:
                    if end > 0:
                        junctions[0, 1, *own] += 1
                        level_ends.update(arc.sites)
            elif ends == [0, 0]:
                self._check_flat(arc)
                seams[0, 1, *own] += 1
            elif least == 0 and min(ends) > 0:  # The level touches the arc inside: all of its curves end there.
                junctions[0, 1, *own] += 1
                level_ends.update(arc.sites * 2)
        self._ends_at_nodes(level_ends)
        for s, ends in level_ends.items():
            if ends % 2:
                raise ValueError("a curve on the level has an odd number of ends")
            seams[0, 1, name[s]] += ends // 2
        middle = self._middles()
        if middle:
            sheets[0, 1] = middle
        reflex = Counter()
        for k in diagram.reflex:
            faces = sorted(name[s] for s in (diagram.before[k], k))
            reflex[(*faces, name[diagram.site_of_reflex[k]])] += 1
        for k in range(len(diagram.corners)):
            own = sorted(name[s] for s in (diagram.before[k], k))
            own += [name[diagram.site_of_reflex[k]]] if k in diagram.site_of_reflex else []
            junctions[0, *own] += 1
            junctions[1, *own] += 1
        inner = [own for own, count in seams.items() if len(own) > 3]
        deep = [own for own in junctions if len(own) > 4]
        return Prism(sheets, seams, reflex, junctions, _Areas(self).areas(name), bool(inner or deep))

    def _check_flat(self, arc):
        if not all(self.diagram.sites[s].is_side for s in arc.sites):
            raise ValueError("both ends of a curved arc lie on the level, and none of it below; expected no such arc")

    def _ends_at_nodes(self, level_ends):
        """Adds the curves on the level that end in nodes on it.

        Points beyond a gap between closest points are above the level if the gap is above 180 degrees. If it is 180
        degrees, they are above it unless the two sites are parallel sides.
        """
        for node, side in zip(self.diagram.nodes, self.side, strict=True):
            if side != 0:
                continue
            feet = [_minus(self.diagram._foot(s, node.position), node.position) for s in node.sites]
            for k, one in enumerate(feet):
                following = (k + 1) % len(feet)
                pair = node.sites[k], node.sites[following]
                turn, along = _cross(one, feet[following]), _dot(one, feet[following])
                if abs(turn) <= SAME * self.diagram.size**2:
                    above = along < 0 and not all(self.diagram.sites[s].is_side for s in pair)
                else:
                    above = turn < 0
                if above:
                    level_ends.update(pair)

    def _middles(self):
        """Connected parts of the points above the level. Each retracts to arcs and nodes above it."""
        parent = {}

        def root(k):
            parent.setdefault(k, k)
            while parent[k] != k:
                k = parent[k]
            return k

        for k, side in enumerate(self.side):
            if side > 0:
                root(k)
        for arc in self.diagram.arcs:
            ends = [self.compared(d) for d in arc.distances]
            if max(ends) <= 0:
                continue
            if self.compared(arc.least) > 0 or (min(ends) == 0 and self.compared(arc.least) == 0):
                points = [end for end, side in zip(arc.ends, ends, strict=True) if side > 0]
                if len(points) == 2:
                    parent[root(points[0])] = root(points[1])
        return len({root(k) for k in list(parent)})


class _Areas:
    """Areas of the sheets of a prism, by Gauss quadrature of exact integrals along the arcs.

    The graph of d has the slope 1. So the sheet of a cap and a site has sqrt(2) times the area of the site's region
    below the level. For a side, this is the integral of min(d, t) over the closest points. For a corner, it is that of
    min(d, t)^2 / 2 over angles.
    """

    def __init__(self, levels):
        self.diagram, self.level, self.height = levels.diagram, float(levels.level), float(levels.height)
        self.nodes, self.weights = np.polynomial.legendre.leggauss(40)

    def _curve(self, arc, low, high):
        """Points, velocities along the parameter, distances and weights for parameters from low to high."""
        t = (low + high) / 2 + (high - low) / 2 * self.nodes
        ends = [tuple(map(float, self._end(k))) for k in arc.ends]
        points = np.array([self.diagram.point(arc.sites, *ends, float(x)) for x in t])
        return t, points, self._distances(arc, points), self.weights * (high - low) / 2

    def _end(self, k):
        return self.diagram.corners[-1 - k] if k < 0 else self.diagram.nodes[k].position

    def _distances(self, arc, points):
        """From a corner of the pair, if it has one, or from its first side."""
        site = self.diagram.sites[arc.sites[1]]
        w = points - self.diagram.float_corners[site.corner]
        if not site.is_side:
            return np.hypot(*w.T)
        return w @ np.array(self.diagram.normals[site.corner], dtype=float)

    def _pieces(self, arc):
        """Parameters at which the arc starts, crosses the level, or ends."""
        ends = [tuple(map(float, self._end(k))) for k in arc.ends]

        def above(t):
            point = np.array([self.diagram.point(arc.sites, *ends, float(t))])
            return float(self._distances(arc, point)[0]) - self.level

        marks = np.linspace(0, 1, 65)
        values = [above(t) for t in marks]
        cuts = [float(mark) for mark, value in zip(marks[1:-1], values[1:-1], strict=True) if value == 0]
        for k in range(64):
            if values[k] * values[k + 1] < 0:
                low, high = marks[k], marks[k + 1]
                for _ in range(60):
                    middle = (low + high) / 2
                    low, high = (middle, high) if above(middle) * values[k] > 0 else (low, middle)
                cuts.append(float(low))
        return itertools.pairwise([0.0, *sorted(cuts), 1.0])

    def areas(self, name):
        diagram = self.diagram
        regions = np.zeros(len(diagram.sites))
        out = Counter()
        for arc in diagram.arcs:
            wall = 0.0
            for low, high in self._pieces(arc):
                t, points, distances, weights = self._curve(arc, low, high)
                below = np.minimum(distances, self.level)
                speed = self._speed(arc, t)
                wall += float(weights @ (np.hypot(*speed.T) * np.maximum(self.height - 2 * distances, 0)))
                if arc.is_own:
                    continue
                for s in arc.sites:
                    regions[s] += self._swept(s, points, speed, below, weights)
            if wall > 1e-12 * float(diagram.size) ** 2:
                out[tuple(name[s] for s in arc.sites)] += wall
        for s in name:
            out[0, name[s]] = out[1, name[s]] = math.sqrt(2) * float(regions[s])
        middle = self.area() - regions.sum()
        if middle > 1e-12 * float(diagram.size) ** 2:
            out[0, 1] = middle
        return dict(out)

    def _speed(self, arc, t):
        """The derivative of the point by the parameter."""
        ends = [tuple(map(float, self._end(k))) for k in arc.ends]
        line = np.tile(np.subtract(ends[1], ends[0]), (len(t), 1))
        s, second = arc.sites
        if arc.is_own or not self.diagram.sites[s].is_side or self.diagram.sites[second].is_side:
            return line
        # A parabola: x = foot + |foot - v|^2 / (2 h) n, and the foot moves along u.
        k = self.diagram.sites[s].corner
        u, n = (np.array(v[k], dtype=float) for v in (self.diagram.along, self.diagram.normals))
        a, v = self.diagram.float_corners[k], self.diagram.float_corners[self.diagram.sites[second].corner]
        start = np.array(ends[0])
        along = (start - a) @ u + t * (line[0] @ u)
        h, place = (v - a) @ n, (v - a) @ u
        return (line[0] @ u) * (u[None] + ((along - place) / h)[:, None] * n)

    def _swept(self, s, points, speed, below, weights):
        site = self.diagram.sites[s]
        if site.is_side:
            u = np.array(self.diagram.along[site.corner], dtype=float)
            return abs(float(weights @ (below * (speed @ u))))
        w = points - self.diagram.float_corners[site.corner]
        turn = (w[:, 0] * speed[:, 1] - w[:, 1] * speed[:, 0]) / np.einsum("ij,ij->i", w, w)
        return abs(float(weights @ (below**2 / 2 * turn)))

    def area(self):
        p = self.diagram.float_corners
        q = p[self.diagram.after]
        return float(np.sum(p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]) / 2)
