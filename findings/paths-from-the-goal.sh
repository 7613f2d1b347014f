#!/usr/bin/env bash
# OMPL 2.0.1: in an empty square, AORRTC returns a path that stays at the goal, and OMPL calls it an exact solution.
#
# Version: ompl 2.0.1 (PyPI), Python 3.11.
# AORRTC is the planner that OMPL 2 adds for short paths in little time. The problem has no obstacles: from (0.1, 0.1) to
# (0.9, 0.9) in the unit square.
#
# Expected: a path that begins at the start and ends at the goal, as of RRTConnect and RRT* for the same problem.
# Seen: solve() returns "Invalid goal", which is False. Then haveExactSolutionPath() is True, and the solution path has
# two states, both the goal, and the length 0. With an objective of path length, and for other states, the same.
#
# Issue 1420 of OMPL reports the zero length for version 2.0.0; the exact solution is not mentioned there.
#
# Affected: programs that try AORRTC, and benchmarks of planners. A program that asks haveExactSolutionPath() sends the
# robot a path that does not begin where the robot is. A program that tests the status finds no path.
# Workaround: use another planner, and compare the first state of each path with the start.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check ompl==2.0.1
cat >look.py <<'END_OF_PYTHON'
from ompl import base, geometric, util

util.setLogLevel(util.LOG_NONE)


def solved(planner, start, goal):
    """Whether a planner solves the problem, whether OMPL has an exact solution, and this path."""
    space = base.RealVectorStateSpace(2)
    space.setBounds(0, 1)
    setup = geometric.SimpleSetup(space)
    setup.setStateValidityChecker(lambda state: True)
    ends = []
    for point in (start, goal):
        state = space.allocState()
        state[0], state[1] = point
        ends.append(state)
    setup.setStartAndGoalStates(*ends)
    setup.setPlanner(getattr(geometric, planner)(setup.getSpaceInformation()))
    status = bool(setup.solve(1.0))
    path = [(state[0], state[1]) for state in setup.getSolutionPath().getStates()]
    return status, setup.haveExactSolutionPath(), path


for start, goal in (((0.1, 0.1), (0.9, 0.9)), ((0.2, 0.8), (0.7, 0.3))):
    status, exact, path = solved("RRTConnect", start, goal)
    print("RRTConnect: solved", status, "exact", exact, "from", path[0], "to", path[-1])
    assert status and exact and path[0] == start and path[-1] == goal, "changed: RRTConnect"
    status, exact, path = solved("AORRTC", start, goal)
    print("AORRTC:     solved", status, "exact", exact, "from", path[0], "to", path[-1])
    assert not status and exact and path == [goal, goal], "changed: AORRTC"
END_OF_PYTHON
env/bin/python look.py
