"""Proves that VTK reads the files of debug_dump() without errors or warnings.

The program debug_dump_sample writes the files. It lies beside the command-line tool (environment variable BLUM) or in
build/release/bin.
"""

import os
import pathlib
import subprocess

import numpy
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCommand
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

PROJECT = pathlib.Path(__file__).resolve().parents[2]
PLACES = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.1, 0.2, 0.3], [9, 9, 9]]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    tool = os.environ.get("BLUM")
    programs = pathlib.Path(tool).parent if tool else PROJECT / "build" / "release" / "bin"
    made = tmp_path_factory.mktemp("dumps")
    subprocess.run([programs / "debug_dump_sample", made], check=True)
    return made


def read(path):
    reader = vtkXMLPolyDataReader()
    complaints = []
    for event in (vtkCommand.ErrorEvent, vtkCommand.WarningEvent):
        reader.AddObserver(event, lambda *_: complaints.append(path.name))
    reader.SetFileName(str(path))
    reader.Update()
    assert not complaints
    return reader.GetOutput()


def corners(cells, count):
    return vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, count).tolist() if cells.GetNumberOfCells() else []


@pytest.mark.parametrize(
    ("name", "alone", "edges", "triangles"),
    [
        ("mesh", [[4]], [[1, 3]], [[0, 1, 2], [0, 2, 3]]),
        ("points", [[0], [1], [2], [3], [4]], [], []),
        ("complex", [], [[0, 4], [3, 4]], [[2, 1, 0]]),
    ],
)
def test_vtk_reads_dumped_files(folder, name, alone, edges, triangles):
    data = read(folder / f"{name}.vtp")
    assert numpy.array_equal(vtk_to_numpy(data.GetPoints().GetData()), PLACES)
    assert corners(data.GetVerts(), 1) == alone
    assert corners(data.GetLines(), 2) == edges
    assert corners(data.GetPolys(), 3) == triangles
