"""Proves answers about motions: SciPy interpolates the poses, and a scene gives the distance at each of them."""

import itertools

import numpy as np
import pytest

blum = pytest.importorskip("blum")
transform = pytest.importorskip("scipy.spatial.transform")

SHAPES = [blum.generate(name) for name in ("box", "torus", "bracket", "star")]


def pose(random, far):
    return transform.Rotation.random(random_state=random.integers(2**31)), random.uniform(-far, far, 3)


def poses_between(start, goal, centre, times):
    """The poses at some times: the centre moves along a line."""
    turns = transform.Slerp([0, 1], transform.Rotation.concatenate([start[0], goal[0]]))(times)
    first, last = (turn.apply(centre) + shift for turn, shift in (start, goal))
    places = first + np.asarray(times)[:, None] * (last - first)
    return [(turn.as_matrix(), place - turn.apply(centre)) for turn, place in zip(turns, places, strict=True)]


def distances(body, obstacles, poses):
    scene = blum.ProximityScene()
    fixed, moving = scene.add(obstacles), scene.add(body)
    found = []
    for rotation, translation in poses:
        scene.update(moving, transform=(rotation, translation))
        found.append(scene.separation(fixed, moving).distance)
    return np.array(found)


@pytest.mark.parametrize("clearance", [0.0, 0.1])
def test_answers_are_those_of_samples(clearance):
    random = np.random.default_rng(7)
    delta, count = 1e-4, dict.fromkeys(("free", "too_close", "colliding"), 0)
    for _ in range(60):
        body, obstacles = SHAPES[random.integers(4)], SHAPES[random.integers(4)]
        start, goal, centre = pose(random, 3), pose(random, 3), random.uniform(-1, 1, 3)
        found = blum.certify_motion(
            body,
            obstacles,
            (start[0].as_matrix(), start[1]),
            (goal[0].as_matrix(), goal[1]),
            centre=centre,
            clearance=clearance,
            delta=delta,
        )
        count[found.verdict] += 1
        before = np.linspace(0, found.free_until, 60, endpoint=found.verdict == "free")
        if found.free_until > 0:
            assert distances(body, obstacles, poses_between(start, goal, centre, before)).min() > clearance - 1e-12
        if found.verdict == "free":
            assert found.closest is None
            continue
        (there,) = distances(body, obstacles, poses_between(start, goal, centre, [found.time]))
        assert np.isclose(found.closest.distance, there, atol=1e-9)
        assert there <= clearance + delta + 1e-9
        assert (found.closest.distance == 0) == (found.verdict == "colliding")
    assert count["free"] > 5 and count["colliding"] > 5


def test_points_and_default_centre():
    """Without a turn, the centre does not matter. The pair of a contact is reported with its points."""
    box, identity = blum.generate("box"), np.eye(3)
    certifier = blum.MotionCertifier(box, box)
    found = certifier.certify((identity, (-3, 0, 0)), (identity, (-1.25, 0, 0)), clearance=0.5)
    assert found.verdict == "too_close" and np.isclose(found.free_until, 1.5 / 1.75, atol=1e-5)
    assert np.allclose([found.closest.on_body[0], found.closest.on_other[0]], [-1.0, -0.5], atol=1e-5)
    assert certifier.certify((identity, (-3, 0, 0)), (identity, (-1.25, 0, 0)), clearance=0.2).verdict == "free"


def test_several_bodies_and_given_motions():
    """Bodies of a list move at once. A motion along given poses is that between them, if the poses are the same."""
    box, identity = blum.generate("box"), np.eye(3)
    certifier = blum.MotionCertifier([box, box], [])
    apart = [(identity, (-3, 0, 0)), (identity, (3, 0, 0))]
    swapped = [(identity, (3, 0, 0)), (identity, (-3, 0, 0))]
    assert len(certifier) == 2
    assert certifier.certify(apart, apart).verdict == "free"
    met = certifier.certify(apart, swapped)
    assert met.verdict == "colliding" and np.isclose(met.free_until, 5 / 12, atol=1e-5)
    assert (met.closest.body, met.closest.other_body, met.closest.obstacle) == (0, 1, None)
    contact = certifier.first_contact(apart, swapped)
    assert contact.earliest <= 5 / 12 <= contact.latest + 1e-12 and contact.latest - contact.earliest < 1e-8

    def poses_at(time):
        return np.stack([np.c_[identity, [6 * time - 3, 0, 0]], np.c_[identity, [3 - 6 * time, 0, 0]]])

    given = certifier.certify_poses(poses_at, [6, 6])
    assert given.verdict == "colliding" and np.isclose(given.free_until, 5 / 12, atol=1e-5)
    certifier.exclude(0, 1)
    assert certifier.certify(apart, swapped).verdict == "free"
    with pytest.raises(ZeroDivisionError):
        certifier.certify_poses(lambda time: 1 / 0, [6, 6])
    with pytest.raises(blum.InvalidOption, match="2 bodies"):
        certifier.certify(apart[:1], apart[:1])


def test_clearances_and_paths_hold():
    box, identity = blum.generate("box"), np.eye(3)
    certifier = blum.MotionCertifier(box, box)
    places = [(-4, 0, 0), (0, 2, 0), (4, 0, 0)]
    proof = certifier.certify_path([(identity, place) for place in places], clearance=0.2, tolerance=0.01)
    samples = [
        (identity, (1 - t) * np.array(a) + t * np.array(b))
        for a, b in itertools.pairwise(places)
        for t in np.linspace(0, 1, 50)
    ]
    least = distances(box, box, samples).min()
    assert proof.verdict == "free" and proof.at_least <= least <= 1.02 * proof.at_least
    assert min(part.clearance for part in proof.intervals) == proof.at_least
    for edge in range(2):
        parts = [part for part in proof.intervals if part.edge == edge]
        assert parts[0].start == 0 and parts[-1].end == 1
        assert all(a.end == b.start for a, b in itertools.pairwise(parts))
    one = certifier.clearance((identity, places[0]), (identity, places[1]), tolerance=0.01)
    assert one.at_least <= distances(box, box, samples[:50]).min() <= 1.02 * one.at_least


def test_the_independent_check_agrees():
    """Poses may be seven numbers. A path through the obstacle is refused, and so is a raised clearance."""
    box = blum.generate("box")
    around = np.array([[-3, 0, 0, 1, 0, 0, 0], [0, 3, 0, 0.6, 0, 0, 0.8], [3, 0, 0, 1, 0, 0, 0]])
    proof = blum.MotionCertifier(box, box).certify_path(around, tolerance=0.01)
    assert proof.verdict == "free"
    assert blum.verify_path(around, box, box, clearance=0.99 * proof.at_least).holds
    refused = blum.verify_path(around, box, box, clearance=1.02 * proof.at_most)
    assert not refused.holds and "the distance of body 0 and obstacle 0" in refused.mismatches[0]
    assert not blum.verify_path(around[::2], box, box).holds
    both = np.stack([around, around + np.array([0, 0, 5, 0, 0, 0, 0])], axis=1)
    assert blum.verify_path(both, [box, box], [box]).holds


def test_wrong_arguments_are_named():
    box, at = blum.generate("box"), (np.eye(3), (0, 0, 0))
    with pytest.raises(blum.InvalidOption, match="clearance"):
        blum.certify_motion(box, box, at, at, clearance=-1)
    with pytest.raises(blum.InvalidOption, match="rotation of the pose at time 1"):
        blum.certify_motion(box, box, at, (2 * np.eye(3), (0, 0, 0)))
    with pytest.raises(ValueError, match="transform has the shape"):
        blum.certify_motion(box, box, at, np.eye(2))
