#!/usr/bin/env bash
# meshio 5.3.5: a PLY file with edges ends the Python program; PyVista 0.49.1 and trimesh 5.2.0 drop the edges.
#
# Versions: meshio 5.3.5, pyvista 0.49.1, vtk 9.7.2, trimesh 5.2.0, scipy 1.17.1, numpy 2.4.6.
# PLY files may contain the element "edge" with vertex1 and vertex2. The format's first description lists it, and
# Blender and Open3D read it. Wire frames, curve skeletons and feature lines are stored this way.
#
# Expected: the mesh, with line cells; or an exception of the library that callers can handle.
# Seen: meshio.read() prints a line and calls sys.exit(1). SystemExit is no Exception, so "except Exception" of a batch
# job or a server does not handle it. The same holds for other files that it cannot parse.
# PyVista and trimesh read the triangles and return no edges, without a warning.
#
# Affected: pipelines that convert folders of meshes. One file ends the run, with exit status 1 and no traceback.
# Workaround: catch SystemExit around meshio.read(); or store edges in .vtu, which meshio reads.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check meshio==5.3.5 pyvista==0.49.1 vtk==9.7.2 trimesh==5.2.0 \
  numpy==2.4.6 scipy==1.17.1
cat >wire.ply <<'END_OF_FILE'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
element edge 1
property int vertex1
property int vertex2
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 1 2
2 3
END_OF_FILE
cat >look.py <<'END_OF_PYTHON'
import meshio
import pyvista
import trimesh

ended = False
try:
    meshio.read("wire.ply")
except Exception as error:
    raise SystemExit(f"changed: meshio raises {error!r}")
except SystemExit as error:
    ended = error.code == 1
print("meshio ends the program:", ended)
assert ended, "changed: meshio"

mesh = pyvista.read("wire.ply")
print("pyvista:", mesh.n_cells, "cells,", mesh.n_lines, "lines")
assert (mesh.n_cells, mesh.n_lines) == (1, 0), "changed: pyvista"
loaded = trimesh.load("wire.ply")
kept = getattr(loaded, "entities", None)
print("trimesh:", len(loaded.faces), "face, edges of the file:", kept)
assert len(loaded.faces) == 1 and kept is None, "changed: trimesh"
END_OF_PYTHON
env/bin/python look.py
