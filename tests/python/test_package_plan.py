"""Proves that planned paths are free: SciPy interpolates the poses, and a scene and trimesh give exact distances."""

import os
import signal
import subprocess
import sys
import threading
import time

import blum
import numpy as np
import pytest
import vtk
from planning_scenes import NARROW, bent_tube, box, closed_cube, coils, hollow_cube, joined, twisted_bar
from scipy.spatial.transform import Rotation, Slerp

import blum.ompl  # isort: skip
from ompl import base, geometric, util  # isort: skip

BOX, SPHERE = blum.generate("box"), blum.generate("sphere")
LEFT, RIGHT = [-3, 0, 0, 1, 0, 0, 0], [3, 0, 0, 1, 0, 0, 0]


def sampled(path, count=40):
    """Poses at equal times of each motion of a path: the centre moves along a line, and the turn is at one speed."""
    for first, last in zip(path.poses[:-1], path.poses[1:], strict=True):
        times = np.linspace(0, 1, count)
        turns = Slerp([0, 1], Rotation.from_matrix([first[:, :3], last[:, :3]]))(times).as_matrix()
        places = [pose[:, :3] @ path.centre + pose[:, 3] for pose in (first, last)]
        for turn, part in zip(turns, times, strict=True):
            yield np.c_[turn, (1 - part) * places[0] + part * places[1] - turn @ path.centre]


def least_distance(body, obstacles, poses):
    scene = blum.ProximityScene()
    fixed, moving = scene.add(obstacles), scene.add(body)
    found = []
    for pose in poses:
        scene.update(moving, transform=pose)
        found.append(scene.separation(fixed, moving).distance)
    return min(found)


def planned(scene, **options):
    return blum.plan(scene.body, scene.obstacles, scene.start, scene.goal, bounds=scene.bounds, **options)


