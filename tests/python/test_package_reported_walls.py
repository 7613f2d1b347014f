"""Proves that extended axes of thin-walled profiles stay in the middle of walls, whole, and share edges at a T."""

import warnings

import numpy as np
import pytest

blum = pytest.importorskip("blum")


def rectangle(low, high):
    return [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]]


# Each profile: outline, holes, middles of the walls (two ends, thickness), and the number of T junctions.


def angle(w, h, t, s):
    outline = [[0, 0], [w, 0], [w, t], [s, t], [s, h], [0, h]]
    return outline, [], [((s / 2, t / 2), (w, t / 2), t), ((s / 2, t / 2), (s / 2, h), s)], 0


def channel(w, h, t, s):
    outline = [[0, 0], [w, 0], [w, h], [w - s, h], [w - s, t], [s, t], [s, h], [0, h]]
    sides = [((x, t / 2), (x, h), s) for x in (s / 2, w - s / 2)]
    return outline, [], [((s / 2, t / 2), (w - s / 2, t / 2), t), *sides], 0


def zed(w, h, t):
    outline = [[0, 0], [w, 0], [w, h - t], [2 * w - t, h - t], [2 * w - t, h], [w - t, h], [w - t, t], [0, t]]
    a, b = (w - t / 2, t / 2), (w - t / 2, h - t / 2)
    return outline, [], [((0, t / 2), a, t), (a, b, t), (b, (2 * w - t, h - t / 2), t)], 0


def tube(w, h, t):
    low, high = (t / 2, t / 2), (w - t / 2, h - t / 2)
    corners = [tuple(corner) for corner in rectangle(low, high)]
    middles = [(corners[k], corners[(k + 1) % 4], t) for k in range(4)]
    return rectangle((0, 0), (w, h)), [rectangle((t, t), (w - t, h - t))], middles, 0


def stiffened(w, t, count, h, s):
    outline, middles = [[0, 0], [w, 0], [w, t]], [((0, t / 2), (w, t / 2), t)]
    for k in reversed(range(count)):
        x = w * (k + 1) / (count + 1)
        outline += [[x + s / 2, t], [x + s / 2, t + h], [x - s / 2, t + h], [x - s / 2, t]]
        middles.append(((x, t / 2), (x, t + h), s))
    return [*outline, [0, t]], [], middles, count


def two_cells(w, h, t, s):
    outline, _, middles, _ = tube(w, h, t)
    holes = [rectangle((t, t), ((w - s) / 2, h - t)), rectangle(((w + s) / 2, t), (w - t, h - t))]
    return outline, holes, [*middles, ((w / 2, t / 2), (w / 2, h - t / 2), s)], 2


REPORTED = (
    [[0, 0], [60, 0], [60, 3], [30, 3], [30, 40], [48, 40], [48, 41.5], [28, 41.5], [28, 3], [0, 3]],
    [],
    [((0, 1.5), (60, 1.5), 3), ((29, 1.5), (29, 40.75), 2), ((29, 40.75), (48, 40.75), 1.5)],
    1,
)

# Profile, length, resolution, theta.
FAMILY = {
    "L": (angle(40, 30, 2, 2), 50, 128, 110),
    "T": (stiffened(60, 2, 1, 38, 2), 50, 160, 110),
    "U": (channel(40, 30, 2, 1.5), 60, 144, 110),
    "tall U": (channel(30, 50, 1, 2), 33, 256, 100.5),
    "Z": (zed(30, 40, 2), 50, 160, 110),
    "thin Z": (zed(25, 30, 1.2), 35, 240, 105),
    "tube": (tube(40, 30, 2), 50, 128, 110),
    "flat tube": (tube(50, 20, 1.5), 60, 192, 120),
    "three stiffeners": (stiffened(90, 2, 3, 20, 1.5), 50, 192, 110),
    "two stiffeners": (stiffened(100, 3, 2, 25, 2), 40, 160, 105),
    "four stiffeners": (stiffened(80, 1.5, 4, 12, 1.5), 30, 224, 115),
    "two cells": (two_cells(50, 25, 2, 1.5), 40, 176, 110),
    "two thin cells": (two_cells(60, 30, 1.5, 2), 30, 250, 118),
    "reported profile at 96": (REPORTED, 50, 96, 120),
    "reported profile at 112": (REPORTED, 50, 112, 120),
    "reported profile at 192": (REPORTED, 50, 192, 120),
    "reported profile at 250": (REPORTED, 50, 250, 120),
}


def to_segment(points, a, b):
    along = np.subtract(b, a)
    share = np.clip((points - a) @ along / (along @ along), 0, 1)
    return np.linalg.norm(points - a - share[:, None] * along, axis=1)


def near_junctions(points, middles):
    """True at points near the end of a wall that lies on the middle of another wall."""
    reach = 1.5 * max(thickness for *_, thickness in middles)
    near = np.zeros(len(points), dtype=bool)
    for k, (a, b, _) in enumerate(middles):
        for end in (a, b):
            others = [m for j, m in enumerate(middles) if j != k]
            if any(to_segment(np.array([end]), c, d)[0] < 1e-9 for c, d, _ in others):
                near |= np.linalg.norm(points - end, axis=1) < reach
    return near


def edges_with_counts(triangles):
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)


@pytest.mark.parametrize("name", FAMILY)
def test_extended_profiles_are_middle_surfaces(name):
    (outline, holes, middles, tees), length, resolution, theta = FAMILY[name]
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        part = blum.extrusion(outline, holes, thickness=length)
        found = blum.medial_axis(part, resolution=resolution).certified(theta).extend()
    points = found.vertices[:, :2]
    away = np.array([to_segment(points, a, b) for a, b, _ in middles])
    thickness = np.array([t for *_, t in middles])
    near = near_junctions(points, middles)
    assert np.all(away.min(axis=0)[near] <= 0.35 * thickness.max())
    assert np.all((away.min(axis=0) <= 0.1 * thickness[away.argmin(axis=0)])[~near])
    edges, counts = edges_with_counts(found.triangles)
    characteristic = len(np.unique(found.triangles)) - len(edges) + len(found.triangles)
    assert characteristic == 1 - len(holes)  # that of the axis
    area = sum(np.linalg.norm(np.subtract(a, b)) for a, b, _ in middles) * length
    assert abs(found.report.area / area - 1) < 0.04
    if tees:
        ends = found.vertices[edges[counts >= 3]]
        shared = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum()
        unshared = found.report.unshared_length
        assert shared + unshared > 0.85 * tees * length
        assert unshared == 0 or any("without shared vertices" in str(w.message) for w in given)
