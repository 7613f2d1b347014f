"""Paths of rigid bodies among obstacles, of which every motion is proven free."""

from __future__ import annotations

import importlib
import itertools
import time as clock
import warnings
from dataclasses import dataclass
from typing import Any, Literal, cast, get_args

import numpy as np

from ._arguments import FloatArray, Integer, Real, integer, number
from ._closest import winding_number
from ._errors import InputWarning, InvalidOption
from ._mesh import Mesh, MeshLike, topology
from ._methods import Shown
from ._moving_body import MovingBody, between
from ._rigid import as_pose
from ._sliding_planner import search as sliding_search

__all__ = ["PlannedPath", "plan"]

_Planner = Literal["sliding", "rrt_connect", "rrt", "prm", "kpiece", "bkpiece", "lbkpiece", "rrt_star"]
_CLASSES = {
    "rrt_connect": "RRTConnect",
    "rrt": "RRT",
    "prm": "PRM",
    "kpiece": "KPIECE1",
    "bkpiece": "BKPIECE1",
    "lbkpiece": "LBKPIECE1",
    "rrt_star": "RRTstar",
}
_PER_MOTION = 20  # Shortcuts that are tried for each motion of a path.
_TESTS = 20000  # Tests of distances for shortcuts. Counts do not depend on the machine, unlike seconds.


@dataclass(frozen=True, repr=False)
class PlannedPath(Shown):
    """Path of a body, of which every motion is proven to keep the clearance. See :func:`plan`.

    Examples
    --------
    >>> import blum
    >>> path = blum.plan(
    ...     blum.generate("box"), blum.generate("sphere"), [-3, 0, 0, 1, 0, 0, 0], [3, 0, 0, 1, 0, 0, 0], clearance=0.1
    ... )
    >>> path.proven, path.at(0).tolist() == path.poses[0].tolist()
    (True, True)
    """

    #: Poses (n, 3, 4), from the start to the goal. Between them, the body moves as :meth:`MotionCertifier.certify`
    #: describes. Without rows if no path was found.
    poses: FloatArray
    proven: bool  #: True if a path was found. Then all its motions are proven.
    clearance: float  #: Distance that is kept, mesh units.
    centre: tuple[float, float, float]  #: Centre of the motions, in the coordinates of the body.
    length: float  #: Way of the centre, mesh units.
    planner: str
    states: int  #: States of the planner's trees or roadmap.
    seconds: float
    reason: str  #: Why there is no path. Empty if there is one.

    def at(self, time: Real) -> FloatArray:
        """Returns the pose (3, 4) at a time. At the times 0, 1, 2, ..., it is poses[0], poses[1], poses[2], ...

        Parameters
        ----------
        time : float
            0 to n - 1, for n poses.
        """
        chosen = number(time, "time")
        if not 0 <= chosen <= len(self.poses) - 1:
            raise InvalidOption(f"time is {chosen}, but must be 0 to {len(self.poses) - 1}")
        place = min(int(chosen), max(len(self.poses) - 2, 0))
        if chosen in (place, place + 1):
            return cast(FloatArray, self.poses[int(chosen)].copy())
        return between(self.centre, self.poses[place], self.poses[place + 1], chosen - place)


