"""Proves answers about hostile motions: exact times of contacts, and distances that NumPy and SciPy compute."""

import subprocess
import sys

import blum
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

I3 = np.eye(3)
TRI = np.array([[0, 1, 2]])


def box(size=(1, 1, 1), centre=(0, 0, 0)):
    unit = blum.generate("box")
    return unit.vertices * size + centre, unit.triangles


def sphere(n, r):
    u, v = np.meshgrid(np.arange(n), np.arange(n + 1), indexing="ij")
    a, b = 2 * np.pi * u / n, np.pi * (v + 0.5) / (n + 1)
    points = np.stack([np.sin(b) * np.cos(a), np.sin(b) * np.sin(a), np.cos(b)], -1).reshape(-1, 3) * r

    def at(i, j):
        return (i % n) * (n + 1) + j

    t = [
        f
        for i in range(n)
        for j in range(n)
        for f in ([at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)])
    ]
    return points, np.array(t)


# Own distances of triangles, at many times at once.
def dot(a, b):
    return (a * b).sum(-1)


def segments(a, b, c, d):
    u, v, w = b - a, d - c, a - c
    uu, vv, uv, uw, vw = dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w)
    det = uu * vv - uv * uv
    s = np.clip(np.where(det > 1e-30, (uv * vw - vv * uw) / np.where(det > 1e-30, det, 1), 0), 0, 1)
    t = np.clip((uv * s + vw) / vv, 0, 1)
    s = np.clip((uv * t - uw) / uu, 0, 1)
    return np.linalg.norm(a + u * s[..., None] - c - v * t[..., None], axis=-1)


def triangles(A, B):
    out = np.full(np.broadcast_shapes(A.shape, B.shape)[:-2], np.inf)
    for X, Y in ((A, B), (B, A)):
        a, b, c = (Y[..., k, :] for k in range(3))
        n = np.cross(b - a, c - a)
        nn = np.maximum(dot(n, n), 1e-300)
        for k in range(3):
            p, q = X[..., k, :], X[..., (k + 1) % 3, :]
            hp, hq = dot(p - a, n), dot(q - a, n)
            foot = p - n * (hp / nn)[..., None]
            x = p + (q - p) * np.where(hp * hq < 0, hp / np.where(hp == hq, 1, hp - hq), 0)[..., None]
            inside, pierced = True, hp * hq < 0
            for y, z in ((a, b), (b, c), (c, a)):
                inside = inside & (dot(np.cross(z - y, foot - y), n) >= 0)
                pierced = pierced & (dot(np.cross(z - y, x - y), n) > 0)
            out = np.minimum(out, np.where(inside, np.abs(hp) / np.sqrt(nn), np.inf))
            out = np.where(pierced, 0, out)
    for i in range(3):
        for j in range(3):
            out = np.minimum(out, segments(A[..., i, :], A[..., (i + 1) % 3, :], B[..., j, :], B[..., (j + 1) % 3, :]))
    return out


def distances(body, other, start, goal, centre, times):
    turn = Rotation.from_matrix(start[0].T @ goal[0]).as_rotvec()
    rotation = start[0] @ Rotation.from_rotvec(np.multiply.outer(times, turn)).as_matrix()
    a, b = start[0] @ centre + start[1], goal[0] @ centre + goal[1]
    place = a + np.multiply.outer(times, b - a) - rotation @ centre
    moved = np.einsum("sij,vj->svi", rotation, body[0]) + place[:, None]
    return triangles(moved[:, body[1]][:, :, None], other[0][other[1]][None, None]).min((1, 2))


@pytest.mark.parametrize("seed", range(40))
def test_random_motions(seed):
    g = np.random.default_rng(480 + seed)
    shapes = [
        lambda: box(np.exp(g.uniform(-3, 0.5, 3))),
        lambda: (g.uniform(-1, 1, (3, 3)), TRI),
        lambda: (g.uniform(-1, 1, 3) + np.array([[0, 0, 0], [3, 0, 0], [3, 1e-9, 0]]), TRI),
        lambda: (g.uniform(-1, 1, (6, 3)), np.array([[0, 1, 2], [3, 4, 5], [0, 3, 4]])),
    ]
    body, other = shapes[seed % 4](), shapes[g.integers(1, 4)]()
    scale = 10.0 ** g.choice([-6, 0, 0, 3])
    off = g.uniform(-1, 1, 3) * g.choice([0, 0, 10, 1e6]) * scale
    body, other = (body[0] * scale, body[1]), (other[0] * scale + off, other[1])
    first = Rotation.random(random_state=seed).as_matrix()
    axis = g.normal(size=3)
    turns = [0, np.deg2rad(179.9), np.pi * g.random()]
    last = first @ Rotation.from_rotvec(turns[g.integers(3)] * axis / np.linalg.norm(axis)).as_matrix()
    spread = g.uniform(0.8, 3) * scale
    start, goal = (first, off + g.normal(size=3) * spread), (last, off + g.normal(size=3) * spread)
    centre = g.normal(size=3) * scale * g.choice([1, 5])
    certifier = blum.MotionCertifier(body, other)
    clearance = float(g.choice([0, 0.05]) * scale)
    answer = certifier.certify(start, goal, centre=centre, clearance=clearance)
    contact = certifier.first_contact(start, goal, centre=centre)
    bounds = certifier.clearance(start, goal, centre=centre)
    eps = scale * 1e-11 + np.abs(off).max() * 2e-12
    times = np.unique(np.r_[np.linspace(0, 1, 121), np.clip(bounds.time + np.linspace(-0.01, 0.01, 41), 0, 1)])
    found = distances(body, other, start, goal, centre, times)
    assert answer.verdict != "free" or found.min() >= clearance - eps
    assert not (found[times < answer.free_until] < clearance - eps).any()
    assert found.min() >= bounds.at_least - eps

    def at(time):
        return distances(body, other, start, goal, centre, np.array([time]))[0]

    assert abs(at(bounds.time) - bounds.at_most) <= eps
    if answer.verdict == "colliding":
        assert at(answer.time) <= eps
    if contact is None:
        assert found.min() > 0
    else:
        before = contact.earliest * (1 - np.geomspace(1e-7, 1, 60))
        early = distances(body, other, start, goal, centre, before[before < contact.earliest - 1e-9])
        assert not (early <= 0).any()
        assert contact.latest is None or at(contact.latest) <= eps


