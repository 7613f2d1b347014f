"""Planning with OMPL, where every motion is proven free.

:func:`setup` returns a problem of OMPL whose motions are certified. All planners of OMPL then work on proven edges:

    import blum.ompl
    from ompl import geometric

    problem = blum.ompl.setup(body, obstacles, clearance=0.01)
    problem.set_poses(start, goal)
    problem.setPlanner(geometric.PRM(problem.getSpaceInformation()))
    problem.solve(10.0)
    poses = problem.poses()

This module needs OMPL's package for Python, version 2 (``pip install ompl``). ``import blum`` does not import it.
"""

from __future__ import annotations

import itertools
import signal
import threading
from typing import Any

import numpy as np

from ._arguments import FloatArray, Real
from ._errors import InvalidOption
from ._mesh import MeshLike
from ._moving_body import MovingBody, pose_of
from ._rigid import as_pose, quaternion_of, rotation_of
from ._structs import CertifiedMotion

try:
    from ompl import base, geometric, util
except ImportError as error:
    raise ImportError("blum.ompl needs OMPL's package for Python, version 2: pip install ompl") from error

__all__ = [
    "CertifiedMotionValidator",
    "ClearanceChecker",
    "ClearanceSampler",
    "Problem",
    "RigidBody",
    "search",
    "setup",
]


class RigidBody(MovingBody):
    """Body of a planning problem: converts states of OMPL to poses, and certifies motions between them.

    The position of a state is the position of the body's centre. OMPL moves it along a straight line and turns the
    body about it at a constant speed. This is the motion that :class:`blum.MotionCertifier` certifies.

    Its arguments are those of :func:`setup`, but not `bounds`. A further one is `centre`: 3 numbers, in the coordinates
    of the body. Its default is the middle of the body's box. With `rotation`, the space of states has three dimensions.
    """

    def pose(self, state: Any) -> FloatArray:
        """Returns the pose (3, 4) of a state, which maps the body to the scene."""
        if self.rotation is not None:
            return pose_of(self.centre, self.rotation, np.array((state[0], state[1], state[2])))
        turn = state.rotation()
        rows = rotation_of(turn.w, turn.x, turn.y, turn.z)
        a, b, c = self.centre
        out = [
            (*row, at - (row[0] * a + row[1] * b + row[2] * c))
            for row, at in zip(rows, (state.getX(), state.getY(), state.getZ()), strict=True)
        ]
        return np.array(out)

    def fill(self, state: Any, pose: FloatArray) -> None:
        """Sets a state to a pose (3, 4)."""
        place = self.place(pose)
        if self.rotation is not None:
            state[0], state[1], state[2] = map(float, place)
            return
        state.setXYZ(*map(float, place))
        turn = state.rotation()
        turn.w, turn.x, turn.y, turn.z = quaternion_of(pose[:, :3])

    def certify(self, first: Any, second: Any) -> CertifiedMotion:
        """Returns what is proven of the motion between two states."""
        return self.certify_poses(self.pose(first), self.pose(second))


class ClearanceChecker(base.StateValidityChecker):  # type: ignore[misc]
    """Validity checker for OMPL: a state is valid if the body keeps its clearance there."""

    def __init__(self, information: Any, body: RigidBody) -> None:
        super().__init__(information)
        self._body = body

    def isValid(self, state: Any) -> bool:
        """Returns True if the body is further from the obstacles than the clearance."""
        return self._body.is_free(self._body.pose(state))

    def clearance(self, state: Any) -> float:
        """Returns the distance between the body and the obstacles, mesh units."""
        return float(self._body.separation(self._body.pose(state)).distance)


class CertifiedMotionValidator(base.MotionValidator):  # type: ignore[misc]
    """Motion validator for OMPL: a motion is valid if it is proven to keep the clearance at all times.

    OMPL's package for Python does not pass on the last valid state. :meth:`free_until` returns its time.
    """

    def __init__(self, information: Any, body: RigidBody) -> None:
        super().__init__(information)
        self._body = body
        self.motions = 0  #: Motions that were certified or refused.

    def checkMotion(self, first: Any, second: Any, *last_valid: Any) -> bool:
        """Returns True if the motion is proven."""
        self.motions += 1
        return self._body.certify(first, second).verdict == "free"

    def free_until(self, first: Any, second: Any) -> float:
        """Returns the time, 0 to 1, until which the motion is proven."""
        return self._body.certify(first, second).free_until


