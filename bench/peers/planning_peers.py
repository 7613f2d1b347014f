#!/usr/bin/env python3
"""Compares planners whose motions are certified with OMPL on discrete checks by Coal.

    PYTHONPATH=build/release/python bench/peers/planning_peers.py [--seeds N] [--time S] [--scenes NAME,...] [--json FILE]

The scenes are those of tests/python/planning_scenes.py, each with the seeds 0 to N - 1. All planners get the same scene,
bounds, distance of states and time, in one run. `discrete` is OMPL's RRTConnect with its own validator: it tests samples
at 1 % of the extent of the space for contacts, with Coal. Its paths are simplified by OMPL, as `SimpleSetup` does, and
certified afterwards. `rrt_connect` and `sliding` are the planners of blum.plan(), with their shortened paths.

A path counts as solved if the planner returns it, and as proven if all its motions are certified. Seconds include the
search, the simplification and the structures.

Single motions are those between random free poses at a given distance. Both checks are called from Python.
"""

import argparse
import json
import pathlib
import sys
import time

import blum
import blum.ompl
import coal
import numpy as np
from ompl import base, geometric, util

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/python"))
from planning_scenes import NARROW  # noqa: E402


def coal_model(mesh):
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(mesh.triangles), len(mesh.vertices))
    model.addVertices(np.array(mesh.vertices))
    model.addTriangles(np.array(mesh.triangles, dtype=np.int64))
    model.endModel()
    return model


class CoalChecker(base.StateValidityChecker):
    """A state is valid if Coal finds no contact."""

    def __init__(self, information, body):
        super().__init__(information)
        self.body = body
        self.models = [coal_model(mesh) for mesh in (body.body, body.obstacles)]
        self.rest, self.request, self.result = coal.Transform3s.Identity(), coal.CollisionRequest(), coal.CollisionResult()

    def isValid(self, state):
        pose = self.body.pose(state)
        self.result.clear()
        place = coal.Transform3s(np.asfortranarray(pose[:, :3]), pose[:, 3])
        return not coal.collide(self.models[0], place, self.models[1], self.rest, self.request, self.result)


def discrete_setup(problem):
    """A problem of OMPL with its own validator, in the space of another one."""
    plain = geometric.SimpleSetup(problem.getStateSpace())
    checker = CoalChecker(plain.getSpaceInformation(), problem.rigid_body)
    plain.setStateValidityChecker(checker)
    return plain


def run_discrete(scene, seconds, seed):
    util.RNG.setSeed(seed + 1)
    problem = blum.ompl.setup(scene.body, scene.obstacles, bounds=scene.bounds, threads=1)
    began = time.perf_counter()
    plain = discrete_setup(problem)
    plain.setStartAndGoalStates(problem.state(scene.start), problem.state(scene.goal))
    plain.setPlanner(geometric.RRTConnect(plain.getSpaceInformation()))
    plain.solve(seconds)
    solved = plain.haveExactSolutionPath()
    before = solved and all(each.verdict == "free" for each in problem.certify(problem.poses(plain.getSolutionPath())))
    if solved:
        plain.simplifySolution()
    took = time.perf_counter() - began
    verdicts = [each.verdict for each in problem.certify(problem.poses(plain.getSolutionPath()))] if solved else []
    proven = solved and set(verdicts) == {"free"}
    return {"solved": solved, "proven": proven, "proven_before_simplification": before, "seconds": took,
            "colliding": verdicts.count("colliding")}  # fmt: skip


def run_certified(planner):
    def run(scene, seconds, seed):
        path = blum.plan(scene.body, scene.obstacles, scene.start, scene.goal, bounds=scene.bounds, time=seconds,
                         seed=seed, planner=planner, threads=1)  # fmt: skip
        return {"solved": path.proven, "proven": path.proven, "seconds": path.seconds, "states": path.states}

    return run


PLANNERS = {"discrete": run_discrete, "rrt_connect": run_certified("rrt_connect"), "sliding": run_certified("sliding")}


def best_of(call, runs=5):
    """The shortest mean over some calls."""
    best = np.inf
    for _ in range(runs):
        began = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - began)
    return best


def time_motions(scene, share, count=50):
    """Microseconds for a motion between free poses, whose distance is a share of the extent of the space."""
    util.RNG.setSeed(1)
    problem = blum.ompl.setup(scene.body, scene.obstacles, bounds=scene.bounds, threads=1)
    plain = discrete_setup(problem)
    information, other = problem.getSpaceInformation(), plain.getSpaceInformation()
    information.setup()
    other.setup()
    space, sampler = problem.getStateSpace(), information.allocStateSampler()
    motions = []
    while len(motions) < count:
        first, last = space.allocState(), space.allocState()
        sampler.sampleUniform(first)
        sampler.sampleUniformNear(last, first, share * space.getMaximumExtent())
        if information.checkMotion(first, last) and space.distance(first, last) > 0.3 * share * space.getMaximumExtent():
            motions.append((first, last))
    tests = np.mean([problem.rigid_body.certify(*motion).tests for motion in motions])
    times = {}
    for name, checked in (("certified", information), ("discrete", other)):
        times[name] = 1e6 * best_of(lambda checked=checked: [checked.checkMotion(*each) for each in motions]) / count
    steps = np.mean([space.validSegmentCount(*each) for each in motions])
    return times | {"tests": float(tests), "steps": float(steps)}


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--seeds", type=int, default=50)
    options.add_argument("--time", type=float, default=10.0)
    options.add_argument("--scenes", default=",".join(NARROW))
    options.add_argument("--planners", default=",".join(PLANNERS))
    options.add_argument("--json", type=pathlib.Path)
    given = options.parse_args()
    util.setLogLevel(util.LOG_NONE)
    runs, motions = [], []
    for name in given.scenes.split(","):
        for planner in given.planners.split(","):
            found = [PLANNERS[planner](NARROW[name](seed), given.time, seed) for seed in range(given.seeds)]
            runs += [{"scene": name, "planner": planner, "seed": seed, **row} for seed, row in enumerate(found)]
            solved, proven = (sum(row[key] for row in found) for key in ("solved", "proven"))
            median = np.median([row["seconds"] for row in found])
            print(f"{name:12} {planner:12} solved {solved:2} proven {proven:2} of {given.seeds}, median {median:.2f} s",
                  flush=True)  # fmt: skip
        for share in (0.02, 0.2):
            row = {"scene": name, "share": share, **time_motions(NARROW[name](0), share)}
            motions.append(row)
            print(f"{name:12} motion of {share:.0%}: certified {row['certified']:.0f} us, discrete {row['discrete']:.0f} us "
                  f"({row['tests']:.1f} tests, {row['steps']:.1f} steps)", flush=True)  # fmt: skip
    if given.json:
        given.json.write_text(json.dumps({"time": given.time, "runs": runs, "motions": motions}, indent=1))


if __name__ == "__main__":
    main()
