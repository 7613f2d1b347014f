"""Motions that are proven free of contact."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, Unpack, cast

import numpy as np

from . import _core
from ._arguments import FloatArray, Integer, Real, integer, number, triple
from ._errors import InvalidOption
from ._mesh import Mesh, MeshLike, as_mesh
from ._options import takes
from ._progress import Progress, reporting
from ._rigid import as_place, as_pose, is_seven, numbers_of_pose
from ._structs import (
    CertifiedMotion,
    CertifiedPath,
    MotionClearance,
    MotionContact,
    MotionOptions,
    PathCertificate,
    PathOptions,
)

__all__ = ["MotionCertifier", "certify_motion", "verify_path"]


def _is_list_of_meshes(given: Any) -> bool:
    """Returns True for a list of meshes. A list of vertices and triangles is one mesh."""

    def is_mesh(one: Any) -> bool:
        return isinstance(one, (Mesh, str, os.PathLike, tuple)) or hasattr(one, "vertices") or hasattr(one, "points")

    return isinstance(given, list) and all(map(is_mesh, given))


def _meshes(given: Any) -> list[Mesh]:
    """Returns one mesh, or those of a list, as a list."""
    if _is_list_of_meshes(given):
        return [as_mesh(each) for each in given]
    return [as_mesh(given)]


def _place(pose: Any, name: str) -> FloatArray:
    """Returns a pose as (3, 4)."""
    return as_pose(pose, name) if is_seven(pose) else as_place(pose)


def _body_number(value: Any, name: str) -> int:
    index = integer(value, name)
    if index < 0:
        raise InvalidOption(f"{name} is {index}, but bodies are numbered from 0")
    return index


class MotionCertifier:
    """Certifies motions of bodies among obstacles that rest.

    It keeps copies of the meshes. Each body is compared with all obstacles and with the other bodies. Only surfaces
    count: a body inside the solid of an obstacle does not meet it.

    If one mesh is given as body, methods take one pose and one centre. If a list is given, they take a list of poses
    and a list of centres: one for each body.

    Parameters
    ----------
    body : mesh, or list of meshes
        Any triangles, segments and points.
    obstacles : mesh, or list of meshes
        They may be an empty list if there are several bodies.
    threads
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> certifier = blum.MotionCertifier(blum.generate("box"), blum.generate("sphere"))
    >>> turn = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    >>> start, goal = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [3, 0, 0]), (turn, [0, 3, 0])
    >>> certifier.certify(start, goal).verdict
    'free'
    >>> certifier.certify(start, goal, clearance=0.7).verdict
    'too_close'
    """

    def __init__(self, body: MeshLike | list[Any], obstacles: MeshLike | list[Any], *, threads: int = 0) -> None:
        bodies, fixed = _meshes(body), _meshes(obstacles)
        self._is_list = _is_list_of_meshes(body)
        self._shown = f"MotionCertifier({bodies if self._is_list else bodies[0]!r}, {fixed!r})"
        self._certifier = _core.MotionCertifier(
            [each._arrays for each in bodies], [each._arrays for each in fixed], integer(threads, "threads")
        )

    def __repr__(self) -> str:
        return self._shown

    def __len__(self) -> int:
        """Returns the number of bodies."""
        return int(self._certifier.size())

    def exclude(self, body: Integer, other_body: Integer | None = None) -> None:
        """Excludes a pair of bodies from comparisons, for example neighbouring links of an arm.

        Parameters
        ----------
        body, other_body : int
            Numbers of the bodies, from 0. Without `other_body`, the body is not compared with the obstacles.
        """
        first = _body_number(body, "body")
        if other_body is None:
            self._certifier.exclude_obstacles(first)
        else:
            self._certifier.exclude(first, _body_number(other_body, "other_body"))

    def _places(self, poses: Any, name: str) -> FloatArray:
        """Returns poses as (bodies, 3, 4)."""
        each = list(poses) if self._is_list else [poses]
        if len(each) != len(self):
            raise InvalidOption(f"{name} holds {len(each)} poses, but there are {len(self)} bodies; give one for each")
        return np.stack([_place(pose, name) for pose in each])

    def _poses_at(self, poses_at: Callable[[float], Any], time: float) -> FloatArray:
        """Returns the poses that a function gives, as (bodies, 3, 4)."""
        poses = np.ascontiguousarray(poses_at(time), dtype=np.float64)
        if poses.shape != (len(self), 3, 4) and not (len(self) == 1 and poses.shape == (3, 4)):
            raise InvalidOption(
                f"poses_at({time:g}) has the shape {poses.shape}, but must have ({len(self)}, 3, 4): one pose a body"
            )
        return poses.reshape(len(self), 3, 4)

    def _centres(self, centre: Any) -> FloatArray:
        """Returns centres as (bodies, 3)."""
        if centre is None:
            return np.array([self._certifier.centre(body) for body in range(len(self))])
        each = list(centre) if self._is_list else [centre]
        if len(each) != len(self):
            raise InvalidOption(f"centre holds {len(each)} points, but there are {len(self)} bodies; give one for each")
        return np.array([triple(one, "centre") for one in each])

    @takes("MotionOptions")
    def certify(
        self, start: Any, goal: Any, *, centre: Any = None, **options: Unpack[MotionOptions]
    ) -> CertifiedMotion:
        """Returns a proof that a motion keeps its clearance, or the first time at which it may not.

        The centre of each body moves along a straight line. The body turns about it, by at most 180 degrees, at a
        constant speed. The proof holds for all times between the poses, not only for samples.

        Parameters
        ----------
        start, goal
            Poses: arrays (3, 4) or (4, 4), or pairs of a rotation (3, 3) and a translation (3,). A list of seven
            numbers x, y, z, qw, qx, qy, qz is a pose, too.
        centre : 3 numbers, optional
            Centre of the rotation, in the coordinates of the body. Default: the middle of its box.
        **options
        """
        if self._is_list:
            found: CertifiedMotion = self._certifier.certify_all(
                self._places(start, "start"), self._places(goal, "goal"), self._centres(centre), dict(options)
            )
            return found
        x, y, z = self._certifier.centre(0) if centre is None else triple(centre, "centre")
        return self._certify(_place(start, "start"), _place(goal, "goal"), (x, y, z), dict(options))

    @takes("MotionOptions")
    def certify_poses(
        self, poses_at: Callable[[float], Any], speeds: Any, *, errors: Any = (), **options: Unpack[MotionOptions]
    ) -> CertifiedMotion:
        """Returns a proof that a motion of any kind keeps its clearance, or the first time at which it may not.

        Parameters
        ----------
        poses_at : callable
            Takes a time from 0 to 1, and returns the pose of each body at this time, as an array (bodies, 3, 4).
        speeds : floats
            For each body: no point of the body moves faster, mesh units per unit of time. The proof relies on them.
        errors : floats, optional
            For each body: error of the positions that the poses give, mesh units. Default: 0.
        **options

        Examples
        --------
        A rod that swings about its end, which is the origin.

        >>> import blum, numpy as np
        >>> rod = blum.generate("box").vertices * [4, 0.2, 0.2] + [2, 0, 0], blum.generate("box").triangles
        >>> def swing(time):
        ...     c, s = np.cos(2 * time), np.sin(2 * time)
        ...     return np.array([[[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0]]])
        >>> post = blum.generate("box").vertices + [0, 6, 0], blum.generate("box").triangles
        >>> blum.MotionCertifier(rod, post).certify_poses(swing, [8.1]).verdict
        'free'
        """
        found: CertifiedMotion = self._certifier.certify_poses(
            lambda time: self._poses_at(poses_at, time),
            [number(each, "speeds") for each in speeds],
            [number(each, "errors") for each in errors],
            dict(options),
        )
        return found

    def clearance(self, start: Any, goal: Any, *, centre: Any = None, tolerance: Real = 0.05) -> MotionClearance:
        """Returns bounds of the smallest distance during a motion.

        Parameters
        ----------
        start, goal, centre
            As for :meth:`certify`.
        tolerance : float
            Largest difference of the bounds, relative to the upper one: above 0, below 1.

        Examples
        --------
        >>> import blum
        >>> identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> certifier = blum.MotionCertifier(blum.generate("box"), blum.generate("box"))
        >>> found = certifier.clearance((identity, [-5, 3, 0]), (identity, [5, 3, 0]))
        >>> 1.9 <= found.at_least <= found.at_most <= 2.1
        True
        """
        found: MotionClearance = self._certifier.clearance(
            self._places(start, "start"),
            self._places(goal, "goal"),
            self._centres(centre),
            number(tolerance, "tolerance"),
        )
        return found

    def first_contact(
        self, start: Any, goal: Any, *, centre: Any = None, tolerance: Real = 1e-9
    ) -> MotionContact | None:
        """Returns the first contact during a motion along arcs, or None if the surfaces never meet. It is never late.

        Parameters
        ----------
        start, goal, centre
            As for :meth:`certify`.
        tolerance : float
            Wanted difference of `earliest` and `latest`: above 0, at most 1.

        Examples
        --------
        >>> import blum
        >>> identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> certifier = blum.MotionCertifier(blum.generate("box"), blum.generate("box"))
        >>> found = certifier.first_contact((identity, [-5, 0, 0]), (identity, [5, 0, 0]))
        >>> round(found.earliest, 9)
        0.4
        """
        found: Any = self._certifier.first_contact(
            self._places(start, "start"),
            self._places(goal, "goal"),
            self._centres(centre),
            number(tolerance, "tolerance"),
        )
        return cast("MotionContact | None", found)

    @takes("PathOptions")
    def certify_path(
        self, poses: Any, *, centre: Any = None, progress: Progress = False, **options: Unpack[PathOptions]
    ) -> CertifiedPath:
        """Returns a proof that a path through waypoints keeps its clearance, or the first motion that may not.

        Parameters
        ----------
        poses
            Poses of the body at the waypoints, as for :meth:`certify`. For a list of bodies: a list of poses at each
            waypoint.
        centre
            As for :meth:`certify`.
        progress
            As for :func:`distance_field`.
        **options

        Examples
        --------
        >>> import blum
        >>> identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        >>> certifier = blum.MotionCertifier(blum.generate("box"), blum.generate("box"))
        >>> proof = certifier.certify_path([(identity, place) for place in ([-3, 0, 0], [0, 3, 0], [3, 0, 0])])
        >>> proof.verdict, proof.at_least > 0.5
        ('free', True)
        """
        if len(poses) == 0:
            raise InvalidOption("poses are empty; give the pose of at least one waypoint")
        places = np.stack([self._places(each, f"poses[{k}]") for k, each in enumerate(poses)])
        with reporting(progress) as report:
            found: CertifiedPath = self._certifier.certify_path(places, self._centres(centre), dict(options), report)
        return found

    def _certify(
        self, start: FloatArray, goal: FloatArray, centre: tuple[float, float, float], options: dict[str, Any]
    ) -> CertifiedMotion:
        """Certifies a motion between poses (3, 4). Planners call it for each edge, so it checks no types."""
        found: CertifiedMotion = self._certifier.certify(start, goal, *centre, options)
        return found


def verify_path(
    poses: Any,
    body: MeshLike | list[Any],
    obstacles: MeshLike | list[Any],
    *,
    centre: Any = None,
    clearance: Real = 0.0,
    progress: Progress = False,
) -> PathCertificate:
    """Checks that a path keeps its clearance, with code that is independent of :class:`MotionCertifier`.

    It is the check of ``blum verify``, for example for the path of another planner.

    Parameters
    ----------
    poses
        Poses of the body at the waypoints: x, y, z, qw, qx, qy, qz; or as for :meth:`MotionCertifier.certify`. For a
        list of bodies: a list of poses at each waypoint.
    body, obstacles
        As for :class:`MotionCertifier`.
    centre : 3 numbers, optional
        Point of the body that moves along straight lines, in the coordinates of the body. For a list of bodies: a list.
        Default: the middle of its box.
    clearance : float
        Distance that the surfaces must keep, mesh units.
    progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> around = [[-3, 0, 0, 1, 0, 0, 0], [0, 3, 0, 1, 0, 0, 0], [3, 0, 0, 1, 0, 0, 0]]
    >>> blum.verify_path(around, blum.generate("box"), blum.generate("box"), clearance=0.5).holds
    True
    >>> blum.verify_path(around[::2], blum.generate("box"), blum.generate("box")).mismatches[0][:28]
    'motion 0 at time 0.5: the di'
    """
    is_list = _is_list_of_meshes(body)
    bodies, fixed = _meshes(body), _meshes(obstacles)

    def of_bodies(one: Any, name: str) -> list[Any]:
        each = list(one) if is_list else [one]
        if len(each) != len(bodies):
            raise InvalidOption(f"{name} has {len(each)} entries for {len(bodies)} bodies; give one for each body")
        return each

    waypoints = [
        [numbers_of_pose(pose, f"poses[{k}]") for pose in of_bodies(one, f"poses[{k}]")] for k, one in enumerate(poses)
    ]
    if centre is None:
        centres = [0.5 * (each.vertices.min(axis=0) + each.vertices.max(axis=0)) for each in bodies]
    else:
        centres = [triple(one, "centre") for one in of_bodies(centre, "centre")]
    with reporting(progress) as report:
        found: PathCertificate = _core.verify_path(
            [each._arrays for each in bodies],
            [each._arrays for each in fixed],
            np.array(waypoints, dtype=np.float64).reshape(len(waypoints), len(bodies), 7),
            np.array(centres, dtype=np.float64),
            number(clearance, "clearance"),
            report,
        )
    return found


@takes("MotionOptions")
def certify_motion(
    body: MeshLike,
    obstacles: MeshLike,
    start: Any,
    goal: Any,
    *,
    centre: Any = None,
    threads: int = 0,
    **options: Unpack[MotionOptions],
) -> CertifiedMotion:
    """Returns a proof that a motion among obstacles keeps its clearance, or the first place where it may not.

    See :meth:`MotionCertifier.certify`. For many motions, :class:`MotionCertifier` is faster.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points. Only surfaces count.
    start, goal
        Poses: arrays (3, 4) or (4, 4), or pairs of a rotation (3, 3) and a translation (3,). A list of seven numbers x,
        y, z, qw, qx, qy, qz is a pose, too.
    centre : 3 numbers, optional
        Centre of the rotation, in the coordinates of the body. Default: the middle of its box.
    threads
        As for :func:`distance_field`.
    **options

    Examples
    --------
    >>> import blum
    >>> identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> box, sphere = blum.generate("box"), blum.generate("sphere")
    >>> found = blum.certify_motion(box, sphere, (identity, [-5, 0, 0]), (identity, [5, 0, 0]))
    >>> found.verdict, round(10 * found.free_until - 5, 3)
    ('colliding', -1.5)
    """
    certifier = MotionCertifier(body, obstacles, threads=threads)
    return certifier.certify(start, goal, centre=centre, **options)
