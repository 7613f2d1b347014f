"""Search for a path by two trees whose certified motions slide along the obstacles."""

from __future__ import annotations

import math
import time as clock
import warnings
from typing import Any

import numpy as np

from ._arguments import FloatArray
from ._closest import closest_points, winding_number
from ._errors import InputWarning
from ._mesh import Mesh, topology
from ._moving_body import MovingBody, pose_of, turn_between
from ._rigid import quaternion_of, rotation_of

_SLIDES = 8  # Changes of direction in one extension of a tree.
_TREES = 12  # Further trees in narrow places begin while there are fewer.
_ATTEMPTS = 30  # Poses that are tried for a tree in a narrow place.
_GAPS = 20000  # Pairs of places of the obstacles that are tried.
_SAME_TREE = 0.5  # Share of extensions of the trees of the start and the goal.
#: Least and largest distance from the obstacles when sliding, relative to the radius of the body.
_AWAY = math.log(2e-3), math.log(0.05)
#: Longest slide, relative to the distance from the obstacles. The tests of a motion are as many.
_LONGEST = 100.0


_Contact = tuple[FloatArray, FloatArray, float]


class _Trees:
    """Poses that certified motions join to trees. Trees that meet become one tree, with the lower of their numbers."""

    def __init__(self, moving: MovingBody) -> None:
        self._moving = moving
        self._places, self._turns = np.empty((64, 3)), np.empty((64, 4))
        self._tries, self._tree = np.empty(64), np.empty(64, dtype=int)
        self._roots = 0
        self.poses: list[FloatArray] = []
        self.joined: list[list[int]] = []

    def add(self, pose: FloatArray, parent: int | None = None) -> int:
        """Adds a pose, and returns its number. Without a parent, it is a tree of its own."""
        index = len(self.poses)
        if index == len(self._tree):
            for name in ("_places", "_turns", "_tries", "_tree"):
                each = getattr(self, name)
                setattr(self, name, np.concatenate([each, np.empty_like(each)]))
        self._places[index] = self._moving.place(pose)
        self._turns[index] = quaternion_of(pose[:, :3])
        self._tries[index] = 0
        self.poses.append(pose)
        self.joined.append([])
        if parent is None:
            self._tree[index] = self._roots
            self._roots += 1
        else:
            self._tree[index] = self._tree[parent]
            self.join(parent, index)
        return index

    def join(self, first: int, second: int) -> None:
        """Joins two poses by a motion that is certified."""
        self.joined[first].append(second)
        self.joined[second].append(first)
        low, high = sorted((int(self._tree[first]), int(self._tree[second])))
        if low != high:
            used = self._tree[: len(self.poses)]
            used[used == high] = low

    def tree_of(self, index: int) -> int:
        return int(self._tree[index])

    def numbers(self) -> list[int]:
        """Returns the numbers of all trees."""
        return [int(tree) for tree in np.unique(self._tree[: len(self.poses)])]

    def nearest(self, pose: FloatArray, tree: int, *, other: bool = False) -> tuple[int, float]:
        """Returns the pose of a tree, or of the other trees, from which the way is shortest, and this way."""
        count = len(self.poses)
        of_tree = np.flatnonzero((self._tree[:count] == tree) != other)
        turns = np.abs(self._turns[of_tree] @ np.array(quaternion_of(pose[:, :3])))
        away = self._places[of_tree] - self._moving.place(pose)
        way = np.sqrt(np.einsum("ij,ij->i", away, away)) + 2 * self._moving.radius * np.arccos(np.minimum(turns, 1))
        best = int(np.argmin(way))
        return int(of_tree[best]), float(way[best])

    def rarely_tried(self, tree: int, random: np.random.Generator) -> int:
        """Returns the number of a pose of a tree that few extensions started from."""
        of_tree = np.flatnonzero(self._tree[: len(self.poses)] == tree)
        some = of_tree[random.integers(0, len(of_tree), 6)]
        chosen = int(some[np.argmin(self._tries[some])])
        self._tries[chosen] += 1
        return chosen

    def path(self, start: int, goal: int) -> FloatArray:
        """Returns the poses between two poses of a tree."""
        before, queue = {goal: goal}, [goal]
        for index in queue:
            for after in self.joined[index]:
                if after not in before:
                    before[after] = index
                    queue.append(after)
        out = [start]
        while out[-1] != goal:
            out.append(before[out[-1]])
        return np.array([self.poses[index] for index in out])


def _principal_axes(vertices: FloatArray) -> FloatArray:
    """Returns the principal axes of points, as rows."""
    away = vertices - vertices.mean(axis=0)
    axes: FloatArray = np.linalg.svd(away.T @ away)[2]
    return axes


