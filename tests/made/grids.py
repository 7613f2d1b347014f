"""Families of solids on grid planes and of implicit surfaces: voxels, mazes, Menger sponges, gyroids, booleans."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from .shapes import (
    Draft,
    ball,
    block,
    box,
    cut,
    family,
    is_well_composed,
    placed,
    random_rotation,
    turned,
    voxel_surface,
)


@family(7)
def polycubes(k: int, rng: np.random.Generator) -> Draft:
    """Voxels with exact binary coordinates that touch only through faces; terraces of voxels."""
    side = 4 + k
    if k % 3 == 2:
        steps = np.sort(rng.integers(1, side, (side, side)), axis=0)
        heights = np.sort(steps, axis=1)
        cells = np.arange(side)[None, None] < heights[:, :, None]
        return Draft(voxel_surface(cells, 2.0**-k), 2.0**-k, (1, 0, 0))
    cells = np.zeros((side,) * 3, dtype=bool)
    cells[side // 2] = True
    for _ in range(side**3 * 3):
        place = tuple(rng.integers(0, side, 3))
        cells[place] ^= True
        if not is_well_composed(cells):
            cells[place] ^= True
    return Draft(voxel_surface(cells, 2.0 ** (k - 3)), 2.0 ** (k - 3))


def carved(rng: np.random.Generator, shape: tuple[int, ...]) -> np.ndarray:
    """The corridors of a maze without loops: cells at odd places with walls between them."""
    open_cells = np.zeros([2 * n + 1 for n in shape], dtype=bool)
    stack = [tuple(int(rng.integers(n)) for n in shape)]
    open_cells[tuple(2 * c + 1 for c in stack[0])] = True
    while stack:
        here = stack[-1]
        steps = []
        for axis in range(len(shape)):
            for sign in (1, -1):
                there = tuple(c + sign * (axis == i) for i, c in enumerate(here))
                if 0 <= there[axis] < shape[axis] and not open_cells[tuple(2 * c + 1 for c in there)]:
                    steps.append(there)
        if not steps:
            stack.pop()
            continue
        there = steps[int(rng.integers(len(steps)))]
        open_cells[tuple(a + b + 1 for a, b in zip(here, there, strict=True))] = True
        open_cells[tuple(2 * c + 1 for c in there)] = True
        stack.append(there)
    return open_cells


def hilbert(order: int) -> np.ndarray:
    """Points of the Hilbert curve in 3D (Skilling's transform of Gray codes)."""
    points = []
    for number in range(8**order):
        bits = [(number >> (3 * order - 1 - i)) & 1 for i in range(3 * order)]
        x = [int("".join(str(b) for b in bits[axis::3]), 2) for axis in range(3)]
        low = x[2] >> 1
        for i in (2, 1):
            x[i] ^= x[i - 1]
        x[0] ^= low
        q = 2
        while q != 1 << order:
            mask = q - 1
            for i in (2, 1, 0):
                if x[i] & q:
                    x[0] ^= mask
                else:
                    t = (x[0] ^ x[i]) & mask
                    x[0] ^= t
                    x[i] ^= t
            q <<= 1
        points.append(x)
    return np.array(points)


@family(7)
def mazes(k: int, rng: np.random.Generator) -> Draft:
    """Voxels of mazes: open above, closed on all sides, or the corridors as a solid; Hilbert's curve."""
    if k in (2, 5):
        order = 2 if k == 2 else 3
        points = hilbert(order)
        cells = np.zeros((2 * 2**order - 1,) * 3, dtype=bool)
        cells[tuple((2 * points).T)] = True
        cells[tuple((points[1:] + points[:-1]).T)] = True
        return Draft(voxel_surface(cells, 2.0**-order), 2.0**-order, (1, 0, 0))
    if k % 3 == 0:
        flat = carved(rng, (3 + k, 2 + k))
        cells = np.stack([np.ones_like(flat), ~flat, ~flat], axis=2)
        return Draft(voxel_surface(cells, 0.25), 0.25, (1, 0, 0))
    corridors = carved(rng, (3, 2 + k // 2, 2 + k // 3))
    if k == 1:
        return Draft(voxel_surface(~corridors), 1, (1, 0, 1))
    vertices, triangles = voxel_surface(corridors)
    return Draft((vertices @ random_rotation(rng), triangles), 1, (1, 0, 0))


def menger(level: int, width: float = 1 / 3) -> Manifold:
    """A Menger sponge of side 3**level with a corner in the origin; `width` is the relative width of its holes."""
    side = 3.0**level
    holes = []
    for depth in range(1, level + 1):
        cell = side / 3 ** (depth - 1)
        lower, upper = cell * (1 - width) / 2, cell * (1 + width) / 2
        for axis in range(3):
            for u, v in np.ndindex(3 ** (depth - 1), 3 ** (depth - 1)):
                start, end = (
                    np.array([u * cell + lower, v * cell + lower]),
                    np.array([u * cell + upper, v * cell + upper]),
                )
                holes.append(block(np.insert(start, axis, -1), np.insert(end, axis, side + 1)))
    return cut(block((0, 0, 0), (side, side, side)), holes)


@family(7)
def menger_sponges(k: int, rng: np.random.Generator) -> Draft:
    """Menger sponges on grid planes, turned, with thin walls, or cut by planes of any direction."""
    if k < 2:
        return Draft(menger(1 + k), 1, (1, (5, 81)[k], 0))
    if k == 2:
        return Draft(turned(menger(1, 0.999), rng), 0.0015, (1, 5, 0))
    if k == 3:
        return Draft(menger(2).trim_by_plane((1.0, 1.0, 1.0), 13.4), 0)
    if k == 4:
        return Draft(turned(menger(2), rng), 1, (1, 81, 0))
    if k == 5:
        return Draft(menger(3).trim_by_plane((-1.0, 0.2, 0.1), -11.3), 1)
    direction = rng.normal(size=3)
    return Draft(menger(2).trim_by_plane(tuple(direction), float(direction @ (4.4, 4.5, 4.6))), 0)


TPMS = {
    "gyroid": lambda x, y, z: np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x),
    "primitive": lambda x, y, z: np.cos(x) + np.cos(y) + np.cos(z),
    "diamond": lambda x, y, z: (
        np.sin(x) * np.sin(y) * np.sin(z)
        + np.sin(x) * np.cos(y) * np.cos(z)
        + np.cos(x) * np.sin(y) * np.cos(z)
        + np.cos(x) * np.cos(y) * np.sin(z)
    ),
}


@family(8)
def gyroids(k: int, rng: np.random.Generator) -> Draft:
    """Pieces of periodic minimal surfaces in boxes and balls: one side of the surface, or a wall along it."""
    value = TPMS[("gyroid", "primitive", "diamond")[k % 3]]
    wall = (0, 0.7, 0, 0.5, 0, 0.6, 0, 0.4)[k]
    half = (3.0, 3.3, 4.0, 3.0, 3.1, 3.4, 5.2, 3.6)[k]
    step = 0.6 * wall if wall else half / (6 + k % 3 * 2 + k // 4)

    def inside(x: float, y: float, z: float) -> float:
        v = float(value(x, y, z))
        return wall - abs(v) if k % 2 else v - 0.2

    piece = Manifold.level_set(
        inside, [-half - step, -half - step, -half - step, half + step, half + step, half + step], step
    )
    within = ball(half, segments=32) if k % 3 == 2 else box((2 * half * 0.98,) * 3)
    return Draft(piece ^ within, wall)


@family(7)
def random_booleans(k: int, rng: np.random.Generator) -> Draft:
    """Boxes, balls, cylinders and cones, added and subtracted at random."""
    solid = box((2, 2, 2))
    for number in range(6 + 4 * k):
        size = rng.uniform(0.2, 0.9)
        kind = int(rng.integers(4))
        one = (
            box(rng.uniform(0.1, 1.5, 3)),
            ball(size, segments=12),
            Manifold.cylinder(2 * size, 0.4 * size, -1, 9, True),
            Manifold.cylinder(2 * size, size, 0, 7, True),
        )[kind]
        one = placed(one, random_rotation(rng), rng.uniform(-1.1, 1.1, 3))
        solid = solid + one if number % 2 else solid - one
    return Draft(solid, 0)
