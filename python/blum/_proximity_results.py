"""What scenes answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import overload

import numpy as np

from ._arguments import FloatArray, IntArray, Integer, integer


def earliest_of(*times: FloatArray) -> float | None:
    """The first of some times; None where there is none."""
    every = np.concatenate(times)
    return float(every.min()) if len(every) else None


@dataclass(frozen=True, eq=False)
class PrimitivePair:
    """Two primitives and their closest points. Primitives of a mesh are its triangles, then its segments, then its
    points."""

    object: tuple[int, int]  #: of the scene
    primitive: tuple[int, int]  #: of each object
    distance: float  #: mesh units; 0 just where they meet
    point: FloatArray  #: (2, 3): of each primitive; where they meet, a point near both
    feature: IntArray  #: (2, 3): the one, two or three vertices that each point lies on, padded with -1


@dataclass(frozen=True, eq=False)
class ProximityPairs:
    """Pairs of primitives and their closest points, as arrays; `pairs[k]` is one, `pairs[1:5]` are some, and false is
    what has none."""

    object: IntArray  #: (n, 2): the objects
    primitive: IntArray  #: (n, 2): the primitive of each: a triangle, or behind these a segment, then a point
    distance: FloatArray  #: (n,): mesh units; 0 just where they meet; negative in signed separations
    point: FloatArray  #: (n, 2, 3): the closest points; where they meet, a point near both
    feature: IntArray  #: (n, 2, 3): the one, two or three vertices of each mesh that the point lies on, padded with -1
    culling: str  #: what left out pairs that cannot count: "bvh" or "voronoi"
    cells: int  #: of Voronoi culling
    left_over: int  #: primitives that Voronoi culling left to the hierarchy
    object_pairs: int  #: pairs of objects that were compared
    candidates: int  #: pairs of primitives that culling left over
    exact_tests: int  #: pairs whose distance was computed

    def __len__(self) -> int:
        return len(self.distance)

    @overload
    def __getitem__(self, index: Integer) -> PrimitivePair: ...
    @overload
    def __getitem__(self, index: slice) -> ProximityPairs: ...
    def __getitem__(self, index: Integer | slice) -> PrimitivePair | ProximityPairs:
        if isinstance(index, slice):
            columns = ("object", "primitive", "distance", "point", "feature")
            return replace(self, **{name: getattr(self, name)[index] for name in columns})
        number = integer(index, "the number of a pair")
        if not -len(self) <= number < len(self):
            raise IndexError(f"there is no pair {number}: these are {self!r}, which count from 0")
        k = number % len(self)
        (first_object, second_object), (first, second) = self.object[k].tolist(), self.primitive[k].tolist()
        return PrimitivePair(
            (first_object, second_object), (first, second), float(self.distance[k]), self.point[k], self.feature[k]
        )

    def __iter__(self) -> Iterator[PrimitivePair]:
        return (self[k] for k in range(len(self)))

    @property
    def closest(self) -> PrimitivePair | None:
        """The pair with the smallest distance, the first of those equally close; None where there is none."""
        return self[int(np.argmin(self.distance))] if len(self) else None

    def __repr__(self) -> str:
        return f"ProximityPairs({len(self):,} {'pair' if len(self) == 1 else 'pairs'})"


@dataclass(frozen=True, eq=False)
class Penetration:
    """A connected part of what two solids have in common."""

    object: tuple[int, int]  #: the two solids; twice the same of one that is compared with itself
    depth: float  #: mesh units: the distance of deep_point from surface_point
    depth_bound: float  #: what the depth is at most, for certain but for rounding
    direction: FloatArray  #: (3,): where the first object is to be moved by the depth, to bring deep_point out
    deep_point: FloatArray  #: (3,): the deepest point of the surface of one object in the other one
    surface_point: FloatArray  #: (3,): the closest one to it of the surface of that
    is_first_deep: bool  #: whether deep_point is one of the first object
    deep_triangle: int  #: that deep_point lies on, in its object
    surface_triangle: int  #: that surface_point lies on, in the other one
    area: tuple[float, float]  #: of the parts of both surfaces that bound it; of one object, all in the first
    volume: float  #: cubic mesh units
    curves: list[FloatArray]  #: (n, 3) each: where the surfaces cross, closed

    def __repr__(self) -> str:
        return f"Penetration(depth {self.depth:.6g}, volume {self.volume:.6g})"


@dataclass(frozen=True, eq=False)
class SceneCollisions:
    """What of the objects of a scene meets while they move."""

    vertex_face: IntArray  #: (n, 4): the object of a vertex, the vertex, the object of the face, the face
    vertex_face_time: FloatArray  #: (n,): when they meet first, 0 to 1
    edge_edge: IntArray  #: (m, 6): an object and the ends of an edge of it, then another one, or the same one
    edge_edge_time: FloatArray  #: (m,)
    box_pairs: int  #: pairs of features whose moving boxes touch
    exact_tests: int  #: pairs that were tested

    @property
    def earliest(self) -> float | None:
        """The first time at which anything meets; None where nothing does."""
        return earliest_of(self.vertex_face_time, self.edge_edge_time)

    def __repr__(self) -> str:
        return f"SceneCollisions({len(self.vertex_face):,} vertex_face, {len(self.edge_edge):,} edge_edge)"