class ClearanceSampler(base.ValidStateSampler):  # type: ignore[misc]
    """Sampler of valid states for OMPL. It finds more states in narrow places than uniform samples do.

    For each four states, two are uniform. One is the middle of two states that are not valid (Hsu et al. 2003). One has
    moved away from the closest obstacle until another one is as close (Wilmarth, Amato and Stiller 1999). Planners that
    ask for valid states use it, for example PRM and BKPIECE. RRTs do not.
    """

    def __init__(self, information: Any, body: RigidBody) -> None:
        super().__init__(information)
        self._body = body
        self._space = information.getStateSpace()
        self._sampler = information.allocStateSampler()
        self._other = self._space.allocState()
        self._calls = 0

    def sample(self, state: Any) -> bool:
        """Sets a state to a valid one. Returns False if none was found."""
        self._calls += 1
        attempts = self.getNrAttempts()
        for attempt in range(attempts):
            self._sampler.sampleUniform(state)
            if self._place(state, self._calls % 4 if 2 * attempt < attempts else 0):
                return True
        return False

    def sampleNear(self, state: Any, near: Any, distance: float) -> bool:
        """Sets a state to a valid one within a distance of another state. Returns False if none was found."""
        for _ in range(self.getNrAttempts()):
            self._sampler.sampleUniformNear(state, near, distance)
            if self._is_valid(state):
                return True
        return False

    def _place(self, state: Any, kind: int) -> bool:
        """Moves a state to a narrow place, as its kind asks for. Returns True if it is valid."""
        valid = self._is_valid(state)
        if kind == 1 and valid:
            self._ascend(state)
        if kind != 2:
            return valid
        if valid:
            return False
        self._sampler.sampleUniformNear(self._other, state, 4 * self._body.radius)
        if self._is_valid(self._other):
            return False
        self._space.interpolate(state, self._other, 0.5, state)
        return self._is_valid(state)

    def _is_valid(self, state: Any) -> bool:
        return self._space.satisfiesBounds(state) and self._body.is_free(self._body.pose(state))

    def _ascend(self, state: Any, steps: int = 8) -> None:
        """Moves a valid state away from the obstacles while their distance grows."""
        pose = self._body.pose(state)
        here = self._body.separation(pose)
        step = here.distance
        for _ in range(steps):
            away = np.subtract(here.closest[1], here.closest[0])
            pose = pose.copy()
            pose[:, 3] += step / here.distance * away
            there = self._body.separation(pose)
            if there.distance <= here.distance:
                return
            self._body.fill(self._other, pose)
            if not self._space.satisfiesBounds(self._other):
                return
            self._body.fill(state, pose)
            here = there


class Problem(geometric.SimpleSetup):  # type: ignore[misc]
    """Planning problem of a rigid body, whose motions are certified: see :func:`setup`."""

    def __init__(self, body: RigidBody, bounds: Any = None) -> None:
        """`bounds` are those of :func:`setup`."""
        space = _space_of(body, bounds)
        super().__init__(space)
        self.rigid_body = body
        information = self.getSpaceInformation()
        self.validator = CertifiedMotionValidator(information, body)
        self.checker = ClearanceChecker(information, body)
        information.setStateValidityChecker(self.checker)
        information.setMotionValidator(self.validator)
        information.setValidStateSamplerAllocator(lambda given: ClearanceSampler(given, body))

    def state(self, pose: Any) -> Any:
        """Returns the state of a pose, given as for :func:`blum.plan`."""
        made = self.getStateSpace().allocState()
        self.rigid_body.fill(made, as_pose(pose, "pose"))
        return made

    def pose(self, state: Any) -> FloatArray:
        """Returns the pose (3, 4) of a state."""
        return self.rigid_body.pose(state)

    def set_poses(self, start: Any, goal: Any) -> None:
        """Sets the start and the goal, for which the centre of the body must be in the bounds."""
        states = self.state(start), self.state(goal)
        for name, state in zip(("start", "goal"), states, strict=True):
            if not self.getStateSpace().satisfiesBounds(state):
                raise InvalidOption(f"{name}: the centre of the body is outside the bounds")
        self.setStartAndGoalStates(*states)

    def poses(self, path: Any = None) -> FloatArray:
        """Returns the poses (n, 3, 4) of a path of OMPL. Default: the solution."""
        states = (self.getSolutionPath() if path is None else path).getStates()
        return np.array([self.pose(state) for state in states]).reshape(-1, 3, 4)

    def certify(self, poses: Any) -> list[CertifiedMotion]:
        """Returns what is proven of the motions between poses (n, 3, 4), one entry for each motion.

        The bounds are a quarter of the search's, so that rounding does not refuse what the search has proven.
        """
        delta = self.rigid_body.delta / 4
        return [self.rigid_body.certify_poses(*pair, delta=delta) for pair in itertools.pairwise(poses)]


