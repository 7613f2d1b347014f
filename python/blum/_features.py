"""Close features of a mesh.

A pair of features is a vertex and a face, or two edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._arguments import FloatArray, IntArray, Real, integer, number
from ._mesh import Mesh, MeshLike, as_mesh
from ._progress import Progress
from ._proximity_results import ProximityPairs
from ._proximity_scene import ProximityScene

__all__ = ["FeaturePairs", "close_features"]

_VERTICES, _FACES, _EDGES = 1, 2, 4  # Layers of the scene.


@dataclass(frozen=True, eq=False)
class FeaturePairs:
    """Pairs of close features of a mesh, as arrays; the result of :func:`close_features`.

    Examples
    --------
    >>> import blum
    >>> blum.close_features(blum.generate("box"), 0.5)
    FeaturePairs(0 vertex_face, 0 edge_edge)
    """

    vertex_face: IntArray  #: A vertex, and a triangle of which it is not a corner: (n, 2), ascending.
    vertex_face_distance: FloatArray  #: Distances of these pairs: (n,), mesh units.
    edge_edge: IntArray  #: Two rows of `edges` that share no vertex, the smaller first: (m, 2), ascending.
    edge_edge_distance: FloatArray  #: Distances of these pairs: (m,), mesh units.
    edges: IntArray  #: All sides of triangles, and segments, each once: (k, 2), ascending, the smaller vertex first.

    @property
    def min_distance(self) -> float | None:
        """Smallest distance of all pairs, mesh units. None without pairs."""
        every = np.concatenate([self.vertex_face_distance, self.edge_edge_distance])
        return float(every.min()) if len(every) else None

    def __repr__(self) -> str:
        return f"FeaturePairs({len(self.vertex_face):,} vertex_face, {len(self.edge_edge):,} edge_edge)"


def close_features(mesh: MeshLike, distance: Real, *, threads: int = 0, progress: Progress = False) -> FeaturePairs:
    """Returns all close pairs of a vertex and a triangle, and of two edges, that share no vertex. The answer is exact.

    Contact potentials of simulations need these pairs. Vertices with the same position count as one vertex. Edges are
    the sides of triangles and the segments of the mesh. Vertices are those of its triangles, segments and points.

    Parameters
    ----------
    mesh : mesh
        As for :func:`distance_field`.
    distance : float
        Largest distance of a pair, mesh units, not negative.
    threads, progress
        As for :func:`distance_field`.

    Returns
    -------
    FeaturePairs

    Examples
    --------
    >>> import blum
    >>> floor, above = [[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 1], [2, 1, 2], [1, 2, 2]]
    >>> found = blum.close_features((floor + above, [[0, 1, 2], [3, 4, 5]]), 1.5)
    >>> found, found.vertex_face.tolist(), found.min_distance
    (FeaturePairs(1 vertex_face, 4 edge_edge), [[3, 0]], 1.0)
    >>> found.edges[found.edge_edge[0]].tolist()
    [[0, 1], [3, 4]]
    """
    own = as_mesh(mesh)
    most, count = number(distance, "distance"), integer(threads, "threads")
    vertices, edges = _named_vertices(own), _edges(own)
    scene = ProximityScene()
    scene.add(Mesh(own.vertices, points=vertices), layers=_VERTICES, meets=_FACES, threads=count)
    if len(own.triangles):
        scene.add(Mesh(own.vertices, own.triangles), layers=_FACES, meets=_VERTICES, threads=count)
    if len(edges):
        scene.add(Mesh(own.vertices, segments=edges), layers=_EDGES, meets=0, compare_self=True, threads=count)
    found = scene.closer_than(most, threads=count, progress=progress)
    is_edge = found.object[:, 0] == found.object[:, 1]
    vertex_face = _vertex_face(own, found, ~is_edge, vertices)
    return FeaturePairs(*vertex_face, found.primitive[is_edge], found.distance[is_edge], edges)


def _named_vertices(mesh: Mesh) -> IntArray:
    """Returns the vertices that triangles, segments or points use."""
    named = np.concatenate([mesh.triangles.ravel(), mesh.segments.ravel(), mesh.points])
    return np.unique(named).astype(np.int32)


def _edges(mesh: Mesh) -> IntArray:
    """Returns each edge once, without those whose ends are one vertex."""
    ends = np.concatenate(
        [mesh.triangles[:, [0, 1]], mesh.triangles[:, [1, 2]], mesh.triangles[:, [2, 0]], mesh.segments]
    )
    ends = np.sort(ends.astype(np.int64), axis=1)
    ends = ends[ends[:, 0] < ends[:, 1]]
    count = len(mesh.vertices)
    keys = np.unique(ends[:, 0] * count + ends[:, 1])  # Faster than np.unique with axis=0.
    return np.column_stack([keys // count, keys % count]).astype(np.int32)


def _vertex_face(
    mesh: Mesh, found: ProximityPairs, chosen: np.ndarray[tuple[int], np.dtype[np.bool_]], vertices: IntArray
) -> tuple[IntArray, FloatArray]:
    """Returns the pairs of a vertex and a face whose corners lie elsewhere."""
    pairs = found.primitive[chosen]
    distance = found.distance[chosen]
    pairs = np.column_stack([vertices[pairs[:, 0]], pairs[:, 1]]).astype(np.int32)
    touching = np.flatnonzero(distance == 0)
    places = mesh.vertices[mesh.triangles[pairs[touching, 1]]]
    is_corner = (places == mesh.vertices[pairs[touching, 0]][:, None]).all(axis=2).any(axis=1)
    kept = np.ones(len(pairs), dtype=bool)
    kept[touching[is_corner]] = False
    return pairs[kept], distance[kept]
