"""Scenes of motion planning: a body, obstacles, a start and a goal. Each is made from a seed and a tightness.

The tightness is the play of the narrowest passage, relative to the size of what passes it. The seed turns the whole
scene and chooses the pose of the goal.
"""

from dataclasses import dataclass

import blum
import numpy as np


@dataclass(frozen=True)
class Scene:
    """Poses map the body to the scene. Bounds are for the centre of the body's box."""

    name: str
    body: blum.Mesh
    obstacles: blum.Mesh
    start: tuple
    goal: tuple
    bounds: tuple
    feasible: bool = True


def joined(*meshes):
    """All triangles of some meshes as one mesh."""
    counts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    vertices = np.vstack([mesh.vertices for mesh in meshes])
    return blum.Mesh(vertices, np.vstack([mesh.triangles + k for mesh, k in zip(meshes, counts, strict=False)]))


def box(low, high):
    """An axis-aligned box, with triangles facing outwards."""
    unit = blum.generate("box").vertices
    low, high, least, most = map(np.asarray, (low, high, unit.min(0), unit.max(0)))
    return blum.Mesh(low + (unit - least) / (most - least) * (high - low), blum.generate("box").triangles)


def boxes(*pairs):
    return joined(*(box(*pair) for pair in pairs))


def rotation(axis, degrees):
    """The matrix of a rotation about an axis."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    skew, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.radians(degrees)
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


def random_rotation(random):
    return rotation(random.normal(size=3), random.uniform(0, 180))


def swept(frames, outline):
    """The closed solid that an outline (n, 2) sweeps. Frames are (origin, first axis, second axis)."""
    count, rings = len(outline), len(frames)
    vertices = np.vstack([origin + outline @ np.array([first, second]) for origin, first, second in frames])
    ring, k = np.arange(rings - 1)[:, None] * count, np.arange(count)
    after = (k + 1) % count
    a, b, c, d = (x.ravel() for x in (ring + k, ring + after, ring + count + k, ring + count + after))
    cap = np.array([(0, i + 1, i) for i in range(1, count - 1)])
    last = (rings - 1) * count + cap[:, ::-1]
    return blum.Mesh(vertices, np.vstack([np.c_[a, b, d], np.c_[a, d, c], cap, last]))


def circle(radius, sides):
    angles = 2 * np.pi * np.arange(sides) / sides
    return radius * np.c_[np.cos(angles), np.sin(angles)]


def arc_frames(radius, start, end, count, pitch=0.0):
    """Frames along an arc about z, degrees. It climbs by the pitch for each turn."""
    frames = []
    for angle in np.radians(np.linspace(start, end, count)):
        out = np.array([np.cos(angle), np.sin(angle), 0])
        frames.append((radius * out + [0, 0, pitch * angle / (2 * np.pi)], out, np.array([0.0, 0, 1])))
    return frames


def arc_rod(radius, thickness, start, end, *, count=12, sides=8, pitch=0.0):
    return swept(arc_frames(radius, start, end, count, pitch), circle(thickness, sides))


def arc_pipe(radius, inner, outer, start, end, *, count=12, sides=8):
    """A bent pipe, open at both ends: an inner and an outer wall, and rings that join them."""
    frames = arc_frames(radius, start, end, count)
    walls = [swept(frames, circle(size, sides)) for size in (outer, inner)]
    caps = 2 * (sides - 2)
    outside, inside = walls[0].triangles[:-caps], walls[1].triangles[:-caps, ::-1]
    shift, k = len(walls[0].vertices), np.arange(sides)
    after, last = (k + 1) % sides, (count - 1) * sides
    first = np.vstack([np.c_[k, shift + k, shift + after], np.c_[k, shift + after, after]])
    end_ring = np.vstack([np.c_[k, shift + after, shift + k], np.c_[k, after, shift + after]]) + last
    vertices = np.vstack([wall.vertices for wall in walls])
    return blum.Mesh(vertices, np.vstack([outside, inside + shift, first, end_ring]))


def turned_scene(name, body, obstacles, start, goal, room, random, *, feasible=True):
    """A scene with the obstacles turned as a whole. The room is a box in which the centre of the body may be."""
    turn = random_rotation(random)
    moved = blum.Mesh(obstacles.vertices @ turn.T, obstacles.triangles)
    poses = [(turn @ rotation, turn @ np.asarray(place, float)) for rotation, place in (start, goal)]
    corners = np.array(np.meshgrid(*np.transpose(room))).reshape(3, -1).T @ turn.T
    bounds = tuple(map(tuple, (corners.min(0), corners.max(0))))
    return Scene(name, blum.oriented_mesh(body).mesh, blum.oriented_mesh(moved).mesh, *poses, bounds, feasible)


def piano(seed=0, tightness=0.2):
    """A piano with a keyboard is moved from one room through a door into the next one, between floor and ceiling."""
    random, high = np.random.default_rng(seed), 2.4
    body = boxes(((-0.75, -0.15, -0.6), (0.75, 0.15, 0.6)), ((-0.7, 0.15, -0.1), (0.7, 0.4, 0.05)))
    door = 0.55 * (1 + tightness)
    at = random.uniform(0.6, 3.4 - door)
    walls = [((-4, -0.1, -0.1), (4, 4.1, 0)), ((-4, -0.1, high), (4, 4.1, high + 0.1))]
    walls += [((-4.1, -0.1, 0), (-4, 4.1, high)), ((4, -0.1, 0), (4.1, 4.1, high))]
    walls += [((-4, -0.1, 0), (4, 0, high)), ((-4, 4, 0), (4, 4.1, high))]
    walls += [((-0.1, 0, 0), (0.1, at, high)), ((-0.1, at + door, 0), (0.1, 4, high))]
    walls += [((-0.1, at, 2), (0.1, at + door, high))]
    start, goal = (np.eye(3), (-2.5, 2, 0.7)), (rotation((0, 0, 1), random.uniform(-180, 180)), (2.5, 2, 0.7))
    bounds = ((-3.9, 0.1, 0.1), (3.9, 3.9, high - 0.1))
    return Scene("piano", body, boxes(*walls), start, goal, bounds)


def bent_tube(seed=0, tightness=0.2):
    """A rod bent to an arc leaves a pipe that is bent to the same arc."""
    thickness = 0.15
    body = arc_rod(1, thickness, 0, 90)
    inner = thickness * (1 + tightness) / np.cos(np.pi / 8)
    pipe = arc_pipe(1, inner, inner + 0.1, 10, 80)
    random = np.random.default_rng(seed)
    start, goal = (np.eye(3), (0, 0, 0)), (random_rotation(random), (3, 3, 0))
    return turned_scene("bent_tube", body, pipe, start, goal, ((-2, -2, -2), (4, 4, 2)), random)


def coils(seed=0, tightness=1.0):
    """Two rods, each bent to a loop whose ends overlap, are interlocked. Each has to pass between the other's ends."""
    thickness = 0.1
    pitch = 2 * thickness * (2 + tightness)
    rod = arc_rod(1, thickness, -200, 200, count=28, sides=6, pitch=pitch)
    random = np.random.default_rng(seed)
    start = (rotation((1, 0, 0), 90), (1, 0, 0))
    goal = (random_rotation(random), (4, 0, 0))
    return turned_scene("coils", rod, rod, start, goal, ((-3, -3, -3), (5, 3, 3)), random)


