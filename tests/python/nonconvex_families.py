"""Families of solids with flat faces that are not convex, for tests of Voronoi diagrams. All of them are seeded.

A `Profile` is a polygon, perhaps with holes. `extruded()` makes it a solid whose sites have known numbers, so that
profile_diagrams.py can state all pairs and counts. `blocks()` fills cells of a grid, without needless vertices.
`named()` and `random()` return all solids, `profiles()` all profiles. `variants()` returns a solid as made, turned by
four rotations, as float32, far off, and tiny.

Coordinates of solids as made are exact: all corners of a face lie in its plane, and tolerances are 0.
"""

import itertools
from typing import NamedTuple

import numpy as np
from exact_structure_families import Solid, moved
from scipy.spatial import ConvexHull


class Profile(NamedTuple):
    """A polygon: its outline runs anticlockwise, its holes run clockwise. Loops do not touch."""

    name: str
    loops: list  # Arrays [n, 2].

    def corners(self):
        return np.concatenate([np.asarray(loop, dtype=float) for loop in self.loops])


def variants(solid):
    """The solid, and the solid turned by four rotations, as float32, far off and tiny.

    If all of its faces are single triangles, all coordinates are meant as they are, and tolerances stay 0.
    """
    a, b, c = (solid.vertices[solid.triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    found = {}
    for t, corners in enumerate(solid.triangles.tolist()):
        for edge in itertools.combinations(sorted(corners), 2):
            found.setdefault(edge, []).append(t)
    return moved(solid, stays=all(normals[s] @ normals[t] < 1 - 1e-9 for s, t in found.values()))


# Triangulation


def _turn(a, b, c):
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _cross(a, b, c, d):
    """If two segments have a point in common."""
    one, two = _turn(a, b, c), _turn(a, b, d)
    three, four = _turn(c, d, a), _turn(c, d, b)
    if one * two < 0 and three * four < 0:
        return True
    within = lambda p, q, r: min(p[0], q[0]) <= r[0] <= max(p[0], q[0]) and min(p[1], q[1]) <= r[1] <= max(p[1], q[1])  # noqa: E731
    return any(
        t == 0 and within(*s) for t, s in ((one, (a, b, c)), (two, (a, b, d)), (three, (c, d, a)), (four, (c, d, b)))
    )


def _bridged(points, loops):
    """One loop of ids: holes are joined to the outline by the shortest bridges."""
    ring, holes = list(loops[0]), [list(hole) for hole in loops[1:]]
    while holes:
        sides = [(x[k - 1], x[k]) for x in [ring, *holes] for k in range(len(x))]
        bridges = (
            (np.hypot(*(points[ring[i]] - points[hole[j]])), i, h, j)
            for h, hole in enumerate(holes)
            for i in range(len(ring))
            for j in range(len(hole))
        )
        for _, i, h, j in sorted(bridges):
            a, b = ring[i], holes[h][j]
            others = (side for side in sides if a not in side and b not in side)
            if not any(_cross(points[a], points[b], points[c], points[d]) for c, d in others):
                break
        hole = holes.pop(h)
        ring[i : i + 1] = [ring[i], *hole[j:], *hole[: j + 1], ring[i]]
    return ring


def triangulated(points, loops):
    """Triangles of a polygon with holes, from loops of ids: an anticlockwise outline, then clockwise holes."""
    left, out = _bridged(points, loops), []
    while len(left) > 3:
        best = None
        for k in range(len(left)):
            ids = left[k - 1], left[k], left[(k + 1) % len(left)]
            a, b, c = (points[i] for i in ids)
            size = _turn(a, b, c)
            if size <= 0 or len(set(ids)) < 3:
                continue
            form = size / max(np.sum((a - b) ** 2), np.sum((b - c) ** 2), np.sum((c - a) ** 2))
            if best is not None and form <= best[0]:
                continue
            others = (points[i] for i in left if i not in ids)
            if not any(min(_turn(a, b, p), _turn(b, c, p), _turn(c, a, p)) >= 0 for p in others):
                best = form, k, ids
        if best is None:
            raise ValueError("the polygon has no ear; expected loops that do not touch")
        out.append(best[2])
        del left[best[1]]
    out.append(tuple(left))
    return out


def _area(points, loop):
    p = points[list(loop)]
    return 0.5 * float(np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)))


