"""Results of proximity queries."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, overload

import numpy as np

from . import _core
from ._arguments import FloatArray, IntArray, Integer, integer
from ._methods import Shown
from ._warn import warn_all

__all__ = ["FirstContact", "Penetration", "PrimitivePair", "ProximityPairs", "SceneCollisions"]


def earliest_of(*times: FloatArray) -> float | None:
    """Returns the smallest of some times. None without times."""
    every = np.concatenate(times)
    return float(every.min()) if len(every) else None


def warn_of_start(*times: FloatArray) -> None:
    """Warns if pairs meet at the start of a motion."""
    warn_all(_core.start_warnings(sum(int(np.count_nonzero(one == 0)) for one in times)))


@dataclass(frozen=True, eq=False, repr=False)
class PrimitivePair(Shown):
    """Two primitives and their closest points.

    Primitives of a mesh are its triangles, then its segments, then its points.

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.separation(box, (box.vertices + [3, 0, 0], box.triangles))
    >>> found.object, found.distance
    ((0, 1), 2.0)
    """

    object: tuple[int, int]  #: Objects of the scene.
    primitive: tuple[int, int]  #: Primitive of each object.
    distance: float  #: Mesh units. 0 if and only if they meet.
    closest: FloatArray  #: Closest point of each primitive: (2, 3). If they meet, a point near both.
    #: The one, two or three vertices of the feature that contains each point: (2, 3), padded with -1.
    feature: IntArray


@dataclass(frozen=True, eq=False)
class ProximityPairs:
    """Pairs of primitives and their closest points, as arrays.

    `pairs[k]` is one pair, and `pairs[1:5]` contains several. An object without pairs is false.

    Examples
    --------
    >>> import blum
    >>> pairs = blum.closest_primitives(blum.generate("box"))
    >>> len(pairs), pairs[0].primitive, len(pairs[1:5])
    (12, (0, 11), 4)
    """

    object: IntArray  #: Objects: (n, 2).
    primitive: IntArray  #: Primitives: (n, 2). Triangles are numbered first, then segments, then points.
    distance: FloatArray  #: Distances: (n,), mesh units. 0 if and only if they meet; negative in signed separations.
    #: Closest points: (n, 2, 3). If they meet, a point near both. Files call this column `point`.
    closest: FloatArray
    #: The one, two or three vertices of the feature that contains each point: (n, 2, 3), padded with -1.
    feature: IntArray
    culling: str  #: Method that excluded pairs: "bvh" or "voronoi".
    cells: int  #: Number of cells of Voronoi culling.
    left_over: int  #: Number of primitives that Voronoi culling left to the hierarchy.
    object_pairs: int  #: Number of compared pairs of objects.
    candidates: int  #: Number of pairs of primitives that culling did not exclude.
    exact_tests: int  #: Number of pairs whose distance was computed.

    def __len__(self) -> int:
        return len(self.distance)

    @overload
    def __getitem__(self, index: Integer) -> PrimitivePair: ...
    @overload
    def __getitem__(self, index: slice) -> ProximityPairs: ...
    def __getitem__(self, index: Integer | slice) -> PrimitivePair | ProximityPairs:
        if isinstance(index, slice):
            columns = ("object", "primitive", "distance", "closest", "feature")
            return replace(self, **{name: getattr(self, name)[index] for name in columns})
        number = integer(index, "the number of a pair")
        if not -len(self) <= number < len(self):
            raise IndexError(f"pair {number} does not exist: there are {len(self):,} pairs, counted from 0")
        k = number % len(self)
        (first_object, second_object), (first, second) = self.object[k].tolist(), self.primitive[k].tolist()
        return PrimitivePair(
            (first_object, second_object), (first, second), float(self.distance[k]), self.closest[k], self.feature[k]
        )

    def __iter__(self) -> Iterator[PrimitivePair]:
        return (self[k] for k in range(len(self)))

    @property
    def closest_pair(self) -> PrimitivePair | None:
        """Pair with the smallest distance; the first one if several are equally close. None without pairs."""
        return self[int(np.argmin(self.distance))] if len(self) else None

    def __repr__(self) -> str:
        return f"ProximityPairs({len(self):,} {'pair' if len(self) == 1 else 'pairs'})"


@dataclass(frozen=True, eq=False)
class Penetration:
    """Connected part of the overlap of two solids.

    Examples
    --------
    >>> import blum
    >>> scene, box = blum.ProximityScene(), blum.generate("box")
    >>> a, b = scene.add(box), scene.add((box.vertices + [0.75, 0, 0], box.triangles))
    >>> (part,) = scene.penetration(a, b)
    >>> part
    Penetration(depth 0.25, volume 0.25)
    """

    object: tuple[int, int]  #: The two solids. Twice the same one if it is compared with itself.
    depth: float  #: Distance of deep_point and surface_point, mesh units.
    depth_bound: float  #: Upper bound on the true depth, proven except for rounding.
    #: Unit vector: (3,). Moving the first object by the depth in this direction brings deep_point to the surface.
    direction: FloatArray
    deep_point: FloatArray  #: Deepest point of the surface of one object in the other: (3,).
    surface_point: FloatArray  #: Closest point to it on the surface of the other object: (3,).
    is_first_deep: bool  #: True if deep_point belongs to the first object.
    deep_triangle: int  #: Triangle of its object that contains deep_point.
    surface_triangle: int  #: Triangle of the other object that contains surface_point.
    #: Areas of the parts of both surfaces that bound it. For one object, the first contains both.
    area: tuple[float, float]
    volume: float  #: Cubic mesh units.
    curves: list[FloatArray]  #: Closed curves in which the surfaces cross: (n, 3) each.

    def __repr__(self) -> str:
        return f"Penetration(depth {self.depth:.6g}, volume {self.volume:.6g})"


def penetration_of(
    objects: tuple[int, int],
    depth: float,
    bound: float,
    direction: Any,
    deep: Any,
    surface: Any,
    is_first: bool,
    *rest: Any,
) -> Penetration:
    """Returns a Penetration from the library's values."""
    return Penetration(objects, depth, bound, np.array(direction), np.array(deep), np.array(surface), is_first, *rest)


