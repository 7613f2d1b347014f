"""Solids: what a mesh or an image stands for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Unpack, cast

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Integer, Real, integer, label_of, optional_number, points_and_shape
from ._complex import Complex
from ._image import Image, as_image, is_image, refuse_selection
from ._mesh import Betti, Mesh, MeshOrVertices, as_mesh, betti_of, mesh_of_arrays
from ._options import takes
from ._progress import Progress, reporting
from ._structs import Bounds, CellularModelOptions, CellularModelReport, CrossingCounts, SolidShell


@dataclass(frozen=True)
class SolidBody:
    """A connected part of a solid, or the whole of it, and the triangles of the input around it."""

    mesh: Mesh  #: of a polyhedron, it faces outwards
    vertex_of: npt.NDArray[
        np.uint32
    ]  #: of each vertex of `mesh`, in the input; 0xffffffff: new, where triangles crossed
    triangle_of: npt.NDArray[np.uint32]  #: of each triangle of `mesh`, that of the input which it is a part of
    betti: Betti  #: components, tunnels, voids; of polyhedra
    shells: tuple[int, ...]  #: of polyhedra: the outer one, then its voids


class CellularModel:
    """A cell complex with the homotopy type of a polyhedron: see :meth:`Solid.model`."""

    def __init__(self, core: Any) -> None:
        self._core = core

    @property
    def report(self) -> CellularModelReport:
        """What it consists of, and the places that do not pass."""
        found: CellularModelReport = self._core.report
        return found

    @property
    def passes(self) -> bool:
        """Whether every component in a cell is contractible, so that the model has the solid's homotopy type."""
        return self.report.passes

    def complex(self, *, threads: int = 0, progress: Progress = False) -> Complex:
        """The model, collapsed as far as removing free cells from outside goes."""
        with reporting(progress) as report:
            return Complex._from_core(self._core.complex(integer(threads, "threads"), report))

    def betti(self, *, threads: int = 0, progress: Progress = False) -> Betti:
        """Components, tunnels and voids, by the homology of :meth:`complex`."""
        with reporting(progress) as report:
            numbers: Any = self._core.betti(integer(threads, "threads"), report)
        return betti_of(numbers)

    def __repr__(self) -> str:
        return f"CellularModel(passes={self.passes}, cells={self.report.cells})"


class Solid:
    """The solid that a mesh or an image stands for: by which rule, its bodies, and their topology.

    Closed meshes that do not cross themselves are polyhedra, shell by shell; shells and triangles that face the wrong
    way are reversed. Those that do cross become polyhedra, too, where few triangles cross: the solid is where the
    winding number is 1 or more. Of other meshes it is where that is above 1/2. Of images it is the union of the
    selected voxels, which touch in corners.

    Parameters
    ----------
    shape, triangles
        A mesh, as for :func:`distance_field`; or an image: an array [z, y, x], an :class:`Image`, a path.
    label, threshold
        Images: which voxels; default: those that are not zero.
    weld : float, optional
        Meshes: as for :func:`distance_field`.

    Raises
    ------
    InvalidMesh, InvalidImage, InvalidOption (all ValueError), TypeError, KeyboardInterrupt

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
        if triangles is None and is_image(shape):
            image = as_image(shape)
            chosen = None if label is None else label_of(label, "label")
            least = optional_number(threshold, "threshold")
            with reporting(progress) as report:
                self._core = _core.solid_of_image(image._arrays, chosen, least, count, report)
            return
        refuse_selection(label, threshold)
        mesh = as_mesh(cast(MeshOrVertices, shape), triangles, "shape", weld=weld)
        with reporting(progress) as report:
            self._core = _core.solid_of_mesh(mesh._arrays, count, report)

    @property
    def rule(self) -> str:
        """What tells its inside: "polyhedron", "winding" or "voxels"."""
        return self._core.rule

    @property
    def reason(self) -> str:
        """One sentence: why this rule."""
        return self._core.reason

    @property
    def problem(self) -> str:
        """What keeps a mesh from bounding bodies that do not touch, with what to do; empty where nothing does."""
        return self._core.problem

    @property
    def surface(self) -> Mesh:
        """Meshes: the surface of all bodies, which faces outwards. Triangles and vertices have the numbers that they
        have in the input, but where crossings were resolved."""
        return mesh_of_arrays(self._core.surface)

    @property
    def betti(self) -> Betti | None:
        """Components, tunnels and voids; None for "winding", where only voxels have numbers."""
        numbers: Any = self._core.betti
        return None if numbers is None else betti_of(numbers)

    @property
    def bodies(self) -> tuple[SolidBody, ...]:
        """Polyhedra: each faces outwards. "winding": one, of all triangles. Images: none."""
        return tuple(
            SolidBody(mesh_of_arrays(arrays), vertices, triangles, betti_of(betti), tuple(map(int, shells)))
            for arrays, vertices, triangles, betti, shells in self._core.bodies
        )

    @property
    def shells(self) -> tuple[SolidShell, ...]:
        """Of polyhedra, in the order of their smallest triangles."""
        return tuple(self._core.shells)

    @property
    def reversed_shells(self) -> int:
        """How many shells faced the wrong way and were reversed."""
        return self._core.reversed_shells

    @property
    def reversed_triangles(self) -> int:
        """How many triangles faced another way than most of their shell and were reversed."""
        return self._core.reversed_triangles

    @property
    def resolved(self) -> CrossingCounts | None:
        """What stood in the way of the mesh being a polyhedron, where that was resolved; None where nothing did."""
        found: CrossingCounts | None = self._core.resolved
        return found

    @property
    def faces_inwards(self) -> bool:
        """ "winding": whether the triangles face inwards as a whole, so that hardly anything is inside."""
        return self._core.faces_inwards

    @property
    def bounds(self) -> Bounds:
        """Meshes: the box around the input. Images: that of all voxels, selected or not."""
        lower, upper = self._core.box
        return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])

    def inside(self, points: Any, *, threads: int = 0, progress: Progress = False) -> npt.NDArray[np.bool_]:
        """Whether points (..., 3) lie in the solid; those of a polyhedron's surface do. Exact for closed ones."""
        rows, shape = points_and_shape(points, "points")
        if not np.isfinite(rows).all():
            raise ValueError("points must be finite")
        with reporting(progress) as report:
            found: npt.NDArray[np.uint8] = self._core.inside(rows, integer(threads, "threads"), report)
        return found.view(np.bool_).reshape(shape)

    @takes("CellularModelOptions")
    def model(
        self, *, threads: int = 0, progress: Progress = False, **options: Unpack[CellularModelOptions]
    ) -> CellularModel:
        """A cell complex with the homotopy type of a polyhedron, at any resolution.

        Parameters
        ----------
        **options
        threads, progress
            As for :func:`distance_field`.

        Raises
        ------
        InvalidOption, also for an image; InvalidMesh unless the solid is a polyhedron.

        >>> import blum
        >>> model = blum.Solid(blum.generate("torus")).model(resolution=4)
        >>> model.passes, model.betti()
        (True, (1, 1, 0))
        """
        count = integer(threads, "threads")
        with reporting(progress) as report:
            return CellularModel(self._core.model(dict(options), count, report))

    def __repr__(self) -> str:
        return f"Solid(rule={self.rule!r}, betti={self.betti}, bodies={len(self._core.bodies)})"
