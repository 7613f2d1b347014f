"""Solids of meshes and images."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Unpack, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import (
    Integer,
    Real,
    check_finite,
    integer,
    label_of,
    optional_number,
    points_and_shape,
    thread_number,
)
from ._complex import Complex
from ._grid import check_one
from ._image import Image, as_image, is_image, labelled, refuse_selection
from ._mesh import Betti, Mesh, MeshOrVertices, as_mesh, betti_of, mesh_of_arrays
from ._methods import Rebuilt, Shown
from ._options import takes
from ._progress import Progress, ProgressCallback, reporting
from ._structs import Bounds, CellularModelOptions, CellularModelReport, CrossingCounts, SolidShell

__all__ = ["CellularModel", "Solid", "SolidBody"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreModel = _core.CellularModel
_CoreSolid = _core.Solid


@dataclass(frozen=True, eq=False, repr=False)
class SolidBody(Shown):
    """Connected part of a solid, or the whole of it, with the triangles of the input around it.

    Examples
    --------
    >>> import blum
    >>> (body,) = blum.Solid(blum.generate("box")).bodies
    >>> body.mesh, body.betti, body.shells
    (Mesh(8 vertices, 12 triangles), (1, 0, 0), (0,))
    """

    mesh: Mesh  #: Its surface. For a polyhedron, it faces outwards.
    #: Vertex of the input for each vertex of `mesh`. 0xffffffff: a new one, at which triangles crossed.
    vertex_of: npt.NDArray[np.uint32]
    triangle_of: npt.NDArray[np.uint32]  #: Triangle of the input of which each triangle of `mesh` is a part.
    betti: Betti  #: Polyhedra: components, tunnels, voids.
    shells: tuple[int, ...]  #: Polyhedra: the outer shell, then its voids.


class CellularModel(Rebuilt):
    """Cell complex with the homotopy type of a polyhedron; the result of :meth:`Solid.model`.

    A pickle or copy holds the solid and the options, and computes the model again at its first use.

    Examples
    --------
    >>> import blum
    >>> blum.Solid(blum.generate("box")).model(resolution=2).passes
    True
    """

    def __init__(self, core: Any, solid: Solid, options: dict[str, Any]) -> None:
        self._core = core
        self._solid = solid
        self._options = options

    @cached_property
    def _core(self) -> _CoreModel:
        return self._solid._core.model(self._options, 0, None)

    @property
    def report(self) -> CellularModelReport:
        """Counts of the model's cells, and the boxes that fail the test."""
        found: CellularModelReport = self._core.report
        return found

    @property
    def passes(self) -> bool:
        """True if every component in a cell is contractible, so that the model has the solid's homotopy type."""
        return self.report.passes

    def complex(self, *, threads: int = 0, progress: Progress = False) -> Complex:
        """Returns the model after removal of free cells from outside, as far as possible.

        Examples
        --------
        >>> import blum
        >>> blum.Solid(blum.generate("box")).model(resolution=2).complex()
        Complex(1 vertices, 0 edges, 0 triangles)
        """
        with reporting(progress) as report:
            return Complex._from_core(self._core.complex(thread_number(threads), report))

    def betti(self, *, threads: int = 0, progress: Progress = False) -> Betti:
        """Returns components, tunnels and voids, by the homology of :meth:`complex`.

        Examples
        --------
        >>> import blum
        >>> blum.Solid(blum.generate("torus")).model(resolution=4).betti()
        (1, 1, 0)
        """
        with reporting(progress) as report:
            numbers: Any = self._core.betti(integer(threads, "threads"), report)
        return betti_of(numbers)

    def __repr__(self) -> str:
        return f"CellularModel(passes={self.passes}, cells={self.report.cells})"


