"""Distances and collisions among meshes that move."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeGuard, Unpack, cast, overload

import numpy as np

from . import _core
from ._arguments import (
    FloatArray,
    IntArray,
    Integer,
    Real,
    as_array,
    float_rows,
    integer,
    matrix,
    number,
    text,
    triple,
    truth,
)
from ._errors import InvalidMesh, InvalidOption
from ._mesh import MeshLike, as_mesh, end_vertices
from ._options import takes
from ._progress import Progress, ProgressCallback, reporting
from ._proximity_results import Penetration, PrimitivePair, ProximityPairs, SceneCollisions
from ._structs import ImpactOptions, PenetrationOptions, SceneOptions

_ALL_LAYERS = 0xFFFFFFFF


@takes("SceneOptions")
class ProximityScene:
    """Meshes that move, deform and change, and what is close among them; exact for the coordinates as they are.

    A scene keeps copies of its meshes. Answers do not depend on the number of threads, and after any updates are those
    of a scene made anew. Of pairs that are equally far apart, the one with the smallest (object, primitive) of the
    first, then of the second, is told. Threads that share a scene wait for each other.

    Parameters
    ----------
    **options

    >>> import blum
    >>> scene = blum.ProximityScene()
    >>> table, ball = scene.add(blum.generate("box")), scene.add(blum.generate("sphere"))
    >>> scene.update(ball, transform=([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 3]))
    >>> found = scene.separation(table, ball)
    >>> round(found.distance, 6), found.point.round(6).tolist()
    (1.5, [[0.0, 0.0, 0.5], [0.0, 0.0, 2.0]])
    >>> len(scene.collisions())
    0
    """

    def __init__(self, **options: Unpack[SceneOptions]) -> None:
        self._scene = _core.ProximityScene(dict(options))
        self._count = 0
        self._busy = threading.Lock()
        self._owner: int | None = None  # the thread that asks or changes

    def __repr__(self) -> str:
        return f"ProximityScene({self._count} {'object' if self._count == 1 else 'objects'})"

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
        """Adds a mesh, and tells its number.

        Parameters
        ----------
        mesh : anything that stands for a mesh
        layers : int
            The layers that the object is in, a bit for each.
        meets : int
            The layers whose objects it is compared with. Two objects are compared where each is in a layer that the
            other one meets.
        compare_self : bool
            Whether it is compared with itself: primitives that share no vertex. (In C++ `ObjectOptions::self`.)
        name : str
            What messages call it. Without one they say "object 3".
        transform : see :meth:`update`
        """
        own = as_mesh(mesh)
        options = _layers(layers, "layers"), _layers(meets, "meets"), truth(compare_self, "compare_self")
        called = text(name, "name")
        place = _place(np.eye(4) if transform is None else transform)
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            added: int = self._scene.add(own._arrays, *options, called, place, count, report)
            self._count += 1
        return added

    def remove(self, index: Integer) -> None:
        """Removes an object; the others keep their numbers."""
        which = _object(index, "index")
        with self._alone():
            self._scene.remove(which)
            self._count -= 1

    def rename(self, index: Integer, name: str) -> None:
        """Gives an object another name, by which messages call it."""
        which, called = _object(index, "index"), text(name, "name")
        with self._alone():
            self._scene.rename(which, called)

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
        """Changes an object: where its vertices are, where the whole is, or what it is.

        Parameters
        ----------
        index : int
            The object.
        vertices : (n, 3) array, optional
            New positions before the transform, as many as there are.
        transform : (4, 4) or (3, 4) array, or a pair (rotation (3, 3), translation (3,)), optional
            Where the object is, from the positions of its vertices: not relative to where it was. Rigid to 1e-9, so in
            doubles: of others :func:`closest_rotation`.
        mesh : anything that stands for a mesh, optional
            Another mesh for the object. It stays where it is, and is compared with what it was.
        """
        if vertices is not None and mesh is not None:
            raise InvalidOption("mesh excludes vertices: a mesh brings its own")
        if vertices is None and transform is None and mesh is None:
            raise InvalidOption("there is nothing to update: give vertices, transform or mesh")
        which = _object(index, "index")
        rows = None if vertices is None else float_rows(vertices, "vertices")
        own = None if mesh is None else as_mesh(mesh)
        place = None if transform is None else _place(transform)
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            if place is not None:
                self._scene.check_place(place)  # before anything has changed
            if rows is not None:
                self._scene.set_vertices(which, rows, count, report)
            if own is not None:
                self._scene.set_mesh(which, own._arrays, count, report)
            if place is not None:
                self._scene.set_place(which, place)

    def exclude(self, a: Integer, b: Integer, excluded: bool = True) -> None:
        """Leaves out a pair of objects, or an object with itself, whatever their layers; or takes that back."""
        first, second = _object(a, "a"), _object(b, "b")
        with self._alone():
            self._scene.exclude(first, second, truth(excluded, "excluded"))

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
        """The closest pair of primitives of two objects, whatever their layers, or of one with itself; None where there
        is none within `max_distance`. Without `a` and `b`, that of each two objects that are compared."""
        if (a is None) != (b is None):
            raise InvalidOption("separation takes two objects, or none for all pairs")
        most, count = number(max_distance, "max_distance"), integer(threads, "threads")
        if a is None or b is None:
            with self._alone(progress) as report:
                return ProximityPairs(*self._scene.separations(most, count, report))
        first, second = _object(a, "a"), _object(b, "b")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.separation(first, second, most, count, report)).closest

    def closest_primitives(
        self, max_distance: Real = np.inf, *, threads: int = 0, progress: Progress = False
    ) -> ProximityPairs:
        """For each primitive of the scene the closest one that it is compared with, where there is one within
        `max_distance`; by rising object and primitive of the first."""
        most, count = number(max_distance, "max_distance"), integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.closest_primitives(most, count, report))

    def closer_than(self, distance: Real, *, threads: int = 0, progress: Progress = False) -> ProximityPairs:
        """All pairs of primitives that are compared and no further apart than `distance`, each once."""
        most, count = number(distance, "distance"), integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.closer_than(most, count, report))

    def collisions(self, *, threads: int = 0, progress: Progress = False) -> ProximityPairs:
        """All pairs of primitives that have a point in common. Of one object also those that share a vertex, and have
        more in common than the corner or edge that they share."""
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.collisions(count, report))

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
        """What two solids have in common, in its connected parts, the deepest first; none where they only touch. With
        one object twice, what lies in two parts of it.

        Parameters
        ----------
        a, b : int
            Objects: closed, facing outwards.
        **options

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
        return [_penetration(*part) for part in found]

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
        """The distance of two solids where they are apart, 0 where they touch, less the largest depth where they have
        more in common. The depth is that of :meth:`penetration`, how far points of one surface lie in the other solid,
        and not the least way apart that GJK with EPA tells of convex shapes.

        Parameters
        ----------
        a, b : int
        **options
        """
        first, second, count = _object(a, "a"), _object(b, "b"), integer(threads, "threads")
        with self._alone(progress) as report:
            distance: float = self._scene.signed_separation(first, second, dict(options), count, report)
        return distance

    @takes("PenetrationOptions")
    def penetrations(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[PenetrationOptions]
    ) -> list[Penetration]:
        """What each two solids that are compared have in common: the parts that :meth:`penetration` tells of each pair,
        by rising pair of objects. What makes an object a solid is looked at once.

        Parameters
        ----------
        **options

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
        return [_penetration(*part) for part in found]

    @takes("PenetrationOptions")
    def signed_separations(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[PenetrationOptions]
    ) -> ProximityPairs:
        """How far each two solids that are compared are apart, or less the depth where they have something in common:
        the pairs of :meth:`separation`, of which those that overlap are the deepest point of their deepest part and the
        closest one to it of the other surface, with a negative distance. Its `closest` is then the deepest.

        Parameters
        ----------
        **options
        """
        count = integer(threads, "threads")
        with self._alone(progress) as report:
            return ProximityPairs(*self._scene.signed_separations(dict(options), count, report))

    @takes("ImpactOptions")
    def continuous(
        self,
        motions: Mapping[int, Any],
        *,
        threads: int = 0,
        progress: Progress = False,
        **options: Unpack[ImpactOptions],
    ) -> SceneCollisions:
        """All pairs of a vertex and a face, and of two edges, of objects that are compared, that meet while objects
        move: their vertices along straight lines. The scene stays as it is.

        Parameters
        ----------
        motions : dict
            For each object that moves where it is at the end: vertices (n, 3) before its transform, a transform, or
            ``{"vertices": ..., "transform": ...}`` with either or both, as :meth:`update` takes them. In place of
            vertices also what stands for the mesh at the end, with as many.
        **options

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
            return SceneCollisions(*self._scene.continuous(rows, dict(options), count, report))

    @contextmanager
    def _alone(self, progress: Progress = False) -> Iterator[ProgressCallback | None]:
        """What the library calls with progress, while nothing else asks or changes the scene."""
        if self._owner == threading.get_ident():
            raise RuntimeError("this scene is at work: its progress and signal handlers cannot ask or change it")
        with self._busy, reporting(progress) as report:
            self._owner = threading.get_ident()
            try:
                yield report
            finally:
                self._owner = None


