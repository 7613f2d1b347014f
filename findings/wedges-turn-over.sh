#!/usr/bin/env bash
# VTK 9.7 and VTK 9.6 number a wedge (a prism of 6 nodes) in opposite directions.
#
# Versions: vtk 9.6.2 beside vtk 9.7.2 with pyvista 0.49.1 and meshio 5.3.5.
# Up to 9.6 the normal of nodes 0, 1, 2 pointed out of the cell; from 9.7 it points into it.
# Gmsh numbers wedges like 9.7. VTK 9.3.1 and 9.5.2 number them like 9.6.2.
# Readers do not reorder the nodes of older files; .vtu and .vtk files keep their version number.
#
# Expected: a file has the same volume in both versions.
# Expected: all filters of one version follow one numbering.
# Seen: a box of two wedges and a hexahedron, written by 9.6, has the volume 2; read by 9.7 it is 0.
# The same happens from 9.7 to 9.6. It affects .vtu, .vtk and .vtkhdf.
# meshio still writes the old numbering: a Gmsh file that it converts has the volume 0 in 9.7.
# Within 9.7.2 itself, vtkGeometryFilter follows the new numbering, vtkDataSetSurfaceFilter the old.
# For a box that 9.7 accepts, the latter makes a surface with 4 edges at which triangles disagree.
# extract_surface of PyVista calls that filter by default.
# vtkMassProperties gives this surface, closed but of mixed orientation, the volume 0.4 instead of 2.
# vtkImplicitPolyDataDistance is 0.2 at a point inside this surface, instead of -0.2.
#
# Affected: users who keep prism meshes in files, for example of boundary layers and extrusions.
# Volumes of wedges cancel those of other cells in sums, and there is no warning.
# Workaround: check vtkCellSizeFilter's volumes after reading; swap nodes 1, 2 and 4, 5 if they are negative.
# Extract surfaces with vtkGeometryFilter, in PyVista with algorithm="geometry".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv old
python3 -m venv new
old/bin/pip install --quiet --disable-pip-version-check vtk==9.6.2 numpy==2.4.6
new/bin/pip install --quiet --disable-pip-version-check vtk==9.7.2 numpy==2.4.6 pyvista==0.49.1 meshio==5.3.5

# A unit cube of two prisms with a hexahedron beside it, in the node order of Gmsh.
cat >box.msh <<'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
12
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 2 0 0
10 2 1 0
11 2 0 1
12 2 1 1
$EndNodes
$Elements
3
1 6 2 0 0 1 2 3 5 6 7
2 6 2 0 0 1 3 4 5 7 8
3 5 2 0 0 2 9 10 3 6 11 12 7
$EndElements
END

cat >box.py <<'END'
import sys
import warnings

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

VERSION = vtk.vtkVersion.GetVTKVersion()
POINTS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
POINTS += [[2, 0, 0], [2, 1, 0], [2, 0, 1], [2, 1, 1]]
WEDGES = {"inwards": [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]], "outwards": [[0, 2, 1, 4, 6, 5], [0, 3, 2, 4, 7, 6]]}
FORMATS = {
    "vtu": (vtk.vtkXMLUnstructuredGridWriter, vtk.vtkXMLUnstructuredGridReader),
    "vtk": (vtk.vtkUnstructuredGridWriter, vtk.vtkUnstructuredGridReader),
    "vtkhdf": (vtk.vtkHDFWriter, vtk.vtkHDFReader),
}


def box(normal):
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    points.SetData(numpy_to_vtk(np.array(POINTS, float), deep=True))
    grid.SetPoints(points)
    for wedge in WEDGES[normal]:
        grid.InsertNextCell(vtk.VTK_WEDGE, 6, wedge)
    grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, [1, 8, 9, 2, 5, 10, 11, 6])
    return grid


