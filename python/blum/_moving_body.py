"""Body that moves among obstacles, with certified motions and the poses between two poses."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._arguments import FloatArray, Real, box, number, triple
from ._errors import InvalidOption
from ._mesh import MeshLike, as_mesh
from ._planning import MotionCertifier
from ._proximity_results import PrimitivePair
from ._proximity_scene import ProximityScene
from ._rigid import as_pose, quaternion_of, rotation_of
from ._structs import CertifiedMotion


class MovingBody:
    """Body among obstacles that rest. It moves as :meth:`blum.MotionCertifier.certify` describes.

    Parameters
    ----------
    body, obstacles : meshes
        Any triangles, segments and points. Only surfaces count.
    clearance, delta : float
        As for :meth:`blum.MotionCertifier.certify`, mesh units. Default of `delta`: 1e-4 of the size of the body.
    centre : 3 numbers, optional
        In the coordinates of the body. Default: the middle of its box.
    rotation : (3, 3) array, optional
        If given, the body keeps this rotation.
    threads
        As for :func:`blum.distance_field`.
    """

    def __init__(
        self,
        body: MeshLike,
        obstacles: MeshLike,
        *,
        clearance: Real = 0.0,
        delta: Real | None = None,
        centre: Any = None,
        rotation: Any = None,
        threads: int = 0,
    ) -> None:
        self.body, self.obstacles = as_mesh(body), as_mesh(obstacles)
        self.certifier = MotionCertifier(self.body, self.obstacles, threads=threads)  # It checks the meshes.
        vertices = self.body.vertices
        lower, upper = vertices.min(axis=0), vertices.max(axis=0)
        self.centre = triple((lower + upper) / 2 if centre is None else centre, "centre")
        #: Largest distance of a point of the body from the centre, mesh units. A single point counts as a small body.
        self.radius = float(np.linalg.norm(vertices - self.centre, axis=1).max()) or 1e-3
        size = float(np.linalg.norm(upper - lower))
        self.clearance = number(clearance, "clearance")
        self.delta = number(delta, "delta") if delta is not None else 1e-4 * size if size > 0 else 1e-9
        if not self.clearance >= 0 or not self.delta > 0:
            raise InvalidOption(
                f"clearance is {self.clearance} and delta is {self.delta}, but they must be >= 0 and > 0"
            )
        #: Rotation that the body keeps, or None if it turns.
        self.rotation = None if rotation is None else as_pose((rotation, (0, 0, 0)), "rotation")[:, :3]
        self._options = {"clearance": self.clearance, "delta": self.delta}
        self._scene = ProximityScene()
        self._fixed, self._moving = self._scene.add(self.obstacles), self._scene.add(self.body)

    def bounds(self, given: Any) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Returns the corners of the box in which the centre may be. Default: the body fits beside the obstacles."""
        if given is None:
            vertices, room = self.obstacles.vertices, 2 * self.radius + self.clearance
            given = vertices.min(axis=0) - room, vertices.max(axis=0) + room
        low, high = box(given, "bounds")
        if not all(map(math.isfinite, (*low, *high))) or any(b <= a for a, b in zip(low, high, strict=True)):
            raise InvalidOption(f"bounds are {low} to {high}, but must be finite, with a size above 0 along each axis")
        return low, high

    def certify_poses(self, first: FloatArray, second: FloatArray, *, delta: float | None = None) -> CertifiedMotion:
        """Returns what is proven of the motion between two poses (3, 4)."""
        options = self._options if delta is None else {**self._options, "delta": delta}
        return self.certifier._certify(first, second, self.centre, options)

    def is_free(self, pose: FloatArray) -> bool:
        """Returns True if the body keeps its clearance at a pose (3, 4)."""
        return self.certify_poses(pose, pose).verdict == "free"

    def separation(self, pose: FloatArray) -> PrimitivePair:
        """Returns the closest pair of the obstacles (first) and the body at a pose (3, 4)."""
        self._scene.update(self._moving, transform=pose)
        pair = self._scene.separation(self._fixed, self._moving)
        assert pair is not None
        return pair

    def place(self, pose: FloatArray) -> FloatArray:
        """Returns the position of the centre at a pose (3, 4)."""
        place: FloatArray = pose[:, :3] @ self.centre + pose[:, 3]
        return place

    def between(self, first: FloatArray, second: FloatArray, time: float) -> FloatArray:
        """Returns the pose at a time, 0 to 1, of the motion between two poses (3, 4)."""
        return between(self.centre, first, second, time)

    def way(self, first: FloatArray, second: FloatArray) -> float:
        """Returns a bound on the way of each point of the body between two poses (3, 4), mesh units."""
        angle, _ = turn_between(first[:, :3], second[:, :3])
        return float(np.linalg.norm(self.place(second) - self.place(first))) + angle * self.radius


def turn_between(first: FloatArray, second: FloatArray) -> tuple[float, FloatArray]:
    """Returns the angle, 0 to pi, and the axis (in the coordinates of the body) of the turn between two rotations."""
    w, *xyz = quaternion_of(first.T @ second)
    axis = np.array(xyz) if w >= 0 else -np.array(xyz)
    size = float(np.linalg.norm(axis))
    return 2 * math.atan2(size, abs(w)), axis / size if size > 0 else np.array([0.0, 0.0, 1.0])


def pose_of(centre: Any, rotation: FloatArray, place: FloatArray) -> FloatArray:
    """Returns the pose (3, 4) with a rotation and a position of the centre."""
    out = np.empty((3, 4))
    out[:, :3] = rotation
    out[:, 3] = place - rotation @ centre
    return out


def between(centre: Any, first: FloatArray, second: FloatArray, time: float) -> FloatArray:
    """Returns the pose at a time, 0 to 1, of the motion between two poses (3, 4)."""
    angle, axis = turn_between(first[:, :3], second[:, :3])
    half = 0.5 * time * angle
    x, y, z = (math.sin(half) * axis).tolist()
    turned = first[:, :3] @ np.array(rotation_of(math.cos(half), x, y, z))
    start, end = (pose[:, :3] @ centre + pose[:, 3] for pose in (first, second))
    return pose_of(centre, turned, (1 - time) * start + time * end)
