"""The exact medial axis of a convex polyhedron: its sheets, seams and junctions. An oracle that does not use Blum.

Inside a convex polyhedron, the distance to the border is the least of the distances to the planes of its faces. So the
points (x, h) with 0 <= h <= n_i.(p_i - x) for all faces i form a convex polytope in four dimensions. Its facets are
the regions of the faces. Its ridges, edges and vertices above h = 0 are the sheets, seams and junctions. The vertices
of the polyhedron, in which seams end, count as junctions.

Qhull proposes the vertices of the polytope. Each one is checked against all half-spaces. Qhull may miss some that are
very close. If coordinates count as exact, a walk along all edges then finds them, in integers. All else follows without
numbers, from the sets of half-spaces whose borders pass each vertex. At last the structure is proven complete
(`_prove`).

Tolerance, in the units of the vertices:
- With `tolerance=0`, coordinates count as exact. Faces, convexity, and the half-spaces that pass a vertex, are decided
  by exact signs (exact_signs.py). So the structure is that of exactly the given solid, however close two vertices are.
  Only positions, lengths and areas are rounded, to some 1e-15 of the solid's size. So two junctions may have the same
  position, and a seam between them the length 0. A side of four corners that rounding has bent makes the solid concave,
  or has two faces; the first is an error.
- With `tolerance=t > 0`, each coordinate may have an error up to t. Triangles whose vertices lie within t of a plane
  form one face. A half-space passes a vertex if its slack is at most t (1 + s). Here s is the sum of the absolute
  factors that give its row from the four rows of the vertex. This bounds the error of the slack to first order. Cases
  are `unclear` if a slack is above this bound, but less than `UNCLEAR` times as large. The counts of a structure with
  unclear cases may depend on the tolerance. So features smaller than about 100 t have no reliable structure.
"""

import itertools
from typing import NamedTuple

import numpy as np
from exact_signs import ExactPlanes, dot, exact_plane, float_plane, integers, minus
from scipy.spatial import ConvexHull, QhullError

EPS = np.finfo(float).eps
UNCLEAR = 30.0  # Slacks between the bound and this many times the bound are named as unclear.
STEEP = 1e7  # Fours with a larger condition number are decided and solved in integers, if the tolerance is zero.
FILTER = 1e3 * EPS  # Relative errors of floats in this module stay far below this.


class Sheet(NamedTuple):
    """The part of the axis at which the distances to two faces are equal and least: a convex polygon."""

    faces: frozenset
    area: float
    centroid: np.ndarray
    polygon: np.ndarray  # [n, 3], in order.


class Seam(NamedTuple):
    """A segment at which three or more faces are nearest."""

    faces: frozenset
    length: float
    ends: np.ndarray  # [2, 3]
    junctions: tuple  # Ids of the junctions at its ends.


class Junction(NamedTuple):
    """A point at which four or more faces are nearest, or a corner of the polyhedron (radius 0)."""

    faces: frozenset
    position: np.ndarray
    radius: float


class Structure(NamedTuple):
    sheets: list  # Sorted by faces, as are the lists that follow.
    seams: list
    junctions: list
    face_of: np.ndarray  # [triangles] face ids, in the order of the faces' first triangles.
    normals: np.ndarray  # [faces, 3] outward unit normals.
    offsets: np.ndarray  # [faces] n.x of the face's points.
    areas: np.ndarray  # [faces].
    regions: np.ndarray  # [faces] volume of the part of the solid nearest to each face.
    edges: int  # Edges of the polyhedron.
    unclear: list  # Texts that name cases too close to call; empty if the counts are certain.

    def counts(self):
        return len(self.sheets), len(self.seams), len(self.junctions)


def structure(vertices, triangles, tolerance=0.0):
    """The exact structure of a closed convex polyhedron with outward triangles.

    `vertices` [n, 3] are floats, `triangles` [m, 3] their indices. Raises ValueError if the mesh is not a closed convex
    polyhedron, or if the tolerance admits no consistent structure. Takes about 10 ms for 40 faces.
    """
    vertices, triangles = np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int64)
    solid = _Exact(vertices, triangles) if tolerance == 0 else _Rounded(vertices, triangles, tolerance)
    points, passed = _polytope(solid)
    try:
        return _read(solid, points, passed)
    except ValueError:
        if not solid.exact or not len(passed):
            raise
    return _read(solid, *_walk(solid, passed))