def _gaps(moving: MovingBody, random: np.random.Generator) -> tuple[FloatArray, ...]:
    """Returns the middles of gaps between close places of the obstacles, directions across the gaps, and weights.

    The weights sum to 1. Narrow gaps have large ones.
    """
    first, second = (_points_on_edges(moving.obstacles, random, _GAPS) for _ in range(2))
    across, middles = second - first, (first + second) / 2
    widths = np.linalg.norm(across, axis=1)
    thin = 0.5 * float(np.ptp(moving.body.vertices @ _principal_axes(moving.body.vertices).T, axis=0).min())
    room = closest_points(moving.obstacles, middles, sign="none").distance
    chosen = (widths < 4 * moving.radius) & (room > 0.3 * widths) & (room > 0.5 * thin)
    if len(moving.obstacles.triangles) and topology(moving.obstacles).closed:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            chosen &= np.abs(winding_number(moving.obstacles, middles)) < 0.5
    weights = 1 / room[chosen] ** 2
    return middles[chosen], across[chosen] / widths[chosen, None], weights / weights.sum()


def _points_on_edges(mesh: Mesh, random: np.random.Generator, count: int) -> FloatArray:
    """Returns random points on the edges of triangles. Half of them do not depend on the lengths of edges."""
    if len(mesh.triangles) == 0:
        chosen = random.integers(0, len(mesh.vertices), count)
        return mesh.vertices[chosen]
    ends = np.vstack([mesh.triangles[:, pair] for pair in ((0, 1), (1, 2), (2, 0))])
    first, second = mesh.vertices[ends[:, 0]], mesh.vertices[ends[:, 1]]
    ways = np.linalg.norm(second - first, axis=1)
    chosen = random.choice(len(ways), count, p=0.5 * ways / ways.sum() + 0.5 / len(ways))
    part = random.random((count, 1))
    return (1 - part) * first[chosen] + part * second[chosen]


