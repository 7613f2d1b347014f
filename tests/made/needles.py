"""Families of solid and empty needles, fans of thin triangles, and grazing contacts."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from .shapes import (
    Arrays,
    Draft,
    ball,
    block,
    box,
    circle,
    cut,
    extruded,
    family,
    placed,
    random_directions,
    random_rotation,
    rod,
    turned,
    union,
)


def cone(tip: np.ndarray, towards: np.ndarray, length: float, degrees: float, sides: int) -> Manifold:
    """A cone; `degrees` is the whole angle at the tip."""
    radius = length * np.tan(np.radians(degrees) / 2)
    return rod(tip + length * towards, tip, radius, sides, 0.0)


@family(8)
def solid_needles(k: int, rng: np.random.Generator) -> Draft:
    """Spikes of 2 to 20 degrees on a ball or box."""
    degrees = (20, 15, 10, 7, 5, 3, 2, 2)[k]
    spikes = [
        cone(3 * one, -one, 3, degrees, 3 + k) for one in random_directions(rng, 3 + 3 * k, 0.4 if k > 4 else 0.6)
    ]
    return Draft(union([ball(0.8) if k % 2 else box((0.9, 0.9, 0.9)), *spikes]), 0, (1, 0, 0))


@family(8)
def empty_needles(k: int, rng: np.random.Generator) -> Draft:
    """Voids shaped like cones, pyramids and spindles, with tips in any direction."""
    degrees = (20, 15, 10, 7, 5, 3, 2, 12)[k]
    side = 1 + (k + 1) // 3
    voids = []
    for cell in np.ndindex(side, side, 1 + k % 2):
        direction = random_directions(rng, 1)[0]
        at = np.array(cell) - 0.4 * direction
        one = cone(at, direction, 0.4, degrees, 3 + k % 5)
        if k % 3 == 2:
            one = Manifold.batch_hull([one, cone(at + 0.75 * direction, -direction, 0.35, degrees, 3 + k % 5)])
        voids.append(one)
    solid = cut(block((-0.5,) * 3, (side - 0.5, side - 0.5, 0.5 + k % 2)), voids)
    return Draft(solid, 0, (1, 0, len(voids)))


@family(8)
def cut_needles(k: int, rng: np.random.Generator) -> Draft:
    """Empty needles of 2 to 20 degrees cut into a block from outside."""
    degrees = (20, 15, 10, 7, 5, 4, 3, 2)[k]
    side = 2 + k % 3
    holes = []
    for x, y in np.ndindex(side, side):
        lean = rng.uniform(-0.25, 0.25, 2)
        direction = np.array([*lean, 1.0]) / np.linalg.norm([*lean, 1.0])
        holes.append(cone(np.array([x, y, rng.uniform(-0.6, -0.2)]), direction, 1.6, degrees, 3 + (k + x + y) % 4))
    solid = cut(block((-1, -1, -1), (side, side, 0.5)), holes)
    return Draft(turned(solid, rng) if k % 2 else solid, 0, (1, 0, 0))


@family(7)
def hourglasses(k: int, rng: np.random.Generator) -> Draft:
    """Pairs of cones tip to tip, a hair apart or joined by a hair; solid, or empty in a block."""
    gap, degrees = 0.1**k if k else 0.2, (40, 20, 10, 30, 60, 15, 5)[k]
    meets = k % 2 == 1
    parts, radius = [], 2 * np.tan(np.radians(degrees) / 2)
    for x in (0.0, 3.0):
        offset = -gap / 2 if meets else gap / 2
        up = Manifold.cylinder(2, 0, radius, 5 + k).translate((x, 0, offset))
        down = Manifold.cylinder(2, radius, 0, 5 + k).translate((x, 0, -2 - offset))
        parts += [up, down]
    if k % 3 == 0:
        plates = [box((6, 4, 1), (1.5, 0, 2)), box((6, 4, 1), (1.5, 0, -2))]
        betti = (1, 1, 0) if meets else (2, 0, 0)
        return Draft(union([*parts, *plates]), gap, betti)
    solid = cut(box((6, 3, 3), (1.5, 0, 0)), parts)
    return Draft(solid, gap, (1, 2, 0) if meets else (1, 0, 0))


@family(8)
def fans(k: int, rng: np.random.Generator) -> Draft:
    """Vertices of high valence with needle triangles around them."""
    sides = (16, 64, 200, 500, 1000, 2000, 97, 300)[k]
    rim = np.column_stack([circle(1, sides, turn=0.1 * k), np.zeros(sides)])
    if k % 4 == 3:  # a disc; each face is a fan around one corner of the border
        lower, upper = rim, rim + np.array([0, 0, 0.05])
        around = np.arange(sides)
        following = (around + 1) % sides
        inner = np.arange(1, sides - 1)
        faces = [
            np.column_stack([0 * inner, inner + 1, inner]),
            np.column_stack([0 * inner, inner, inner + 1]) + sides,
            np.column_stack([around, following, following + sides]),
            np.column_stack([around, following + sides, around + sides]),
        ]
        return Draft((np.concatenate([lower, upper]), np.concatenate(faces)), 0.05, (1, 0, 0))
    height = (1, 0.1, 5, 0, 1e-3, 0.5, 20)[k % 7]
    if k % 2:
        rim[:, 2] = 0.3 * np.cos(np.arange(sides) * 2 * np.pi / sides * 5)
        height += 0.4
    tips = np.array([[0.1, 0.2, height], [-0.1, 0.05, -height]])
    around = np.arange(sides)
    following = (around + 1) % sides
    sheet = np.column_stack([around, following, np.full(sides, sides)])
    other = np.column_stack([following, around, np.full(sides, sides + 1)])
    return Draft((np.concatenate([rim, tips]), np.concatenate([sheet, other])), 0, (1, 0, 0))


def sphere_mesh(rows: int, around: int) -> Arrays:
    """A unit sphere with two poles of high valence."""
    heights = np.pi * np.arange(1, rows) / rows
    angles = 2 * np.pi * np.arange(around) / around
    rings = np.array([[(np.sin(h) * np.cos(a), np.sin(h) * np.sin(a), -np.cos(h)) for a in angles] for h in heights])
    vertices = np.concatenate([rings.reshape(-1, 3), [[0, 0, -1], [0, 0, 1]]])
    low, high = len(vertices) - 2, len(vertices) - 1
    triangles = []
    for j in range(around):
        following = (j + 1) % around
        triangles.append((low, following, j))
        triangles.append((high, (rows - 2) * around + j, (rows - 2) * around + following))
        for i in range(rows - 2):
            a, b = i * around + j, i * around + following
            triangles += [(a, b, b + around), (a, b + around, a + around)]
    return vertices, np.array(triangles)


@family(7)
def urchins(k: int, rng: np.random.Generator) -> Draft:
    """Spheres whose vertices are moved along their rays, from roughness to spikes of single vertices."""
    vertices, triangles = sphere_mesh(6 + 2 * k, 8 + 4 * k)
    if k % 2:
        radii = np.where(rng.uniform(size=len(vertices)) < 0.1, rng.uniform(1.5, 4, len(vertices)), 1)
    else:
        radii = np.exp(rng.normal(size=len(vertices)) * 0.1 * (1 + k))
    return Draft((vertices * radii[:, None] @ random_rotation(rng), triangles), 0, (1, 0, 0))


@family(8)
def grazing(k: int, rng: np.random.Generator) -> Draft:
    """Bodies that barely reach through a plane, and nearly coplanar faces."""
    by = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-5, 1e-3, 1e-4)[k]
    kind = k % 4
    if kind == 0:  # dents and bumps as shallow as `by`
        bumps = [ball(1, (x, 0.1, 0.5 + 1 - by), 64) for x in (-2.0, 1.0)]
        dents = [Manifold.cylinder(1, 0.3, -1, 24).translate((x, -0.7, 0.5 - by)) for x in (-2.0, 1.0)]
        return Draft(cut(box((8, 3, 1)), dents) + union(bumps), by, (1, 0, 0))
    if kind == 1:  # holes near a face that nearly break through
        drills = [Manifold.cylinder(3, 0.25, -1, 24, True).translate((x, 0.75 - by, 0)) for x in (-1.5, 0.0, 1.5)]
        return Draft(cut(box((4, 2, 2)), drills), by, (1, 3, 0))
    if kind == 2:  # boxes turned slightly against each other
        blocks = [
            box((2, 1, 1)).rotate((0.0, 0.0, float(np.degrees(by) * i))).translate((0.9 * i, 0, 0)) for i in range(4)
        ]
        return Draft(union(blocks), by, (1, 0, 0))
    stack = [box((2, 2, 0.5)).translate((by * i, -by * i * i, 0.4 * i)) for i in range(6)]
    stack += [placed(extruded([circle(0.9, 40)], 0.3), None, (0.1 - by, 0.1 - by, 2))]
    return Draft(turned(union(stack), rng), by, (1, 0, 0))