# Faces


def neighbours(triangles):
    """Pairs (a, b) of triangles that share an edge. Raises ValueError if the mesh is not closed."""
    opened, pairs = {}, []
    for t, corners in enumerate(triangles.tolist()):
        for k in range(3):
            edge = corners[k], corners[(k + 1) % 3]
            if edge in opened:
                raise ValueError(f"edge {edge} has two triangles on one side; expected a closed oriented mesh")
            opened[edge] = t
    for (a, b), t in opened.items():
        if (b, a) not in opened:
            raise ValueError(f"edge {(a, b)} has one triangle; expected a closed oriented mesh")
        if a < b:
            pairs.append((t, opened[b, a]))
    return pairs


def _numbered(parent):
    """Face ids, in the order of their first triangles, from the triangle that represents each triangle's face."""
    _, first, inverse = np.unique(parent, return_index=True, return_inverse=True)
    order = np.empty(len(first), dtype=np.int64)
    order[np.argsort(first)] = np.arange(len(first))
    return order[inverse]


def _areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a) / 2


class _Exact:
    """Faces of a solid whose coordinates count as exact. Vertex 0 is the origin."""

    def __init__(self, vertices, triangles):
        whole, scale = integers(vertices)
        points = [minus(p, whole[0]) for p in whole]
        self.points = np.array([[x / scale for x in p] for p in points])
        self.origin = vertices[0]
        parent = self._join(points, triangles)
        self.face_of = _numbered(parent)
        areas = np.linalg.norm(_areas(self.points, triangles), axis=1)
        self.areas = np.bincount(self.face_of, areas)
        order = np.lexsort((-areas, self.face_of))  # The largest triangle of each face first.
        largest = order[np.unique(self.face_of[order], return_index=True)[1]]
        planes = [exact_plane(*(points[i] for i in triangles[t])) for t in largest]
        found = [float_plane(n, d, scale) for n, d in planes]
        self.normals = np.array([n for n, _ in found])
        self.offsets = np.array([d for _, d in found])
        self._check(points, planes)
        self.exact = ExactPlanes([n for n, _ in planes], [d for _, d in planes])
        self.scale, self.tolerance, self.unclear = scale, 0.0, []

    @staticmethod
    def _join(points, triangles):
        """The first triangle of the face of each triangle."""
        corners = triangles.tolist()
        planes = [exact_plane(*(points[i] for i in t)) for t in corners]
        if any(n == (0, 0, 0) for n, _ in planes):
            raise ValueError("a triangle has no area; expected triangles with an area")
        parent = list(range(len(corners)))

        def root(t):
            while parent[t] != t:
                t = parent[t]
            return t

        for a, b in neighbours(triangles):
            normal, offset = planes[a]
            sides = [dot(normal, points[i]) - offset for i in corners[b]]
            if any(side > 0 for side in sides):
                raise ValueError(f"triangles {a} and {b} meet at a reflex edge; expected a convex solid")
            if not any(sides):
                low, high = sorted((root(a), root(b)))
                parent[high] = low
        return np.array([root(t) for t in range(len(corners))])

    def _check(self, points, planes):
        slack = self.offsets - self.points @ self.normals.T
        for v, f in np.argwhere(slack < 1e-9 * np.abs(self.points).max()):
            normal, offset = planes[f]
            if dot(normal, points[v]) > offset:
                raise ValueError(f"vertex {v} lies outside face {f}; expected a convex solid")


