"""Extended medial axes.

The sheets of an extended axis reach the surface. They serve as meshes of shell elements.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, PathLike, integer
from ._axis_graph import mesh_of
from ._complex import Complex, core_arguments
from ._errors import InvalidOption
from ._mesh import Mesh, MeshOrVertices
from ._options import takes
from ._progress import Progress, reporting
from ._structs import ExtendOptions, ExtendReport
from ._warn import warn_all

__all__ = ["ExtendedAxis", "extend_axis"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex


class ExtendedAxis(Complex):
    """Medial axis whose sheets reach the surface; the result of :func:`extend_axis`.

    The vertices of the axis come first, in their order; the new vertices follow. The edges of the result are the curves
    of the axis. Vertices and curves in gaps between sheets are left out if extensions close the gap (option `join`).

    Examples
    --------
    >>> import blum
    >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
    >>> shell = blum.medial_axis(plate, resolution=24).simplify(120).extend()
    >>> bool(shell.triangle_extended.any()), shell.thickness.shape == (len(shell.vertices),)
    (True, True)
    """

    #: Outcome for the rims, with counts and lengths.
    report: ExtendReport
    _stated: dict[str, Any]

    @staticmethod
    def _of(core: _CoreComplex, report: ExtendReport, stated: dict[str, Any]) -> ExtendedAxis:
        made = ExtendedAxis.__new__(ExtendedAxis)
        made._core = core
        made.report = report
        made._stated = stated
        return made

    @property
    def thickness(self) -> FloatArray:
        """Twice the radius of the axis at each vertex: (n,), mesh units. New vertices have the value of their rim."""
        found: FloatArray = self.vertex_columns["thickness"]
        return found

    @property
    def triangle_sheet(self) -> IntArray:
        """Sheet of the axis that each triangle belongs to or extends: (m,)."""
        found: IntArray = self.triangle_columns["sheet"]
        return found

    @property
    def triangle_extended(self) -> IntArray:
        """1 for new triangles, 0 for those of the axis: (m,)."""
        found: IntArray = self.triangle_columns["extended"]
        return found

    def write(self, path: PathLike) -> None:
        """Writes .vtp, .ply, .obj, .npz or .stl (triangles only). The file appears under its name only when it is
        complete.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
        >>> shell = blum.medial_axis(plate, resolution=24).simplify(120).extend()
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     shell.write(pathlib.Path(folder) / "shell.vtp")
        ...     (pathlib.Path(folder) / "shell.vtp").stat().st_size > 1000
        True
        """
        _core.write_extended(Path(os.fspath(path)), self._core, self._stated)

    def to_mesh(self) -> Mesh:
        """Returns the vertices and triangles as a mesh, without the curves.

        Examples
        --------
        >>> import blum
        >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
        >>> shell = blum.medial_axis(plate, resolution=24).simplify(120).extend()
        >>> len(shell.to_mesh().triangles) == len(shell.triangles)
        True
        """
        return Mesh(np.array(self.vertices), np.array(self.triangles))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (core_arguments(self), self.report, self._stated)

    def __repr__(self) -> str:
        return f"ExtendedAxis({len(self.vertices):,} vertices, {len(self.triangles):,} triangles)"


def _restored(arguments: tuple[Any, ...], report: ExtendReport, stated: dict[str, Any]) -> ExtendedAxis:
    return ExtendedAxis._of(_core.Complex(*arguments), report, stated)


@takes("ExtendOptions")
def extend_axis(
    axis: Complex,
    mesh: MeshOrVertices | None = None,
    triangles: npt.ArrayLike | None = None,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[ExtendOptions],
) -> ExtendedAxis:
    """Returns the sheets of a medial axis, extended from their rims to the surface: a mesh for shell elements.

    Use an axis at theta 100 to 120. A smaller angle adds sheets that run into edges; a larger angle leaves gaps where
    walls meet. If a rim reaches another sheet before the surface, the extension ends at that sheet. With `join`, the
    extension shares vertices and edges with that sheet, whose triangles are divided. The result has the topology of the
    axis.

    Parameters
    ----------
    axis : MedialComplex
        It must have radii and sheets. Another complex with these columns is also accepted.
    mesh, triangles
        The mesh of the axis, as for :func:`distance_field`. Default: the mesh from which the axis was made. For an axis
        from a file, the mesh must be given.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    ExtendedAxis
        Triangles with `thickness`, `triangle_sheet` and `triangle_extended`. `.report` contains the outcome for the
        rims.

    Examples
    --------
    >>> import blum
    >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.25)
    >>> shell = blum.medial_axis(plate, resolution=48).certified(120).extend()
    >>> round(shell.report.area, 6), shell.report.not_reached
    (6.0, 0)
    """
    if not isinstance(axis, Complex):
        raise TypeError(f"axis must be a blum.MedialComplex, not {type(axis).__name__}")
    own = mesh_of(axis, mesh, triangles)
    if own is None:
        raise InvalidOption("the mesh of this axis is not known here: pass it, as in extend_axis(axis, mesh)")
    with reporting(progress) as report:
        core, stated, found = _core.extend_axis(
            axis._core, own._arrays, dict(options), integer(threads, "threads"), report
        )
    warn_all(found)
    origin = getattr(axis, "_origin", None)
    known = {} if origin is None else {k: v for k, v in vars(origin).items() if k not in ("shape", "version")}
    return ExtendedAxis._of(core, stated, known)