def _space_of(body: RigidBody, bounds: Any) -> Any:
    """Returns the space of the body's states. A turn counts as the way of the body's furthest point."""
    low, high = body.bounds(bounds)
    limits = base.RealVectorBounds(3)
    limits.low, limits.high = list(low), list(high)
    if body.rotation is not None:
        line = base.RealVectorStateSpace(3)
        line.setBounds(limits)
        return line
    space = base.SE3StateSpace()
    space.setBounds(limits)
    space.setSubspaceWeight(1, 2 * body.radius)  # OMPL's distance of rotations is half their angle.
    return space


def setup(
    body: MeshLike,
    obstacles: MeshLike,
    *,
    clearance: Real = 0.0,
    delta: Real | None = None,
    bounds: Any = None,
    rotation: Any = None,
    threads: int = 0,
) -> Problem:
    """Returns a problem of OMPL (a `SimpleSetup`) with certified motions, a validity checker and a sampler.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points. Only surfaces count.
    clearance, delta : float
        As for :meth:`blum.MotionCertifier.certify`, mesh units. Default of `delta`: 1e-4 of the size of the body.
    bounds : pair of corners, optional
        Box in which the centre of the body may be. Default: a box around the obstacles in which the body fits on each
        side.
    rotation : (3, 3) array, optional
        If given, the body keeps this rotation.
    threads
        As for :func:`blum.distance_field`.

    Examples
    --------
    >>> import blum, blum.ompl
    >>> from ompl import geometric, util
    >>> util.setLogLevel(util.LOG_WARN)
    >>> problem = blum.ompl.setup(blum.generate("box"), blum.generate("sphere"), clearance=0.1)
    >>> problem.set_poses([-2.5, 0, 0, 1, 0, 0, 0], [2.5, 0, 0, 1, 0, 0, 0])
    >>> problem.setPlanner(geometric.RRTConnect(problem.getSpaceInformation()))
    >>> bool(problem.solve(10.0))
    True
    >>> {motion.verdict for motion in problem.certify(problem.poses())}
    {'free'}
    """
    made = RigidBody(body, obstacles, clearance=clearance, delta=delta, rotation=rotation, threads=threads)
    return Problem(made, bounds)


def search(
    body: RigidBody, ends: tuple[FloatArray, FloatArray], bounds: Any, time: float, seed: int, planner: str
) -> tuple[FloatArray, int, str]:
    """Searches for a path with a planner of OMPL: :func:`blum.plan` without checks of its arguments.

    Returns the poses (n, 3, 4) of the path, or no rows. The other results are the number of the planner's states, and
    how close it came to the goal.
    """
    level = util.getLogLevel()
    util.setLogLevel(util.LOG_NONE)  # OMPL reports an error for each seed but the first, although it uses the seed.
    try:
        util.RNG.setSeed(seed + 1)
        problem = Problem(body, bounds)
        problem.set_poses(*ends)
        problem.setPlanner(getattr(geometric, planner)(problem.getSpaceInformation()))
        _solve(problem, time)
        states = base.PlannerData(problem.getSpaceInformation())
        problem.getPlannerData(states)
        count = states.numVertices()
    finally:
        util.setLogLevel(level)
    if problem.haveExactSolutionPath():
        poses = problem.poses()
        poses[0], poses[-1] = ends
        return poses, count, ""
    nearest = "its states do not come close to the goal"
    if problem.haveSolutionPath():
        last = problem.poses()[-1]
        nearest = f"its closest approach is {body.way(last, ends[1]):.6g} from the goal"
    return np.empty((0, 3, 4)), count, nearest


def _solve(problem: Problem, time: float) -> None:
    """Solves a problem. Ctrl-C ends the search first: PRM ends the process if an exception passes through it."""
    limit = base.timedPlannerTerminationCondition(time)
    pressed: list[int] = []

    def stop(number: int, _: Any) -> None:
        pressed.append(number)
        limit.terminate()

    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or before in (None, signal.SIG_IGN):
        problem.solve(limit)
        return
    signal.signal(signal.SIGINT, stop)
    try:
        problem.solve(limit)
    finally:
        signal.signal(signal.SIGINT, before)
    if pressed:
        raise KeyboardInterrupt
