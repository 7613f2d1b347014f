#!/usr/bin/env bash
# pyvista.to_trimesh triangulates a mesh but attaches the data of the mesh before triangulation.
#
# Versions: pyvista 0.49.1 with vtk 9.7.2, trimesh 5.2.0. The function exists since PyVista 0.47.
# With triangulate=True it takes the surface, drops lines and points, and splits polygons.
# It then copies face_attributes and vertex_attributes from the original mesh.
# Neither package compares their lengths with the surface.
# Polygons cause no warning. Lines cause a warning, which only mentions an internal copy.
#
# Expected: each triangle has the value of its cell, each vertex the value of its point.
# Seen: 12 triangles of a cube of 6 quads have 6 values.
# With two lines and two triangles, triangle i has the value of cell i, which is a line.
# A line and a quad become 2 triangles with 2 values; the first value belongs to the line.
# A block of 27 points keeps 26 vertices and 27 values.
# Vertices 13 to 25 of the block have the value of another point.
#
# Affected: users who colour, filter or export by such values.
# Meshes with lines suffer most: lines come first in VTK, so every triangle has a wrong value.
# Medial axes and other complexes of edges and triangles are such meshes.
# Workaround: make a mesh of the triangles alone, with their values, and convert that mesh.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check \
  pyvista==0.49.1 vtk==9.7.2 trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1

cat >columns.py <<'END'
import warnings

import numpy as np
import pyvista
import trimesh

print("pyvista", pyvista.__version__, "vtk", pyvista.vtk_version_info, "trimesh", trimesh.__version__)
warnings.simplefilter("ignore")


def place(points):
    """A value that identifies the place of a point."""
    return np.asarray(points, float) @ (1, 10, 100)


def convert(what, mesh):
    """Gives each cell and each point the value of its place, converts, and compares values with places again."""
    mesh.clear_data()
    mesh.point_data["place"] = place(mesh.points)
    mesh.cell_data["height"] = mesh.cell_centers().points[:, 2].astype(float)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        surface = pyvista.to_trimesh(mesh, triangulate=True)
    faces = np.asarray(surface.face_attributes["height"]).tolist()
    points = np.asarray(surface.vertex_attributes["place"])
    count = len(surface.vertices)
    wrong = int((~np.isclose(points[:count], place(surface.vertices))).sum())
    print(f"{what}: {len(surface.faces)} triangles, {len(faces)} values; ", end="")
    print(f"{count} vertices, {len(points)} values, {wrong} of another point; {len(caught)} warnings")
    return len(surface.faces), faces, count, len(points), wrong, len(caught)


corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 8], [1, 0, 8]], float)
quads = convert("cube of 6 quads", pyvista.Cube().clean())
axis = convert("2 lines at 8, 2 triangles at 0",
               pyvista.PolyData(corners, faces=[3, 0, 1, 2, 3, 0, 2, 3], lines=[2, 4, 5, 2, 5, 4]))
print("  values of its triangles:", axis[1][: axis[0]])
mixed = convert("1 line at 8, 1 quad at 0", pyvista.PolyData(corners, faces=[4, 0, 1, 2, 3], lines=[2, 4, 5]))
print("  values of its triangles:", mixed[1])
block = convert("block of 27 points", pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid())

changed = "the behaviour has changed"
assert quads[0] == 12 and len(quads[1]) == 6, changed
assert axis[0] == 2 and axis[1] == [8, 8, 0, 0], changed
assert mixed[0] == 2 and mixed[1] == [8, 0], changed
assert block[2:5] == (26, 27, 13), changed
assert quads[5] == block[5] == 0, changed

# The workaround.
mesh = pyvista.PolyData(corners, faces=[3, 0, 1, 2, 3, 0, 2, 3], lines=[2, 4, 5, 2, 5, 4])
values = np.array([8.0, 8, 0, 0])
alone = pyvista.PolyData.from_regular_faces(mesh.points, mesh.regular_faces)
alone.cell_data["height"] = values[mesh.n_verts + mesh.n_lines :]
result = pyvista.to_trimesh(alone).face_attributes["height"]
print("triangles alone:", result.tolist())
assert result.tolist() == [0, 0], "the way round fails"
END
venv/bin/python columns.py
