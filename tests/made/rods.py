"""Families of thin round parts: trusses, lattices, vessels, chains, knots, springs, bands."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold
from scipy.spatial import cKDTree

from .shapes import (
    Draft,
    arrays_of,
    ball,
    bounds_of,
    box,
    circle,
    family,
    joined,
    manifold_of,
    placed,
    random_directions,
    random_rotation,
    rod,
    swept,
    torus,
    tube,
    turned,
    union,
)


def frame_of(nodes: np.ndarray, edges: list[tuple[int, int]], radius: float, sides: int, knob: float = 0.0) -> Manifold:
    parts = [rod(nodes[a], nodes[b], radius, sides) for a, b in edges]
    parts += [ball(knob or 1.3 * radius, node, 8) for node in nodes]
    return union(parts)


def tunnels(nodes: np.ndarray, edges: list[tuple[int, int]]) -> int:
    """The number of tunnels of a connected graph."""
    return len(edges) - len(nodes) + 1


@family(8)
def trusses(k: int, rng: np.random.Generator) -> Draft:
    """Girders of three booms, and flat girders of two, with diagonals."""
    bays, radius = 2 + k, 0.08 * 0.6**k
    booms = 3 if k % 2 else 2
    corners = np.array([(0, 0), (0.5, 0.9), (1, 0)])[:booms]
    nodes = np.array([(x, *corner) for x in range(bays + 1) for corner in corners])
    nodes = nodes + rng.uniform(-0.03, 0.03, nodes.shape)
    edges = []
    for bay in range(bays + 1):
        start = booms * bay
        edges += [(start + i, start + (i + 1) % booms) for i in range(booms if booms > 2 else 1)]
        if bay < bays:
            edges += [(start + i, start + booms + i) for i in range(booms)]
            edges += [(start + i, start + booms + (i + 1) % booms) for i in range(booms if booms > 2 else 1)]
    solid = frame_of(nodes, edges, radius, 5 + k % 4)
    return Draft(turned(solid, rng), 2 * radius, (1, tunnels(nodes, edges), 0))


@family(8)
def crossing_rods(k: int, rng: np.random.Generator) -> Draft:
    """Rods of any direction through a small region, or layers of logs stacked crosswise."""
    count, radius = 6 + 5 * k, 0.08 * 0.75**k
    if k % 3 == 2:
        layers, each = 3 + k // 2, 3
        logs = []
        for layer in range(layers):
            for place in range(each):
                at = (0, place - 1, 0) if layer % 2 else (place - 1, 0, 0)
                size = (3, 0.3, 0.3) if layer % 2 else (0.3, 3, 0.3)
                logs.append(box(size).translate(at).translate((0, 0, (0.3 - 0.3 * radius) * layer)))
        contacts = (layers - 1) * each * each
        return Draft(turned(union(logs), rng), 0.3 * radius, (1, contacts - layers * each + 1, 0))
    rods = []
    for direction in random_directions(rng, count):
        at = rng.uniform(-0.25, 0.25, 3)
        rods.append(rod(at - direction, at + direction, radius, 4 + k))
    return Draft(union(rods), 2 * radius)


@family(8)
def lattices(k: int, rng: np.random.Generator) -> Draft:
    """Struts between the nodes of a cubic or body-centred lattice; square bars with exact binary coordinates."""
    side, radius = 2 + k % 3, 0.16 * 0.65**k
    nodes = np.array(list(np.ndindex(side, side, side)), dtype=float)
    lengths = np.linalg.norm(nodes[:, None] - nodes[None], axis=2)
    edges = [(a, b) for a, b in np.argwhere(np.isclose(lengths, 1)) if a < b]
    if k % 4 == 2:
        width = 2.0 ** -(2 + k)
        bars = []
        for axis in range(3):
            size = np.full(3, width)
            size[axis] = side - 1 + width
            for u, v in np.ndindex(side, side):
                middle = np.insert(np.array([u, v], dtype=float), axis, (side - 1) / 2)
                bars.append(box(size, middle))
        return Draft(union(bars), width, (1, tunnels(nodes, edges), 0))
    if k % 4 == 3:
        centres = np.array(list(np.ndindex(side - 1, side - 1, side - 1))) + 0.5
        far = np.linalg.norm(nodes[:, None] - centres[None], axis=2)
        edges = [(a, len(nodes) + b) for a, b in np.argwhere(far < 1)]
        nodes = np.concatenate([nodes, centres])
    solid = frame_of(nodes, edges, radius, 6, knob=1.5 * radius)
    return Draft(turned(solid, rng) if k % 2 else solid, 2 * radius, (1, tunnels(nodes, edges), 0))


def branches(
    rng: np.random.Generator, levels: int, radius: float
) -> list[tuple[np.ndarray, np.ndarray, float, float, bool]]:
    """The vessels of a binary tree: start, end, radius at both, and True for a leaf."""
    found = []

    def grow(start: np.ndarray, direction: np.ndarray, wide: float, length: float, level: int) -> None:
        end, thin = start + length * direction, wide * 0.78
        found.append((start, end, wide, thin, level == levels))
        if level == levels:
            return
        across = np.cross(direction, random_directions(rng, 1)[0])
        across /= np.linalg.norm(across)
        for sign in (1, -1):
            angle = sign * rng.uniform(0.45, 0.8)
            grow(
                end,
                np.cos(angle) * direction + np.sin(angle) * across,
                thin,
                length * rng.uniform(0.72, 0.85),
                level + 1,
            )

    grow(np.zeros(3), np.array([0.0, 0, 1]), radius, 1.0, 1)
    return found


def vessels(tree: list[tuple[np.ndarray, np.ndarray, float, float, bool]], wall: float, open_by: float) -> Manifold:
    """The union of vessels with radii reduced by `wall`, and leaves and root extended by `open_by`."""
    parts = []
    for number, (start, end, wide, thin, is_leaf) in enumerate(tree):
        along = (end - start) / np.linalg.norm(end - start)
        more = (wide - thin) / np.linalg.norm(end - start) * open_by  # continues the taper
        first, at_first = (start - along * open_by, wide + more) if number == 0 else (start, wide)
        last, at_last = (end + along * open_by, thin - more) if is_leaf else (end, thin)
        parts.append(rod(first, last, at_first - wall, 8, at_last - wall))
        if not is_leaf:
            parts.append(ball(1.1 * (thin - wall), end, 16))  # large enough to hide the ends of all three vessels
    return union(parts)


@family(8)
def vessel_trees(k: int, rng: np.random.Generator) -> Draft:
    """Forking vessels: solid, hollow with open ends, or as a hole that opens at a face of a block."""
    levels, radius = 3 + k // 3, 0.1 * 0.8**k
    tree = branches(rng, levels, radius)
    if k % 3 == 1:
        wall = 0.3 * 0.5**k * radius
        return Draft(vessels(tree, 0, 0) - vessels(tree, wall, 0.3 * radius), wall, (1, 2 ** (levels - 1), 0))
    if k % 3 == 2:
        void = vessels(tree, 0, 0)
        lower, upper = bounds_of(void)
        size = upper - lower + 0.2
        middle = (lower + upper) / 2
        return Draft(box((*size[:2], size[2] - 0.2001), (*middle[:2], middle[2] + 0.1)) - void, radius / 2, (1, 0, 0))
    return Draft(turned(vessels(tree, 0, 0), rng), radius / 2, (1, 0, 0))


def least_distance(one: np.ndarray, other: np.ndarray) -> float:
    """The distance of two closed polygons, approximated by points on their edges."""
    parts = np.arange(16)[:, None, None] / 16
    first, second = (((1 - parts) * a + parts * np.roll(a, -1, axis=0)).reshape(-1, 3) for a in (one, other))
    return float(cKDTree(first).query(second)[0].min())


@family(7)
def chains(k: int, rng: np.random.Generator) -> Draft:
    """Linked rings that nearly touch: chains, pairs of intertwined threads, Borromean rings."""
    gap = 0.1 * 0.2**k
    if k % 3 == 2:
        angles = 2 * np.pi * np.arange(48) / 48
        ellipse = np.column_stack([1.6 * np.cos(angles), 0.8 * np.sin(angles), 0 * angles])
        turn = np.roll(np.eye(3), 1, axis=0)
        one = tube(ellipse, (least_distance(ellipse, ellipse @ turn) - gap) / 2, 10, closed=True)
        rings = [(one[0] @ np.linalg.matrix_power(turn, i), one[1]) for i in range(3)]
        return Draft(joined(*rings), gap, (3, 3, 0))
    if k % 3 == 1:
        turns, angles = 3 + k, 2 * np.pi * np.arange(40 * (1 + k)) / (40 * (1 + k))
        curves = []
        for phase in (0, np.pi):
            wide = 1 + 0.2 * np.cos(turns * angles + phase)
            up = 0.2 * np.sin(turns * angles + phase)
            curves.append(np.column_stack([wide * np.cos(angles), wide * np.sin(angles), up]))
        radius = (least_distance(*curves) - gap) / 2
        return Draft(joined(*(tube(curve, radius, 8, closed=True) for curve in curves)), gap, (2, 2, 0))
    count, major, minor = 3 + k, 1.0, 0.2
    links = [placed(torus(major, minor, 24, 12), None).rotate((90.0 * (i % 2), 0.0, 0.0)) for i in range(count)]
    pitch = 2 * major - 2 * minor - gap
    turn = random_rotation(rng)
    parts = [arrays_of(link.translate((pitch * i, 0, 0))) for i, link in enumerate(links)]
    vertices, triangles = joined(*parts)
    return Draft((vertices @ turn, triangles), gap, (count, count, 0))


@family(7)
def knots(k: int, rng: np.random.Generator) -> Draft:
    """Torus knots and the figure eight, thick or hair-thin; one is a void in a block."""
    radius = (0.3, 0.1, 0.2, 0.01, 0.1, 1e-3, 0.15)[k]
    p, q = ((2, 3), (2, 3), (2, 5), (3, 4), (2, 3), (3, 5), (5, 2))[k]
    steps = 60 + 12 * p * q
    t = 2 * np.pi * np.arange(steps) / steps
    wide = 2 + np.cos(q * t)
    points = np.column_stack([wide * np.cos(p * t), wide * np.sin(p * t), np.sin(q * t)])
    if k in (1, 4):
        wide = 2 + np.cos(2 * t)
        points = np.column_stack([wide * np.cos(3 * t), wide * np.sin(3 * t), np.sin(4 * t)])
    vertices, triangles = tube(points @ random_rotation(rng), radius, 6 + k, closed=True)
    if k == 4:
        return Draft(box((8, 8, 8)) - manifold_of(vertices, triangles), 2 * radius, (1, 1, 1))
    return Draft((vertices, triangles), 2 * radius, (1, 1, 0))


@family(7)
def springs(k: int, rng: np.random.Generator) -> Draft:
    """Helices with turns that nearly touch."""
    turns, radius, gap = 3 + 2 * k, 0.2, 0.2 * 0.2**k
    steps = 24 * turns
    t = 2 * np.pi * turns * np.arange(steps + 1) / steps
    pitch = 2 * radius + gap
    wide = 0.6 + 0.4 * t / t[-1] if k % 3 == 2 else np.ones_like(t)  # conical or straight
    section = circle(radius, 8 + 4 * (k % 2))  # in planes through the axis, so that corners face those of the next turn
    reach = wide[:, None] + section[:, 0]
    heights = pitch * t[:, None] / (2 * np.pi) + section[:, 1]
    rings = np.stack([reach * np.cos(t)[:, None], reach * np.sin(t)[:, None], heights], axis=2)
    vertices, triangles = swept(rings[:, ::-1], False)
    return Draft((vertices @ random_rotation(rng), triangles), gap, (1, 0, 0))


@family(7)
def bands(k: int, rng: np.random.Generator) -> Draft:
    """Closed bands with any number of half twists, thick and thin."""
    half_twists, thickness = (1, 2, 3, 1, 5, 0, 7)[k], 0.1 * 0.25**k
    steps = 60 + 20 * k
    t = 2 * np.pi * np.arange(steps) / steps
    rings = []
    for angle in t:
        out, up = np.array([np.cos(angle), np.sin(angle), 0]), np.array([0.0, 0, 1])
        turn = half_twists * angle / 2 + 0.2
        wide = np.cos(turn) * up + np.sin(turn) * out
        thin = np.cos(turn) * out - np.sin(turn) * up
        corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
        rings.append([out + 0.4 * a * wide + thickness / 2 * b * thin for a, b in corners])
    vertices, triangles = swept(np.array(rings), True, 2 * (half_twists % 2), (1, 2))
    return Draft((vertices @ random_rotation(rng), triangles), thickness, (1, 1, 0))
