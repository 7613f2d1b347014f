"""Families of machine parts: screws, gears, joints with little play, parts that nearly touch, folded walls."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from .shapes import (
    Draft,
    ball,
    block,
    box,
    circle,
    cut,
    extruded,
    family,
    manifold_of,
    rod,
    swept,
    torus,
    turned,
    union,
)


def thread(radius: float, depth: float, pitch: float, turns: int, steps: int) -> Manifold:
    """A helical ridge with a triangular section; the foot of the ridge reaches below `radius`."""
    t = 2 * np.pi * turns * np.arange(turns * steps + 1) / (turns * steps)
    profile = np.array([(-0.1 * radius, -0.42 * pitch), (depth, 0.0), (-0.1 * radius, 0.42 * pitch)])
    out = np.column_stack([np.cos(t), np.sin(t), 0 * t])
    rings = out[:, None] * (radius + profile[None, :, :1])
    rings[:, :, 2] = pitch * t[:, None] / (2 * np.pi) + profile[None, :, 1]
    return manifold_of(*swept(rings[:, ::-1], False))


@family(8)
def screws(k: int, rng: np.random.Generator) -> Draft:
    """Threads on screws, in nuts, or on both with little play between them; twisted bars."""
    kind, turns, steps = k % 4, 3 + k // 2, 16 + k
    if kind == 3:
        section = np.concatenate([circle(1.0 + 0.3 * (i % 2), 1, turn=2 * np.pi * i / 12) for i in range(12)])
        options = {"n_divisions": 20 + 5 * k, "twist_degrees": 120.0 * k}
        return Draft(extruded([section], 5, **options), 0.3, (1, 0, 0))
    depth = 0.25 * 0.7**k
    screw = union(
        [Manifold.cylinder(turns * 0.5 + 1, 1, -1, steps).translate((0, 0, -0.5)), thread(1, depth, 0.5, turns, steps)]
    )
    if kind == 0:
        head = Manifold.cylinder(0.6, 1.8, -1, 6).translate((0, 0, -1))
        return Draft(turned(screw + head, rng), depth, (1, 0, 0))
    nut = box((4, 4, 0.5 * turns - 1), (0, 0, 0.25 * turns))
    if kind == 1:
        return Draft(turned(nut - screw, rng), depth, (1, 1, 0))
    play = 0.05 * 0.1 ** (k // 2)
    smaller = screw.scale((1 - play, 1 - play, 1.0))
    return Draft((nut - screw) + smaller, play, (2, 1, 0))


def gear(teeth: int, radius: float, depth: float, gap: float = 0.0) -> np.ndarray:
    """The outline of a gear; `gap` is the share by which teeth are narrower than without play."""
    points = []
    for tooth in range(teeth):
        for at, r in ((-0.27, -1), (-0.12, 1), (0.12, 1), (0.27, -1)):
            angle = 2 * np.pi * (tooth + at * (1 - gap)) / teeth
            points.append(((radius + r * depth) * np.cos(angle), (radius + r * depth) * np.sin(angle)))
    return np.array(points)


@family(7)
def gears(k: int, rng: np.random.Generator) -> Draft:
    """Straight and helical gears with bores and windows between spokes; pairs of gears with little play."""
    teeth, depth = 8 + 4 * k, 0.4 * 0.7**k
    wheel, bore = gear(teeth, 2, depth), circle(0.4, 16)[::-1]
    if k % 3 == 2:
        play = 0.2 * 0.3**k
        gap = 4 + 2 * depth + play  # side by side, with teeth that do not interlock
        pair = [extruded([wheel, bore], 0.6), extruded([gear(teeth, 2, depth), bore], 0.6).translate((gap, 0, 0))]
        return Draft(turned(union(pair), rng), play, (2, 2, 0))
    windows, thin = 3 + k, 0.15 * 0.5**k
    holes = []
    for window in range(windows):
        start, end = 2 * np.pi * window / windows, 2 * np.pi * (window + 1) / windows
        along = np.linspace(start, end, 6)
        outer = np.column_stack([np.cos(along), np.sin(along)]) * (2 - depth - thin)
        middle = (start + end) / 2
        aside = outer + 0  # for parallel spokes, both sides of a window move in by half a spoke
        aside[[0, -1]] += thin / 2 * np.array([(-np.sin(start), np.cos(start)), (np.sin(end), -np.cos(end))])
        inner = np.array([(np.cos(middle), np.sin(middle))]) * (0.4 + thin) * 1.2
        holes.append(np.concatenate([aside, inner])[::-1])
    options = {"n_divisions": 8, "twist_degrees": 20.0} if k % 2 else {}
    return Draft(turned(extruded([wheel, bore, *holes], 0.6, **options), rng), thin, (1, 1 + windows, 0))


@family(7)
def joints(k: int, rng: np.random.Generator) -> Draft:
    """Interlocked parts with little play: ball and socket, axle and bushing, hinges."""
    play = 0.05 * 0.15**k
    if k % 3 == 0:
        head = ball(1, segments=24) + rod((0, 0, 0), (0, 0, 3), 0.4, 12)
        hollow = ball(1 / (1 - play), segments=24)
        socket = cut(box((3, 3, 2.6), (0, 0, -0.2)), [hollow, rod((0, 0, 0.5), (0, 0, 3), 0.9, 24)])
        return Draft(turned(union([socket, head]), rng), play, (2, 0, 0))
    if k % 3 == 1:
        axle = (
            Manifold.cylinder(4, 0.5, -1, 24, True) + box((1, 1.5, 1.5), (0, 0, 2.0)) + box((1, 1.5, 1.5), (0, 0, -2.0))
        )
        bushing = Manifold.cylinder(1.2, 1.2, -1, 24, True) - Manifold.cylinder(3, 0.5 + play, -1, 24, True)
        return Draft(turned(union([axle, bushing]), rng), play, (2, 1, 0))
    leaves = []
    for i in range(5):
        knuckle = Manifold.cylinder(1 - play, 0.4, -1, 20).rotate((-90.0, 0.0, 0.0)).translate((0, i, 0))
        side = 1 if i % 2 else -1
        leaves.append(knuckle + block((0, i, -0.1), (2, i + 1 - play, 0.1)).scale((float(side), 1.0, 1.0)))
    plates = [block((0.5, 0, -0.1), (2, 5, 0.1)), block((-2, 0, -0.1), (-0.5, 5, 0.1))]
    hinge = cut(union([*leaves, *plates]), [block((-0.1, -1, -0.1), (0.1, 6, 0.1))])
    pin = block((-0.05, -0.2, -0.05), (0.05, 5.2, 0.05))
    return Draft(turned(hinge + pin, rng), play, (3, 2 + 3, 0))


@family(8)
def near_parts(k: int, rng: np.random.Generator) -> Draft:
    """Parts that nearly touch, with gaps down to 1e-6: face to face, tip to face, ball to ball, comb in comb."""
    gap = (0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 1e-6)[k]
    kind = k % 4
    if kind == 0:
        side = 2 + k // 4
        cubes = [box((1 - gap,) * 3, cell) for cell in np.ndindex(side, side, side)]
        return Draft(Manifold.compose(cubes), gap, (side**3, 0, 0))
    if kind == 1:
        balls = [ball(0.5 - gap / 2, (x, y, 0), 24) for x in range(3) for y in range(2)]
        return Draft(Manifold.compose(balls), gap, (6, 0, 0))
    if kind == 2:
        tips = [Manifold.cylinder(1, 0, 0.3, 5 + k).translate((x, 0, gap)) for x in (-1.0, 0.0, 1.0)]
        tips += [Manifold.sphere(0.5, 4).translate((x, 1.2, 0.5 + gap)) for x in (-1.1, 0.0, 1.1)]
        return Draft(turned(Manifold.compose([block((-2, -1, -0.5), (2, 2, 0)), *tips]), rng), gap, (7, 0, 0))
    teeth, pitch = 4 + k, 0.5
    combs = []
    for sign in (1, -1):
        back = block((0, 1.6, 0), (teeth * pitch, 2, 0.5))
        first = 0.0 if sign > 0 else pitch / 2
        fingers = [
            block((first + i * pitch, -1.6 + gap, 0), (first + i * pitch + pitch / 2 - gap, 1.7, 0.5))
            for i in range(teeth)
        ]
        comb = union([back, *fingers])
        combs.append(comb if sign > 0 else comb.mirror((0.0, 1.0, 0.0)))
    return Draft(turned(Manifold.compose(combs), rng), gap, (2, 0, 0))


@family(8)
def folds(k: int, rng: np.random.Generator) -> Draft:
    """Bodies that nearly touch themselves: rolled up, folded back and forth, or bent to a ring with a slit."""
    gap = 0.2 * 0.25**k
    kind = k % 4
    if kind == 0 or kind == 3:  # a rolled-up wall, or a spiral slit in a disc
        turns, wall = 2 + k // 2, 0.1
        pitch = wall + gap if kind == 0 else wall + 0.1
        width = wall if kind == 0 else gap
        t = 2 * np.pi * np.arange(3, 24 * turns) / 24  # corners of successive turns lie above each other
        r = 0.2 + pitch * t / (2 * np.pi)
        inner, outer = ((r + s * width)[:, None] * np.column_stack([np.cos(t), np.sin(t)]) for s in (0, 1))
        strip = extruded([np.concatenate([outer, inner[::-1]])], 1)
        if kind == 3:
            strip = cut(Manifold.cylinder(1, float(r[-1] + 0.3), -1, 48), [strip.translate((0, 0, 0.5))])
        return Draft(turned(strip, rng), min(gap, wall), (1, 0, 0))
    if kind == 1:
        layers, wall = 4 + k, 0.2
        parts = []
        for layer in range(layers):
            z = layer * (wall + gap)
            parts.append(block((0, 0, z), (2, 1, z + wall)))
            if layer:
                x = 2 - wall if layer % 2 else 0
                parts.append(block((x, 0, z - gap - wall / 2), (x + wall, 1, z + wall / 2)))
        return Draft(turned(union(parts), rng), gap, (1, 0, 0))
    ring = torus(1, 0.35, 32, 12)
    slit = [box((2, gap, 2), (1, 0, 0)).rotate((0.0, 0.0, 3.7)), rod((0, 0, 0), (-3, 0.1, 0), 0.1, 5)]
    return Draft(turned(cut(ring, slit), rng), gap, (1, 1, 0))