@dataclass(frozen=True, eq=False)
class SceneCollisions:
    """Pairs of features of a scene's objects that meet while the objects move; see :meth:`ProximityScene.continuous`.

    Examples
    --------
    >>> import blum
    >>> scene, box = blum.ProximityScene(), blum.generate("box")
    >>> a, b = scene.add(box), scene.add((box.vertices + [3, 0, 0], box.triangles))
    >>> scene.continuous({b: box.vertices + [2, 0, 0]})
    SceneCollisions(0 vertex_face, 0 edge_edge)
    """

    vertex_face: IntArray  #: Object of a vertex, the vertex, object of a face, the face: (n, 4).
    vertex_face_time: FloatArray  #: Times of first contact, 0 to 1: (n,).
    edge_edge: IntArray  #: An object and the ends of an edge of it, then the same for the other edge: (m, 6).
    edge_edge_time: FloatArray  #: Times of first contact, 0 to 1: (m,).
    box_pairs: int  #: Number of pairs of features whose moving boxes touch.
    exact_tests: int  #: Number of pairs that were tested.

    @property
    def earliest(self) -> float | None:
        """Earliest time of all pairs, 0 to 1. None without pairs."""
        return earliest_of(self.vertex_face_time, self.edge_edge_time)

    def __repr__(self) -> str:
        return f"SceneCollisions({len(self.vertex_face):,} vertex_face, {len(self.edge_edge):,} edge_edge)"


@dataclass(frozen=True)
class FirstContact:
    """The first pair of features that meet while meshes move.

    See :meth:`ProximityScene.first_contact` and :func:`first_contact`.

    Examples
    --------
    >>> import blum
    >>> scene, box = blum.ProximityScene(), blum.generate("box")
    >>> a, b = scene.add(box), scene.add((box.vertices + [3, 0, 0], box.triangles))
    >>> scene.first_contact({b: box.vertices - [1, 0, 0]}).time
    0.5
    """

    time: float  #: Time of the contact, 0 to 1.
    #: ``"vertex_face"`` or ``"edge_edge"``, or ``"face_vertex"``: a face of the first object, a vertex of the second.
    kind: str
    object: tuple[int, int]  #: First and second object.
    vertex: int | None  #: None for ``"edge_edge"``.
    face: int | None  #: None for ``"edge_edge"``.
    edges: tuple[tuple[int, int], tuple[int, int]] | None  #: Ends of both edges. None for a vertex and a face.