def from_polygons(name, vertices, faces):
    """A solid from its faces. Each is a list of loops of vertex ids, anticlockwise as seen from outside; holes run the
    other way."""
    vertices, triangles = np.asarray(vertices, dtype=float), []
    for loops in faces:
        p = vertices[list(loops[0])]
        normal = np.cross(p - p[0], np.roll(p, -1, axis=0) - p[0]).sum(axis=0)
        axis = int(np.abs(normal).argmax())
        flat = vertices[:, [(axis + 1) % 3, (axis + 2) % 3]]
        if normal[axis] < 0:
            flat = flat[:, ::-1]
        own = triangulated(flat, loops)
        total = sum(_area(flat, loop) for loop in loops)
        if not np.isclose(sum(_area(flat, t) for t in own), total, rtol=1e-12) or min(_area(flat, t) for t in own) <= 0:
            raise ValueError(f"{name}: triangles do not cover a face")
        triangles += own
    return Solid(name, vertices, np.array(triangles, dtype=np.int64), 0.0)


def turned_inside_out(solid):
    return solid._replace(triangles=solid.triangles[:, ::-1])


def merged(name, *solids):
    """Several closed surfaces as one, such as a solid and its voids."""
    starts = np.cumsum([0] + [len(solid.vertices) for solid in solids[:-1]])
    triangles = [solid.triangles + start for solid, start in zip(solids, starts, strict=True)]
    return Solid(name, np.concatenate([s.vertices for s in solids]), np.concatenate(triangles), 0.0)


# Profiles


def extruded(profile, height):
    """The prism over a profile. Its sites have known numbers, which profile_diagrams.py states.

    Vertex k is corner k of the profile, vertex n + k lies above it. Face 0 is the bottom, face 1 the top, face 2 + k
    holds the profile's side that starts at corner k.
    """
    corners, n = profile.corners(), len(profile.corners())
    starts = np.cumsum([0] + [len(loop) for loop in profile.loops])
    loops = [list(range(a, b)) for a, b in itertools.pairwise(starts)]
    faces = [[loop[::-1] for loop in loops], [[k + n for k in loop] for loop in loops]]
    for loop in loops:
        for k, a in enumerate(loop):
            b = loop[(k + 1) % len(loop)]
            faces.append([[a, b, b + n, a + n]])
    vertices = np.vstack([np.c_[corners, np.zeros(n)], np.c_[corners, np.full(n, float(height))]])
    return from_polygons(f"{profile.name}, {height:g}", vertices, faces)


def _rectangle(x, y, w, h):
    return [(x, y), (x + w, y), (x + w, y + h), (x, y + h)]


def angle(w=3.0, h=2.5, t=1.0, s=1.0, name="L"):
    return Profile(name, [[(0, 0), (w, 0), (w, t), (s, t), (s, h), (0, h)]])


def tee(w=3.0, h=3.0, t=1.0, left=1.0, s=1.0, name="T"):
    y = h - t
    return Profile(name, [[(left, 0), (left + s, 0), (left + s, y), (w, y), (w, h), (0, h), (0, y), (left, y)]])


def channel(w=4.0, left=2.0, right=2.0, t=0.75, a=1.0, b=0.75, name="U"):
    return Profile(name, [[(0, 0), (w, 0), (w, right), (w - b, right), (w - b, t), (a, t), (a, left), (0, left)]])


def zed(w=2.0, h=3.0, t=0.5, s=0.5, b=0.5, v=2.0, name="Z"):
    """Flanges of lengths w to the left below and v to the right above of a web of width s."""
    return Profile(name, [[(-w, 0), (s, 0), (s, h - b), (s + v, h - b), (s + v, h), (0, h), (0, t), (-w, t)]])