def plan(
    body: MeshLike,
    obstacles: MeshLike,
    start: Any,
    goal: Any,
    *,
    clearance: Real = 0.0,
    delta: Real | None = None,
    bounds: Any = None,
    time: Real = 10.0,
    seed: Integer = 0,
    planner: _Planner = "rrt_connect",
    rotate: bool = True,
    allow_inside: bool = False,
    threads: int = 0,
) -> PlannedPath:
    """Searches for a path of a rigid body among obstacles. Every motion of the path is proven free, not only samples.

    OMPL searches (``pip install ompl``). The planner "sliding" needs no OMPL: its trees slide along the obstacles, and
    begin also in narrow gaps between them. If no path is found in time, the result says so. This does not prove that
    there is none.

    Equal arguments give the same path, if the search ends before its time. The planner "rrt_star" uses all of the time,
    so its paths may differ. The planners of OMPL seed its generator, which the whole process shares.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points. Only surfaces count.
    start, goal
        Poses, which map the body to the scene: x, y, z, qw, qx, qy, qz; or as for :func:`certify_motion`.
    clearance : float
        Distance that the body must keep, mesh units.
    delta : float, optional
        Motions that come closer than the clearance plus this distance may be refused, mesh units. Default: 1e-4 of the
        size of the body.
    bounds : pair of corners, optional
        Box in which the centre of the body's box may be. Default: a box around the obstacles, the start and the goal,
        in which the body fits on each side.
    time : float
        Seconds for the search. The path is then shortened, with a number of tries that depends on its poses.
    seed : int
        0 to 2^32 - 2.
    planner : str
        "sliding", or a planner of OMPL.
    rotate : bool
        False: the body only translates. Start and goal must have the same rotation.
    allow_inside : bool
        True: the start may be inside the solid of a closed obstacle, for example in a room whose walls are one surface.
    threads
        As for :func:`distance_field`.

    Raises
    ------
    InvalidOption
        If the body is too close to the obstacles, or inside one of them, at the start or the goal. The message states
        the place.

    Examples
    --------
    >>> import blum
    >>> path = blum.plan(
    ...     blum.generate("box"), blum.generate("sphere"), [-3, 0, 0, 1, 0, 0, 0], [3, 0, 0, 1, 0, 0, 0], clearance=0.1
    ... )
    >>> path.proven, path.clearance, path.reason
    (True, 0.1, '')
    """
    began = clock.perf_counter()
    if planner not in get_args(_Planner):
        raise InvalidOption(f"planner is {planner!r}, but must be one of {', '.join(get_args(_Planner))}")
    limit, chosen = number(time, "time"), integer(seed, "seed", bits=64)
    if not 0 < limit < np.inf or not 0 <= chosen < 2**32 - 1:
        raise InvalidOption(f"time is {limit} and seed is {chosen}, but they must be > 0 and 0 to 2^32 - 2")
    ends = as_pose(start, "start"), as_pose(goal, "goal")
    if not rotate and np.abs(ends[0][:, :3] - ends[1][:, :3]).max() > 1e-9:
        raise InvalidOption("start and goal have different rotations, but rotate=False")
    ompl = None if planner == "sliding" else importlib.import_module("blum.ompl")
    kept = None if rotate else ends[0][:, :3]
    kind = MovingBody if ompl is None else ompl.RigidBody
    moving = kind(body, obstacles, clearance=clearance, delta=delta, rotation=kept, threads=threads)
    for name, pose in zip(("start", "goal"), ends, strict=True):
        _check_end(moving, pose, name, allow_inside)
    corners = _bounds_with_ends(moving, ends, bounds)
    if ompl is None:
        poses, states, nearest = sliding_search(moving, ends, corners, limit, chosen)
    else:
        poses, states, nearest = ompl.search(moving, ends, corners, limit, chosen, _CLASSES[planner])
    found = _proven_path(moving, poses, chosen)
    reason = "" if len(found) else f"no path was found in {limit:g} seconds; {nearest}"
    places = np.array([moving.place(pose) for pose in found]).reshape(-1, 3)
    return PlannedPath(
        poses=found,
        proven=len(found) > 0,
        clearance=moving.clearance,
        centre=moving.centre,
        length=float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum()),
        planner=planner,
        states=states,
        seconds=clock.perf_counter() - began,
        reason=reason,
    )


def _check_end(moving: MovingBody, pose: FloatArray, name: str, allow_inside: bool) -> None:
    """Raises InvalidOption if the body is too close to the obstacles at a pose, or inside one of them."""
    found = moving.certify_poses(pose, pose)
    if found.closest is not None:
        pair = found.closest
        what = "meets the obstacles" if pair.distance == 0 else f"is only {pair.distance:.6g} from the obstacles"
        raise InvalidOption(
            f"{name}: the body {what} at {_shown(pair.on_other)}: primitive {pair.primitive} of the body, "
            f"{pair.other_primitive} of the obstacles; the wanted clearance is {moving.clearance:g}"
        )
    if allow_inside:
        return
    turned = moving.body.vertices @ pose[:, :3].T + pose[:, 3]
    back = (moving.obstacles.vertices - pose[:, 3]) @ pose[:, :3]
    for solid, points, what in (
        (moving.obstacles, turned, "the body is inside the solid of the obstacles"),
        (moving.body, back, "an obstacle is inside the solid of the body"),
    ):
        inside = _first_inside(solid, points)
        if inside is not None:
            raise InvalidOption(f"{name}: {what}, at {_shown(inside)} of it; allow_inside=True permits this")


