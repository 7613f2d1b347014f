"""Solids with known middles and known insides, for the families of reported faults."""

import itertools

import numpy as np
import pytest

manifold3d = pytest.importorskip("manifold3d")


def rotation(seed):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q *= np.sign(np.diag(r))
    return q * np.linalg.det(q)


def section(sides, radius):
    """A cross-section [n, 2] with its inner radius: a number of sides, "ellipse" or "bar"."""
    if sides == "ellipse":
        turn = 2 * np.pi * np.arange(40) / 40
        return radius * np.c_[1.3 * np.cos(turn), np.sin(turn)], radius
    if sides == "bar":
        return radius * np.array([[-1.3, -1], [1.3, -1], [1.3, 1], [-1.3, 1]]), radius
    turn = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    return radius * np.c_[np.cos(turn), np.sin(turn)], radius * np.cos(np.pi / sides)


def frames(points, closed):
    """Unit vectors across a polyline that turn as little as possible, and meet again if it is closed."""
    along = np.roll(points, -1, 0) - np.roll(points, 1, 0) if closed else np.gradient(points, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    last = np.cross(along[0], [0.3, 0.5, 0.8])
    if np.abs(along[0]).max() > 0.999:
        last = np.roll(np.abs(along[0]).round(), 1)
    first = []
    for direction in along:
        last = last - (last @ direction) * direction
        last = last / np.linalg.norm(last)
        first.append(last)
    u = np.array(first)
    v = np.cross(along, u)
    if not closed:
        return u, v
    end = u[-1] - (u[-1] @ along[0]) * along[0]
    turn = -np.arctan2(end @ v[0], end @ u[0]) * np.arange(len(u)) / len(u)
    cosine, sine = np.cos(turn)[:, None], np.sin(turn)[:, None]
    return u * cosine + v * sine, v * cosine - u * sine


def swept(points, polygon, closed=False):
    """The tube with the given cross-section along a polyline: vertices and triangles."""
    points = np.asarray(points, dtype=float)
    u, v = frames(points, closed)
    sides, rings = len(polygon), len(points)
    vertices = points[:, None] + polygon[None, :, :1] * u[:, None] + polygon[None, :, 1:] * v[:, None]
    k, j = np.meshgrid(np.arange(rings if closed else rings - 1), np.arange(sides), indexing="ij")
    a, b = k * sides + j, k * sides + (j + 1) % sides
    c, d = (k + 1) % rings * sides + j, (k + 1) % rings * sides + (j + 1) % sides
    triangles = [np.stack([a, b, d], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]
    if not closed:
        j = np.arange(1, sides - 1)
        top = (rings - 1) * sides
        triangles += [np.c_[0 * j, j + 1, j], np.c_[0 * j + top, top + j, top + j + 1]]
    return vertices.reshape(-1, 3), np.concatenate(triangles).astype(np.int32)


def rod(start, end, sides, radius, stacks=1):
    polygon, inner = section(sides, radius)
    return swept(np.linspace(start, end, stacks + 1), polygon), inner


def solid(mesh):
    return manifold3d.Manifold(
        manifold3d.Mesh64(vert_properties=mesh[0].astype(np.float64), tri_verts=mesh[1].astype(np.uint64))
    )


def joined(*meshes):
    """The union of solids."""
    whole = solid(meshes[0])
    for mesh in meshes[1:]:
        whole += solid(mesh)
    found = whole.to_mesh64()
    return np.asarray(found.vert_properties)[:, :3].copy(), np.asarray(found.tri_verts).astype(np.int32)


def together(*meshes):
    """One mesh with the triangles of all meshes, not joined."""
    firsts = np.cumsum([0] + [len(mesh[0]) for mesh in meshes[:-1]])
    triangles = [mesh[1] + first for mesh, first in zip(meshes, firsts, strict=True)]
    return np.concatenate([mesh[0] for mesh in meshes]), np.concatenate(triangles).astype(np.int32)


def dense(path, step):
    """Points on a polyline, at most a step apart."""
    points = [path[:1]]
    for a, b in itertools.pairwise(path):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / step)))
        points.append(a + (b - a) * np.arange(1, count + 1)[:, None] / count)
    return np.concatenate(points)