def plus(arms=(1.0, 1.0, 1.0, 1.0), a=1.0, b=1.0, name="plus"):
    right, up, left, down = arms
    return Profile(
        name,
        [
            [
                (0, 0),
                (0, -down),
                (a, -down),
                (a, 0),
                (a + right, 0),
                (a + right, b),
                (a, b),
                (a, b + up),
                (0, b + up),
                (0, b),
                (-left, b),
                (-left, 0),
            ]
        ],
    )


def aitch(widths=(1.0, 1.0, 1.0), low=1.0, web=1.0, high=1.0, name="H"):
    a, gap, b = widths
    top = low + web + high
    return Profile(
        name,
        [
            [
                (0, 0),
                (a, 0),
                (a, low),
                (a + gap, low),
                (a + gap, 0),
                (a + gap + b, 0),
                (a + gap + b, top),
                (a + gap, top),
                (a + gap, low + web),
                (a, low + web),
                (a, top),
                (0, top),
            ]
        ],
    )


def comb(teeth=((0.5, 1.0), (0.5, 1.0), (0.5, 1.0)), gaps=(0.5, 0.5), back=0.5, name="comb"):
    """Teeth with widths and lengths, gaps between them, and a back."""
    width = sum(w for w, _ in teeth) + sum(gaps)
    outline, x = [(0, 0), (width, 0)], width
    for k in reversed(range(len(teeth))):
        w, length = teeth[k]
        outline += [(x, back + length), (x - w, back + length)]
        if k:
            outline += [(x - w, back), (x - w - gaps[k - 1], back)]
            x -= w + gaps[k - 1]
    return Profile(name, [outline])


def stairs(treads=(1.0, 1.0, 1.0), rises=(0.5, 0.5, 0.5), name="stairs"):
    x, y = sum(treads), 0.0
    outline = [(0, 0), (x, 0)]
    for tread, rise in zip(treads, rises, strict=True):
        y += rise
        outline += [(x, y), (x - tread, y)]
        x -= tread
    return Profile(name, [outline])


def notched_wedge(length=8.0, half=1.0, at=3.0, width=0.5, depth=0.5, name="wedge with a notch"):
    """A triangle with a square notch in its back, which is long."""
    return Profile(name, [[(0, 0), (at, 0), (at, depth), (at + width, depth), (at + width, 0), (length, 0), (1, half)]])


def bent(first=3.0, second=2.5, t=1.0, corner=(1.0, 2.0), name="bent bar"):
    """Two bars of thickness about t that meet at an angle. `corner` is the direction of the second one."""
    dx, dy = corner
    return Profile(
        name,
        [
            [
                (0, 0),
                (first, 0),
                (first, t),
                (t, t),
                (t + second * dx, t + second * dy),
                (second * dx - t * dy, second * dy + t * dx),
            ]
        ],
    )


def frame(outer=4.0, inner=(1.0, 1.0, 2.0, 2.0), name="frame"):
    return Profile(name, [_rectangle(0, 0, outer, outer), _rectangle(*inner)[::-1]])


def polygon_hole(sides=6, radius=1.0, shift=(0.0, 0.0), name=None):
    """A plate with a hole that is a regular polygon, up to rounding."""
    turn = 2 * np.pi * (np.arange(sides) + 0.25) / sides
    hole = np.c_[2 + shift[0] + radius * np.cos(turn), 2 + shift[1] + radius * np.sin(turn)]
    return Profile(name or f"plate with a hole of {sides} corners", [_rectangle(0, 0, 4.0, 4.0), hole[::-1].tolist()])


def two_holes(first=(0.5, 0.5, 1.0, 1.0), second=(2.5, 2.0, 1.0, 1.25), name="plate with two holes"):
    return Profile(name, [_rectangle(0, 0, 4.0, 4.0), _rectangle(*first)[::-1], _rectangle(*second)[::-1]])


def four_holes(name="plate with four holes"):
    holes = [_rectangle(x, y, 1.0, 1.0)[::-1] for x in (1.0, 3.0) for y in (1.0, 3.0)]
    return Profile(name, [_rectangle(0, 0, 5.0, 5.0), *holes])