class _Rounded:
    """Faces of a solid whose coordinates have errors up to a tolerance. Vertex 0 is the origin."""

    def __init__(self, vertices, triangles, tolerance):
        whole, scale = integers(vertices)
        points = [minus(p, whole[0]) for p in whole]
        self.points = np.array([[x / scale for x in p] for p in points])
        self.origin, self.tolerance, self.exact, self.unclear = vertices[0], tolerance, None, []
        # Integers, because floats lose the direction of long thin triangles.
        corners = [[points[i] for i in t] for t in triangles.tolist()]
        vectors = [exact_plane(*t)[0] for t in corners]
        if (0, 0, 0) in vectors:
            raise ValueError("a triangle has no area; expected triangles with an area")
        areas = np.linalg.norm(_areas(self.points, triangles), axis=1)
        normals = np.array([float_plane(vector, 0, scale)[0] for vector in vectors])
        self.face_of = _numbered(self._grow(triangles, normals, areas))
        sums = [[0, 0, 0] for _ in range(self.face_of.max() + 1)]
        for face, vector in zip(self.face_of, vectors, strict=True):
            sums[face] = [a + b for a, b in zip(sums[face], vector, strict=True)]
        self.normals = np.array([float_plane(vector, 0, scale)[0] for vector in sums])
        self.areas = np.bincount(self.face_of, areas)
        heights = [
            float_plane(sums[f], sum(dot(sums[f], p) for p in t), 3 * scale)[1]
            for f, t in zip(self.face_of, corners, strict=True)
        ]
        self.offsets = np.bincount(self.face_of, areas * heights) / self.areas
        self._check()

    def _grow(self, triangles, normals, areas):
        """Faces grow from their largest triangles over neighbours whose vertices lie in the plane."""
        beside = [[] for _ in triangles]
        for a, b in neighbours(triangles):
            beside[a].append(b)
            beside[b].append(a)
        face = np.full(len(triangles), -1)
        for seed in np.argsort(-areas, kind="stable"):
            if face[seed] >= 0:
                continue
            normal, corners = normals[seed], self.points[triangles[seed]]
            middle = corners.mean(axis=0)
            width = 2 * areas[seed] / np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max()
            from_seed = self.points - middle
            # The seed's plane is known to about the tolerance at the seed, and to less away from it.
            bound = 4 * self.tolerance * (1 + np.linalg.norm(from_seed, axis=1) / width)
            ratio = np.abs(from_seed @ normal) / bound
            face[seed], pending = seed, [seed]
            while pending:
                for t in beside[pending.pop()]:
                    if face[t] >= 0 or normals[t] @ normal <= 0:
                        continue
                    worst = ratio[triangles[t]].max()
                    if worst <= 1:
                        face[t] = seed
                        pending.append(t)
                    elif worst < UNCLEAR:
                        self.unclear.append(f"triangle {t} is bent from triangle {seed} by {worst:.1f} tolerances")
        return face

    def _check(self):
        slack = self.offsets - self.points @ self.normals.T
        worst = np.unravel_index(slack.argmin(), slack.shape)
        if slack[worst] < -64 * self.tolerance:
            raise ValueError(
                f"vertex {worst[0]} lies {-slack[worst]:.3g} outside face {worst[1]}; expected a convex solid"
            )


# Vertices of the polytope


def _polytope(solid):
    """Vertices (x, h) of the polytope, and the half-spaces [vertices, faces + 1] whose borders pass them."""
    rows = np.vstack([np.c_[solid.normals, np.ones(len(solid.normals))], [0, 0, 0, -1]])
    offsets = np.append(solid.offsets, 0.0)
    inner, frame = _round_frame(solid.points, rows, offsets)
    room = offsets - rows @ inner
    scaled = (rows @ frame) / room[:, None]  # Half-space j is scaled[j] @ w <= 1.
    try:
        fours = np.sort(ConvexHull(scaled, qhull_options="Qt").simplices, axis=1)
    except QhullError as error:
        raise ValueError("Qhull finds no polytope; expected a solid that is not flat") from error
    size = np.abs(solid.points).max()
    return _distinct(solid, fours, scaled, room, size, inner, frame)