class Solid(Rebuilt):
    """Solid of a mesh or an image: its rule, its bodies and their topology.

    Closed meshes that do not cross themselves bound polyhedra. Shells and triangles that face the wrong way are
    reversed. Meshes that cross themselves become polyhedra if few triangles cross: the solid is where the winding
    number is 1 or more. For other meshes, the solid is where the winding number is above 1/2. For images, the solid is
    the union of the selected voxels; voxels that touch in a corner are connected.

    A pickle or copy holds the mesh or the image. The copy computes the solid again at its first use, from the arrays of
    the shape, which must not have changed in place.

    Parameters
    ----------
    shape, triangles
        A mesh, as for :func:`distance_field`, or an image, as for :func:`distance_transform`.
    label, threshold
        Images: `label` selects voxels of this value, `threshold` voxels of at least this value. Default: the nonzero
        voxels.
    weld : float, optional
        Meshes: as for :func:`distance_field`.
    threads, progress
        As for :func:`distance_field`.

    Raises
    ------
    InvalidMesh, InvalidImage, InvalidOption (all ValueError), TypeError, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> solid = blum.Solid(blum.generate("torus"))
    >>> solid.rule, solid.betti, solid.inside([[0, 0, 0], [1, 0, 0]])
    ('polyhedron', (1, 1, 0), array([False,  True]))
    """

    def __init__(
        self,
        shape: MeshOrVertices | Image,
        triangles: npt.ArrayLike | None = None,
        *,
        label: Integer | None = None,
        threshold: Real | None = None,
        weld: Real | None = None,
        threads: int = 0,
        progress: Progress = False,
    ) -> None:
        count = integer(threads, "threads")
        self._label = None if label is None else label_of(label, "label")
        self._threshold = optional_number(threshold, "threshold")
        self._shape: Mesh | Image
        if triangles is None and is_image(shape):
            self._shape = labelled(as_image(shape), None if self._label is None else [self._label])
        else:
            refuse_selection(label, threshold)
            self._shape = as_mesh(cast(MeshOrVertices, shape), triangles, "shape", weld=weld)
        with reporting(progress) as report:
            self._core = self._made(count, report)

    def _made(self, threads: int, report: ProgressCallback | None) -> _CoreSolid:
        if isinstance(self._shape, Image):
            return _core.solid_of_image(self._shape._arrays, self._label, self._threshold, threads, report)
        return _core.solid_of_mesh(self._shape._arrays, threads, report)

    @cached_property
    def _core(self) -> _CoreSolid:
        return self._made(0, None)

    @property
    def rule(self) -> str:
        """Rule that decides which points are inside: "polyhedron", "winding" or "voxels"."""
        return self._core.rule

    @property
    def reason(self) -> str:
        """Reason for this rule, one sentence."""
        return self._core.reason

    @property
    def problem(self) -> str:
        """Reason why the mesh does not bound separate bodies, with advice. Empty if it bounds separate bodies."""
        return self._core.problem

    @property
    def surface(self) -> Mesh:
        """Surface of all bodies of a mesh, which faces outwards.

        Vertices and triangles have the numbers of the input, unless crossings were resolved.
        """
        return mesh_of_arrays(self._core.surface)

    @property
    def betti(self) -> Betti | None:
        """Components, tunnels and voids. None for "winding", because only the voxels of such a solid have Betti
        numbers."""
        numbers: Any = self._core.betti
        return None if numbers is None else betti_of(numbers)

    @property
    def bodies(self) -> tuple[SolidBody, ...]:
        """Polyhedra: the bodies, each facing outwards. "winding": one body with all triangles. Images: none."""
        return tuple(
            SolidBody(mesh_of_arrays(arrays), vertices, triangles, betti_of(betti), tuple(map(int, shells)))
            for arrays, vertices, triangles, betti, shells in self._core.bodies
        )

    @property
    def shells(self) -> tuple[SolidShell, ...]:
        """Shells of a polyhedron, in the order of their smallest triangles."""
        return tuple(self._core.shells)

    @property
    def reversed_shells(self) -> int:
        """Number of shells that faced the wrong way and were reversed."""
        return self._core.reversed_shells

    @property
    def reversed_triangles(self) -> int:
        """Number of triangles that faced another way than most of their shell and were reversed."""
        return self._core.reversed_triangles

    @property
    def resolved(self) -> CrossingCounts | None:
        """Counts of the crossings that were resolved. None if no crossings were resolved."""
        found: CrossingCounts | None = self._core.resolved
        return found

    @property
    def faces_inwards(self) -> bool:
        """True for "winding" if the triangles face inwards as a whole, so that hardly anything is inside."""
        return self._core.faces_inwards

    @property
    def bounds(self) -> Bounds:
        """Meshes: box around the input. Images: box around all voxels, selected or not."""
        lower, upper = self._core.box
        return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])

    def inside(self, points: Any, *, threads: int = 0, progress: Progress = False) -> npt.NDArray[np.bool_]:
        """Returns True for each of the points (..., 3) that lies in the solid.

        It is exact for closed, consistently oriented meshes. Points on the surface of a polyhedron lie in it.

        Parameters
        ----------
        points : array of shape (..., 3)
            Finite.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> blum.Solid(blum.generate("box")).inside([[0, 0, 0.5], [0, 0, 0.6]]).tolist()
        [True, False]
        """
        rows, shape = points_and_shape(points, "points")
        check_finite(rows, shape, "points")
        with reporting(progress) as report:
            found: npt.NDArray[np.uint8] = self._core.inside(rows, integer(threads, "threads"), report)
        return found.view(np.bool_).reshape(shape)

    @takes("CellularModelOptions")
    def model(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[CellularModelOptions]
    ) -> CellularModel:
        """Returns a cell complex with the homotopy type of a polyhedron, at any resolution.

        Parameters
        ----------
        **options
        threads, progress
            As for :func:`distance_field`.

        Raises
        ------
        InvalidOption, also for an image. InvalidMesh, unless the solid is a polyhedron.

        Examples
        --------
        >>> import blum
        >>> model = blum.Solid(blum.generate("torus")).model(resolution=4)
        >>> model.passes, model.betti()
        (True, (1, 1, 0))
        """
        check_one(options.get("resolution"), options.get("spacing"), "sides of the cubes")
        count = integer(threads, "threads")
        with reporting(progress) as report:
            return CellularModel(self._core.model(dict(options), count, report), self, dict(options))

    def __repr__(self) -> str:
        return f"Solid(rule={self.rule!r}, betti={self.betti}, bodies={len(self._core.bodies)})"