def symmetric_profiles():
    """Profiles with exact symmetries or equal widths. Many have points with more than three sites."""
    return [
        angle(), tee(), channel(), zed(), plus(), aitch(), comb(), stairs(), notched_wedge(), bent(), frame(),
        angle(4.0, 4.0, 1.0, 1.0, "L, symmetric"), channel(3.0, 2.0, 2.0, 1.0, 1.0, 1.0, "U of equal walls"),
        zed(2.0, 3.0, 0.5, 1.0, 0.5, 2.0, "Z, wide web"), two_holes(), four_holes(),
    ]  # fmt: skip


def random_profiles(count=20, seed=1):
    """Profiles of all kinds with random sizes, which are multiples of 1/1024."""
    rng, out = np.random.default_rng(seed), []

    def size(low=0.5, high=1.5, n=None):
        return (np.round(rng.uniform(low, high, size=n) * 1024) / 1024).tolist()

    def one(kind, name):
        if kind == "L":
            return angle(size(2, 4), size(2, 4), size(), size(), name)
        if kind == "T":
            return tee(size(3.5, 5), size(2, 4), size(), size(), size(), name)
        if kind == "U":
            return channel(size(3.5, 5), size(2, 3), size(2, 3), size(), size(), size(), name)
        if kind == "Z":
            return zed(size(1, 3), size(2.5, 4), size(0.3, 1), size(0.3, 1), size(0.3, 1), size(1, 3), name)
        if kind == "plus":
            return plus(size(n=4), size(), size(), name)
        if kind == "H":
            return aitch(size(n=3), size(), size(), size(), name)
        if kind == "comb":
            n = int(rng.integers(3, 6))
            return comb([size(n=2) for _ in range(n)], size(n=n - 1), size(), name)
        if kind == "stairs":
            n = int(rng.integers(2, 6))
            return stairs(size(n=n), size(0.2, 1, n), name)
        if kind == "wedge":
            return notched_wedge(size(6, 9), size(1, 2), size(1.5, 3), size(0.2, 1), size(0.1, 0.3), name)
        if kind == "bent":
            return bent(size(2, 4), size(1, 2), size(0.3, 1), size(0.5, 2, 2), name)
        if kind == "star":
            return _star(rng, name)
        holes = [[x + a, y + b, w, h] for x in (0.5, 2.5) for y in (0.5, 2.5) for a, b, w, h in [size(0, 0.5, 4)]]
        holes = [_rectangle(x, y, 0.3125 + w, 0.3125 + h)[::-1] for x, y, w, h in holes]
        if kind == "holes":
            return Profile(name, [_rectangle(0, 0, 4.0, 4.0), *holes[: int(rng.integers(1, 5))]])
        turn = np.sort(rng.uniform(0, 2 * np.pi, size=12))[:: int(rng.integers(1, 4))]
        hole = (
            np.round((2 + rng.uniform(0.5, 1.5, size=(len(turn), 1)) * np.c_[np.cos(turn), np.sin(turn)]) * 1024) / 1024
        )
        return Profile(name, [_rectangle(0, 0, 4.0, 4.0), hole[::-1].tolist()])

    kinds = ("L", "T", "U", "Z", "plus", "H", "comb", "stairs", "wedge", "bent", "star", "holes", "hole")
    for k in range(count):
        kind = kinds[k % len(kinds)]
        out.append(one(kind, f"random {kind} {seed}.{k}"))
    return out


def _star(rng, name):
    """A random polygon that is star-shaped, with about as many reflex corners as convex ones."""
    n = int(rng.integers(6, 13))
    turn = 2 * np.pi * (np.arange(n) + rng.uniform(0.1, 0.9, size=n)) / n
    points = rng.uniform(0.6, 2.0, size=(n, 1)) * np.c_[np.cos(turn), np.sin(turn)]
    return Profile(name, [(np.round(points * 1024) / 1024).tolist()])


def profiles():
    return symmetric_profiles() + [polygon_hole(n) for n in (3, 5, 6, 8)] + random_profiles(39)


# Blocks