def bug_trap(seed=0, tightness=0.5):
    """A rod leaves a box whose only opening is a funnel that points inwards."""
    random, width = np.random.default_rng(seed), 0.2
    body = box((-0.3, -width / 2, -width / 2), (0.3, width / 2, width / 2))
    gap, wall, size, deep = width * (1 + tightness) / 2, 0.05, 1.0, 0.6
    parts = [((-size, -size, -size), (-size + wall, size, size))]
    for axis in (1, 2):
        for side in (-1, 1):
            low, high = np.array([-size, -size, -size]), np.array([size, size, size])
            low[axis], high[axis] = sorted((side * size, side * (size - wall)))
            parts.append((low, high))
            low, high = np.array([size - wall, -size, -size]), np.array([size, size, size])
            low[axis], high[axis] = sorted((side * size, side * gap))
            if axis == 2:
                low[1], high[1] = -gap, gap
            parts.append((low, high))
            low, high = np.array([size - deep, -gap - wall, -gap - wall]), np.array([size, gap + wall, gap + wall])
            low[axis], high[axis] = sorted((side * gap, side * (gap + wall)))
            parts.append((low, high))
    start, goal = (random_rotation(random), (-0.45, 0, 0)), (random_rotation(random), (2, 0, 0))
    return turned_scene("bug_trap", body, boxes(*parts), start, goal, ((-1.5, -1.5, -1.5), (2.5, 1.5, 1.5)), random)