def check(scene, path):
    """The path leads from the start to the goal, and is free at samples."""
    assert path.proven and path.reason == ""
    for pose, end in ((path.poses[0], scene.start), (path.poses[-1], scene.goal)):
        assert np.allclose(pose, np.c_[end[0], end[1]], atol=1e-12)
    places = np.array([pose[:, :3] @ path.centre + pose[:, 3] for pose in path.poses])
    assert np.isclose(path.length, np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    assert (places > np.array(scene.bounds[0]) - 1e-9).all() and (places < np.array(scene.bounds[1]) + 1e-9).all()
    assert least_distance(scene.body, scene.obstacles, sampled(path)) > path.clearance


@pytest.mark.parametrize(("make", "seed"), [(coils, 1), (bent_tube, 2), (hollow_cube, 0)])
def test_paths_through_narrow_passages_are_free(make, seed):
    scene = make(seed)
    check(scene, planned(scene, planner="sliding", seed=seed, time=60))


@pytest.mark.parametrize("planner", ["rrt_connect", "rrt", "prm", "kpiece", "bkpiece", "lbkpiece", "rrt_star"])
def test_every_planner_of_ompl_works(planner):
    scene = coils(0, tightness=8)
    path = planned(scene, planner=planner, clearance=0.01, time=0.5 if planner == "rrt_star" else 20)
    check(scene, path)
    assert path.planner == planner and path.states > 1 and path.clearance == 0.01


def vtk_mesh(mesh):
    made = vtk.vtkPolyData()
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    points.SetDataTypeToDouble()
    for point in mesh.vertices.tolist():
        points.InsertNextPoint(point)
    for triangle in mesh.triangles.tolist():
        cells.InsertNextCell(3, triangle)
    made.SetPoints(points)
    made.SetPolys(cells)
    return made


def test_an_independent_library_finds_no_contact():
    scene = coils(2)
    path = planned(scene, planner="sliding", time=60)
    check(scene, path)
    checker, place = vtk.vtkCollisionDetectionFilter(), vtk.vtkMatrix4x4()
    checker.SetCollisionModeToFirstContact()
    for k, mesh in enumerate((scene.body, scene.obstacles)):
        checker.SetInputData(k, vtk_mesh(mesh))
    checker.SetMatrix(0, place)
    checker.SetTransform(1, vtk.vtkTransform())
    contacts = []
    through = [np.c_[scene.start[0], scene.start[1] + shift * scene.start[0][:, 0]] for shift in (0.3, 0.5, 0.8)]
    for pose in [*sampled(path, 8), *through]:
        place.DeepCopy([*pose.ravel().tolist(), 0, 0, 0, 1])
        place.Modified()
        checker.Update()
        contacts.append(checker.GetNumberOfContacts())
    assert not any(contacts[:-3]) and any(contacts[-3:])


@pytest.mark.parametrize("planner", ["sliding", "rrt_connect"])
def test_thin_walls_are_not_jumped(planner):
    """There is no path, so a planner that tests samples returns a wrong one. The answer claims no impossibility."""
    scene = closed_cube(0)
    path = planned(scene, planner=planner, time=1.0)
    assert not path.proven and len(path.poses) == 0 and path.seconds < 3
    assert path.reason.startswith("no path was found in 1 seconds; ") and "approach" in path.reason


def test_a_discrete_validator_jumps_the_thin_wall():
    """The scene is a real test: with OMPL's own validator, motions through its walls count as free."""
    scene = closed_cube(0)
    problem = blum.ompl.setup(scene.body, scene.obstacles, bounds=scene.bounds)
    plain = base.SpaceInformation(problem.getStateSpace())
    plain.setStateValidityChecker(blum.ompl.ClearanceChecker(plain, problem.rigid_body))
    plain.setup()
    random, jumps = np.random.default_rng(1), 0
    for _ in range(40):
        turn = scene.start[0]
        places = [turn @ np.append(random.uniform(-0.3, 0.3, 2), height) for height in (0, random.uniform(0.8, 0.9))]
        first, last = (problem.state((turn, place)) for place in places)
        jumps += plain.checkMotion(first, last)
        assert not problem.getSpaceInformation().checkMotion(first, last)
    assert jumps > 5


@pytest.mark.parametrize("planner", ["sliding", "rrt_connect"])
def test_equal_seeds_give_equal_paths(planner):
    scene = twisted_bar(2, tightness=3)
    first, second, other = (planned(scene, planner=planner, seed=seed, time=60) for seed in (5, 5, 6))
    assert first.poses.tobytes() == second.poses.tobytes() != other.poses.tobytes()
    assert first.states == second.states


def test_translations_keep_the_rotation():
    for planner in ("sliding", "rrt_connect"):
        path = blum.plan(BOX, SPHERE, LEFT, RIGHT, rotate=False, planner=planner, clearance=0.2)
        assert path.proven and (path.poses[:, :, :3] == np.eye(3)).all()
        assert least_distance(BOX, SPHERE, sampled(path)) > 0.2
    with pytest.raises(blum.InvalidOption, match="start and goal have different rotations"):
        blum.plan(BOX, SPHERE, LEFT, [3, 0, 0, 0, 1, 0, 0], rotate=False)


def test_poses_may_be_given_in_any_form():
    turn = Rotation.from_quat([0.5, 0.1, -0.3, 0.8])
    x, y, z, w = turn.as_quat()
    square = np.eye(4)
    square[:3] = np.c_[turn.as_matrix(), [-3, 1, 2]]
    forms = ([-3, 1, 2, w, x, y, z], np.array([-3, 1, 2, -w, -x, -y, -z]), square, square[:3])
    for form in (*forms, (turn.as_matrix(), [-3, 1, 2])):
        path = blum.plan(BOX, BOX, form, RIGHT, planner="rrt_connect")
        assert np.allclose(path.poses[0], square[:3], atol=1e-15)


def test_a_path_gives_the_poses_between():
    path = blum.plan(BOX, SPHERE, LEFT, [3, 0, 0, 0, 1, 0, 0], planner="sliding")
    times = np.linspace(0, len(path.poses) - 1, 7 * (len(path.poses) - 1) + 1)
    expected = [pose for k, pose in enumerate(sampled(path, 8)) if k % 8 != 7] + [path.poses[-1]]
    assert np.allclose([path.at(time) for time in times], expected, atol=1e-12)
    assert path.at(0).tolist() == path.poses[0].tolist()
    with pytest.raises(blum.InvalidOption, match="time is -1"):
        path.at(-1)


def test_bad_ends_are_named_with_their_place():
    with pytest.raises(
        blum.InvalidOption, match=r"start: the body meets the obstacles at \(.*primitive \d+ of the body"
    ):
        blum.plan(BOX, SPHERE, [1, 0, 0, 1, 0, 0, 0], RIGHT)
    with pytest.raises(blum.InvalidOption, match=r"goal: the body is only 0\.1 .* clearance is 0\.2"):
        blum.plan(BOX, box((-1, -1, -1), (1, 1, 1)), LEFT, [1.6, 0, 0, 1, 0, 0, 0], clearance=0.2)
    with pytest.raises(blum.InvalidOption, match=r"goal: the centre of the body is at \(3, 0, 0\), but the bounds are"):
        blum.plan(BOX, SPHERE, LEFT, RIGHT, bounds=((-4, -4, -4), (2, 4, 4)))


def test_a_body_inside_a_solid_is_refused():
    room, small = box((-2, -2, -2), (2, 2, 2)), box((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1))
    ends = [-1, 0, 0, 1, 0, 0, 0], [1, 1, 0, 1, 0, 0, 0]
    with pytest.raises(
        blum.InvalidOption, match=r"start: the body is inside the solid of the obstacles, at .*allow_inside"
    ):
        blum.plan(small, room, *ends)
    assert blum.plan(small, room, *ends, allow_inside=True).proven
    with pytest.raises(blum.InvalidOption, match="start: an obstacle is inside the solid of the body"):
        blum.plan(room, small, *ends)
    shell = joined(room, blum.Mesh(small.vertices * 15, small.triangles[:, ::-1]))
    assert blum.plan(small, shell, *ends).proven, "the hollow of a shell is outside its solid"
    assert blum.plan(small, blum.Mesh(room.vertices, room.triangles[2:]), *ends).proven, "an open mesh has no inside"


def test_unusual_meshes_are_planned_with():
    triangle, points = blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), blum.Mesh([[0, 0, 0.0]])
    far = 1e6
    for planner in ("sliding", "rrt_connect"):
        assert blum.plan(triangle, triangle, LEFT, RIGHT, planner=planner).proven
        assert blum.plan(triangle, points, LEFT, RIGHT, planner=planner).proven
        assert blum.plan(points, triangle, LEFT, RIGHT, planner=planner).proven
        assert blum.plan(BOX, SPHERE, LEFT, LEFT, planner=planner).length < 1e-9
        moved = blum.Mesh(SPHERE.vertices + far, SPHERE.triangles)
        ends = [[x + far, far, far, 1, 0, 0, 0] for x in (-3, 3)]
        path = blum.plan(BOX, moved, *ends, planner=planner)
        assert path.proven and least_distance(BOX, moved, sampled(path, 10)) > 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"planner": "best"}, "planner is 'best', but must be one of sliding, rrt_connect"),
        ({"time": 0}, "time is 0"),
        ({"seed": -1}, "seed is -1"),
        ({"clearance": -1}, "clearance is -1"),
        ({"delta": 0}, "delta is 0"),
        ({"bounds": ((0, 0, 0), (1, 1, 0))}, "bounds are"),
        ({"bounds": ((0, 0, 0), (1, 1, np.inf))}, "bounds are"),
    ],
)
def test_wrong_options_are_named(options, message):
    with pytest.raises(blum.InvalidOption, match=message):
        blum.plan(BOX, SPHERE, LEFT, RIGHT, **options)