def blocks(name, xs, ys, zs, filled):
    """The union of cells of a grid, with as few vertices as possible. `filled` [x, y, z] marks the cells.

    Raises ValueError if the union touches itself along an edge or in a vertex.
    """
    grid = [np.asarray(axis, dtype=float) for axis in (xs, ys, zs)]
    filled = np.pad(np.asarray(filled, dtype=bool), 1)
    for window in np.lib.stride_tricks.sliding_window_view(filled, (2, 2, 2)).reshape(-1, 2, 2, 2):
        if not (_connected(window) and _connected(~window)):
            raise ValueError(f"{name} touches itself; expected a solid without common edges or vertices of its parts")
    loops_of_faces = []
    for axis in range(3):
        for side in (1, -1):
            out = np.roll(filled, -side, axis=axis)
            border = np.argwhere(filled & ~out)
            for k in np.unique(border[:, axis]):
                squares = {tuple(np.delete(cell, axis).tolist()) for cell in border[border[:, axis] == k]}
                height = int(k) - 1 + (side > 0)
                for part in _parts(squares):
                    loops_of_faces.append(
                        [[_corner(axis, height, p) for p in loop] for loop in _loops(part, axis, side)]
                    )
    corners = {loop[k] for loops in loops_of_faces for loop in loops for k in range(len(loop)) if _is_corner(loop, k)}
    corners = sorted(corners)
    ids = {corner: k for k, corner in enumerate(corners)}
    faces = [[[ids[c] for c in loop if c in ids] for loop in loops] for loops in loops_of_faces]
    faces = [sorted(loops, key=lambda loop: -_extent(corners, loop)) for loops in faces]
    return from_polygons(name, [[grid[a][c[a]] for a in range(3)] for c in corners], faces)


def _extent(corners, loop):
    p = np.array([corners[k] for k in loop])
    return float(np.prod(np.ptp(p, axis=0) + 1.0))


def _connected(cells):
    """If the marked cells of 2 x 2 x 2 are joined through sides."""
    marked = {tuple(c) for c in np.argwhere(cells).tolist()}
    if not marked:
        return True
    pending = [min(marked)]
    seen = set(pending)
    while pending:
        cell = pending.pop()
        for other in marked - seen:
            if sum(abs(a - b) for a, b in zip(cell, other, strict=True)) == 1:
                seen.add(other)
                pending.append(other)
    return seen == marked


def _parts(squares):
    left = set(squares)
    while left:
        pending = [min(left)]
        part = set(pending)
        while pending:
            i, j = pending.pop()
            for other in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
                if other in left and other not in part:
                    part.add(other)
                    pending.append(other)
        left -= part
        yield part


def _loops(part, axis, side):
    """Loops around connected squares, with the squares on the left as seen from outside."""
    after = {}
    for i, j in part:
        around = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        for k, beyond in enumerate(((i, j - 1), (i + 1, j), (i, j + 1), (i - 1, j))):
            if beyond not in part:
                after.setdefault(around[k], []).append(around[(k + 1) % 4])
    loops = []
    while after:
        loop = [min(after)]
        while True:
            ends = after[loop[-1]]
            if len(ends) > 1 and len(loop) == 1:
                ends.sort()
            if len(ends) > 1:  # Two squares touch in a corner: stay with the same square.
                back, here = loop[-2] if len(loop) > 1 else None, loop[-1]
                if back is not None:
                    ends.sort(key=lambda end: -_turn(back, here, end))
            following = ends.pop(0)
            if not ends:
                del after[loop[-1]]
            if following == loop[0] and following not in after:
                break
            loop.append(following)
        if len(set(loop)) < len(loop):
            raise ValueError("a face touches itself in a corner")
        loops.append(loop)
    # Axes (1, 2), (0, 2) and (0, 1) of the plane: the second one is turned the other way.
    return loops if (side > 0) == (axis != 1) else [loop[::-1] for loop in loops]


def _corner(axis, height, place):
    """Grid indices of a corner. Those of padded cells are larger by one."""
    corner = [p - 1 for p in place]
    corner.insert(axis, height)
    return tuple(corner)


def _is_corner(loop, k):
    a, b, c = np.array(loop[k - 1]), np.array(loop[k]), np.array(loop[(k + 1) % len(loop)])
    return bool(np.any(np.cross(b - a, c - b)))


