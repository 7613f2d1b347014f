"""Families of solids with shells, holes and voids."""

from __future__ import annotations

import numpy as np
from manifold3d import CrossSection, Manifold

from .shapes import (
    Draft,
    ball,
    block,
    bounds_of,
    box,
    cut,
    family,
    placed,
    random_directions,
    rod,
    torus,
    turned,
    union,
)


def voxel(solid: Manifold) -> float:
    """The voxel size of a grid of 64 cells along the longest side."""
    lower, upper = bounds_of(solid)
    return float((upper - lower).max()) / 64


def shell_of(solid: Manifold, thickness: float) -> Manifold:
    """Hollows a star-shaped solid around the origin; the wall is at most `thickness`."""
    lower, upper = bounds_of(solid)
    half = (upper - lower).max() / 2
    return solid - solid.scale((float(1 - thickness / half),) * 3)


@family(8)
def thin_shells(k: int, rng: np.random.Generator) -> Draft:
    """Closed walls of 0.001 to 1 voxel thickness in a grid of 64."""
    voxels = (1, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001, 0.5)[k]
    if k in (2, 6):
        thickness = voxels * 2 * 1.4 / 64
        solid = torus(1, 0.4, 24 + k, 12) - torus(1, 0.4 - thickness, 24 + k, 12)
        return Draft(turned(solid, rng), thickness, (1, 2, 1))
    solids = (
        ball(1, segments=24),
        box((2, 1, 1.5)),
        ball(1),
        ball(1, segments=20).scale((1.0, 0.6, 0.3)),
        Manifold.cylinder(2, 0.7, 0.5, 20, True),
        Manifold.batch_hull([ball(0.5, (0.7, 0, 0)), ball(0.3, (-0.7, 0.2, 0))]),
        ball(1),
        Manifold.hull_points(rng.normal(size=(30, 3))),
    )
    thickness = voxels * voxel(solids[k])
    return Draft(turned(shell_of(solids[k], thickness), rng), thickness, (1, 0, 1))


@family(8)
def pierced_shells(k: int, rng: np.random.Generator) -> Draft:
    """Thin shells with holes through the wall."""
    holes, thickness = 1 + 2 * k, 0.1 * 0.35**k
    radius = 0.5 / np.sqrt(holes + 1)
    whole = ball(1, segments=20) if k % 2 else box((1.6, 1.4, 1.2))
    directions = random_directions(rng, holes, 2.2 * np.arcsin(min(radius / 0.6, 0.6)) if k < 3 else 0.45)
    drills = [rod((0, 0, 0), 2 * one, radius * (0.5 if k > 2 else 0.8), 7) for one in directions]
    solid = cut(shell_of(whole, thickness), [union(drills)] if k % 3 == 2 else drills)
    return Draft(turned(solid, rng), thickness)


@family(8)
def pinholes(k: int, rng: np.random.Generator) -> Draft:
    """Tiny holes through a plate, straight or slanted."""
    radius = (0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)[k]
    side = 2 + k % 4
    places = [(x, y) for x in np.arange(side) for y in np.arange(side)]
    lean = np.radians(40) if k % 3 == 1 else 0.0
    holes = []
    for x, y in places:
        slope = 2 * np.tan(lean) * rng.uniform(-0.2, 0.2, 2)
        off = rng.uniform(-0.1, 0.1, 2)
        middle = np.array([x + off[0], y + off[1], 0])
        step = np.array([*slope, 1.0])
        holes.append(rod(middle - step, middle + step, radius, 3 + k % 6))
    solid = cut(block((-0.5, -0.5, -0.25), (side - 0.5, side - 0.5, 0.25)), holes)
    return Draft(turned(solid, rng) if k % 2 else solid, 2 * radius, (1, side * side, 0))


@family(7)
def drillings(k: int, rng: np.random.Generator) -> Draft:
    """Thin holes that meet in the middle of a block or a ball, or narrowly miss each other."""
    holes, radius = 2 + k // 2, 0.2 * 0.3**k
    solid = ball(1, segments=24) if k % 3 == 2 else box((2, 2, 2))
    directions = random_directions(rng, holes, 0.5)
    if k % 2 == 0:
        drills = [rod(-3 * one, 3 * one, radius, 6 + k) for one in directions]
        return Draft(cut(solid, drills), 2 * radius, (1, 2 * holes - 1, 0))
    gap = 0.5 * radius
    drills = []
    for layer in range(holes):
        angle = np.pi * layer / holes + 0.1
        direction, z = np.array([np.cos(angle), np.sin(angle), 0]), (layer - (holes - 1) / 2) * (2 * radius + gap)
        drills.append(rod(np.array([0, 0, z]) - 3 * direction, np.array([0, 0, z]) + 3 * direction, radius, 8))
    return Draft(cut(solid, drills), gap, (1, holes, 0))