def separation(
    a: MeshLike, b: MeshLike, *, max_distance: Real = np.inf, threads: int = 0, progress: Progress = False
) -> PrimitivePair | None:
    """The closest points of two meshes, exactly; None where they are further apart than `max_distance`.

    For meshes that move, :class:`ProximityScene` asks again without starting anew.

    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.separation(box, (box.vertices + [3, 0, 0], box.triangles))
    >>> found.distance, found.point[:, 0].tolist()
    (2.0, [0.5, 2.5])
    """
    scene = ProximityScene()
    for name, mesh in (("a", a), ("b", b)):
        scene.add(as_mesh(mesh, name=name), name=name, threads=threads)
    return scene.separation(0, 1, max_distance, threads=threads, progress=progress)


def closest_primitives(
    meshes: MeshLike | Sequence[MeshLike],
    *,
    max_distance: Real = np.inf,
    compare_self: bool | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> ProximityPairs:
    """For each primitive (triangle, segment, point) of one or several meshes the closest one of another mesh, or of the
    same one that shares no vertex with it; exact.

    Parameters
    ----------
    meshes : anything that stands for a mesh, or a list of these
    max_distance : float
        Primitives that have nothing this close are left out.
    compare_self : bool, optional
        Whether each mesh is compared with itself. Default: where there is only one.

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
    """All pairs of primitives (triangles, segments, points) of one or several meshes that meet, or that are no further
    apart than `max_distance`; exact.

    Parameters
    ----------
    meshes : anything that stands for a mesh, or a list of these
    max_distance : float
        In mesh units. With 0, primitives that share a vertex are told where they have more in common than that; else
        they are left out.
    compare_self : bool, optional
        Whether each mesh is compared with itself. Default: where there is only one.

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
        raise InvalidOption(f"max_distance is {distance}, but must be a number of at least 0")
    return scene.closer_than(distance, threads=threads, progress=progress)


@dataclass(frozen=True, eq=False)
class TriangleDistances:
    """How far triangles are apart, and where."""

    distance: FloatArray  #: (n,): 0 just where they have a point in common
    point: FloatArray  #: (n, 2, 3): the closest points of both; where they meet, a point near both
    feature: IntArray  #: (n, 2, 3): the one, two or three corners (0 to 2) that each lies on, padded with -1


def triangle_distances(a: Any, b: Any, *, threads: int = 0, progress: Progress = False) -> TriangleDistances:
    """The closest points of pairs of triangles, of which any may have lost its area; exact where they meet.

    Parameters
    ----------
    a, b : (n, 3, 3) arrays
        The corners of the first and the second triangle of each pair.

    >>> import blum
    >>> floor, above = [[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[1, 1, 2], [9, 0, 3], [0, 9, 3]]
    >>> found = blum.triangle_distances([floor], [above])
    >>> found.distance.tolist(), found.point.round(9).tolist()
    ([2.0], [[[1.0, 1.0, 0.0], [1.0, 1.0, 2.0]]])
    >>> found.feature.tolist()
    [[[0, 1, 2], [0, -1, -1]]]
    """
    first, second = _triangles(a, "a"), _triangles(b, "b")
    if len(first) != len(second):
        raise InvalidMesh(f"a has {len(first)} triangles, and b {len(second)}; they must be as many")
    with reporting(progress) as report:
        return TriangleDistances(*_core.triangle_distances(first, second, integer(threads, "threads"), report))


def _scene_of(meshes: MeshLike | Sequence[MeshLike], compare_self: bool | None, threads: int) -> ProximityScene:
    if _is_several(meshes):
        several = [(f"meshes[{k}]", mesh) for k, mesh in enumerate(meshes)]
    else:
        several = [("mesh", cast(MeshLike, meshes))]
    if not several:
        raise InvalidMesh("meshes holds no mesh: give at least one")
    own = len(several) == 1 if compare_self is None else truth(compare_self, "compare_self")
    scene = ProximityScene()
    for name, mesh in several:
        scene.add(as_mesh(mesh, name=name), name=name, compare_self=own, threads=threads)
    return scene


def _penetration(
    objects: tuple[int, int],
    depth: float,
    bound: float,
    direction: Any,
    deep: Any,
    surface: Any,
    is_first: bool,
    *rest: Any,
) -> Penetration:
    return Penetration(objects, depth, bound, np.array(direction), np.array(deep), np.array(surface), is_first, *rest)


def _motions_of(motions: Any) -> list[tuple[Any, Any]]:
    if isinstance(motions, Mapping):
        return list(motions.items())
    raise TypeError(
        f"motions must be a dict from the number of an object to its vertices at the end, {{number: vertices}}, not "
        f"{type(motions).__name__}"
    )


def _is_place(end: Any) -> bool:
    """Whether it is a transform: a matrix of four columns, or a rotation and a translation."""
    if isinstance(end, tuple) and len(end) == 2:
        return np.shape(end[0]) == (3, 3) and np.shape(end[1]) == (3,)
    return isinstance(end, np.ndarray) and end.shape in ((3, 4), (4, 4))


def _motion(which: Any, end: Any) -> tuple[int, FloatArray | None, FloatArray | None]:
    given = end if isinstance(end, dict) else {"transform" if _is_place(end) else "vertices": end}
    if unknown := set(given) - {"vertices", "transform"}:
        raise InvalidOption(f"motions[{which}] has {sorted(unknown)}, but takes 'vertices' and 'transform'")
    vertices, transform = given.get("vertices"), given.get("transform")
    moved = None if vertices is None else end_vertices(vertices, f"motions[{which}]")
    if moved is not None and len(moved) == 0:
        raise InvalidMesh(f"motions[{which}] has no vertices; an object that rests is left out of the motions")
    return (
        _object(which, "motions"),
        moved,
        None if transform is None else _place(transform),
    )


def closest_rotation(matrix: Any) -> FloatArray:
    """The rotation that is closest to a matrix that is one but for rounding, in doubles: of poses in float32, for
    :meth:`ProximityScene.update`.

    Parameters
    ----------
    matrix : (3, 3), (3, 4) or (4, 4) array
        A rotation, or a transform, of which only the rotation changes. Its columns have length 1 and are at right
        angles to 0.1.

    >>> import blum, numpy as np
    >>> turn = np.array([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]], dtype=np.float32)
    >>> rotation = blum.closest_rotation(turn)
    >>> bool(np.abs(rotation.T @ rotation - np.eye(3)).max() < 1e-15)
    True
    """
    rows = as_array(matrix, "matrix")
    if rows.dtype.kind not in "fiu":
        raise TypeError(f"matrix must hold real numbers, not {rows.dtype}")
    if rows.shape not in ((3, 3), (3, 4), (4, 4)):
        raise ValueError(f"matrix has the shape {rows.shape}, but must have (3, 3), (3, 4) or (4, 4)")
    out: FloatArray = np.array(rows, dtype=np.float64)
    out[:3, :3] = np.reshape(_core.closest_rotation(np.ascontiguousarray(out[:3, :3])), (3, 3))
    return out


def _is_several(meshes: Any) -> TypeGuard[Sequence[MeshLike]]:
    """Whether this is a list of meshes, and not vertices with triangles."""
    if not isinstance(meshes, Sequence) or isinstance(meshes, (str, bytes)):
        return False
    return len(meshes) != 2 or not _is_rows(meshes[0])


def _is_rows(value: Any) -> bool:
    """Whether this is a matrix of numbers, as vertices are."""
    try:
        return np.ndim(value) == 2
    except ValueError:  # lists of different lengths
        return False


def _layers(value: Any, name: str) -> int:
    bits = integer(value, name, bits=64)
    if not 0 <= bits <= _ALL_LAYERS:
        raise InvalidOption(f"{name} is {bits}, but must be 0 to 2^32 - 1: a bit for each layer")
    return bits


def _object(value: Any, name: str) -> int:
    index = integer(value, name)
    if index < 0:
        raise InvalidOption(f"{name} is {index}, but objects count from 0")
    return index


def _place(transform: Any) -> FloatArray:
    """(3, 4): a rotation, and beside it a translation."""
    if isinstance(transform, (tuple, list)) and len(transform) == 2:
        rotation, translation = matrix(transform[0], "transform[0]"), triple(transform[1], "transform[1]")
        rows = np.column_stack([rotation, translation])
    else:
        rows = as_array(transform, "transform")
        if rows.dtype.kind not in "fiu":
            raise TypeError(f"transform must hold real numbers, not {rows.dtype}")
        if rows.shape not in ((4, 4), (3, 4)):
            raise ValueError(
                f"transform has the shape {rows.shape}, but must have (4, 4) or (3, 4), or be a pair "
                "(rotation (3, 3), translation (3,))"
            )
        if len(rows) == 4 and rows[3].tolist() != [0, 0, 0, 1]:
            raise InvalidOption(f"the last row of transform is {rows[3].tolist()}, but must be [0, 0, 0, 1]")
    if not np.isfinite(rows).all():
        raise InvalidOption("transform holds numbers that are not finite")
    return np.ascontiguousarray(rows[:3], dtype=np.float64)


def _triangles(value: Any, name: str) -> FloatArray:
    array = as_array(value, name)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{name} must hold real numbers, not {array.dtype}")
    if array.ndim != 3 or array.shape[1:] != (3, 3):
        raise ValueError(f"{name} has the shape {array.shape}, but must have (n, 3, 3)")
    return np.ascontiguousarray(array, dtype=np.float64)