def _cells(shape, *removed):
    """All cells of a grid but some boxes of them: slices or indices for each axis."""
    out = np.ones(shape, dtype=bool)
    for part in removed:
        out[part] = False
    return out


def _only(shape, *kept):
    out = np.zeros(shape, dtype=bool)
    for part in kept:
        out[part] = True
    return out


ALL = slice(None)


def named_blocks():
    """Solids of blocks: plates with pockets, steps, bosses, corners cut off, voids and tunnels."""
    unit, thirds = np.arange(6.0), np.arange(4.0)
    boss = _only((3, 3, 2), (ALL, ALL, 0), (1, 1, 1))
    side_boss = _only((3, 2, 2), (ALL, ALL, 0), (1, 0, 1))
    plate = [0, 0.5, 1.5, 2, 3.25, 4]
    pockets = _cells((5, 3, 2), (1, 1, 1), (3, 1, 1))
    chair = _only((2, 2, 2), (0, ALL, ALL), (1, ALL, 0), (1, 0, 1))
    table = _only((3, 3, 2), (ALL, ALL, 1), *((x, y, 0) for x in (0, 2) for y in (0, 2)))
    cross3 = _only((3, 3, 3), (1, 1, ALL), (1, ALL, 1), (ALL, 1, 1))
    knot = _only((3, 3, 3), (ALL, 0, 0), (2, ALL, 0), (2, 2, ALL), (ALL, 2, 2), (0, ALL, 2), (0, 0, ALL))
    bend = _cells((3, 3, 3), (1, slice(0, 2), 1), (1, 1, 2))
    pocket, void = _cells((3, 3, 2), (1, 1, 1)), _cells((3, 3, 3), (1, 1, 1))
    return [
        blocks("box with a box boss", [0, 1, 2.5, 4], [0, 0.75, 1.75, 3], [0, 1, 1.5], boss),
        blocks("box with a boss in the middle", thirds, thirds, [0, 1, 2], boss),
        blocks("box with a boss at its side", [0, 1, 2.5, 4], [0, 1.75, 3], [0, 1, 1.5], side_boss),
        blocks("plate with a pocket", [0, 1, 2.5, 4], [0, 1, 2, 3.25], [0, 0.5, 1.25], pocket),
        blocks("plate with a pocket, symmetric", [0, 1, 3, 4], [0, 1, 3, 4], [0, 0.5, 1], pocket),
        blocks("plate with two pockets", plate, [0, 0.75, 2, 3], [0, 0.5, 1], pockets),
        blocks("step", [0, 1, 3], [0, 2], [0, 1, 1.75], _cells((2, 1, 2), (1, 0, 1))),
        blocks("corner steps", unit[:3], unit[:3], unit[:3], _cells((2, 2, 2), (1, 1, 1))),
        blocks("chair", [0, 1, 3], [0, 0.75, 2], [0, 1, 2.5], chair),
        blocks("two corners", [0, 1, 2, 3.5], [0, 1.25, 2.5], [0, 1, 2.25], _cells((3, 2, 2), (0, 0, 0), (2, 1, 1))),
        blocks("box with a void", [0, 1, 2.25, 3.5], [0, 0.75, 2, 3], [0, 1, 1.75, 3], void),
        blocks("cube with a cubic void", thirds, thirds, thirds, void),
        blocks("tunnel with a bend", thirds, [0, 1, 2, 3.25], [0, 0.75, 1.5, 2.5], bend),
        blocks("table", [0, 0.5, 2.5, 3], [0, 0.5, 1.75, 2.25], [0, 1.5, 2], table),
        blocks("cross of three bars", thirds, thirds, thirds, cross3),
        blocks("cross of three unequal bars", [0, 1.125, 2, 3.25], [0, 1, 1.75, 3], [0, 1.25, 2.25, 3], cross3),
        blocks("closed chain of bars", [0, 1, 3, 4], [0, 0.75, 2.5, 3.5], [0, 1, 2.75, 3.5], knot),
    ]