@family(8)
def nested_voids(k: int, rng: np.random.Generator) -> Draft:
    """Solids nested in voids of solids with thin walls and gaps, or many voids side by side."""
    if k % 4 == 3:
        side = 2 + k // 4
        cells = [(x, y, z) for x in range(side) for y in range(side) for z in range(side)]
        voids = []
        for cell in cells:
            at = np.array(cell) + rng.uniform(-0.05, 0.05, 3)
            size = rng.uniform(0.3, 0.5)
            voids.append(
                ball(size * 0.85, at, 8) if sum(cell) % 2 else turned(box((size,) * 3), rng).translate(tuple(at))
            )
        solid = cut(block((-0.5,) * 3, (side - 0.5,) * 3), voids)
        return Draft(solid, 0.05, (1, 0, len(cells)))
    depth, step = 2 + k, 0.15 * 0.5**k
    shells = []
    for level in range(depth):
        size = 1 - step * level
        one = (ball(size, segments=16), box((2 * size,) * 3), Manifold.sphere(size, 4))[k % 3]
        shells.append(one)
    solid = Manifold()
    for level in range(0, depth, 2):
        inner = shells[level + 1 : level + 2]
        solid = solid + (cut(shells[level], inner) if inner else shells[level])
    return Draft(turned(solid, rng) if k % 2 else solid, step / 2, ((depth + 1) // 2, 0, depth // 2))


@family(7)
def bellows(k: int, rng: np.random.Generator) -> Draft:
    """Folded walls of revolution as open or closed tubes."""
    folds, wall = 3 + k, 0.1 * 0.4**k
    heights = np.linspace(0, 2, 2 * folds + 1)
    radii = np.where(np.arange(2 * folds + 1) % 2, 1.0, 0.55)
    if k % 2 == 0:
        outer, inner = np.column_stack([radii, heights]), np.column_stack([radii - wall, heights])
        profile, betti = np.concatenate([outer, inner[::-1]]), (1, 1, 0)
    else:
        ends = np.array([(0.0, 2.0 + wall), (0.0, 2.0), (0.0, 0.0), (0.0, -wall)])
        outer, inner = np.column_stack([radii, heights]), np.column_stack([radii - wall, heights])
        outer[0, 1], outer[-1, 1] = -wall, 2 + wall
        profile = np.concatenate([outer, ends[:2], inner[::-1], ends[2:]])
        betti = (1, 0, 1)
    solid = CrossSection([profile]).revolve(16 + k)
    return Draft(turned(solid, rng), wall, betti)


@family(7)
def hairs(k: int, rng: np.random.Generator) -> Draft:
    """Bodies connected by hairs, or chambers opened by hair-thin holes."""
    count, radius = 1 + k, (0.05, 0.01, 2e-3, 5e-4, 1e-4, 1e-5, 1e-6, 1e-3)[k]
    places = rng.uniform(-0.6, 0.6, (count, 2))
    while count > 1 and min(np.linalg.norm(a - b) for i, a in enumerate(places) for b in places[:i]) < 0.12:
        places = rng.uniform(-0.6, 0.6, (count, 2))
    strands = [rod((x, y, -1), (x + 0.02, y - 0.01, 1), radius, 3 + k % 4) for x, y in places]
    if k % 2 == 0:
        solid = union([box((2, 2, 1), (0, 0, 0.9)), box((2, 2, 1), (0, 0, -0.9)), *strands])
        return Draft(turned(solid, rng), 2 * radius, (1, count - 1, 0))
    outer, chamber = box((2, 2, 2), (0, 0, -0.5)), box((1.5, 1.5, 0.5), (0, 0, -0.6))
    drills = [rod((x, y, -0.6), (x + 0.02, y - 0.01, 1), radius, 3 + k % 4) for x, y in places]
    return Draft(placed(cut(outer, [chamber, *drills])), 2 * radius, (1, count - 1, 0))
