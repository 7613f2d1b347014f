"""Proves that resolved self-crossing meshes equal Manifold's unions of their parts, and agree with winding numbers."""

import manifold3d
import numpy as np
import pytest

import blum


def turned(seed):
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


def part(name, seed=None, shift=(0, 0, 0), factor=1.0, **parameters):
    mesh = blum.generate(name, **parameters)
    vertices = mesh.vertices * factor
    if seed is not None:
        vertices = vertices @ turned(seed).T
    return vertices + np.asarray(shift), np.asarray(mesh.triangles)


def together(parts):
    vertices, triangles, count = [], [], 0
    for own, corners in parts:
        vertices.append(own)
        triangles.append(corners + count)
        count += len(own)
    return np.vstack(vertices), np.vstack(triangles).astype(np.uint32)


def union_of(parts):
    """Betti numbers and volume of the union of parts, by Manifold."""
    out = manifold3d.Manifold()
    for vertices, triangles in parts:
        mesh = manifold3d.Mesh64(np.ascontiguousarray(vertices), np.ascontiguousarray(triangles, np.uint64))
        out += manifold3d.Manifold(mesh)
    shells = out.decompose()
    outer = sum(shell.volume() > 0 for shell in shells)
    return (outer, sum(shell.genus() for shell in shells), len(shells) - outer), out.volume()


def windings(vertices, triangles, points):
    a, b, c = (vertices[triangles[:, k]][None] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(x, axis=2) for x in (a, b, c))
    dot = lambda x, y: np.einsum("ijk,ijk->ij", x, y)  # noqa: E731
    above = dot(a, np.cross(b, c))
    below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb
    return np.round(np.arctan2(above, below).sum(axis=1) / (2 * np.pi))


def random_places(count, spread, first=0):
    return [(k, np.random.default_rng(k).normal(size=3) * spread) for k in range(first, first + count)]


GRID = [np.random.default_rng(k).integers(-4, 4, size=3) * 0.5 for k in range(12)]
CASES = {
    "boxes": [part("box"), part("box", shift=(0.3, 0.4, 0.5))],
    "boxes, turned": [part("box"), part("box", seed=1, shift=(0.3, 0.4, 0.5))],
    "spheres": [part("sphere", frequency=4), part("sphere", frequency=4, shift=(0.7, 0.1, 0.05))],
    "rings": [part("torus", seed=seed, shift=at, ring_segments=24, tube_segments=12) for seed, at in random_places(5, 0.5)],
    "many boxes": [part("box", seed=seed, shift=at) for seed, at in random_places(12, 0.8)],
    "boxes on a grid": [part("box", shift=at) for at in GRID],
    "gear and bracket": [part("gear"), part("bracket", seed=4, shift=(0.1, 0.2, 0.05))],
}


def volume_of(mesh):
    a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


@pytest.mark.parametrize("name", CASES)
def test_unions_of_parts_are_those_of_manifold(name):
    vertices, triangles = together(CASES[name])
    solid = blum.Solid(vertices, triangles)
    assert solid.rule == "polyhedron" and solid.resolved is not None, solid.reason
    betti, volume = union_of(CASES[name])
    assert solid.betti == betti
    assert sum(volume_of(body.mesh) for body in solid.bodies) == pytest.approx(volume, rel=1e-9)
    rng = np.random.default_rng(0)
    lower, upper = vertices.min(axis=0), vertices.max(axis=0)
    points = np.vstack([rng.uniform(lower, upper, size=(200, 3)),
                        vertices[triangles[rng.integers(len(triangles), size=200)]].mean(axis=1)
                        + rng.normal(size=(200, 3)) * 1e-4])
    assert np.array_equal(solid.inside(points), windings(vertices, triangles, points) >= 1)
    for resolution in (6, 24):
        model = solid.model(resolution=resolution)
        assert model.passes and model.betti() == betti


def test_resolved_meshes_count_crossings_and_map_to_the_input():
    vertices, triangles = together(CASES["boxes, turned"])
    solid = blum.Solid(vertices, triangles)
    assert solid.resolved.crossing == len(blum.self_intersections(vertices, triangles).pairs)
    (body,) = solid.bodies
    is_new = body.vertex_of == 0xFFFFFFFF
    assert is_new.sum() == solid.resolved.new_vertices > 0
    assert np.array_equal(body.mesh.vertices[~is_new], vertices[body.vertex_of[~is_new]])
    assert body.triangle_of.max() < len(triangles)
    assert blum.Solid(*part("box")).resolved is None