def twisted_bar(seed=0, tightness=0.2):
    """A bar, twisted by a quarter turn, passes a slot in a plate. It has to turn like a screw."""
    random, width, height, count = np.random.default_rng(seed), 0.2, 0.6, 13
    outline = np.array([(-height, -width), (height, -width), (height, width), (-height, width)]) / 2
    frames = []
    for z, angle in zip(np.linspace(-1, 1, count), np.radians(np.linspace(0, 90, count)), strict=True):
        first = np.array([np.cos(angle), np.sin(angle), 0])
        frames.append((np.array([0, 0, z]), first, np.array([-np.sin(angle), np.cos(angle), 0])))
    play = 1 + tightness
    plate = blum.extrusion([(-4, -4), (4, -4), (4, 4), (-4, 4)], [play * outline], thickness=0.1)
    start, goal = (rotation((0, 0, 1), random.uniform(0, 360)), (0, 0, 1.6)), (random_rotation(random), (0, 0, -1.6))
    return turned_scene(
        "twisted_bar", swept(frames, outline), plate, start, goal, ((-2, -2, -2), (2, 2, 2)), random
    )


def hollow_cube(seed=0, tightness=0.5, *, opening=True):
    """A plate leaves a hollow cube whose walls have a thousandth of its size. Steps of samples jump through them."""
    random, thin, small = np.random.default_rng(seed), 1e-3, 0.1
    body = box((-small / 2, -small / 2, -small / 20), (small / 2, small / 2, small / 20))
    gap = small * (1 + tightness) / 2
    parts = []
    for axis in range(3):
        for side in (-1, 1):
            low, high = np.full(3, -0.5), np.full(3, 0.5)
            low[axis], high[axis] = sorted((side * 0.5, side * (0.5 + thin)))
            if not opening or (axis, side) != (0, 1):
                parts.append((low, high))
    if opening:
        x, y = random.uniform(-0.3, 0.3, 2)
        slabs = [((-0.5, -0.5), (0.5, y - gap)), ((-0.5, y + gap), (0.5, 0.5))]
        slabs += [((-0.5, y - gap), (x - gap, y + gap)), ((x + gap, y - gap), (0.5, y + gap))]
        parts += [((0.5, *low), (0.5 + thin, *high)) for low, high in slabs]
    start, goal = (np.eye(3), (0, 0, 0)), (random_rotation(random), (-0.8, 0, 0))
    name = "hollow_cube" if opening else "closed_cube"
    bounds = ((-1, -1, -1), (1, 1, 1))
    return turned_scene(name, body, boxes(*parts), start, goal, bounds, random, feasible=opening)


def closed_cube(seed=0):
    """The cube without an opening: there is no path."""
    return hollow_cube(seed, opening=False)


#: Scenes with a narrow passage, by name.
NARROW = {make.__name__: make for make in (piano, bent_tube, coils, bug_trap, twisted_bar, hollow_cube)}
