#!/usr/bin/env bash
# Two cubes that share an edge and its two vertices lose triangles without an error.
#
# Versions: manifold3d 3.5.4, meshlib 3.1.4.297; trimesh 5.2.0 for comparison.
# The mesh has 14 vertices and 24 triangles, is closed and faces outwards.
# Four triangles meet at the common edge, so it is not a 2-manifold.
# Manifold accepts such edges, and gives each body its own vertices.
#
# Expected: for every order of the triangles, the status is NoError and the volume is 2.
# Seen, manifold3d: 16 of 48 orders of the same triangles have a volume of 1.833 or 1.667.
# The orders are the 24 rotations of the list, forwards and backwards.
# One vertex and two triangles are then missing, but the status is still NoError.
# Mesh and Mesh64 agree. If each cube has its own vertices, all orders give 2.
# Seen, meshlib: an .off file of the mesh is read with 18 of 24 triangles, open, of volume 1.5.
# Its .obj and .ply files, and arrays, are read completely, closed and with 16 vertices.
# Seen, trimesh: body_count is 1, and split gives 2 bodies.
#
# Affected: users who join parts that touch, for example in assemblies, voxel meshes and lattices.
# A corner of the part is cut off, and nothing in the result reports that.
# Workaround: give each body its own vertices before a boolean.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check \
  manifold3d==3.5.4 meshlib==3.1.4.297 trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1 networkx==3.6.1

cat >cubes.py <<'END'
from collections import Counter
from importlib.metadata import version

import manifold3d
import meshlib.mrmeshnumpy
import meshlib.mrmeshpy
import numpy as np
import trimesh

print(*(f"{name} {version(name)}" for name in ("manifold3d", "meshlib", "trimesh")))

FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4)]
FACES += [(2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def cube(x, y, z):
    return [(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)) for i in range(8)]


first, second = cube(0, 0, 0), cube(1, 1, 0)
shared = first + [corner for corner in second if corner not in first]
shared_faces = FACES + [tuple(shared.index(second[i]) for i in face) for face in FACES]
apart = first + second
apart_faces = FACES + [tuple(i + 8 for i in face) for face in FACES]


def volumes(points, faces, kind, index):
    """How often each volume comes out, with how many vertices and triangles, over 48 orders of the triangles."""
    counts = Counter()
    for start in range(len(faces)):
        for step in (1, -1):
            order = (faces[start:] + faces[:start])[::step]
            solid = manifold3d.Manifold(kind(np.array(points, float).astype(index[0]), np.array(order, index[1])))
            assert solid.status() == manifold3d.Error.NoError, "the status has changed"
            counts[round(solid.volume(), 3), solid.num_vert(), solid.num_tri()] += 1
    return dict(counts)


single, double = (np.float32, np.uint32), (np.float64, np.uint64)
print("manifold3d, (volume, vertices, triangles): orders of 48, the status always NoError")
results = {}
results["shared"] = volumes(shared, shared_faces, manifold3d.Mesh, single)
results["shared, Mesh64"] = volumes(shared, shared_faces, manifold3d.Mesh64, double)
results["apart"] = volumes(apart, apart_faces, manifold3d.Mesh, single)
for name, result in results.items():
    print(f"  {name}: {result}")

mesh = trimesh.Trimesh(np.array(shared, float), shared_faces, process=False)
bodies = mesh.body_count, len(mesh.split(only_watertight=False))
print("trimesh: body_count", bodies[0], "and split", bodies[1])

print("meshlib, vertices, triangles, closed, volume")


def tell(name, read):
    topology = read.topology
    facts = topology.numValidVerts(), topology.numValidFaces(), topology.isClosed(), round(read.volume(), 3)
    print(f"  {name}: {facts}")
    return facts


loaded = {}
for extension in ("off", "obj", "ply"):
    mesh.export(f"cubes.{extension}")
    loaded[extension] = tell(f".{extension}", meshlib.mrmeshpy.loadMesh(f"cubes.{extension}"))
arrays = np.array(shared_faces, np.int32), np.array(shared, float)
loaded["arrays"] = tell("arrays", meshlib.mrmeshnumpy.meshFromFacesVerts(*arrays))

changed = "the behaviour has changed"
lossy = {(2.0, 16, 24): 32, (1.833, 15, 22): 15, (1.667, 15, 22): 1}
assert results["shared"] == results["shared, Mesh64"] == lossy, changed
assert results["apart"] == {(2.0, 16, 24): 48}, changed
assert bodies == (1, 2), changed
assert loaded["off"] == (14, 18, False, 1.5), changed
assert loaded["obj"] == loaded["ply"] == loaded["arrays"] == (16, 24, True, 2.0), changed
END
venv/bin/python cubes.py
