"""Closed meshes that face outwards, without needles and needless vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Real, integer, number
from ._mesh import Mesh, MeshLike, as_mesh, mesh_of_arrays
from ._progress import Progress, reporting
from ._solid import Solid
from ._structs import CleanReport
from ._warn import warn_all


@dataclass(frozen=True, eq=False)
class CleanedMesh:
    """A cleaned mesh: what :func:`clean_mesh` returns."""

    mesh: Mesh  #: its vertices are some of the input's, in their order
    vertex_of: npt.NDArray[np.uint32]  #: of each vertex, in the input; 0xffffffff: new
    report: CleanReport  #: what was done, and the bound that holds


def clean_mesh(
    mesh: MeshLike | Solid,
    tolerance: Real,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> CleanedMesh:
    """A closed mesh without needles and vertices that it can do without: what to do before :func:`voronoi_complex`.

    Vertices are moved onto neighbours and edges of flat triangles are turned, one by one. The surface stays what it is
    up to homeomorphism, no triangles cross or touch (in exact arithmetic), and the solid keeps its Betti numbers.

    Parameters
    ----------
    mesh : mesh
        As for :func:`distance_field`, closed; or a :class:`Solid`. It may face any way, and cross itself: the result is
        then near the surface without the crossings.
    tolerance : float
        The result is nowhere further from the mesh than this, nor the mesh from it, for certain; mesh units.
    weld, threads, progress
        As for :func:`distance_field`.

    Raises
    ------
    InvalidMesh, InvalidOption (both ValueError), TypeError, KeyboardInterrupt

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


@dataclass(frozen=True, eq=False)
class OrientedMesh:
    """A mesh that faces away from the solid: what :func:`oriented_mesh` returns."""

    mesh: Mesh  #: the given one, but that the last two corners of some triangles have changed places
    reversed_triangles: int  #: that faced another way than most of their shell
    reversed_shells: int  #: that faced the solid, as a whole


def oriented_mesh(
    mesh: MeshLike, *, weld: Real | None = None, threads: int = 0, progress: Progress = False
) -> OrientedMesh:
    """The same triangles, in their order, turned such that all face away from the solid that they bound.

    First those are turned that disagree with most of their shell, then shells that face the solid.

    Parameters
    ----------
    mesh : mesh
        As for :func:`distance_field`: closed and manifold.
    weld, threads, progress
        As for :func:`distance_field`.

    Raises
    ------
    InvalidMesh (a ValueError), TypeError, KeyboardInterrupt

    >>> import blum
    >>> box = blum.generate("box")
    >>> found = blum.oriented_mesh((box.vertices, box.triangles[:, ::-1]))
    >>> found.reversed_shells, blum.topology(found.mesh).faces_outwards
    (1, True)
    """
    given = as_mesh(mesh, weld=weld)
    with reporting(progress) as report:
        arrays, triangles, shells = _core.oriented_mesh(given._arrays, integer(threads, "threads"), report)
    return OrientedMesh(mesh_of_arrays(arrays), triangles, shells)