class _Search:
    """Random poses, and extensions of trees towards them."""

    def __init__(self, moving: MovingBody, bounds: Any, seed: int) -> None:
        self.moving = moving
        self.low, self.high = map(np.array, bounds)
        self.extent = float(np.linalg.norm(self.high - self.low))
        self.random = np.random.default_rng(seed)
        #: Principal axes of the body.
        self.axes = _principal_axes(moving.body.vertices)
        self.gaps = _gaps(moving, self.random)
        self.turning = 0.0 if moving.rotation is not None else 1.0

    def grow(self, trees: _Trees, turn: int) -> int:
        """Extends a tree, or begins a new one in a narrow place. Returns the last pose that it added."""
        numbers = trees.numbers()
        if turn % 4 == 0 and len(numbers) < _TREES:
            pose = self.bridging()
            if pose is not None:
                return trees.add(pose)
        tree = int(self.random.choice(numbers if self.random.random() > _SAME_TREE else numbers[:2]))
        if turn % 2:
            target = self.uniform()
            start, _ = trees.nearest(target, tree)
        else:
            start = trees.rarely_tried(tree, self.random)
            target = self.near(trees.poses[start])
        return self.extend(trees, start, target)[0]

    def uniform(self) -> FloatArray:
        """Returns a random pose."""
        place = self.random.uniform(self.low, self.high)
        if self.moving.rotation is not None:
            return pose_of(self.moving.centre, self.moving.rotation, place)
        rows = np.array(rotation_of(*self.random.normal(size=4).tolist()))
        return pose_of(self.moving.centre, rows, place)

    def bridging(self) -> FloatArray | None:
        """Returns a random free pose of the body between two close places of the obstacles, or None.

        Its centre, or a random vertex of it, is in the middle between the two places.
        """
        middles, directions, weights = self.gaps
        for _ in range(_ATTEMPTS if len(middles) else 0):
            chosen = self.random.choice(len(middles), p=weights)
            pose = self.uniform() if self.random.random() < 0.3 else self.aligned(directions[chosen])
            vertices = self.moving.body.vertices
            point = vertices[self.random.integers(len(vertices))] if self.random.random() < 0.3 else self.moving.centre
            pose[:, 3] = middles[chosen] - pose[:, :3] @ point
            place = self.moving.place(pose)
            if (place >= self.low).all() and (place <= self.high).all() and self.moving.is_free(pose):
                return pose
        return None

    def aligned(self, direction: FloatArray) -> FloatArray:
        """Returns a random pose that turns an axis of the body to a direction."""
        pose = self.uniform()
        if self.moving.rotation is None:
            axis = pose[:, :3] @ self.axes[self.random.integers(3)]
            x, y, z = np.cross(axis, direction).tolist()
            turned = np.array(rotation_of(1 + float(axis @ direction) + 1e-12, x, y, z))
            pose[:, :3] = turned @ pose[:, :3]
        return pose

    def near(self, pose: FloatArray) -> FloatArray:
        """Returns a random pose at a distance of any order of magnitude."""
        twist = self.random.normal(size=6)
        twist *= self.extent * math.exp(self.random.uniform(math.log(0.003), 0)) / np.linalg.norm(twist)
        return self.moved(pose, twist[:3], twist[3:] / self.moving.radius)

    def moved(self, pose: FloatArray, shift: FloatArray, turn: FloatArray) -> FloatArray:
        """Returns a pose after a translation of the centre, within the bounds, and a turn about it (a vector)."""
        angle = self.turning * float(np.linalg.norm(turn))
        rows = pose[:, :3]
        if angle > 0:
            half = 0.5 * min(angle, 3.0)
            x, y, z = (math.sin(half) / angle * turn).tolist()
            rows = np.array(rotation_of(math.cos(half), x, y, z)) @ rows
        place = np.clip(self.moving.place(pose) + shift, self.low, self.high)
        return pose_of(self.moving.centre, rows, place)

    def extend(self, tree: _Trees, index: int, target: FloatArray) -> tuple[int, bool]:
        """Adds poses on the way to a target, and slides along obstacles. Returns the last pose, and if it is there."""
        contacts: list[_Contact] = []
        aim = target
        for _ in range(_SLIDES):
            here = tree.poses[index]
            found = self.moving.certify_poses(here, aim)
            if found.verdict == "free":
                index = tree.add(aim, index)
                if aim is target:
                    return index, True
                here = aim
            else:
                way = self.moving.way(here, aim)
                back = self.moving.radius * math.exp(self.random.uniform(*_AWAY))
                time = max(found.free_until - back / way, 0.5 * found.free_until)
                if time * way > 1e-3 * self.moving.radius:
                    here = self.moving.between(here, aim, time)
                    index = tree.add(here, index)
            contacts.append(self.contact(here))
            aim = self.slid(here, target, contacts)
            if self.moving.way(here, aim) < 1e-2 * self.moving.radius:
                break
        return index, False

    def contact(self, pose: FloatArray) -> _Contact:
        """Returns how translations and turns of the body change its distance from the closest obstacle."""
        pair = self.moving.separation(pose)
        normal = np.subtract(pair.closest[1], pair.closest[0]) / pair.distance
        arm = np.subtract(pair.closest[1], self.moving.place(pose))
        return normal, self.turning * np.cross(arm, normal), pair.distance

    def slid(self, pose: FloatArray, target: FloatArray, contacts: list[_Contact]) -> FloatArray:
        """Returns the pose closest to a target such that the distances at the contacts do not shrink."""
        angle, axis = turn_between(pose[:, :3], target[:, :3])
        shift, turn = self.moving.place(target) - self.moving.place(pose), angle * (pose[:, :3] @ axis)
        inertia = 0.4 * self.moving.radius**2
        away = self.moving.radius * math.exp(self.random.uniform(*_AWAY))
        forces = [0.0] * len(contacts)
        for _ in range(6):
            for k, (normal, moment, _) in enumerate(contacts):
                need = away - float(normal @ shift + moment @ turn)
                force = max(forces[k] + need / (1 + float(moment @ moment) / inertia), 0.0)
                shift = shift + (force - forces[k]) * normal
                turn = turn + (force - forces[k]) / inertia * moment
                forces[k] = force
        room = contacts[-1][2] - self.moving.clearance
        longest = _LONGEST * max(room, math.exp(_AWAY[0]) * self.moving.radius)
        way = float(np.linalg.norm(shift)) + self.moving.radius * float(np.linalg.norm(turn))
        part = min(1.0, longest / max(way, 1e-300))
        return self.moved(pose, part * shift, part * turn)


def search(
    moving: MovingBody, ends: tuple[FloatArray, FloatArray], bounds: Any, time: float, seed: int
) -> tuple[FloatArray, int, str]:
    """Searches for a path. Returns its poses (n, 3, 4), the number of states, and how close the trees came."""
    run = _Search(moving, bounds, seed)
    trees = _Trees(moving)
    start, goal = (trees.add(end) for end in ends)
    until = clock.perf_counter() + time
    closest, turn = math.inf, 0
    while clock.perf_counter() < until:
        turn += 1
        last = run.grow(trees, turn)
        tree = trees.tree_of(last)
        aim = trees.poses[last]
        near, _ = trees.nearest(aim, tree, other=True)
        met, reached = run.extend(trees, near, aim)
        if reached:
            trees.join(met, last)
            if trees.tree_of(start) == trees.tree_of(goal):
                return trees.path(start, goal), len(trees.poses), ""
        elif {tree, trees.tree_of(met)} == {0, 1}:
            closest = min(closest, moving.way(aim, trees.poses[met]))
    nearest = f"the closest approach of its trees is {closest:.6g}"
    return np.empty((0, 3, 4)), len(trees.poses), nearest