@pytest.mark.parametrize(
    ("pose", "message"),
    [
        ([-3, 0, 0, 2, 0, 0, 0], "start: the quaternion .* has the length 2"),
        ([-3, 0, np.nan, 1, 0, 0, 0], "start is .* must be finite"),
        ((2 * np.eye(3), (0, 0, 0)), "start"),
        (np.eye(5), "start: transform has the shape"),
        ((np.eye(3), (0, 0, np.inf)), "start is not finite"),
    ],
)
def test_wrong_poses_are_named(pose, message):
    with pytest.raises((blum.InvalidOption, ValueError), match=message):
        blum.plan(BOX, SPHERE, pose, RIGHT)


def test_programs_of_ompl_keep_their_form():
    scene = twisted_bar(0, tightness=2)
    util.setLogLevel(util.LOG_ERROR)
    problem = blum.ompl.setup(scene.body, scene.obstacles, clearance=0.01, bounds=scene.bounds)
    problem.set_poses(scene.start, scene.goal)
    problem.setPlanner(geometric.PRM(problem.getSpaceInformation()))
    assert problem.solve(20.0) and problem.haveExactSolutionPath()
    problem.simplifySolution()
    assert {motion.verdict for motion in problem.certify(problem.poses())} == {"free"}
    assert problem.validator.motions > 10
    path = problem.getSolutionPath()
    assert path.check()
    with pytest.raises(blum.InvalidOption, match="start: the centre of the body is outside the bounds"):
        problem.set_poses([99, 0, 0, 1, 0, 0, 0], scene.goal)


