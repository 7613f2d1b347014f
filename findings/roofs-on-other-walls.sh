#!/usr/bin/env bash
# compas_cgal 0.10.0: extrude() gives the roof over each wall the angle of another wall.
#
# Versions: compas_cgal 0.10.0 with compas 2.15.1. The function is new in this version.
# It takes a footprint and one angle (or weight) per edge, and returns a roof from the weighted straight skeleton.
# It accepts both directions of the footprint, and reverses a clockwise one, but not the list of its angles.
#
# Expected: angle i belongs to the edge from point i to point i + 1, in either direction of the footprint.
# Seen, counter-clockwise: angle i belongs to the edge that ends at point i. weighted_offset_polygon()
# documents this order, extrude() does not.
# Seen, clockwise: angle i belongs to edge n - 1 - i of n edges. So neither order fits both directions.
# For a courtyard the two directions change places: clockwise points shift the values, others reverse them.
# There is no warning, because the lengths of both lists agree. In the example no wall has its own angle.
#
# Affected: users who model roofs, and so volumes, gutters or solar areas, from footprints. Rings of Shapefiles are
# clockwise, those of GeoJSON are counter-clockwise: a converted file gives another roof. With equal angles, or
# with the symmetry of a rectangle, nobody sees it.
# Workaround: make the outline counter-clockwise and courtyards clockwise. Then rotate each list by one place, so
# that the angle of the last edge comes first.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check compas_cgal==0.10.0 compas==2.15.1 numpy==2.4.6 scipy==1.17.1
cat >look.py <<'END'
from importlib.metadata import version

import numpy as np
from compas_cgal.straight_skeleton_2 import extrude

print("compas_cgal", version("compas_cgal"), "compas", version("compas"))
OUTLINE = [(0, 0, 0), (14, 0, 0), (14, 11, 0), (5, 11, 0), (5, 8, 0), (0, 8, 0)]
COURT = [(7, 3, 0), (7, 6, 0), (11, 7, 0), (11, 3, 0)]  # clockwise


def walls(points):
    return [frozenset((points[i][:2], points[(i + 1) % len(points)][:2])) for i in range(len(points))]


def angles_of_roof(mesh):
    """The angle of the roof over each wall in degrees, from the triangles that contain a wall."""
    points, faces = mesh.to_vertices_and_faces()
    points = np.array(points)
    angles = {}
    for face in faces:
        on_ground = [i for i in face if abs(points[i][2]) < 1e-9]
        if len(on_ground) == 2:
            a, b, c = points[face]
            normal = np.cross(b - a, c - a)
            wall = frozenset(tuple(float(x) for x in points[i][:2].round(6)) for i in on_ground)
            angles[wall] = round(float(np.degrees(np.arccos(abs(normal[2]) / np.linalg.norm(normal)))), 6)
    return angles


def edges_of_values(outline, holes, contour):
    """For each value of a contour, the edge of that contour whose roof has the value."""
    contours = [outline, *holes]
    result = []
    for index in range(len(contours[contour])):
        angles = [[30.0] * len(points) for points in contours]
        angles[contour][index] = 40.0
        found = angles_of_roof(extrude(outline, holes=holes, angles=angles)[0])
        steep = [wall for wall, angle in found.items() if angle == 40]
        assert len(steep) == 1, "changed: another number of walls has the angle"
        result.append(walls(contours[contour]).index(steep[0]))
    return result


own = [20.0, 25.0, 30.0, 35.0, 40.0, 45.0]
roof = angles_of_roof(extrude(OUTLINE, angles=own)[0])
print("angles of the walls, given:", own, "roof:", [roof[wall] for wall in walls(OUTLINE)])
assert not any(roof[wall] == angle for wall, angle in zip(walls(OUTLINE), own)), "changed: angles of walls"

cases = {
    "outline, counter-clockwise": (OUTLINE, [], 0),
    "outline, clockwise": (OUTLINE[::-1], [], 0),
    "courtyard, clockwise": (OUTLINE, [COURT], 1),
    "courtyard, counter-clockwise": (OUTLINE, [COURT[::-1]], 1),
}
for name, case in cases.items():
    count = len(case[0] if case[2] == 0 else case[1][0])
    found = edges_of_values(*case)
    kept = name in ("outline, counter-clockwise", "courtyard, clockwise")
    print(f"{name}: values 0 to {count - 1} are on the edges {found}")
    assert found == [i - 1 if kept and i else count - 1 - i for i in range(count)], "changed: order of the values"
END
env/bin/python look.py