def _round_frame(points, rows, offsets):
    """A point inside the polytope, and a frame [4, 4] in which the polytope is about round."""
    middle = points.mean(axis=0)
    height = (offsets[:-1] - rows[:-1, :3] @ middle).min()
    if height <= 0:
        raise ValueError("the solid is flat; expected a solid with a volume")
    _, spread, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    frame = np.zeros((4, 4))
    frame[:3, :3] = axes.T * (spread / np.sqrt(len(points)))
    frame[3, 3] = height
    return np.append(middle, height / 2), frame


def _distinct(solid, fours, scaled, room, size, inner, frame):
    """Drops fours of half-spaces that do not meet in a vertex, and joins those that meet in one."""
    matrices = scaled[fours]
    with np.errstate(all="ignore"):
        usable = np.abs(np.linalg.det(matrices)) > 0
        fours, matrices = fours[usable], matrices[usable]
        inverse = np.linalg.inv(matrices)
    w = inverse.sum(axis=2)
    for _ in range(2):
        w += np.einsum("kij,kj->ki", inverse, 1 - np.einsum("kij,kj->ki", matrices, w))
    slack = room * (1 - w @ scaled.T)  # [fours, half-spaces]
    factors = np.abs(np.einsum("jc,kci->kji", scaled, inverse)) * room[None, :, None] / room[fours][:, None, :]
    spread = 1 + factors.sum(axis=2)
    terms = room * (1 + np.abs(w) @ np.abs(scaled).T)  # Sizes of what cancels in each slack.
    rounding = terms + size + np.einsum("kji,ki->kj", factors, np.take_along_axis(terms, fours, axis=1) + size)
    bound = FILTER * rounding if solid.exact else solid.tolerance * spread + 4 * EPS * rounding
    steep = ~(np.linalg.cond(matrices) < STEEP)
    if solid.exact:  # Floats decide nothing about planes that nearly meet in a line.
        slack[steep], bound[steep] = 0.0, np.inf
    own = np.zeros(slack.shape, dtype=bool)
    np.put_along_axis(own, fours, True, axis=1)
    inside = (slack >= -bound).all(axis=1)
    doubtful = ((slack <= (1 if solid.exact else UNCLEAR) * bound) & ~own).any(axis=1)
    order = np.argsort(np.abs(inverse).max(axis=(1, 2)), kind="stable")  # The best conditioned four comes first.
    kept, passed, joints = [], [], []
    for k in order[inside[order]]:
        joined = own[k]
        if doubtful[k] and not any(joint[fours[k]].all() for joint in joints):
            joined = _passing(solid, fours[k], slack[k], bound[k], own[k])
            if joined is None:
                continue
            if joined.sum() > 4:
                joints.append(joined)
        kept.append(k)
        passed.append(joined)
    passed, kept = np.array(passed).reshape(len(kept), len(scaled)), np.array(kept, dtype=int)
    if joints:
        passed, kept = _largest(passed, np.array(joints), kept)
    points = inner + w[kept] @ frame.T
    if solid.exact:
        for v in np.flatnonzero(steep[kept]):
            points[v] = solid.exact.point(fours[kept[v]].tolist()) / solid.scale
    return points, passed


def _largest(passed, joints, kept):
    """Without the fours that are part of a point that more half-spaces pass."""
    sizes, larger = passed.sum(axis=1), joints.sum(axis=1)
    numbers = passed.astype(np.float32)
    part = (numbers @ joints.T.astype(np.float32) == sizes[:, None]) & (sizes[:, None] < larger)
    keep = ~part.any(axis=1)
    return passed[keep], kept[keep]


def _passing(solid, four, slack, bound, own):
    """The half-spaces that pass the point of a four, or None if the point lies outside one of them."""
    near = np.flatnonzero((np.abs(slack) <= bound) & ~own)
    joined = own.copy()
    if not solid.exact:
        for j in np.flatnonzero((slack > bound) & (slack < UNCLEAR * bound) & ~own):
            solid.unclear.append(
                f"half-space {j} passes the point of {four.tolist()} at {slack[j] / bound[j]:.1f} tolerances"
            )
        joined[near] = True
        return joined
    chosen = tuple(four.tolist())
    if solid.exact.sign_of_four(chosen) == 0:
        return None
    for j in near:
        side = solid.exact.side(chosen, int(j))
        if side < 0:
            return None
        joined[j] = side == 0
    return joined


