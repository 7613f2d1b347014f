#!/usr/bin/env bash
# VTK 9.7.2: the Delaunay tetrahedra of vtkVoronoiFlower3D leave gaps and face inwards; equal points count twice.
#
# Versions: vtk 9.7.2, scipy 1.17.1 (Qhull).
# The filter is new in 9.7. Its documentation offers a "Delaunay tetrahedralization" and a "valid triangulation", and
# states that "Coincident input points are discarded". The page of the 2D filter says that a small padding makes the
# triangulation less convex; the page of the 3D filter does not.
#
# Expected: tetrahedra of positive volume that fill the convex hull, as those of Qhull do.
# Seen, grids: each cube of the grid gets one tetrahedron of volume -1/6, so gaps are 5/6 of the volume.
# The check by ValidateOn() reports that all is valid.
# Seen, 100 random points: 26 % of the volume is missing, and half of the tetrahedra are negative.
# Seen, four points of a flat tetrahedron: no cell. Its circumcentre lies outside of the padded box.
# Padding cannot help: SetPadding() reduces larger values to 0.25 without a message. Then 8 % is still missing.
# Seen, coincident points: each copy gets a Voronoi cell of its own. Two copies of a cube's corners have cells that
# fill the box twice.
#
# Affected: users who take this filter in place of vtkDelaunay3D, because it is parallel: volumes, interpolation between
# the nodes of grids and sampled images, and meshes for simulation. Also sums over Voronoi cells of scans with copies.
# Workaround: scipy.spatial.Delaunay, or vtkDelaunay3D, for tetrahedra; remove coincident points beforehand.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv env
env/bin/pip install --quiet --disable-pip-version-check vtk==9.7.2 scipy==1.17.1 numpy==2.4.6
cat >look.py <<'END'
import numpy as np
from scipy.spatial import Delaunay
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints, vtkVersion
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersMeshing import vtkVoronoiFlower3D
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

print("vtk", vtkVersion.GetVTKVersion())


def cloud(points):
    data = vtkPoints()
    data.SetData(numpy_to_vtk(np.array(points, float), deep=True))
    result = vtkPolyData()
    result.SetPoints(data)
    return result


def volumes(algorithm):
    """The signed volumes of the cells."""
    algorithm.Update()
    sizes = vtkCellSizeFilter()
    sizes.SetInputConnection(algorithm.GetOutputPort())
    sizes.Update()
    return vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))


def flower(points, padding=None, voronoi=False):
    algorithm = vtkVoronoiFlower3D()
    algorithm.SetInputData(cloud(points))
    algorithm.SetOutputType(algorithm.VORONOI if voronoi else algorithm.DELAUNAY)
    if padding:
        algorithm.SetPadding(padding)
    return volumes(algorithm), algorithm.GetPadding()


def qhull(points):
    """The volumes of Qhull's tetrahedra."""
    points = np.array(points, float)
    a, b, c, d = points[Delaunay(points).simplices].transpose(1, 0, 2)
    return abs(np.linalg.det(np.stack([b - a, c - a, d - a], 1))) / 6


def grid(n):
    return np.stack(np.meshgrid(*[np.arange(n)] * 3, indexing="ij"), -1).reshape(-1, 3)


for n in (2, 3, 6):
    found, expected = flower(grid(n))[0], qhull(grid(n))
    print(f"grid of {n}^3 points: {len(found)} tetrahedra, volume {abs(found).sum():.4g}, negative "
          f"{(found < 0).sum()}; Qhull {expected.sum():.4g}")
    assert np.isclose(expected.sum(), (n - 1) ** 3)
    assert np.allclose(found, -1 / 6) and len(found) == (n - 1) ** 3, "changed: grids"

points = np.random.default_rng(1).random((100, 3))
hull = qhull(points).sum()
for asked, missing in ((None, 0.26), (0.1, 0.145), (0.25, 0.078), (10, 0.078)):
    found, padding = flower(points, asked)
    print(f"100 random points, padding {asked} becomes {padding:g}: {len(found)} tetrahedra, negative "
          f"{(found < 0).sum()}, missing {1 - abs(found).sum() / hull:.1%} of the volume")
    assert abs(1 - abs(found).sum() / hull - missing) < 0.01, "changed: random points"
    assert abs((found < 0).mean() - 0.5) < 0.05, "changed: the order of corners"
assert padding == 0.25, "changed: the largest padding"

flat = [[0, 0, 0], [4, 0, 0], [2, 3, 0], [2, 1, 0.5]]
print("flat tetrahedron: cells", len(flower(flat)[0]), "Qhull", qhull(flat))
assert len(flower(flat)[0]) == 0 and np.allclose(qhull(flat), 1), "changed: the flat tetrahedron"

once = flower(grid(2), voronoi=True)[0]
twice = flower(np.vstack([grid(2)] * 2), voronoi=True)[0]
cleaned = flower(np.unique(np.vstack([grid(2)] * 2), axis=0), voronoi=True)[0]
for name, found in (("once", once), ("twice", twice), ("twice, cleaned", cleaned)):
    print(f"corners of a cube, {name}: {len(found)} Voronoi cells, volume {found.sum():.5g}")
assert len(once) == len(cleaned) == 8 and np.isclose(once.sum(), cleaned.sum())
assert len(twice) == 16 and np.isclose(twice.sum(), 2 * once.sum()), "changed: coincident points"
END
env/bin/python look.py
