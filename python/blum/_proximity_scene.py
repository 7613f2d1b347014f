"""Proximity scenes.

Scenes compute distances and collisions among meshes that move.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import replace
from typing import Any, TypeGuard, Unpack, cast, overload

import numpy as np

from . import _core
from ._arguments import BoolArray, FloatArray, Integer, Real, float_rows, integer, number, text, truth
from ._errors import InvalidMesh, InvalidOption
from ._mesh import MeshLike, as_mesh, end_vertices, mesh_of_arrays
from ._methods import ShortList
from ._options import takes
from ._progress import Progress, ProgressCallback, reporting
from ._proximity_results import (
    FirstContact,
    Penetration,
    PrimitivePair,
    ProximityPairs,
    SceneCollisions,
    penetration_of,
    warn_of_start,
)
from ._rigid import as_place, as_places
from ._scene_copies import SceneObject, restored_scene
from ._structs import ImpactOptions, LeastTranslation, PenetrationOptions, SceneOptions, TranslationOptions

__all__ = [
    "ProximityScene",
    "closest_primitives",
    "collisions",
    "separation",
]

_ALL_LAYERS = 0xFFFFFFFF


@takes("SceneOptions")
class ProximityScene:
    """Meshes that move, deform and change, with queries of proximity among them. Exact for the given coordinates.

    A scene keeps copies of its meshes. Results do not depend on the number of threads. After updates, results equal
    those of a new scene. Among equally close pairs, the first one is returned, by (object, primitive) of the first
    primitive, then of the second primitive. Threads that share a scene wait for each other.

    Parameters
    ----------
    **options

    Examples
    --------
    >>> import blum
    >>> scene = blum.ProximityScene()
    >>> table, ball = scene.add(blum.generate("box")), scene.add(blum.generate("sphere"))
    >>> scene.update(ball, transform=([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 3]))
    >>> found = scene.separation(table, ball)
    >>> round(found.distance, 6), found.closest.round(6).tolist()
    (1.5, [[0.0, 0.0, 0.5], [0.0, 0.0, 2.0]])
    >>> len(scene.collisions())
    0
    """

    def __init__(self, **options: Unpack[SceneOptions]) -> None:
        self._scene = _core.ProximityScene(dict(options))
        self._options = dict(options)
        self._objects: list[SceneObject | None] = []  # None: removed
        self._excluded: set[tuple[int, int]] = set()
        self._busy = threading.Lock()
        self._owner: int | None = None  # Thread that uses the scene.

    def __reduce__(self) -> tuple[Any, ...]:
        with self._alone():
            objects = [
                None if each is None else (mesh_of_arrays(self._scene.mesh(number)), each)
                for number, each in enumerate(self._objects)
            ]
            return restored_scene, (type(self), self._options, objects, sorted(self._excluded))

    def __repr__(self) -> str:
        count = sum(each is not None for each in self._objects)
        return f"ProximityScene({count} {'object' if count == 1 else 'objects'})"

    def add(
        self,
        mesh: MeshLike,
        *,
        layers: Integer = 1,
        meets: Integer = _ALL_LAYERS,
        compare_self: bool = False,
        name: str = "",
        transform: Any = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> int:
        """Adds a mesh and returns its number.

        Parameters
        ----------
        mesh : mesh
            As for :func:`distance_field`.
        layers : int
            Layers that contain the object, one bit for each.
        meets : int
            Layers whose objects this object is compared with. Two objects are compared if each is in a layer that the
            other one meets.
        compare_self : bool
            True: the object is compared with itself, except primitives that share a vertex. (In C++
            `ObjectOptions::self`.)
        name : str
            Name of the object in messages. Default: "object 3", with its number.
        transform
            See :meth:`update`.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> scene = blum.ProximityScene()
        >>> scene.add(blum.generate("box"), name="table"), scene.add(blum.generate("sphere"))
        (0, 1)
        """
        own = as_mesh(mesh)
        options = _layers(layers, "layers"), _layers(meets, "meets"), truth(compare_self, "compare_self")
        called = text(name, "name")
        place = as_place(np.eye(4) if transform is None else transform)
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            added: int = self._scene.add(own._arrays, *options, called, place, count, report)
            self._objects.append(SceneObject(*options, called, place.copy()))
        return added

    def remove(self, index: Integer) -> None:
        """Removes an object. The other objects keep their numbers.

        Examples
        --------
        >>> import blum
        >>> scene = blum.ProximityScene()
        >>> scene.remove(scene.add(blum.generate("box")))
        >>> scene
        ProximityScene(0 objects)
        """
        which = _object(index, "index")
        with self._alone():
            self._scene.remove(which)
            self._objects[which] = None
            self._excluded = {pair for pair in self._excluded if which not in pair}

    def rename(self, index: Integer, name: str) -> None:
        """Changes the name of an object in messages.

        Examples
        --------
        >>> import blum
        >>> scene = blum.ProximityScene()
        >>> scene.rename(scene.add(blum.generate("box")), "table")
        """
        which, called = _object(index, "index"), text(name, "name")
        with self._alone():
            self._scene.rename(which, called)
            self._change(which, name=called)

    def update(
        self,
        index: Integer,
        vertices: Any = None,
        transform: Any = None,
        mesh: MeshLike | None = None,
        *,
        threads: int = 0,
        progress: Progress = False,
    ) -> None:
        """Changes an object: the positions of its vertices, its transform, or its mesh.

        Parameters
        ----------
        index : int
            Number of the object.
        vertices : (n, 3) array, optional
            New positions of all vertices, before the transform.
        transform : (4, 4) or (3, 4) array, or a pair (rotation (3, 3), translation (3,)), optional
            Absolute pose of the object, applied to the positions of its vertices. It must be rigid to within 1e-9, so
            it needs double precision. :func:`closest_rotation` converts less precise rotations.
        mesh : mesh, optional
            Another mesh for the object. Transform and comparisons stay the same. Excludes `vertices`.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> fixed, moving = scene.add(box), scene.add(box)
        >>> scene.update(moving, transform=([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [3, 0, 0]))
        >>> scene.separation(fixed, moving).distance
        2.0
        """
        if vertices is not None and mesh is not None:
            raise InvalidOption("mesh excludes vertices: a mesh has its own")
        if vertices is None and transform is None and mesh is None:
            raise InvalidOption("there is nothing to update: give vertices, transform or mesh")
        which = _object(index, "index")
        rows = None if vertices is None else float_rows(vertices, "vertices")
        own = None if mesh is None else as_mesh(mesh)
        place = None if transform is None else as_place(transform)
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            if place is not None and (rows is not None or own is not None):
                self._scene.check_place(place)  # Before anything changes.
            if rows is not None:
                self._scene.set_vertices(which, rows, count, report)
            if own is not None:
                self._scene.set_mesh(which, own._arrays, count, report)
            if place is not None:
                self._scene.set_place(which, place)
                self._change(which, place=place.copy())

    def exclude(self, a: Integer, b: Integer, excluded: bool = True) -> None:
        """Excludes a pair of objects, or one object and itself, from comparisons, or includes the pair again.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add(box)
        >>> before = len(scene.collisions())
        >>> scene.exclude(a, b)
        >>> before > 0, len(scene.collisions())
        (True, 0)
        """
        first, second = _object(a, "a"), _object(b, "b")
        is_excluded = truth(excluded, "excluded")
        with self._alone():
            self._scene.exclude(first, second, is_excluded)
            pair = (min(first, second), max(first, second))
            (self._excluded.add if is_excluded else self._excluded.discard)(pair)

    @overload
    def separation(
        self,
        a: None = None,
        b: None = None,
        max_distance: Real = ...,
        *,
        threads: int = 0,
        progress: Progress = False,
    ) -> ProximityPairs: ...
    @overload
    def separation(
        self, a: Integer, b: Integer, max_distance: Real = ..., *, threads: int = 0, progress: Progress = False
    ) -> PrimitivePair | None: ...
    def separation(
        self,
        a: Integer | None = None,
        b: Integer | None = None,
        max_distance: Real = np.inf,
        *,
        threads: int = 0,
        progress: Progress = False,
    ) -> ProximityPairs | PrimitivePair | None:
        """Returns the closest pair of primitives of two objects, whatever their layers, or of one object with itself.

        Without `a` and `b`, returns the closest pair of each compared pair of objects.

        Parameters
        ----------
        a, b : int, optional
            Numbers of objects: both or neither.
        max_distance : float
            Largest distance of a pair, mesh units.
        threads, progress
            As for :func:`distance_field`.

        Returns
        -------
        PrimitivePair, or None if no pair lies within `max_distance`. ProximityPairs without `a` and `b`.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [3, 0, 0], box.triangles))
        >>> scene.separation(a, b).distance, scene.separation(a, b, max_distance=1), len(scene.separation())
        (2.0, None, 1)
        """
        if (a is None) != (b is None):
            raise InvalidOption("separation() takes both a and b, or neither for all pairs")
        most, count = number(max_distance, "max_distance"), integer(threads, "threads")
        if a is None or b is None:
            with self._alone(progress) as report:
                return ProximityPairs(*self._scene.pairs("separation", most, {}, count, report))
        first, second = _object(a, "a"), _object(b, "b")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.separation(first, second, most, count, report)).closest_pair

    @overload
    def meets(
        self, a: None = None, b: None = None, transforms: None = None, *, threads: int = 0, progress: Progress = False
    ) -> bool: ...
    @overload
    def meets(
        self, a: Integer, b: Integer, transforms: None = None, *, threads: int = 0, progress: Progress = False
    ) -> bool: ...
    @overload
    def meets(
        self, a: Integer, b: Integer, transforms: Any, *, threads: int = 0, progress: Progress = False
    ) -> BoolArray: ...
    def meets(
        self,
        a: Integer | None = None,
        b: Integer | None = None,
        transforms: Any = None,
        *,
        threads: int = 0,
        progress: Progress = False,
    ) -> bool | BoolArray:
        """Returns True if two objects meet, whatever their layers. The search stops at the first pair of primitives.

        Only surfaces are compared: a solid inside another solid meets it only if their surfaces meet. If `a` and `b`
        are the same object, returns True if :meth:`collisions` would find a pair within it. Without `a` and `b`,
        returns True if any compared pair of objects meets.

        Parameters
        ----------
        a, b : int, optional
            Numbers of objects: both or neither.
        transforms : (n, 4, 4) or (n, 3, 4) array, optional
            Poses of `b`, as for :meth:`update`. The result is then an array of n booleans, one for each pose. The scene
            does not change.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum, numpy as np
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add(box)
        >>> poses = np.tile(np.eye(4), (3, 1, 1))
        >>> poses[:, 0, 3] = [0.5, 1, 1.5]
        >>> scene.meets(a, b), scene.meets(a, b, poses).tolist()
        (True, [True, True, False])
        """
        if (a is None) != (b is None):
            raise InvalidOption("meets() takes both a and b, or neither for all pairs")
        count = integer(threads, "threads")
        if a is None or b is None:
            if transforms is not None:
                raise InvalidOption("transforms are those of b: meets() then takes both a and b")
            with self._alone(progress) as report:
                return bool(self._scene.meets(count, report))
        first, second = _object(a, "a"), _object(b, "b")
        if transforms is None:
            with self._alone(progress) as report:
                return bool(self._scene.meets_two(first, second, count, report))
        places = as_places(transforms)
        with self._alone(progress) as report:
            found: BoolArray = self._scene.meets_at(first, second, places, count, report).view(bool)
        return found

    def closest_primitives(
        self, max_distance: Real = np.inf, *, threads: int = 0, progress: Progress = False
    ) -> ProximityPairs:
        """Returns, for each primitive of the scene, the closest primitive that it is compared with.

        A primitive is left out if no such primitive is within `max_distance`. Pairs are sorted by the object, then the
        primitive, of their first primitive.

        Parameters
        ----------
        max_distance : float
            Mesh units.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [3, 0, 0], box.triangles))
        >>> len(scene.closest_primitives()), len(scene.closest_primitives(1))
        (24, 0)
        """
        most, count = number(max_distance, "max_distance"), integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.pairs("closest_primitives", most, {}, count, report))

    def closer_than(self, distance: Real, *, threads: int = 0, progress: Progress = False) -> ProximityPairs:
        """Returns all compared pairs of primitives that are at most a distance apart, each once.

        Parameters
        ----------
        distance : float
            Mesh units, not negative.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [3, 0, 0], box.triangles))
        >>> len(scene.closer_than(2)) > 0, len(scene.closer_than(1.9))
        (True, 0)
        """
        most, count = number(distance, "distance"), integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.pairs("closer_than", most, {}, count, report))

    def collisions(self, *, threads: int = 0, progress: Progress = False) -> ProximityPairs:
        """Returns all compared pairs of primitives that have a point in common.

        Within one object, pairs that share a vertex are included if they have more in common than a corner or an edge.

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [0.5, 0.25, 0.25], box.triangles))
        >>> bool(scene.collisions())
        True
        """
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.pairs("collisions", 0, {}, count, report))

    @takes("PenetrationOptions")
    def penetration(
        self,
        a: Integer,
        b: Integer,
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[PenetrationOptions],
    ) -> list[Penetration]:
        """Returns the connected parts of the overlap of two solids, the deepest first.

        The list is empty if the solids only touch. If `a` and `b` are the same object, returns the overlaps of its
        parts.

        Parameters
        ----------
        a, b : int
            Numbers of objects, which must be closed and face outwards.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene = blum.ProximityScene()
        >>> box, ball = scene.add(blum.generate("box")), scene.add(blum.generate("sphere", radius=0.5))
        >>> scene.update(ball, transform=([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0.9]))
        >>> part, = scene.penetration(box, ball)
        >>> round(part.depth, 6), part.direction.round(6).tolist(), len(part.curves)
        (0.1, [-0.0, -0.0, -1.0], 1)
        """
        first, second, count = _object(a, "a"), _object(b, "b"), integer(threads, "threads")
        with self._alone(progress) as report:
            found = self._scene.penetration(first, second, dict(options), count, report)
        return ShortList(penetration_of(*part) for part in found)

    @takes("TranslationOptions")
    def least_translation(
        self,
        a: Integer,
        b: Integer,
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[TranslationOptions],
    ) -> LeastTranslation:
        """Returns the result of :func:`blum.least_translation` for two objects.

        Parameters
        ----------
        a, b, threads, progress
            As for :meth:`penetration`, but not the same object twice.
        **options

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> scene.least_translation(scene.add(box), scene.add(box)).are_convex
        True
        """
        first, second, count = _object(a, "a"), _object(b, "b"), integer(threads, "threads")
        with self._alone(progress) as report:
            found: LeastTranslation = self._scene.least_translation(first, second, dict(options), count, report)
        return found

    @takes("PenetrationOptions")
    def signed_separation(
        self,
        a: Integer,
        b: Integer,
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[PenetrationOptions],
    ) -> float:
        """Returns the signed distance of two solids, mesh units.

        If the solids are apart, the result is their distance. If they touch, it is 0. If they overlap, it is minus the
        largest depth. The depth of :meth:`penetration` measures how far points of one surface lie in the other solid.
        This depth differs from the length of the shortest separating translation (GJK with EPA).

        Parameters
        ----------
        a, b : int
            As for :meth:`penetration`.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [0.75, 0, 0], box.triangles))
        >>> scene.signed_separation(a, b)
        -0.25
        """
        first, second, count = _object(a, "a"), _object(b, "b"), integer(threads, "threads")
        with self._alone(progress) as report:
            distance: float = self._scene.signed_separation(first, second, dict(options), count, report)
        return distance

    @takes("PenetrationOptions")
    def penetrations(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[PenetrationOptions]
    ) -> list[Penetration]:
        """Returns the overlaps of all compared pairs of solids, by ascending pair of objects.

        The parts of each pair are those of :meth:`penetration`. Each object is checked once.

        Parameters
        ----------
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> places = [[0, 0, 0], [0.75, 0, 0], [1.25, 0, 0]]
        >>> boxes = [scene.add((box.vertices + at, box.triangles)) for at in places]
        >>> [(part.object, part.depth) for part in scene.penetrations()]
        [((0, 1), 0.25), ((1, 2), 0.5)]
        >>> scene.signed_separations().distance.tolist()
        [-0.25, 0.25, -0.5]
        """
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            found = self._scene.penetrations(dict(options), count, report)
        return ShortList(penetration_of(*part) for part in found)

    @takes("PenetrationOptions")
    def signed_separations(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[PenetrationOptions]
    ) -> ProximityPairs:
        """Returns the signed distances of all compared pairs of solids.

        The results are the pairs of :meth:`separation`. For solids that overlap, the pair has a negative distance. The
        points of this pair are the deepest point of the deepest part and the closest point of the other surface.
        `closest_pair` is then the deepest pair.

        Parameters
        ----------
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> a, b = scene.add(box), scene.add((box.vertices + [0.75, 0, 0], box.triangles))
        >>> scene.signed_separations().closest_pair.distance
        -0.25
        """
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.pairs("signed_separations", 0, dict(options), count, report))

    @takes("ImpactOptions")
    def continuous(
        self,
        motions: Mapping[int, Any],
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[ImpactOptions],
    ) -> SceneCollisions:
        """Returns all pairs of a vertex and a face, and of two edges, of compared objects that meet while objects move.

        Vertices move along straight lines. The scene is not changed. Objects without a motion rest. A warning reports
        pairs that meet at the start, because their times are 0.

        Parameters
        ----------
        motions : dict
            The end of the motion of each moving object: vertices (n, 3) before its transform, or a transform, or
            ``{"vertices": ..., "transform": ...}``. Vertices and transform have the forms of :meth:`update`. A mesh
            with the same number of vertices may be given for the vertices.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene = blum.ProximityScene()
        >>> box = blum.generate("box")
        >>> floor, falling = scene.add(box), scene.add((box.vertices + [0.25, 0.25, 3], box.triangles))
        >>> found = scene.continuous({falling: box.vertices + [0.25, 0.25, -1]})
        >>> found.earliest
        0.5
        """
        rows = [_motion(which, end) for which, end in _motions_of(motions)]
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            found = SceneCollisions(*self._scene.continuous(rows, dict(options), count, report))
        warn_of_start(found.vertex_face_time, found.edge_edge_time)
        return found

    @takes("ImpactOptions")
    def first_contact(
        self,
        motions: Mapping[int, Any],
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[ImpactOptions],
    ) -> FirstContact | None:
        """Returns the first contact of objects that move, or None if nothing meets.

        The first contact is the pair with the smallest time among those that :meth:`continuous` returns. If many pairs
        meet, this search is much faster. Pairs with the same time are ordered by objects, then by kind, then by vertex
        and face, or by the ends of the edges. The order of kinds is ``vertex_face``, ``face_vertex``, ``edge_edge``.

        Parameters
        ----------
        motions : dict
            As for :meth:`continuous`.
        threads, progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> scene, box = blum.ProximityScene(), blum.generate("box")
        >>> floor, falling = scene.add(box), scene.add((box.vertices + [0.25, 0.25, 3], box.triangles))
        >>> scene.first_contact({falling: box.vertices + [0.25, 0.25, -1]}).time
        0.5
        """
        rows = [_motion(which, end) for which, end in _motions_of(motions)]
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            found: Any = self._scene.first_contact(rows, dict(options), count, report)
        return FirstContact(*found) if found is not None else None

    def _change(self, index: int, **facts: Any) -> None:
        """Notes changes of an object, for copies of the scene."""
        own = self._objects[index]
        assert own is not None  # The library rejects removed objects.
        self._objects[index] = replace(own, **facts)

    def _alone(self, progress: Progress = False) -> AbstractContextManager[ProgressCallback | None]:
        """Returns a context with the library's progress callback, in which no other thread uses the scene."""
        return _Alone(self) if progress is False else self._alone_reporting(progress)

    @contextmanager
    def _alone_reporting(self, progress: Progress) -> Iterator[ProgressCallback | None]:
        with _Alone(self), reporting(progress) as report:
            yield report


