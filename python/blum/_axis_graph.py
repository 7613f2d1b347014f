"""Graphs of medial axes.

A graph lists the sheets, seams, curves and junctions of an axis.
"""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import Any, Unpack

import numpy.typing as npt

from . import _core
from ._arguments import PathLike, integer
from ._complex import Complex
from ._mesh import Mesh, MeshOrVertices, as_mesh
from ._options import takes
from ._progress import Progress, reporting
from ._structs import AxisGraph, AxisGraphOptions, SheetMatches, SheetMatchOptions

__all__ = ["axis_graph", "match_sheets"]


@takes("AxisGraphOptions")
def axis_graph(
    axis: Complex,
    mesh: MeshOrVertices | None = None,
    triangles: npt.ArrayLike | None = None,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[AxisGraphOptions],
) -> AxisGraph:
    """Returns the sheets, seams, curves and junctions of a medial axis, with areas, lengths and thicknesses.

    Parameters
    ----------
    axis : MedialComplex
        It must have radii and sheets. Another complex with these columns is also accepted.
    mesh, triangles
        The mesh of the axis, as for :func:`distance_field`. If the mesh is known, `patches` contains the smooth parts
        of the mesh, and each sheet has `patch_pairs` for its two sides. Default: the mesh from which the axis was made.
        For an axis from a file, no mesh is known.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    AxisGraph
        Numbers of seams, curves, junctions and patches are indices into the lists of the graph. Sheets are numbered as
        in `triangle_sheet`. `.to_networkx()` converts the graph.

    Examples
    --------
    >>> import blum
    >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
    >>> graph = blum.medial_axis(plate, resolution=48).simplify(120).graph()
    >>> [round(sheet.thickness.median, 6) for sheet in graph.sheets]
    [0.5]
    """
    if not isinstance(axis, Complex):
        raise TypeError(f"axis must be a blum.MedialComplex, not {type(axis).__name__}")
    own = mesh_of(axis, mesh, triangles)
    with reporting(progress) as report:
        found: AxisGraph = _core.axis_graph(
            axis._core,
            None if own is None else own._arrays,
            _stated(axis, options),
            integer(threads, "threads"),
            report,
        )
    return found


@takes("SheetMatchOptions")
def match_sheets(
    first: Complex,
    second: Complex,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SheetMatchOptions],
) -> SheetMatches:
    """Compares the sheets of two medial axes of one solid, and returns those that both have.

    Points are spread evenly over each sheet. A point lies on the sheet of the closest triangle of the other axis, if
    this triangle is within the tolerance. Two sheets are partners if more than half of each lies on the other.

    Parameters
    ----------
    first, second : MedialComplex
        Axes with sheets. Other complexes with a column `sheet` of triangles are also accepted.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    SheetMatches
        `first` and `second` list the sheets of each axis. Each sheet has its `partner`, and all `overlaps` with sheets
        of the other axis. If both axes have patches (`with_patches`), `sides` contains the patches on both sides of a
        sheet.

    Examples
    --------
    >>> import blum
    >>> box = blum.generate("box", size_x=3, size_y=2)
    >>> grid = blum.medial_axis(box, resolution=48).simplify(10).with_patches()
    >>> exact = blum.voronoi_complex(box, part="medial").with_patches().medial_axis(10)
    >>> found = blum.match_sheets(grid, exact)
    >>> found.first.matched, found.second.matched, found.same_sides, found.same_large_sheets
    (13, 13, 13, True)
    """
    for axis in (first, second):
        if not isinstance(axis, Complex):
            raise TypeError(f"an axis must be a blum.MedialComplex, not {type(axis).__name__}")
    with reporting(progress) as report:
        found: SheetMatches = _core.match_sheets(
            first._core, second._core, dict(options), integer(threads, "threads"), report
        )
    return found


