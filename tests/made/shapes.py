"""Tools that the families of made solids share: placed solids, swept tubes, surfaces of voxels."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from manifold3d import CrossSection, Manifold, Mesh64, OpType

Arrays = tuple[np.ndarray, np.ndarray]  # vertices float64 [n, 3], triangles int64 [m, 3]


@dataclass(frozen=True)
class Draft:
    """A solid as its family constructs it."""

    body: Manifold | Arrays
    thinnest: float  # the requested thinnest wall, gap or hole; 0 if the solid tapers to a point or edge
    betti: tuple[int, int, int] | None = None  # if they follow from the construction


Maker = Callable[[int, np.random.Generator], Draft]


@dataclass(frozen=True)
class Family:
    make: Maker
    count: int


FAMILIES: dict[str, Family] = {}


def family(count: int) -> Callable[[Maker], Maker]:
    """Registers a maker of `count` numbered solids; higher numbers are mostly harder."""

    def enter(make: Maker) -> Maker:
        FAMILIES[make.__name__] = Family(make, count)
        return make

    return enter


def box(size: Sequence[float], at: Sequence[float] = (0, 0, 0)) -> Manifold:
    """A box; `at` is its centre."""
    return Manifold.cube(tuple(map(float, size)), True).translate(tuple(map(float, at)))


def block(lower: Sequence[float], upper: Sequence[float]) -> Manifold:
    """A box between two corners, which keep their exact coordinates."""
    x, y, z = np.array([lower, upper], dtype=float).T
    corners = np.array([[a, b, c] for c in z for b in y for a in x])
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return manifold_of(corners, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]))


def ball(radius: float, at: Sequence[float] = (0, 0, 0), segments: int = 16) -> Manifold:
    return Manifold.sphere(float(radius), segments).translate(tuple(map(float, at)))


def torus(major: float, minor: float, around: int = 32, sides: int = 16) -> Manifold:
    """A torus around the z axis."""
    return CrossSection.circle(float(minor), sides).translate((float(major), 0.0)).revolve(around)


def frame(direction: np.ndarray) -> np.ndarray:
    """A rotation that maps z to `direction`."""
    z = np.asarray(direction, dtype=float) / np.linalg.norm(direction)
    x = np.cross(np.eye(3)[np.argmin(np.abs(z))], z)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def placed(solid: Manifold, rotation: np.ndarray | None = None, at: Sequence[float] = (0, 0, 0)) -> Manifold:
    turn = np.eye(3) if rotation is None else rotation
    return solid.transform(np.column_stack([turn, np.asarray(at, dtype=float)]))


def rod(
    start: Sequence[float], end: Sequence[float], radius: float, sides: int = 8, tip: float | None = None
) -> Manifold:
    """A prism from `start` to `end`; `tip` is the radius at the end, and 0 gives a cone."""
    a, b = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    last = radius if tip is None else tip
    straight = Manifold.cylinder(float(np.linalg.norm(b - a)), float(radius), float(last), sides)
    return placed(straight, frame(b - a), a)


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def turned(solid: Manifold, rng: np.random.Generator) -> Manifold:
    return placed(solid, random_rotation(rng))


def random_directions(rng: np.random.Generator, count: int, least_angle: float = 0.0) -> np.ndarray:
    """Unit vectors, any two at least `least_angle` (radians) apart."""
    found: list[np.ndarray] = []
    while len(found) < count:
        one = rng.normal(size=3)
        one /= np.linalg.norm(one)
        if all(one @ other < np.cos(least_angle) for other in found):
            found.append(one)
    return np.array(found)


def union(parts: Sequence[Manifold]) -> Manifold:
    return Manifold.batch_boolean(list(parts), OpType.Add)


def cut(solid: Manifold, parts: Sequence[Manifold]) -> Manifold:
    return Manifold.batch_boolean([solid, *parts], OpType.Subtract)


def extruded(polygons: Sequence[np.ndarray], height: float, **options: float) -> Manifold:
    """Extrudes counter-clockwise polygons with clockwise holes from z = 0."""
    section = CrossSection([np.asarray(polygon, dtype=float) for polygon in polygons])
    return Manifold.extrude(section, float(height), **options)


def circle(radius: float, sides: int, at: Sequence[float] = (0, 0), turn: float = 0.0) -> np.ndarray:
    angles = turn + 2 * np.pi * np.arange(sides) / sides
    return np.column_stack([at[0] + radius * np.cos(angles), at[1] + radius * np.sin(angles)])


def manifold_of(vertices: np.ndarray, triangles: np.ndarray) -> Manifold:
    made = Manifold(
        Mesh64(np.ascontiguousarray(vertices, dtype=float), np.ascontiguousarray(triangles, dtype=np.uint64))
    )
    if made.is_empty():
        raise ValueError(f"not a manifold: {made.status()}")
    return made


def arrays_of(body: Manifold | Arrays) -> Arrays:
    if not isinstance(body, Manifold):
        return np.asarray(body[0], dtype=float), np.asarray(body[1], dtype=np.int64)
    mesh = body.to_mesh64()
    return np.array(mesh.vert_properties[:, :3], dtype=float), np.array(mesh.tri_verts, dtype=np.int64)


def bounds_of(body: Manifold | Arrays) -> tuple[np.ndarray, np.ndarray]:
    vertices = arrays_of(body)[0]
    return vertices.min(axis=0), vertices.max(axis=0)


def joined(*bodies: Arrays) -> Arrays:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in bodies])
    shifted = [triangles + start for start, (_, triangles) in zip(starts, bodies, strict=False)]
    return np.concatenate([vertices for vertices, _ in bodies]), np.concatenate(shifted)


def swept(rings: np.ndarray, closed: bool, shift: int = 0, other_diagonal: Sequence[int] = ()) -> Arrays:
    """The surface through rings [n, sides, 3], which are counter-clockwise when seen from ahead.

    The last ring meets the first one `shift` corners further on. The ends of open surfaces are fans, so their rings
    must be convex. Sides in `other_diagonal` are split the other way, so that both sides of a thin band bend alike."""
    count, sides, _ = rings.shape
    triangles = []
    for ring in range(count if closed else count - 1):
        here, there = ring * sides, (ring + 1) % count * sides
        moved = shift if ring == count - 1 else 0
        for side in range(sides):
            a, b = here + side, here + (side + 1) % sides
            c, d = there + (side + 1 + moved) % sides, there + (side + moved) % sides
            triangles += [(a, b, d), (b, c, d)] if side in other_diagonal else [(a, b, c), (a, c, d)]
    if not closed:
        last = (count - 1) * sides
        triangles += [(0, side + 1, side) for side in range(1, sides - 1)]
        triangles += [(last, last + side, last + side + 1) for side in range(1, sides - 1)]
    return rings.reshape(-1, 3), np.array(triangles)


def tube(points: np.ndarray, radius: float | np.ndarray, sides: int = 8, closed: bool = False) -> Arrays:
    """A round tube with little twist along a curve that stays two radii away from itself."""
    following = np.roll(points, -1, axis=0) - points
    before = points - np.roll(points, 1, axis=0)
    if not closed:
        following[-1], before[0] = before[-1], following[0]
    tangents = following / np.linalg.norm(following, axis=1)[:, None] + before / np.linalg.norm(before, axis=1)[:, None]
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]
    normals = [frame(tangents[0])[:, 0]]
    for tangent in tangents[1:]:
        normal = normals[-1] - tangent * (normals[-1] @ tangent)
        normals.append(normal / np.linalg.norm(normal))
    across = np.array(normals)
    angles = 2 * np.pi * np.arange(sides) / sides
    shift = 0
    if closed:
        other = np.cross(tangents[0], across[0])
        end = across[-1] - tangents[0] * (across[-1] @ tangents[0])
        off = np.arctan2(end @ other, end @ across[0])
        shift = round(off / (2 * np.pi / sides)) % sides
        # The rest is less than half a corner and is spread over the curve.
        left = off - 2 * np.pi / sides * round(off / (2 * np.pi / sides))
        turn = -left * np.arange(len(points)) / len(points)
    else:
        turn = np.zeros(len(points))
    third = np.cross(tangents, across)
    directions = (
        np.cos(angles[None, :, None] + turn[:, None, None]) * across[:, None]
        + np.sin(angles[None, :, None] + turn[:, None, None]) * third[:, None]
    )
    radii = np.broadcast_to(np.asarray(radius, dtype=float), len(points))
    return swept(points[:, None] + radii[:, None, None] * directions, closed, shift)


def voxel_surface(cells: np.ndarray, size: float = 1.0) -> Arrays:
    """The surface of voxels [x, y, z] that touch only through faces."""
    padded = np.pad(cells.astype(bool), 1)
    quads = []
    for axis in range(3):
        for side in (0, 1):
            free = padded & ~np.roll(padded, 1 - 2 * side, axis)
            corner = np.argwhere(free) - 1
            corner[:, axis] += side
            u, v = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
            ring = np.stack([corner, corner + u, corner + u + v, corner + v], axis=1)
            quads.append(ring if side else ring[:, ::-1])
    corners = np.concatenate(quads)
    vertices, ids = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    ids = ids.reshape(-1, 4)
    return vertices * size, np.concatenate([ids[:, [0, 1, 2]], ids[:, [0, 2, 3]]])


def is_well_composed(cells: np.ndarray) -> bool:
    """True if voxels, and the voxels around them, touch only through faces, so that their surface is a manifold."""
    padded = np.pad(cells.astype(bool), 1)
    for a, b in ((0, 1), (0, 2), (1, 2)):
        here, right = padded, np.roll(padded, -1, a)
        up, both = np.roll(padded, -1, b), np.roll(padded, (-1, -1), (a, b))
        if ((here == both) & (right == up) & (here != right)).any():
            return False
    eight = {(i, j, k): np.roll(padded, (-i, -j, -k), (0, 1, 2)) for i in (0, 1) for j in (0, 1) for k in (0, 1)}
    for corner, here in eight.items():
        far = eight[tuple(1 - c for c in corner)]
        others = sum(one.astype(int) for key, one in eight.items()) - here - far
        if (here & far & (others == 0)).any() or (~here & ~far & (others == 6)).any():
            return False
    return True