class _Alone(AbstractContextManager[None]):
    """Context in which no other thread uses a scene.

    It is a class, because a generator would take longer than a query of two objects.
    """

    __slots__ = ("_scene",)

    def __init__(self, scene: ProximityScene) -> None:
        self._scene = scene

    def __enter__(self) -> None:
        scene, own = self._scene, threading.get_ident()
        if scene._owner == own:
            raise RuntimeError("this scene is in use by a running call: callbacks and signal handlers must not use it")
        scene._busy.acquire()
        scene._owner = own

    def __exit__(self, *_: object) -> None:
        self._scene._owner = None
        self._scene._busy.release()


def scene_of_named(named: Sequence[tuple[str, MeshLike]], threads: int, compare_self: bool = False) -> ProximityScene:
    """Returns a scene of named meshes."""
    scene = ProximityScene()
    for name, mesh in named:
        scene.add(as_mesh(mesh, name=name), name=name, compare_self=compare_self, threads=threads)
    return scene


def separation(
    a: MeshLike, b: MeshLike, *, max_distance: Real = np.inf, threads: int = 0, progress: Progress = False
) -> PrimitivePair | None:
    """Returns the closest points of two meshes, exactly. None if they are further apart than `max_distance`.

    :class:`ProximityScene` keeps its structures for meshes that move.

    Parameters
    ----------
    a, b : meshes
        As for :func:`distance_field`.
    max_distance : float
        Mesh units.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.separation(box, (box.vertices + [3, 0, 0], box.triangles))
    >>> found.distance, found.closest[:, 0].tolist()
    (2.0, [0.5, 2.5])
    """
    scene = scene_of_named((("a", a), ("b", b)), threads)
    return scene.separation(0, 1, max_distance, threads=threads, progress=progress)