def _first_inside(mesh: Mesh, points: FloatArray) -> FloatArray | None:
    """Returns the first of some points that is inside a mesh, or None. A mesh that is not closed has no inside."""
    if len(mesh.triangles) == 0 or not topology(mesh).closed:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        inside = np.flatnonzero(np.abs(winding_number(mesh, points)) > 0.5)
    return points[inside[0]] if len(inside) else None


def _shown(point: Any) -> str:
    x, y, z = point
    return f"({x:.6g}, {y:.6g}, {z:.6g})"


def _bounds_with_ends(moving: MovingBody, ends: tuple[FloatArray, FloatArray], given: Any) -> tuple[Any, Any]:
    """Returns the bounds of the centre. Given bounds must contain the start and the goal."""
    low, high = np.array(moving.bounds(given))
    for name, pose in zip(("start", "goal"), ends, strict=True):
        place = moving.place(pose)
        if given is not None and ((place < low) | (place > high)).any():
            raise InvalidOption(
                f"{name}: the centre of the body is at {_shown(place)}, "
                f"but the bounds are {_shown(low)} to {_shown(high)}"
            )
        low, high = np.minimum(low, place - moving.radius), np.maximum(high, place + moving.radius)
    return moving.bounds(given if given is not None else (low, high))


def _proven_path(moving: MovingBody, poses: FloatArray, seed: int) -> FloatArray:
    """Returns a path with a shorter one of it, each of whose motions is certified again. No rows if this fails.

    The bounds are a quarter of the search's, so that rounding does not refuse what the search has proven.
    """
    for path in (_shortened(moving, poses, np.random.default_rng(seed)), poses):
        pairs = itertools.pairwise(path)
        if all(moving.certify_poses(*pair, delta=moving.delta / 4).verdict == "free" for pair in pairs):
            return path
    return poses[:0]


def _shortened(moving: MovingBody, poses: FloatArray, random: np.random.Generator) -> FloatArray:
    """Returns a path in which motions are replaced by shorter ones, all of them certified.

    A try replaces the part between two random places of the path by one motion. Half of the places are poses of it.
    """
    path, tests = list(poses), 0
    for _ in range(_PER_MOTION * max(len(poses) - 1, 0)):
        if tests > _TESTS:
            break
        times = np.sort(random.uniform(0, len(path) - 1, 2))
        if random.random() < 0.5:
            times = np.rint(times)
        i, j = (min(int(time), len(path) - 2) for time in times)
        if i == j:
            continue
        a, b = (moving.between(path[k], path[k + 1], time - k) for k, time in zip((i, j), times, strict=True))
        new = _without_rests(moving, [path[i], a, b, path[j + 1]])
        if _way(moving, new) >= (1 - 1e-6) * _way(moving, path[i : j + 2]):
            continue
        found = [moving.certify_poses(*pair) for pair in itertools.pairwise(new)]
        tests += sum(each.tests for each in found)
        if all(each.verdict == "free" for each in found):
            path[i : j + 2] = new
    return np.array(path).reshape(-1, 3, 4)


def _way(moving: MovingBody, path: list[FloatArray]) -> float:
    return sum(itertools.starmap(moving.way, itertools.pairwise(path)))


def _without_rests(moving: MovingBody, path: list[FloatArray]) -> list[FloatArray]:
    """Returns poses without those that equal the one before, except for rounding. The first and the last one remain."""
    least = 1e-9 * moving.radius
    kept = [path[0]]
    kept += [pose for pose in path[1:-1] if moving.way(kept[-1], pose) > least < moving.way(pose, path[-1])]
    return [*kept, path[-1]]