def write_graph(
    path: PathLike,
    axis: Complex,
    mesh: MeshOrVertices | None,
    triangles: npt.ArrayLike | None,
    options: AxisGraphOptions,
) -> None:
    """Writes the graph of an axis with the known facts about the axis's origin."""
    own = mesh_of(axis, mesh, triangles)
    origin = getattr(axis, "_origin", None)
    stated = {} if origin is None else {k: v for k, v in vars(origin).items() if k not in ("shape", "version")}
    arrays = None if own is None else own._arrays
    _core.write_graph(Path(os.fspath(path)), axis._core, arrays, _stated(axis, options), stated)


def _stated(axis: Complex, options: AxisGraphOptions) -> dict[str, Any]:
    """Returns the options. If the axis's theta is known, it is the default of `homotopy_angle`."""
    theta = getattr(getattr(axis, "_origin", None), "theta", None)
    return ({} if theta is None else {"homotopy_angle": theta}) | dict(options)


def mesh_of(axis: Complex, mesh: MeshOrVertices | None, triangles: npt.ArrayLike | None) -> Mesh | None:
    """Returns the given mesh, or the mesh that the axis was made from, or None."""
    if mesh is not None:
        return as_mesh(mesh, triangles)
    known = getattr(getattr(axis, "_origin", None), "shape", None)
    return known if isinstance(known, Mesh) else None


def to_networkx(graph: AxisGraph) -> Any:
    """Returns the graph as a networkx.MultiGraph; see AxisGraph.to_networkx."""
    out = multigraph("AxisGraph", **attributes_of(graph))
    for sheet in graph.sheets:
        out.add_node(f"sheet{sheet.sheet}", element="sheet", **attributes_of(sheet))
    for element, parts in (("seam", graph.seams), ("junction", graph.junctions), ("patch", graph.patches)):
        for number, part in enumerate(parts):
            out.add_node(f"{element}{number}", element=element, **attributes_of(part))
    for number, curve in enumerate(graph.curves):
        if curve.junctions is None:
            out.add_node(f"curve{number}", element="curve", **attributes_of(curve))
        else:
            first, last = curve.junctions
            stated = {"element": "curve", "curve": number, **attributes_of(curve)}
            out.add_edge(f"junction{first}", f"junction{last}", **stated)
    for sheet in graph.sheets:
        out.add_edges_from(((f"sheet{sheet.sheet}", f"seam{seam}") for seam in sheet.seams), element="incidence")
        shares: dict[int, float] = {}
        for pair in sheet.patch_pairs:
            for patch in {*pair.first.tolist(), *pair.second.tolist()}:
                shares[patch] = shares.get(patch, 0.0) + pair.share
        for patch, share in sorted(shares.items()):
            out.add_edge(f"sheet{sheet.sheet}", f"patch{patch}", element="wall", share=share)
    for number, junction in enumerate(graph.junctions):
        ends = [f"seam{seam}" for seam in sorted(set(junction.seams.tolist()))]
        ends += [f"sheet{sheet}" for sheet in junction.sheets]
        out.add_edges_from(((end, f"junction{number}") for end in ends), element="incidence")
    return out


def multigraph(caller: str, **attributes: Any) -> Any:
    """Returns an empty networkx.MultiGraph. `caller` is the class whose to_networkx() needs it."""
    try:
        import networkx
    except ImportError as error:
        raise ImportError(f"{caller}.to_networkx() needs networkx: pip install networkx") from error
    return networkx.MultiGraph(**attributes)


def attributes_of(part: Any, prefix: str = "") -> dict[str, Any]:
    """Returns the members that are values, by name. Names of nested members follow those of their parents."""
    out: dict[str, Any] = {}
    for field in dataclasses.fields(part):
        value, name = getattr(part, field.name), prefix + field.name
        if dataclasses.is_dataclass(value):
            out |= attributes_of(value, f"{name}_")
        elif isinstance(value, (bool, int, float, str)):
            out[name] = value
        elif field.type == "tuple[float, float, float]":
            out |= {f"{name}_{axis}": number for axis, number in zip("xyz", value, strict=True)}
    return out