def random_blocks(count=12, seed=1):
    """Random connected unions of cells of a grid with random sizes, which are multiples of 1/64."""
    rng, out = np.random.default_rng(seed), []
    while len(out) < count:
        shape = tuple(rng.integers(2, 4, size=3).tolist())
        axes = [np.cumsum([0, *np.round(rng.uniform(0.4, 1.6, size=n) * 64) / 64]) for n in shape]
        filled = rng.uniform(size=shape) < 0.6
        try:
            solid = blocks(f"random blocks {seed}.{len(out)}", *axes, filled)
        except ValueError:
            continue
        if filled.sum() > 3 and _whole(filled) and len(solid.triangles) > 12:
            out.append(solid)
    return out


def _whole(filled):
    marked = {tuple(c) for c in np.argwhere(filled).tolist()}
    pending = [min(marked)]
    seen = set(pending)
    while pending:
        cell = pending.pop()
        for axis, step in itertools.product(range(3), (1, -1)):
            other = tuple(c + step * (a == axis) for a, c in enumerate(cell))
            if other in marked and other not in seen:
                seen.add(other)
                pending.append(other)
    return seen == marked


SHEAR = np.array([[1, 0.25, 0.125], [0, 1, 0.375], [0.25, 0, 1]])


def sheared(solid, matrix=SHEAR):
    """A solid whose edges are not orthogonal. Faces stay exactly flat if products of coordinates are short."""
    return solid._replace(name=f"{solid.name}, sheared", vertices=solid.vertices @ matrix.T)


# Solids of triangles


def _hull_triangles(points):
    hull, middle = ConvexHull(points), points.mean(axis=0)
    out = []
    for t in np.sort(hull.simplices, axis=1)[np.lexsort(np.sort(hull.simplices, axis=1).T[::-1])].tolist():
        a, b, c = points[t]
        out.append(t if np.cross(b - a, c - a) @ (a - middle) > 0 else t[::-1])
    return np.array(out)


def _icosphere(levels):
    g = (1 + 5**0.5) / 2
    golden = np.array([[0, a, b * g] for a in (-1, 1) for b in (-1, 1)])
    points = np.vstack([np.roll(golden, k, axis=1) for k in range(3)])
    triangles = _hull_triangles(points)
    for _ in range(levels):
        found, points, finer = {}, list(points), []

        def middle(a, b, found=found, points=points):
            key = min(a, b), max(a, b)
            if key not in found:
                found[key] = len(points)
                points.append((points[a] + points[b]) / 2)
            return found[key]

        for a, b, c in triangles.tolist():
            p, q, r = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, p, r), (p, b, q), (r, q, c), (p, q, r)]
        points, triangles = np.array(points), np.array(finer)
    return points / np.linalg.norm(points, axis=1)[:, None], triangles


def star_shaped(levels=1, noise=0.3, seed=1):
    """An icosphere whose vertices move along their radii."""
    points, triangles = _icosphere(levels)
    radii = 1 + np.random.default_rng(seed).uniform(-noise, noise, size=(len(points), 1))
    return Solid(f"star-shaped {levels}, {noise:g}, {seed}", points * radii, triangles, 0.0)


def _raised(name, points, triangles, faces, heights):
    """Some triangles get a new vertex, above or below their middles."""
    points, out = list(points), []
    for t, corners in enumerate(triangles.tolist()):
        a, b, c = (points[i] for i in corners)
        if t not in faces:
            out.append(corners)
            continue
        normal = np.cross(b - a, c - a)
        points.append((a + b + c) / 3 + heights[faces.index(t)] * normal / np.linalg.norm(normal))
        new = len(points) - 1
        out += [(corners[k], corners[(k + 1) % 3], new) for k in range(3)]
    return Solid(name, np.array(points), np.array(out), 0.0)


def dented_tetrahedra(seed=1):
    """Tetrahedra with dents in one to four faces, regular and random."""
    rng, out = np.random.default_rng(seed), []
    regular = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float)
    for dents in (1, 2, 4):
        for shape, points in (("regular", regular), ("random", regular + rng.uniform(-0.4, 0.4, size=(4, 3)))):
            heights = [-0.25] * dents if shape == "regular" else (-rng.uniform(0.1, 0.35, size=dents)).tolist()
            name = f"{shape} tetrahedron with {dents} dents"
            out.append(_raised(name, points, _hull_triangles(points), list(range(dents)), heights))
    return out