def volumes(grid):
    size = vtk.vtkCellSizeFilter()
    size.SetInputData(grid)
    size.Update()
    return [round(float(v), 6) for v in vtk_to_numpy(size.GetOutput().GetCellData().GetArray("Volume"))]


def read(path):
    reader = FORMATS[path.rpartition(".")[2]][1]()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def triangles(surface):
    split = vtk.vtkTriangleFilter()
    split.SetInputData(surface)
    split.Update()
    return split.GetOutput()


def clashes(surface):
    """Directed edges of a closed surface that no neighbour has in the other direction."""
    faces = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3).tolist()
    edges = {(face[i], face[(i + 1) % 3]) for face in faces for i in range(3)}
    return sum((b, a) not in edges for a, b in edges)


def mass(surface):
    properties = vtk.vtkMassProperties()
    properties.SetInputData(surface)
    properties.Update()
    return round(properties.GetVolume(), 6)


def distance(surface, point):
    implicit = vtk.vtkImplicitPolyDataDistance()
    implicit.SetInput(surface)
    return round(implicit.EvaluateFunction(point), 6)


def write_and_measure():
    """The normal of nodes 0, 1, 2 for which this version finds positive volumes, and files of that box."""
    found = {normal: volumes(box(normal)) for normal in WEDGES}
    print(f"vtk {VERSION}, volumes by the direction of the normal of nodes 0, 1, 2: {found}")
    right = max(found, key=lambda normal: sum(found[normal]))
    for extension, (writer, _) in FORMATS.items():
        out = writer()
        out.SetFileName(f"{VERSION}.{extension}")
        out.SetInputData(box(right))
        out.Write()
    assert right == {"9.6.2": "outwards", "9.7.2": "inwards"}[VERSION], "the numbering has changed"
    assert found[right] == [0.5, 0.5, 1.0], "the volumes have changed"


def read_files_of(other):
    for extension in FORMATS:
        found = volumes(read(f"{other}.{extension}"))
        print(f"vtk {VERSION} reads .{extension} of {other}: {found}, in all {sum(found)}")
        assert found == [-0.5, -0.5, 1.0], "readers reorder now"


def surfaces():
    for filter_type, expected in ((vtk.vtkGeometryFilter, (0, 2.0, -0.2)), (vtk.vtkDataSetSurfaceFilter, (4, 0.4, 0.2))):
        extract = filter_type()
        extract.SetInputData(box("inwards"))
        extract.Update()
        surface = triangles(extract.GetOutput())
        found = clashes(surface), mass(surface), distance(surface, (0.4, 0.6, 0.2))
        print(f"vtk {VERSION} {filter_type.__name__}: {found[0]} clashing edges, ", end="")
        print(f"vtkMassProperties {found[1]}, distance inside {found[2]}")
        assert found == expected, "the surface has changed"


def others():
    import meshio
    import pyvista

    meshio.write("meshio.vtu", meshio.read("box.msh"))
    found = volumes(read("meshio.vtu"))
    print(f"meshio {meshio.__version__} from .msh to .vtu: {found}, in all {sum(found)}")
    assert found == [-0.5, -0.5, 1.0], "meshio has changed"
    grid = pyvista.wrap(box("inwards"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a later version is to choose another default
        found = {"by default": clashes(triangles(grid.extract_surface()))}
    for name in ("dataset_surface", "geometry"):
        found[name] = clashes(triangles(grid.extract_surface(algorithm=name)))
    print(f"pyvista {pyvista.__version__} extract_surface, clashing edges: {found}")
    assert found == {"dataset_surface": 4, "geometry": 0, "by default": 4}, "pyvista has changed"


if sys.argv[1] == "write":
    write_and_measure()
else:
    read_files_of(sys.argv[2])
    if VERSION == "9.7.2":
        surfaces()
        others()
END
old/bin/python box.py write
new/bin/python box.py write
old/bin/python box.py read 9.7.2
new/bin/python box.py read 9.6.2
