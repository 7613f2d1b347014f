"""Cleaned meshes.

Cleaned meshes are closed, face outwards, and have no needles and no redundant vertices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Real, integer, number, thread_number
from ._mesh import Mesh, MeshLike, as_mesh, mesh_of_arrays
from ._methods import Shown
from ._progress import Progress, reporting
from ._solid import Solid
from ._structs import CleanReport
from ._warn import warn_all

__all__ = ["CleanedMesh", "OrientedMesh", "clean_mesh", "oriented_mesh"]


@dataclass(frozen=True, eq=False, repr=False)
class CleanedMesh(Shown):
    """Result of :func:`clean_mesh`.

    Examples
    --------
    >>> import blum
    >>> found = blum.clean_mesh(blum.generate("box"), 1e-6)
    >>> found.vertex_of.tolist() == list(range(8)), found.report.collapses
    (True, 0)
    """

    mesh: Mesh  #: Its vertices are some of the input's, in their order, then those at which the input crossed itself.
    vertex_of: npt.NDArray[np.uint32]  #: Index of each vertex in the input. 0xffffffff: a new vertex.
    report: CleanReport  #: Counts of changes, and the bound on the deviation.


def clean_mesh(
    mesh: MeshLike | Solid,
    tolerance: Real,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> CleanedMesh:
    """Returns a closed mesh without needles and redundant vertices, for example as input for :func:`voronoi_complex`.

    Vertices are moved onto neighbours, and edges of flat triangles are flipped, one at a time. The surface stays
    homeomorphic to the input. No triangles of the result cross or touch, in exact arithmetic. The solid keeps its Betti
    numbers.

    Parameters
    ----------
    mesh : mesh or Solid
        A closed mesh, as for :func:`distance_field`, or a :class:`Solid`. Triangles may face any way, and may cross. If
        triangles cross, the result is near the surface without the crossings.
    tolerance : float
        Guaranteed bound on the deviation, mesh units. No point of the result is further than this from the mesh, and no
        point of the mesh is further than this from the result.
    weld, threads, progress
        As for :func:`distance_field`. `weld` is ignored for a :class:`Solid`.

    Raises
    ------
    InvalidMesh, InvalidOption (both ValueError), TypeError, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> found = blum.clean_mesh(blum.subdivided(blum.generate("box"), 3), 1e-6)
    >>> found.mesh, found.report.triangles_before, found.report.deviation < 1e-12
    (Mesh(8 vertices, 12 triangles), 768, True)
    """
    most, count = number(tolerance, "tolerance"), integer(threads, "threads")
    if isinstance(mesh, Solid):
        with reporting(progress) as report:
            arrays, vertex_of, done, found = _core.clean_solid(mesh._core, most, count, report)
    else:
        given = as_mesh(mesh, weld=weld)
        with reporting(progress) as report:
            arrays, vertex_of, done, found = _core.clean_mesh(given._arrays, most, count, report)
    warn_all(found)
    return CleanedMesh(mesh_of_arrays(arrays), vertex_of, done)


@dataclass(frozen=True, eq=False, repr=False)
class OrientedMesh(Shown):
    """Result of :func:`oriented_mesh`.

    Examples
    --------
    >>> import blum
    >>> found = blum.oriented_mesh(blum.generate("box"))
    >>> found.mesh, found.reversed_triangles, found.reversed_shells
    (Mesh(8 vertices, 12 triangles), 0, 0)
    """

    mesh: Mesh  #: The input, in which the last two corners of some triangles are swapped.
    reversed_triangles: int  #: Triangles that faced another way than most of their shell.
    reversed_shells: int  #: Shells that faced the solid.


def oriented_mesh(
    mesh: MeshLike, *, weld: Real | None = None, threads: int = 0, progress: Progress = False
) -> OrientedMesh:
    """Returns the same triangles in the same order, all facing away from the solid that they bound.

    First, triangles that face another way than most of their shell are reversed. Then, shells that face into the solid
    are reversed.

    Parameters
    ----------
    mesh : mesh
        As for :func:`distance_field`. The mesh must be closed and manifold.
    weld, threads, progress
        As for :func:`distance_field`.

    Raises
    ------
    InvalidMesh (a ValueError), TypeError, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.oriented_mesh((box.vertices, box.triangles[:, ::-1]))
    >>> found.reversed_shells, blum.topology(found.mesh).faces_outwards
    (1, True)
    """
    given = as_mesh(mesh, weld=weld)
    with reporting(progress) as report:
        arrays, triangles, shells = _core.oriented_mesh(given._arrays, thread_number(threads), report)
    return OrientedMesh(mesh_of_arrays(arrays), triangles, shells)