# All vertices by a walk along edges, in integers: for solids whose vertices are too close for Qhull


def _walk(solid, passed):
    """All vertices of the polytope, from one of them. Takes about 5 ms per edge for 40 faces."""
    exact, count = solid.exact, passed.shape[1]
    start = frozenset(np.flatnonzero(passed[0]).tolist())
    found, pending, used = {start: None}, [start], set()
    while pending:
        held = pending.pop()
        for three, edge, inward in _rays(exact, held):
            found[held] = found[held] or tuple(sorted((*three, min(held - edge))))
            if edge in used:
                continue
            used.add(edge)
            ahead = [j for j in range(count) if j not in held and exact.beyond(three, j) == -inward]
            first = ahead[0]
            for j in ahead[1:]:
                if exact.side(tuple(sorted((*three, first))), j) < 0:
                    first = j
            four = tuple(sorted((*three, first)))
            end = frozenset(j for j in range(count) if exact.side(four, j) == 0)
            if end not in found:
                found[end] = four
                pending.append(end)
    held = list(found)
    passed = np.array([[j in own for j in range(count)] for own in held])
    return np.array([exact.point(found[own]) / solid.scale for own in held]), passed


def _rays(exact, held):
    """The edges at a vertex: three rows, all rows of the edge, and the sign of the rows that the edge leaves."""
    seen = set()
    for three in itertools.combinations(sorted(held), 3):
        if any(edge.issuperset(three) for edge in seen):
            continue
        signs = {j: exact.beyond(three, j) for j in held.difference(three)}
        left = set(signs.values()) - {0}
        if len(left) == 1:
            edge = frozenset(three) | {j for j, sign in signs.items() if sign == 0}
            seen.add(edge)
            yield three, edge, left.pop()


# Edges, ridges, and the proof that none is missing


def _edges(passed):
    """Pairs of vertices that an edge joins: no third vertex lies in all of their common half-spaces."""
    numbers = passed.astype(np.float32)
    common = numbers @ numbers.T
    u, v = np.nonzero(np.triu(common >= 3, 1))
    shared = numbers[u] * numbers[v]
    holders = (shared @ numbers.T >= shared.sum(axis=1)[:, None]).sum(axis=1)
    found = holders == 2
    return np.c_[u, v][found], (shared > 0)[found]


def _cycles(passed, edges, shared):
    """The ridges: pairs of half-spaces, each with its vertices in order along its edges."""
    ridges = {}
    for (u, v), row in zip(edges.tolist(), shared, strict=True):
        held = np.flatnonzero(row).tolist()
        for a, i in enumerate(held):
            for j in held[a + 1 :]:
                ridges.setdefault((i, j), []).append((u, v))
    numbers = passed.astype(np.float32)
    counts = (numbers.T @ numbers).round().astype(int)
    cycles = {}
    for (i, j), own in sorted(ridges.items()):
        if counts[i, j] < 3:
            continue
        cycles[i, j] = _cycle(own)
        if cycles[i, j] is None or len(own) != counts[i, j]:
            raise ValueError(f"the edges between half-spaces {i} and {j} form no polygon; {_ADVICE}")
    expected = int(np.triu(counts >= 3, 1).sum())
    if len(cycles) != expected:
        raise ValueError(f"{expected - len(cycles)} pairs of half-spaces have three vertices but no edges; {_ADVICE}")
    return cycles


_ADVICE = "expected a polytope: use a tolerance as large as the errors of the vertices"


def _cycle(pairs):
    """Vertices in order along edges that form one closed polygon, or None."""
    beside = {}
    for u, v in pairs:
        beside.setdefault(u, []).append(v)
        beside.setdefault(v, []).append(u)
    if any(len(both) != 2 for both in beside.values()):
        return None
    start = last = pairs[0][0]
    here, cycle = beside[start][0], [start]
    while here != start:
        cycle.append(here)
        a, b = beside[here]
        last, here = here, (b if a == last else a)
    return cycle if len(cycle) == len(beside) else None