def spiked(seed=1):
    """Octahedra and icosahedra with spikes on some faces, and boxes with a thin spike."""
    rng = np.random.default_rng(seed)
    octahedron = np.vstack([np.eye(3), -np.eye(3)])
    points, triangles = _icosphere(0)
    chosen = rng.choice(20, size=6, replace=False).tolist()
    out = [
        _raised("stella octangula", octahedron, _hull_triangles(octahedron), list(range(8)), [2 / 3**0.5 * 0.5] * 8),
        _raised("octahedron with a spike", octahedron, _hull_triangles(octahedron), [0], [3.0]),
        _raised("icosahedron with spikes", points, triangles, chosen, rng.uniform(0.5, 2, size=6).tolist()),
    ]
    for width, height in ((0.5, 2.0), (0.125, 1.0), (0.0625, 4.0)):
        base = [(1.5 - width, 1.25 - width, 1), (1.5 + width, 1.25 - width / 2, 1), (1.5 - width / 2, 1.25 + width, 1)]
        outer = [(x, y, z) for z in (0, 1) for x, y in _rectangle(0, 0, 3, 2.5)]
        faces = [[[3, 2, 1, 0]], [[4, 5, 6, 7], [10, 9, 8]]]
        faces += [[[k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k]] for k in range(4)]
        faces += [[[8 + k, 8 + (k + 1) % 3, 11]] for k in range(3)]
        out.append(from_polygons(f"box with a spike of {width:g}", [*outer, *base, (1.5, 1.25, 1 + height)], faces))
    return out


def with_voids(seed=1):
    """Boxes with polyhedral voids: a tetrahedron, an octahedron, an icosahedron, and random hulls."""
    rng = np.random.default_rng(seed)
    tetrahedron = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float)
    inner = {
        "tetrahedron": tetrahedron, "octahedron": np.vstack([np.eye(3), -np.eye(3)]), "icosahedron": _icosphere(0)[0],
        "random hull": rng.normal(size=(8, 3)),
    }  # fmt: skip
    out = []
    for name, points in inner.items():
        points = points / np.linalg.norm(points, axis=1).max()
        points = points[ConvexHull(points).vertices]
        for shift in ((0, 0, 0), (0.25, -0.375, 0.125)):
            box = blocks("box", [-1.5, 1.75], [-2, 2], [-1.5, 1.5], [[[True]]])
            void = turned_inside_out(Solid("", points + shift, _hull_triangles(points), 0.0))
            out.append(merged(f"box with a void, {name}{', shifted' if any(shift) else ''}", box, void))
    return out


def star_shapes():
    return [star_shaped(1, 0.3, 1), star_shaped(1, 0.3, 2), star_shaped(1, 0.1, 3), star_shaped(2, 0.2, 4)]


# All


def prisms():
    """Prisms of all profiles: as long as the default profile of three levels, and plates."""
    out = []
    for k, profile in enumerate(profiles()):
        out.append(extruded(profile, (8.0, 0.25, 0.625)[k % 3]))
    return out


def named():
    """All solids that are not random."""
    made = named_blocks()
    out = [extruded(profile, height) for profile in symmetric_profiles() for height in (8.0, 0.375)]
    out += [extruded(polygon_hole(n), 0.5) for n in (3, 5, 6, 8)]
    return out + made + [sheared(solid) for solid in made] + dented_tetrahedra()[::2] + spiked() + with_voids()


def random(count=20, seed=1):
    """Random solids of all families."""
    rng = np.random.default_rng(seed)
    out = [extruded(p, np.round(rng.uniform(0.2, 6) * 64) / 64) for p in random_profiles(count, seed)]
    out += random_blocks(count, seed) + [sheared(solid) for solid in random_blocks(count // 2, seed + 1)]
    out += dented_tetrahedra(seed)[1::2] + [star_shaped(1, 0.3, seed + k) for k in range(count // 5)]
    return out