def test_states_and_poses_are_the_same_motion():
    """OMPL's interpolation of states gives the poses that are certified."""
    body = blum.Mesh(BOX.vertices * [1, 2, 3] + [5, 0, 1], BOX.triangles)
    problem = blum.ompl.setup(body, SPHERE, bounds=((-9, -9, -9), (9, 9, 9)))
    random = np.random.default_rng(3)
    for turns in Rotation.random(40, random_state=4).as_matrix().reshape(20, 2, 3, 3):
        first, last = (np.c_[turn, random.uniform(-4, 4, 3)] for turn in turns)
        states = [problem.state(pose) for pose in (first, last)]
        assert np.allclose(problem.pose(states[0]), first, atol=1e-13)
        middle = problem.getStateSpace().allocState()
        for part in (0.25, 0.7):
            problem.getStateSpace().interpolate(*states, part, middle)
            assert np.allclose(problem.pose(middle), problem.rigid_body.between(first, last, part), atol=1e-12)


def test_the_checker_and_the_sampler():
    problem = blum.ompl.setup(BOX, SPHERE, clearance=0.1)
    information = problem.getSpaceInformation()
    checker, sampler, state = problem.checker, information.allocValidStateSampler(), problem.state(RIGHT)
    assert checker.isValid(state) and np.isclose(checker.clearance(state), 1.5, atol=1e-3)
    assert not checker.isValid(problem.state([1.55, 0, 0, 1, 0, 0, 0]))
    distances = []
    for _ in range(80):
        assert sampler.sample(state) and information.isValid(state) and information.satisfiesBounds(state)
        distances.append(checker.clearance(state))
    assert min(distances) > 0.1
    assert sampler.sampleNear(state, problem.state(LEFT), 0.5) and information.isValid(state)
    validator = problem.validator
    assert validator.free_until(problem.state(LEFT), problem.state(RIGHT)) < 0.5
    assert validator.free_until(problem.state(LEFT), problem.state(LEFT)) == 1


def test_blum_does_not_import_ompl():
    code = "import sys, blum; assert 'ompl' not in sys.modules; sys.modules['ompl'] = None; import blum.ompl"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "ImportError: blum.ompl needs OMPL's package for Python, version 2: pip install ompl" in done.stderr


@pytest.mark.parametrize("planner", ["sliding", "rrt_connect", "prm"])
def test_ctrl_c_ends_the_search(planner):
    scene = closed_cube(0)
    # Shells ignore the signal for programs in the background.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    began = time.perf_counter()
    with pytest.raises(KeyboardInterrupt):
        planned(scene, planner=planner, time=30)
    assert time.perf_counter() - began < 5
    assert signal.signal(signal.SIGINT, before) is signal.default_int_handler


def test_scenes_have_free_ends():
    for make in (*NARROW.values(), closed_cube):
        for seed in range(3):
            scene = make(seed)
            certifier = blum.MotionCertifier(scene.body, scene.obstacles)
            assert all(certifier.certify(end, end).verdict == "free" for end in (scene.start, scene.goal)), scene.name
            assert blum.topology(scene.body).closed and blum.topology(scene.obstacles).faces_outwards, scene.name
