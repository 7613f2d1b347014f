"""The made solids in their order, with their Betti numbers."""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from . import grids, hollows, machines, needles, plates, rods
from .shapes import FAMILIES, arrays_of

Betti = tuple[int, int, int]
GROUPS = (grids, hollows, machines, needles, plates, rods)  # these modules register their families in FAMILIES


@dataclass(frozen=True)
class MadeSolid:
    name: str
    family: str
    vertices: np.ndarray  # float64 [n, 3].
    triangles: np.ndarray  # Facing outwards, int64 [m, 3].
    betti: Betti  # Components, tunnels and voids, counted from the shells.
    stated: Betti | None  # The same from the construction, if known.
    thinnest: float  # The requested thinnest wall, gap or hole; 0 if the solid tapers to a point or edge.


def shells_of(triangles: np.ndarray, vertex_count: int) -> tuple[int, np.ndarray]:
    """The number of connected surfaces, and the surface of each triangle."""
    starts, ends = triangles[:, [0, 1, 2]].ravel(), triangles[:, [1, 2, 0]].ravel()
    graph = coo_matrix((np.ones(len(starts), dtype=np.int8), (starts, ends)), shape=(vertex_count, vertex_count))
    labels = connected_components(graph, directed=False)[1][triangles[:, 0]]
    found, of = np.unique(labels, return_inverse=True)
    return len(found), of


def counted_betti(vertices: np.ndarray, triangles: np.ndarray) -> Betti:
    """The Betti numbers of the solid that embedded closed surfaces bound, which face outwards.

    Surfaces of positive volume are outer shells, surfaces of negative volume bound voids, and each handle of either is
    a tunnel (Alexander duality)."""
    directed = np.sort(triangles[:, [0, 1, 2]].ravel() * len(vertices) + triangles[:, [1, 2, 0]].ravel())
    if (directed[1:] == directed[:-1]).any():
        raise ValueError("an edge is run through twice in one direction")
    count, of = shells_of(triangles, len(vertices))
    bodies = tunnels = voids = 0
    for shell in range(count):
        own = triangles[of == shell]
        points = vertices[own] - vertices[own[0, 0]]
        volume = np.einsum("ij,ij->", points[:, 0], np.cross(points[:, 1], points[:, 2])) / 6
        euler = len(np.unique(own)) - len(own) // 2
        bodies, voids = bodies + (volume > 0), voids + (volume < 0)
        tunnels += (2 - euler) // 2
    return int(bodies), int(tunnels), int(voids)


def made_solid(family: str, variant: int) -> MadeSolid:
    """The solid of a family by number; reproducible for given versions of Manifold and NumPy."""
    entry = FAMILIES[family]
    rng = np.random.default_rng([zlib.crc32(family.encode()), variant])
    draft = entry.make(variant, rng)
    vertices, triangles = arrays_of(draft.body)
    betti = counted_betti(vertices, triangles)
    return MadeSolid(f"{family}-{variant}", family, vertices, triangles, betti, draft.betti, float(draft.thinnest))


def names() -> list[tuple[str, int]]:
    """Family and variant of all solids: first one of each family, of varying difficulty, then another one of each."""
    found = []
    for turn in range(max(entry.count for entry in FAMILIES.values())):
        for number, (name, entry) in enumerate(FAMILIES.items()):
            if turn < entry.count:
                found.append((name, (turn + 3 * number) % entry.count))
    return found


def made_solids(count: int | None = None) -> Iterator[MadeSolid]:
    """Makes the first `count` of the 300 solids one by one; the first 40 contain each family."""
    for family, variant in names()[:count]:
        yield made_solid(family, variant)
