"""Proves that certificates refuse false axes that earlier versions accepted."""

import pathlib

import blum
import numpy as np

FOLDER = pathlib.Path(__file__).parent / "false_axes"


def test_a_loop_beside_a_tunnel_does_not_go_around_it():
    """A plate has a tunnel beside the bottom of a groove. The only loop of its axis is a strip at the groove."""
    axis = blum.read_medial(FOLDER / "groove.vtp")
    mesh = blum.read_mesh(FOLDER / "groove.obj")
    found = blum.certify(axis, mesh, theta=100, sites=False)
    assert found.topology_holds and found.bodies[0].tunnels_met == 0
    assert any(text.startswith("loops of the axis run around 0 of the 1 tunnel") for text in found.mismatches)


def spiral(sides, turns=0.8, reach=0.7, height=2.0, steps=8):
    """A prism, and an axis whose middle is a spiral. All of it is close to walls between neighbouring facets."""
    turn = 2 * np.pi * np.arange(sides) / sides
    ring, inner = np.c_[np.cos(turn), np.sin(turn)], np.cos(np.pi / sides)
    low, high = np.c_[ring, -height + 0 * turn], np.c_[ring, height + 0 * turn]
    vertices = np.concatenate([low, high, [[0, 0, -height], [0, 0, height]]])
    k = np.arange(sides)
    after = (k + 1) % sides
    last = np.full(sides, 2 * sides)
    sheets = [(k, after, sides + after), (k, sides + after, sides + k), (last, after, k)]
    sheets.append((last + 1, sides + k, sides + after))
    mesh = blum.Mesh(vertices, np.concatenate([np.stack(each, axis=1) for each in sheets]))

    def normal(facet):
        angle = (facet + 0.5) * 2 * np.pi / sides
        return np.array([np.cos(angle), np.sin(angle), 0])

    points, feet, triangles, angles = [], [], [], []
    levels = np.linspace(inner - height, height - inner, steps + 1)
    columns = int(sides * turns)
    for s in range(columns + 1):
        facets = (s - 1, s) if s else (0, sides // 2)
        for z in levels:
            point = np.append(reach * s / columns * ring[s % sides], z)
            points.append(point)
            feet.append([point + normal(f) * (inner - point @ normal(f)) for f in facets])
    for s in range(columns):
        for i in range(steps):
            a = s * (steps + 1) + i
            b = a + steps + 1
            triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
            angles += [360 / sides] * 2
    for border, apex in ((low, 0), (high, steps)):
        first = len(points)
        points += list(border)
        feet += [[corner, corner] for corner in border]
        triangles += [(apex, first + k, first + (k + 1) % sides) for k in range(sides)]
        angles += [90.0] * sides
    points, feet = np.array(points), np.array(feet)
    radius = np.linalg.norm(points - feet[:, 0], axis=1)
    toward = feet - points[:, None]
    across = np.linalg.norm(np.cross(toward[:, 0], toward[:, 1]), axis=1)
    separation = np.degrees(np.arctan2(across, np.sum(toward[:, 0] * toward[:, 1], axis=1)))
    axis = blum.MedialComplex(
        points,
        radius=radius,
        footprints=feet,
        separation_angle=separation,
        triangles=np.array(triangles),
        triangle_angle=np.array(angles),
    )
    return mesh, axis


def test_a_spiral_in_a_prism_is_not_midway():
    """The sheet crosses the walls between neighbouring facets, and does not lie along them."""
    for sides in (96, 192):
        mesh, axis = spiral(sides)
        found = blum.certify(axis, mesh, theta=1)
        assert found.topology_holds
        assert any("lie midway" in text for text in found.mismatches), found.mismatches