@pytest.mark.parametrize("scale", [1e-130, 1e-6, 1, 1e6, 1e60])
def test_exact_time_of_a_box(scale):
    certifier = blum.MotionCertifier(*((v * scale, t) for v, t in (box(), box(centre=(3, 0, 0)))))
    found = certifier.first_contact((I3, [0, 0, 0]), (I3, [6 * scale, 0, 0]))
    assert found.earliest <= 1 / 3 + 1e-15 and found.earliest > 1 / 3 - 1e-9 and found.latest >= 1 / 3 - 1e-15


@pytest.mark.parametrize("far", [0, 1e3, 1e6])
def test_exact_time_of_a_rod_that_turns(far):
    # A rod of radius 1 about z meets the corner line of a wall at an angle of asin(0.5).
    rod = np.add([[0, 0, -0.1], [1, 0, 0], [0, 0, 0.1]], [far, 0, 0]), TRI
    wall = np.add([[0.5, 0.5, -2], [0.5, 0.5, 2], [0.5, 3, 0]], [far, 0, 0]), TRI
    goal = Rotation.from_rotvec([0, 0, 2]).as_matrix()
    pose = (goal, np.array([far, 0, 0]) - goal @ [far, 0, 0])
    found = blum.MotionCertifier(rod, wall).first_contact((I3, [0, 0, 0]), pose, centre=[far, 0, 0])
    exact = np.pi / 8  # the ray at 45 degrees
    assert exact - 1e-7 - 2e-12 * far < found.earliest <= exact + 1e-15 * max(far, 1)


@pytest.mark.parametrize("scale", [1e-162, 1e-170, 1e-200, 1e-300])
def test_tiny_bodies_are_rejected(scale):
    """Squares of lengths would be 0."""
    body = np.array([[0, 0, -0.1], [0.1, 0, -0.1], [0, 0.1, 0.1]]) * scale, TRI
    wall = np.array([[0, -2, -2], [0, 2, -2], [0, 0, 3.0]]) * scale, TRI
    with pytest.raises(blum.InvalidMesh, match="below 1e-140"):
        blum.MotionCertifier(body, wall)


SLIDE = """
import resource; resource.setrlimit(resource.RLIMIT_CPU, (60, 60))  # ends a search that never ends
import blum
i, tris = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], blum.generate('box').triangles
unit = blum.generate('box').vertices
for gap in (1e-4, 1e-6, 1e-7, 1e-9, 1e-12):
    c = blum.MotionCertifier((unit, tris), (unit * [10, 10, 1] - [0, 0, 1 + gap], tris))
    poses = (i, [-3, 0.1, 0]), (i, [3, 0.2, 0])
    VERB
"""


@pytest.mark.parametrize(
    "verb",
    [
        "assert c.certify(*poses, delta=gap / 2).verdict != 'colliding'",
        "found = c.first_contact(*poses); assert found is None or found.latest is None",
        "assert c.clearance(*poses).at_least <= gap * 1.001",
    ],
)
def test_slide_at_a_small_gap(verb):
    subprocess.run([sys.executable, "-c", SLIDE.replace("VERB", verb)], check=True)


NESTED = """
import resource; resource.setrlimit(resource.RLIMIT_CPU, (60, 60))  # comparing all pairs of triangles takes minutes
import blum
ball = blum.generate("sphere", frequency=20)
c = blum.MotionCertifier(ball, (1.3 * ball.vertices, ball.triangles))
turn = [[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]]
found = c.clearance(([[1, 0, 0], [0, 1, 0], [0, 0, 1]], [0, 0, 0]), (turn, [0.1, 0, 0]))
assert 0.15 < found.at_least <= found.at_most < 0.21
"""


def test_clearance_of_nested_shells_is_not_quadratic():
    subprocess.run([sys.executable, "-c", NESTED], check=True)


def test_touching_ends_and_rest():
    certifier = blum.MotionCertifier(box(), box(centre=(3, 0, 0)))
    for start, goal, at in (([0, 0, 0], [2, 0, 0], 1), ([2, 0, 0], [0, 0, 0], 0), ([2, 0, 0], [2, 0, 0], 0)):
        assert certifier.certify((I3, start), (I3, goal)).verdict != "free"
        found = certifier.first_contact((I3, start), (I3, goal))
        assert at - 1e-9 < found.earliest <= at


def test_excluded_pairs_and_neighbours():
    certifier = blum.MotionCertifier([box(), box(centre=(1, 0, 0)), box(centre=(9, 0, 0))], [])
    rest = [(I3, [0, 0, 0])] * 3
    assert certifier.certify(rest, rest).verdict == "colliding"
    certifier.exclude(1, 0)
    assert certifier.certify(rest, rest).verdict == "free"
    assert certifier.certify(rest, [(I3, [0, 0, 0]), (I3, [9, 0, 0]), (I3, [0, 0, 0])]).verdict == "colliding"