def closest_primitives(
    meshes: MeshLike | Sequence[MeshLike],
    *,
    max_distance: Real = np.inf,
    compare_self: bool | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> ProximityPairs:
    """Returns, for each primitive of one or several meshes, the closest primitive of another mesh, exactly.

    Primitives are triangles, segments and points. If a mesh is compared with itself, the closest one may also be a
    primitive of the same mesh that shares no vertex.

    Parameters
    ----------
    meshes : mesh, or a list of meshes
        As for :func:`distance_field`.
    max_distance : float
        A primitive is left out if no other primitive is within this distance. Mesh units.
    compare_self : bool, optional
        True: each mesh is compared with itself. Default: True for a single mesh.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> found = blum.closest_primitives(blum.generate("torus"))
    >>> len(found), found.primitive[0, 0].item(), bool((found.distance > 0).all())
    (6144, 0, True)
    """
    scene = _scene_of(meshes, compare_self, threads)
    return scene.closest_primitives(max_distance, threads=threads, progress=progress)


def collisions(
    meshes: MeshLike | Sequence[MeshLike],
    *,
    max_distance: Real = 0.0,
    compare_self: bool | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> ProximityPairs:
    """Returns all pairs of primitives of one or several meshes that meet, or are at most `max_distance` apart, exactly.

    Primitives are triangles, segments and points.

    Parameters
    ----------
    meshes : mesh, or a list of meshes
        As for :func:`distance_field`.
    max_distance : float
        Mesh units. 0: primitives that share a vertex are returned if they have further points in common. Above 0:
        primitives that share a vertex are left out.
    compare_self : bool, optional
        True: each mesh is compared with itself. Default: True for a single mesh.
    threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> moved = blum.Mesh(box.vertices + [0.5, 0.25, 0.25], box.triangles)
    >>> bool(blum.collisions([box, moved])), bool(blum.collisions(box))
    (True, False)
    """
    distance = number(max_distance, "max_distance")
    scene = _scene_of(meshes, compare_self, threads)
    if distance == 0:
        return scene.collisions(threads=threads, progress=progress)
    if not distance > 0:
        raise InvalidOption(f"max_distance is {distance}, but must be at least 0")
    return scene.closer_than(distance, threads=threads, progress=progress)


def _scene_of(meshes: MeshLike | Sequence[MeshLike], compare_self: bool | None, threads: int) -> ProximityScene:
    """Returns a scene of one or several meshes."""
    if _is_several(meshes):
        several = [(f"meshes[{k}]", mesh) for k, mesh in enumerate(meshes)]
    else:
        several = [("mesh", cast(MeshLike, meshes))]
    if not several:
        raise InvalidMesh("meshes is empty: give at least one mesh")
    own = len(several) == 1 if compare_self is None else truth(compare_self, "compare_self")
    return scene_of_named(several, threads, own)


def _motions_of(motions: Any) -> list[tuple[Any, Any]]:
    """Returns the entries of a dict of motions."""
    if isinstance(motions, Mapping):
        return list(motions.items())
    raise TypeError(
        f"motions must be a dict from the number of an object to its vertices at the end, {{number: vertices}}, not "
        f"{type(motions).__name__}"
    )


def _is_place(end: Any) -> bool:
    """Returns True for a transform: a matrix with four columns, or a rotation and a translation."""
    if isinstance(end, tuple) and len(end) == 2:
        return np.shape(end[0]) == (3, 3) and np.shape(end[1]) == (3,)
    return isinstance(end, np.ndarray) and end.shape in ((3, 4), (4, 4))


def _motion(which: Any, end: Any) -> tuple[int, FloatArray | None, FloatArray | None]:
    """Returns the vertices and the transform of an object at the end of its motion."""
    given = end if isinstance(end, dict) else {"transform" if _is_place(end) else "vertices": end}
    if unknown := set(given) - {"vertices", "transform"}:
        raise InvalidOption(f"motions[{which}] has {sorted(unknown)}, but takes 'vertices' and 'transform'")
    vertices, transform = given.get("vertices"), given.get("transform")
    moved = None if vertices is None else end_vertices(vertices, f"motions[{which}]")
    if moved is not None and len(moved) == 0:
        raise InvalidMesh(f"motions[{which}] has no vertices: leave out objects that do not move")
    return (
        _object(which, "motions"),
        moved,
        None if transform is None else as_place(transform),
    )


def _is_several(meshes: Any) -> TypeGuard[Sequence[MeshLike]]:
    """Returns True for a list of meshes, False for a pair of vertices and triangles."""
    if not isinstance(meshes, Sequence) or isinstance(meshes, (str, bytes)):
        return False
    return len(meshes) != 2 or not _is_rows(meshes[0])


def _is_rows(value: Any) -> bool:
    """Returns True for a matrix of numbers, as vertices are."""
    try:
        return np.ndim(value) == 2
    except ValueError:  # Lists of different lengths.
        return False


def _layers(value: Any, name: str) -> int:
    """Returns a set of layers as bits."""
    bits = integer(value, name, bits=64)
    if not 0 <= bits <= _ALL_LAYERS:
        raise InvalidOption(f"{name} is {bits}, but must be 0 to 2^32 - 1: a bit for each layer")
    return bits


def _object(value: Any, name: str) -> int:
    """Returns the number of an object."""
    index = integer(value, name)
    if index < 0:
        raise InvalidOption(f"{name} is {index}, but must be the number of an object, 0 or more")
    return index
