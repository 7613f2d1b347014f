"""Decides exactly, without Blum, if a mesh touches or crosses itself.

Any two triangles may share a common corner or a common edge, and nothing else."""

from __future__ import annotations

import numpy as np

Point = tuple[int, int, int]


def integers(vertices: np.ndarray) -> list[Point]:
    """The coordinates times a common power of two."""
    mantissas, exponents = np.frexp(vertices)
    least = int(exponents[vertices != 0].min()) - 53
    whole = (mantissas * 2.0**53).astype(np.int64)
    return [
        tuple(int(m) << (int(e) - 53 - least) if m else 0 for m, e in zip(row, powers, strict=True))  # type: ignore[misc]
        for row, powers in zip(whole, exponents, strict=True)
    ]


def box_pairs(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Pairs of triangles with closed boxes that meet."""
    corners = vertices[triangles]
    lower, upper = corners.min(axis=1), corners.max(axis=1)
    axis = int(np.argmax(vertices.max(axis=0) - vertices.min(axis=0)))
    order = np.argsort(lower[:, axis], kind="stable")
    lower, upper = lower[order], upper[order]
    ends = np.searchsorted(lower[:, axis], upper[:, axis], side="right")
    found = []
    for i, end in enumerate(ends):
        others = slice(i + 1, end)
        meets = ((lower[others] <= upper[i]) & (upper[others] >= lower[i])).all(axis=1)
        j = np.flatnonzero(meets) + i + 1
        found.append(np.column_stack([np.full(len(j), i), j]))
    return order[np.concatenate(found)]


class Orientation:
    """Exact signs of determinants of vertices, in floating point if its error bound allows."""

    def __init__(self, vertices: np.ndarray) -> None:
        self.doubles = vertices
        self.exact = integers(vertices)

    def exact_sign(self, a: int, b: int, c: int, d: int) -> int:
        p, q, r, s = self.exact[a], self.exact[b], self.exact[c], self.exact[d]
        u = (q[0] - p[0], q[1] - p[1], q[2] - p[2])
        v = (r[0] - p[0], r[1] - p[1], r[2] - p[2])
        w = (s[0] - p[0], s[1] - p[1], s[2] - p[2])
        value = (
            (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2]
        )
        return (value > 0) - (value < 0)

    def signs(self, a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
        p = self.doubles[a]
        u, v, w = self.doubles[b] - p, self.doubles[c] - p, self.doubles[d] - p
        values = np.einsum("ij,ij->i", np.cross(u, v), w)
        x, y, z = np.abs(u), np.abs(v), np.abs(w)
        sizes = sum(x[:, i] * (y[:, j] * z[:, k] + y[:, k] * z[:, j]) for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)))
        found = np.sign(values).astype(int)
        # Differences and products are rounded, and tiny ones may have become zero.
        for i in np.flatnonzero(np.abs(values) <= 1e-14 * sizes + 1e-280):
            found[i] = self.exact_sign(int(a[i]), int(b[i]), int(c[i]), int(d[i]))
        return found

    def meet_in_plane(self, p: int, q: int, triangle: tuple[int, int, int]) -> bool:
        """True if a segment meets a closed triangle in its plane."""
        a, b, c = (self.exact[i] for i in triangle)
        u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        drop = max(range(3), key=lambda i: abs(normal[i]))
        if normal[drop] == 0:
            return True  # a degenerate triangle is never allowed
        x, y = (drop + 1) % 3, (drop + 2) % 3

        def side(s: Point, t: Point, o: Point) -> int:
            value = (t[x] - s[x]) * (o[y] - s[y]) - (t[y] - s[y]) * (o[x] - s[x])
            return (value > 0) - (value < 0)

        corners = (a, b, c) if normal[drop] > 0 else (a, c, b)
        ends = self.exact[p], self.exact[q]
        sides = [[side(corners[i], corners[(i + 1) % 3], end) for end in ends] for i in range(3)]
        # Apart if an edge of the triangle, or the segment, has the other part strictly on its far side.
        if any(s < 0 and t < 0 for s, t in sides):
            return False
        across = [side(*ends, corner) for corner in corners]
        if any(across):
            return not (all(s > 0 for s in across) or all(s < 0 for s in across))
        return True


def bad_pairs(vertices: np.ndarray, triangles: np.ndarray) -> list[tuple[int, int]]:
    """Pairs of triangles that share more than common corners and edges."""
    pairs = box_pairs(vertices, triangles)
    first, second = triangles[pairs[:, 0]], triangles[pairs[:, 1]]
    same = first[:, :, None] == second[:, None, :]
    shared = same.sum(axis=(1, 2))
    orientation = Orientation(vertices)
    bad = set(map(tuple, pairs[shared == 3].tolist()))

    # Triangles with a common edge are bad if one lies on the other.
    edge = np.flatnonzero(shared == 2)
    for one, other in ((first, second),):
        apex = other[edge][~same[edge].any(axis=1)]
        flat = orientation.signs(*one[edge].T, apex) == 0
        for i, tip in zip(edge[flat], apex[flat], strict=True):
            own = next(int(v) for v in one[i] if v not in other[i])
            ring = one[i].tolist()
            at = ring.index(own)
            a, b = ring[at - 2], ring[at - 1]
            exact = orientation.exact
            if folded(exact[a], exact[b], exact[own], exact[int(tip)]):
                bad.add(tuple(pairs[i].tolist()))

    for one, other, away in ((first, second, ~same.any(axis=2)), (second, first, ~same.any(axis=1))):
        for start in range(3):
            end = (start + 1) % 3
            free = (shared == 0) | ((shared == 1) & away[:, start] & away[:, end])
            rows = np.flatnonzero(free)
            p, q = one[rows, start], one[rows, end]
            a, b, c = other[rows].T
            s, t = orientation.signs(a, b, c, p), orientation.signs(a, b, c, q)
            in_plane = (s == 0) & (t == 0)
            for i in np.flatnonzero(in_plane):
                if orientation.meet_in_plane(int(p[i]), int(q[i]), tuple(other[rows[i]].tolist())):
                    bad.add(tuple(pairs[rows[i]].tolist()))
            through = np.flatnonzero((s * t <= 0) & ~in_plane)
            p, q, a, b, c = p[through], q[through], a[through], b[through], c[through]
            around = np.column_stack([orientation.signs(p, q, *two) for two in ((a, b), (b, c), (c, a))])
            hits = (around >= 0).all(axis=1) | (around <= 0).all(axis=1)
            bad.update(map(tuple, pairs[rows[through[hits]]].tolist()))
    return sorted(bad)


def folded(a: Point, b: Point, p: Point, q: Point) -> bool:
    """True if p and q, coplanar with the line a b, lie on one side of the line or on it."""

    def normal(tip: Point) -> tuple[int, int, int]:
        u, v = [b[i] - a[i] for i in range(3)], [tip[i] - a[i] for i in range(3)]
        return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]

    return sum(m * n for m, n in zip(normal(p), normal(q), strict=True)) >= 0
