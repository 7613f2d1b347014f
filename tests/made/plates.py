"""Families of thin plates and of narrow grooves between them."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from .shapes import Draft, block, box, circle, cut, extruded, family, placed, random_rotation, turned, union


@family(8)
def crossed_plates(k: int, rng: np.random.Generator) -> Draft:
    """Plates of any direction through one place."""
    thickness = 0.4 * 0.4**k
    plates = []
    for _ in range(2 + k):
        size = (*rng.uniform(1, 2, 2), thickness)
        plates.append(placed(box(size), random_rotation(rng), rng.uniform(-0.2, 0.2, 3)))
    return Draft(union(plates), thickness)


@family(7)
def egg_crates(k: int, rng: np.random.Generator) -> Draft:
    """Two sets of parallel plates with exact binary coordinates; some have a floor, some are turned."""
    rows, columns, thickness = 2 + k % 3, 2 + k // 2, 2.0 ** -(2 + k)
    plates = [block((0, y, 0), (columns + 1, y + thickness, 1)) for y in np.linspace(1, rows, rows)]
    plates += [block((x, 0, 0), (x + thickness, rows + 1, 1)) for x in np.linspace(1, columns, columns)]
    tunnels = (rows - 1) * (columns - 1)
    if k % 3 == 2:
        plates.append(block((0, 0, -thickness), (columns + 1, rows + 1, 0)))
        tunnels = 0
    crate = union(plates)
    return Draft(turned(crate, rng) if k % 2 else crate, thickness, (1, tunnels, 0))


@family(8)
def slits(k: int, rng: np.random.Generator) -> Draft:
    """Narrow cuts in a block: open on three sides, through the block, or closed on all sides."""
    count, width = 3 + k, (0.2, 0.05, 0.01, 1e-3, 1e-4, 1e-5, 1e-6, 0.02)[k]
    solid = box((4, 4, 2))
    lengths = rng.uniform(1, 3.5, count)
    places = np.linspace(-1.8, 1.8, count) + rng.uniform(-0.02, 0.02, count)
    kind = k % 3
    if kind == 0:
        parts = [box((width, 5, 1.5), (x, 0, 1)) for x in places]
        betti = (1, 0, 0)
    elif kind == 1:
        parts = [box((width, length, 3), (x, 0, 0)) for x, length in zip(places, lengths, strict=True)]
        betti = (1, count, 0)
    else:
        parts = [box((width, length, 1), (x, 0, 0)) for x, length in zip(places, lengths, strict=True)]
        betti = (1, 0, count)
    result = cut(solid, parts)
    return Draft(turned(result, rng) if k > 3 else result, width, betti)


@family(7)
def heat_sinks(k: int, rng: np.random.Generator) -> Draft:
    """A base with thin fins, pins or tapering pins."""
    count, thickness = 4 + k, 0.2 * 0.35**k
    base = block((0, 0, -0.4), (4, 4, 0))
    steps = 0.3 + 3.4 * np.arange(count) / (count - 1)
    if k % 3 == 0:
        fins = [block((x - thickness / 2, 0.1, -0.1), (x + thickness / 2, 3.9, rng.uniform(1, 2))) for x in steps]
    elif k % 3 == 1:
        fins = [
            Manifold.cylinder(2, thickness, -1, 6 + k % 3).translate((x, y, -0.2)) for x in steps for y in steps[::2]
        ]
    else:
        fins = [
            Manifold.cylinder(1.5, 0.1, thickness / 4, 5).translate((x, y, -0.1)) for x in steps for y in steps[::2]
        ]
    sink = union([base, *fins])
    return Draft(turned(sink, rng) if k % 2 else sink, thickness / (2 if k % 3 == 2 else 1), (1, 0, 0))


@family(7)
def slots(k: int, rng: np.random.Generator) -> Draft:
    """Grooves with a mouth narrower than the bottom: T slots, dovetails, keyholes. The last wall is as thin."""
    mouth = 0.3 * 0.3**k
    count = 2 + k % 3
    parts = []
    for x in 2.0 * np.arange(count):
        if k % 3 == 0:
            parts += [
                block((x - mouth / 2, -1, 0.4), (x + mouth / 2, 5, 2)),
                block((x - 0.5, -1, 0), (x + 0.5, 5, 0.5)),
            ]
        elif k % 3 == 1:
            tail = np.array(
                [
                    (x - 0.7, 0),
                    (x + 0.7, 0),
                    (x + mouth / 2, 1),
                    (x + mouth / 2, 2),
                    (x - mouth / 2, 2),
                    (x - mouth / 2, 1),
                ]
            )
            parts.append(placed(extruded([tail], 6), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), (0, 5, 0)))
        else:
            parts += [block((x - mouth / 2, -1, 0.4), (x + mouth / 2, 5, 2))]
            parts.append(
                placed(
                    extruded([circle(0.4, 12, (x, 0.3))], 6), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]), (0, 5, 0)
                )
            )
    # The top lies exactly on z = 1. The last wall is as thin as the mouth.
    solid = cut(block((-1.5, 0, -0.5), (2.0 * count - 2 + (0.5, 0.7, 0.4)[k % 3] + mouth, 4, 1)), parts)
    return Draft(turned(solid, rng) if k % 2 else solid, mouth, (1, 0, 0))


@family(8)
def wedges(k: int, rng: np.random.Generator) -> Draft:
    """Deep grooves with a sharp bottom, side by side or crossing, or a knife edge."""
    degrees = (10, 5, 2, 1, 0.5, 0.2, 0.1, 3)[k]
    half = np.tan(np.radians(degrees) / 2)
    depth = 1.5
    prism = np.array([(0, -depth), (half * 2 * depth, depth), (-half * 2 * depth, depth)])
    upright = np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    if k % 4 == 3:
        knife = placed(extruded([np.array([(0, 1.5), (-half * 3, -1.5), (half * 3, -1.5)])], 3), upright)
        bar = box((2, 3, 0.5), (0, -1.5, -1.4))
        return Draft(turned(union([knife, bar]), rng), 0, (1, 0, 0))
    grooves = []
    for x in np.linspace(-1.5, 1.5, 2 + k % 3):
        one = placed(extruded([prism], 6), upright, (0, 3, 0))
        grooves.append(one.rotate((0.0, float(rng.uniform(-8, 8)), 0.0)).translate((x, 0, 1)))
    if k % 2:
        grooves += [groove.rotate((0.0, 0.0, 90.0)).translate((0, 0, 0.3)) for groove in grooves[:2]]
    return Draft(cut(box((4, 4, 2)), grooves), 0)


@family(7)
def honeycombs(k: int, rng: np.random.Generator) -> Draft:
    """Hexagonal cells through a plate, with thin webs; some closed by a floor."""
    rows, columns, web = 2 + k % 3, 2 + k // 2, 0.3 * 0.3**k
    pitch = 1.0
    holes, height = [], pitch * np.sqrt(3) / 2
    for row in range(rows):
        for column in range(columns):
            at = (pitch * (column + 0.5 * (row % 2)), height * row)
            holes.append(extruded([circle((pitch - web) / np.sqrt(3), 6, at, np.pi / 6)], 2).translate((0, 0, -1)))
    floor = k % 3 == 2
    plate = block((-0.7, -0.8, -web if floor else 0), (pitch * columns + 0.2, height * rows, 0.75))
    if floor:
        holes = [hole.translate((0, 0, 1)) for hole in holes]
    solid = cut(plate, holes)
    betti = (1, 0 if floor else rows * columns, 0)
    return Draft(turned(solid, rng) if k % 2 else solid, web, betti)


@family(7)
def membranes(k: int, rng: np.random.Generator) -> Draft:
    """Tubes closed by a thin wall, also a slanted one, beside an open tunnel."""
    thickness = 0.3 * 0.15**k
    count = 1 + k % 4
    solid = box((2 * count + 2, 2, 3))
    holes, open_at = [], count
    for hole in range(count + 1):
        x = 2 * hole - count
        drill = Manifold.cylinder(4, 0.6, -1, 10 + k, True).translate((x, 0, 0))
        if hole != open_at:
            slant = placed(box((5, 5, thickness)), random_rotation(rng) if k % 3 == 2 else None, (x, 0, 0))
            if k % 3 == 1:
                slant = box((5, 5, thickness)).rotate((0.0, 30.0, 0.0)).translate((x, 0, 0))
            drill = drill - slant
        holes.append(drill)
    made = cut(solid, holes)
    return Draft(turned(made, rng) if k % 2 else made, thickness, (1, 1, 0) if k % 3 != 2 else None)
