"""Traces Voronoi diagrams of tessellated parts in single precision: facets of holes and teeth, and turned parts.

On the axis of a turned part, many sites nearly meet. Sites come close to long bent seams without reaching them.
"""

import itertools
import warnings

import numpy as np
import pytest
from scipy.spatial import Delaunay

blum = pytest.importorskip("blum")


def circle(sides, radius, x=0.0, y=0.0):
    angles = 2 * np.pi * np.arange(sides) / sides
    return np.stack([x + radius * np.cos(angles), y + radius * np.sin(angles)], 1)


def revolved(profile, sides):
    """A turned part. The profile of (radius, height) leads from one end of the axis to the other."""
    rings, vertices, triangles = [], [], []
    for radius, height in profile:
        first = len(vertices)
        ring = [(0.0, 0.0)] if radius == 0 else circle(sides, radius).tolist()
        vertices += [(*p, height) for p in ring]
        rings.append([first + k % len(ring) for k in range(sides + 1)])
    for low, high in itertools.pairwise(rings):
        for k in range(sides):
            quad = (low[k], low[k + 1], high[k + 1]), (low[k], high[k + 1], high[k])
            triangles += [t for t in quad if len(set(t)) == 3]
    return np.array(vertices), np.array(triangles)


def shaft(sides=25, radii=(10.0, 12.0, 15.0, 12.5, 11.0)):
    """Steps and grooves, turned: 1,600 triangles by default."""
    profile, height = [(0.0, 0.0), (9.0, 0.0), (10.0, 1.0)], 1.0
    for radius in radii:
        if profile[-1][0] != radius:
            profile.append((radius, height))
        profile += [(radius + r, height + z) for r, z in ((0, 6), (-1.5, 6), (-1.5, 8), (0, 8), (0, 15))]
        height += 15
    return revolved([*profile, (radii[-1] - 1, height + 1), (0.0, height + 1)], sides)


def fine_shaft():
    """Facets of 9 degrees: rounding parts junctions below reflex vertices, and makes walls of almost no width."""
    return shaft(40, (10.0, 12.0))


def finest_shaft():
    return shaft(50, (10.0, 12.0))


def extruded(loops, height):
    """A prism. All loops are dense enough that their sides are edges of the Delaunay triangulation."""
    points, n = np.concatenate(loops), sum(map(len, loops))
    numbers = np.concatenate([np.full(len(loop), k) for k, loop in enumerate(loops)])
    flat = Delaunay(points).simplices
    # Triangles with all corners on one hole lie in it.
    owner = numbers[flat]
    flat = flat[(owner[:, 0] == 0) | (owner != owner[:, :1]).any(1)]
    a, b, c = (points[flat[:, k]] for k in range(3))
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    flat[turn < 0] = flat[turn < 0][:, ::-1]
    triangles, start = [flat[:, ::-1], flat + n], 0
    for loop in loops:
        k = start + np.arange(len(loop))
        after = np.roll(k, -1)
        triangles += [np.stack([k, after, after + n], 1), np.stack([k, after + n, k + n], 1)]
        start += len(loop)
    vertices = np.concatenate([np.c_[points, np.zeros(n)], np.c_[points, np.full(n, height)]])
    return vertices, np.concatenate(triangles)


def wheel():
    """Round, with 12 bolt holes and a bore: 2,208 triangles."""
    holes = [circle(30, 6.0, 32 * np.cos(a), 32 * np.sin(a))[::-1] for a in 0.1 + np.pi / 6 * np.arange(12)]
    return extruded([circle(120, 50.0), *holes, circle(60, 15.0)[::-1]], 5.0)


@pytest.mark.parametrize(("part", "share"), [(shaft, 0.5), (fine_shaft, 0.5), (finest_shaft, 0.25), (wheel, 0.5)])
def test_parts_are_traced_and_open_places_are_named(part, share):
    """At least this share of the seams is proven. All other places are named."""
    vertices, triangles = part()
    mesh = blum.Mesh(vertices.astype(np.float32), triangles)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        report = blum.voronoi_complex(mesh, method="traced").report
    assert report.traced, report.trace_problem
    assert report.certified
    open_places = report.junctions - report.proven_junctions + report.seams - report.proven_seams
    assert len(report.open) == open_places
    assert report.proven == (open_places == 0)
    assert report.proven_seams > share * report.seams