def _prove(passed, edges, cycles):
    """Proves that no vertex is missing, or raises ValueError.

    All vertices are true ones. If a true edge at a vertex ended in a missing one, the vertex would lack this edge. A
    vertex of four half-spaces has four edges. At any other vertex, each ridge has two edges, and the edges, ridges and
    facets around it form a sphere. So no edge is missing at any vertex. The edges of a polytope connect all of its
    vertices (Balinski 1961), so no vertex is missing.
    """
    degree = np.bincount(edges.ravel(), minlength=len(passed))
    ridges = np.zeros(len(passed), dtype=int)
    for cycle in cycles.values():
        ridges[cycle] += 1
    facets = passed.sum(axis=1)
    wrong = np.flatnonzero((degree - ridges + facets != 2) | ((facets == 4) & (degree != 4)))
    if len(wrong):
        raise ValueError(f"{len(wrong)} vertices of the polytope lack edges; {_ADVICE}")
    unused = np.flatnonzero(passed.sum(axis=0) < 4)
    if len(unused):
        raise ValueError(f"half-space {unused[0]} has no facet; {_ADVICE}")
    if len(passed) - len(edges) + len(cycles) - passed.shape[1] != 0:
        raise ValueError(f"Euler's relation fails; {_ADVICE}")


# The structure


def _read(solid, points, passed):
    edges, shared = _edges(passed)
    cycles = _cycles(passed, edges, shared)
    _prove(passed, edges, cycles)
    floor = passed.shape[1] - 1  # The half-space h >= 0.
    faces = [frozenset(np.flatnonzero(row[:floor]).tolist()) for row in passed]
    order = sorted(range(len(points)), key=lambda v: sorted(faces[v]))
    rank = {v: k for k, v in enumerate(order)}
    radii = np.where(passed[:, floor], 0.0, points[:, 3])
    junctions = [Junction(faces[v], solid.origin + points[v, :3], float(radii[v])) for v in order]
    above = ~shared[:, floor]
    seams = []
    for (u, v), row in zip(edges[above].tolist(), shared[above], strict=True):
        u, v = sorted((u, v), key=rank.get)
        ends = points[[u, v], :3]
        length = float(np.linalg.norm(ends[1] - ends[0]))
        held = frozenset(np.flatnonzero(row[:floor]).tolist())
        seams.append(Seam(held, length, solid.origin + ends, (rank[u], rank[v])))
    seams.sort(key=lambda seam: sorted(seam.faces))
    sheets, regions = _sheets(solid, points, cycles, floor)
    return Structure(
        sheets,
        seams,
        junctions,
        solid.face_of,
        solid.normals,
        solid.offsets + solid.normals @ solid.origin,
        solid.areas,
        regions,
        int((~above).sum()),
        solid.unclear,
    )


def _sheets(solid, points, cycles, floor):
    sheets, regions = [], np.zeros(floor)
    for (i, j), cycle in cycles.items():
        if j == floor:
            continue
        polygon = points[cycle, :3]
        from_first = polygon[1:] - polygon[0]
        vectors = np.cross(from_first[:-1], from_first[1:]) / 2
        vector = vectors.sum(axis=0)
        area = float(np.linalg.norm(vector))
        weights = vectors @ vector / area if area > 0 else np.zeros(len(vectors))
        centres = polygon[0] + (from_first[:-1] + from_first[1:]) / 3
        centroid = weights @ centres / area if area > 0 else polygon.mean(axis=0)
        sheets.append(Sheet(frozenset((i, j)), area, solid.origin + centroid, solid.origin + polygon))
        for f, other in ((i, j), (j, i)):  # The signed cone from a point of the face's plane over the sheet.
            foot = solid.normals[f] * solid.offsets[f]
            outward = solid.normals[other] - solid.normals[f]
            regions[f] += area * (outward @ (centroid - foot)) / np.linalg.norm(outward) / 3
    return sheets, regions
