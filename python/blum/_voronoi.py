"""Voronoi diagrams of polyhedra."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, IntArray, PathLike, Real, integer, number
from ._axis_graph import attributes_of, multigraph
from ._complex import Complex, core_arguments
from ._errors import InvalidOption
from ._medial_complex import EVERYTHING, MedialComplex, Origin
from ._mesh import Mesh, MeshOrVertices, as_mesh, mesh_of_arrays
from ._methods import ShortList
from ._options import takes
from ._progress import Progress, reporting
from ._solid import Solid
from ._structs import VoronoiGraph, VoronoiOptions, VoronoiPatch, VoronoiRegion, VoronoiReport, VoronoiSite
from ._warn import warn

__all__ = ["VoronoiComplex", "voronoi_complex"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreComplex = _core.Complex


class VoronoiComplex(Complex):
    """Walls of a Voronoi diagram and the surface of its mesh, as triangles; the result of :func:`voronoi_complex`.

    Examples
    --------
    >>> import blum
    >>> found = blum.voronoi_complex(blum.generate("box"), resolution=2)
    >>> found.triangle_sites.shape == (len(found.triangles), 2), found.part
    (True, 'all')
    """

    #: Counts of its parts, and whether it is certified.
    report: VoronoiReport
    #: "all", "walls" or "medial".
    part: str
    _mesh: Mesh

    @staticmethod
    def _of(core: _CoreComplex, report: VoronoiReport, part: str, mesh: Mesh) -> VoronoiComplex:
        made = VoronoiComplex.__new__(VoronoiComplex)
        made._core = core
        made.report = report
        made.part = part
        made._mesh = mesh
        return made

    @property
    def radius(self) -> FloatArray:
        """Distance of each vertex from the closest site: (n,), mesh units. 0 on the surface."""
        found: FloatArray = self.vertex_columns["radius"]
        return found

    @property
    def triangle_sites(self) -> IntArray:
        """Sites of the regions on both sides of each triangle: (m, 2), the smaller index first. -1 outside."""
        columns = self.triangle_columns
        return np.stack([columns["site_a"], columns["site_b"]], axis=1)

    @property
    def footprints(self) -> FloatArray:
        """Closest points of the surface: (n, 2, 3). If more than two exist, the two with the largest angle between
        them."""
        columns = self.vertex_columns
        return np.stack([columns["footprint_0"], columns["footprint_1"]], axis=1)

    @property
    def separation_angle(self) -> FloatArray:
        """Angle between the footprints of each vertex: (n,), degrees."""
        found: FloatArray = self.vertex_columns["separation_angle"]
        return found

    def sites(self) -> list[VoronoiSite]:
        """Returns the sites: the faces, edges and vertices of the mesh to which `triangle_sites` and the regions refer.

        Each site has `kind` ("face", "edge" or "vertex"), `triangles` (of a face) and `vertices` (of an edge or a
        vertex).

        Examples
        --------
        >>> import blum
        >>> found = blum.voronoi_complex(blum.generate("box")).sites()
        >>> len(found), found[0].kind, len(found[0].triangles)
        (6, 'face', 2)
        """
        return ShortList(_core.voronoi_sites(self._mesh._arrays, self.report.joined_faces))

    def regions(self) -> list[VoronoiRegion]:
        """Returns the regions by ascending site, each with `volume`, `surface_area` and `neighbours` (`site`, `area`).

        The diagram must have been made with `part="all"`.

        Examples
        --------
        >>> import blum
        >>> found = blum.voronoi_complex(blum.generate("box")).regions()
        >>> len(found), round(sum(region.volume for region in found), 9)
        (6, 1.0)
        """
        if self.part != "all":
            raise InvalidOption(f'regions need walls and surface: part="all", not "{self.part}"')
        return ShortList(_core.voronoi_regions(self._core))

    def patches(self, patch_angle: Real = 30.0, *, patch_fit: Real | None = None) -> list[VoronoiPatch]:
        """Returns the patches of the sites: smooth parts of the surface, each of which can be treated as one site.

        Each patch has `kind` ("face", "edge" or "vertex") and `sites`. A patch of faces contains the reflex edges and
        vertices inside it. Reflex edges between patches form patches of their own.

        Parameters
        ----------
        patch_angle : float
            Degrees, 0 to 180. The largest bend at an edge between two faces of one patch.
        patch_fit : float, optional
            Mesh units, above 0. If given, patches of faces are parts of planes, spheres, cylinders and cones, with all
            vertices at most this far from their `shape`. Flat faces that fit no other shape are planes.

        Examples
        --------
        >>> import blum
        >>> found = blum.voronoi_complex(blum.generate("cylinder", sides=48))
        >>> len(found.sites()), len(found.patches())
        (50, 3)
        >>> side = found.patches(patch_fit=1e-6)[1].shape
        >>> side.kind, round(side.radius, 9)
        ('cylinder', 0.5)
        """
        options = _patch_options(patch_angle, patch_fit)
        return ShortList(_core.voronoi_patches(self._mesh._arrays, self.report.joined_faces, options))

    def with_patches(self, patch_angle: Real = 30.0, *, patch_fit: Real | None = None) -> VoronoiComplex:
        """Returns this complex with the patches on both sides of each triangle, as columns `patch_a` and `patch_b`.

        Patches are numbered as by :meth:`patches` for the same arguments. The smaller number comes first. `patch_a` is
        -1 on the surface. Inside a patch, both numbers are equal. The axis from :meth:`medial_axis` keeps these
        columns. Its column `patch_sheet` contains the sheet between the two patches. `graph(of_patches=True)` returns
        the graph of these sheets.

        Examples
        --------
        >>> import blum
        >>> walls = blum.voronoi_complex(blum.generate("cylinder", sides=48), part="medial")
        >>> axis = walls.with_patches().medial_axis()
        >>> [sheet.sides for sheet in axis.graph(of_patches=True).sheets]
        [(0, 1), (1, 2)]
        """
        options = _patch_options(patch_angle, patch_fit)
        core = _core.with_patches(self._core, self._mesh._arrays, self.report.joined_faces, options)
        return VoronoiComplex._of(core, self.report, self.part, self._mesh)

    def graph(self, patch_angle: Real | None = None, *, patch_fit: Real | None = None) -> VoronoiGraph:
        """Returns the regions (for `part="all"`), walls, seams and junctions, and their connections.

        `.to_networkx(sites)` converts the graph.

        Parameters
        ----------
        patch_angle : float, optional
            If given, the graph is that of the :meth:`patches`, which its member `patches` lists. All numbers of sites
            in this graph are then numbers of patches.
        patch_fit : float, optional
            If given, patches are those of fitted shapes, also listed in `patches`. `patch_angle` is then 30 by default.

        Examples
        --------
        >>> import blum
        >>> box = blum.Mesh(blum.generate("box").vertices * [1, 2, 3], blum.generate("box").triangles)
        >>> graph = blum.voronoi_complex(box).graph()
        >>> len(graph.regions), len(graph.walls), len(graph.seams), len(graph.junctions)
        (6, 13, 12, 12)
        """
        found: VoronoiGraph = _core.voronoi_graph(
            self._core, self._mesh._arrays, self.report.joined_faces, _given_patches(patch_angle, patch_fit)
        )
        return found

    def medial_axis(self, theta: Real = 1.0, *, threads: int = 0, progress: Progress = False) -> MedialComplex:
        """Returns the part of the medial axis with separation angles above theta, and the cells that connect this part.

        The complex must have been made with `part="medial"`. Triangles with angles of at most theta are removed by
        elementary collapses, so the topology stays. The result for a larger theta is a part of the result for a smaller
        theta.

        Parameters
        ----------
        theta : float
            Degrees, 0 to 180.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> walls = blum.voronoi_complex(blum.generate("box"), part="medial")
        >>> axis = walls.medial_axis(60)
        >>> axis.certificate.holds, len(walls.medial_axis(120).triangles) < len(axis.triangles)
        (True, True)
        """
        if self.part != "medial":
            raise InvalidOption(f'a medial axis needs walls with two footprints: part="medial", not "{self.part}"')
        angle = number(theta, "theta")
        if not self.report.certified:
            warn(
                "the complex is not certified, so the topology of the axis may differ from that of the solid",
                "not-certified",
            )
        with reporting(progress) as report:
            core = _core.collapse_axis(self._core, angle, integer(threads, "threads"), report)
        origin = Origin(self._mesh, theta=angle, solid_rule="polyhedron")
        return MedialComplex._of(core, EVERYTHING, origin)

    def with_failing_cells(self) -> Complex:
        """Returns this complex with the sides of the failing cubes as edges. The diagram may be wrong in these cubes.

        Edges have a column `obstacle`: 1 (square), 2 (tunnel), 3 (enclosed), 4 (face hole), 5 (handle), 6 (joins) and 7
        (contradiction).

        Examples
        --------
        >>> import blum
        >>> found = blum.voronoi_complex(blum.generate("gear"), method="cubes", depth=3)
        >>> found.report.certified, len(found.with_failing_cells().edges) == 12 * len(found.report.failing)
        (False, True)
        """
        cells = [(tuple(cell.low), tuple(cell.high), cell.obstacle) for cell in self.report.failing]
        return Complex._from_core(_core.with_failing_cells(self._core, cells))

    def write(self, path: PathLike, *, allow_uncertified: bool = False) -> None:
        """Writes .vtp, .ply, .obj (without columns), .npz or .glb. :func:`read_complex` reads all of them except .glb.

        The file appears under its name only when it is complete. A diagram that is not certified is rejected unless
        `allow_uncertified` is True, because parts of it may be missing or wrong. The file then records that the diagram
        is not certified, and has the sides of the failing cubes as edges.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     blum.voronoi_complex(blum.generate("box"), resolution=2).write(pathlib.Path(folder) / "box.vtp")
        ...     blum.read_complex(pathlib.Path(folder) / "box.vtp").metadata["certified"]
        'true'
        """
        if not self.report.certified and not allow_uncertified:
            raise InvalidOption(
                "the diagram is not certified, so parts of it may be missing or wrong (report.failing, "
                "with_failing_cells()): use allow_uncertified=True to write it"
            )
        core = self._core if self.report.certified else self.with_failing_cells()._core
        _core.write_complex(Path(os.fspath(path)), core, list(self._metadata().items()), [], True)

    def write_graph(self, path: PathLike, *, patch_angle: Real | None = None, patch_fit: Real | None = None) -> None:
        """Writes :meth:`graph` with the sites to .json or .graphml, and records whether the diagram is certified.

        .json holds everything. .graphml holds nodes and edges with numbers, for networkx, Gephi, igraph and yEd. The
        file appears under its name only when it is complete.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     blum.voronoi_complex(blum.generate("box"), resolution=2).write_graph(pathlib.Path(folder) / "box.json")
        ...     "walls" in (pathlib.Path(folder) / "box.json").read_text()
        True
        """
        _core.write_voronoi_graph(
            Path(os.fspath(path)),
            self._core,
            self._mesh._arrays,
            self.report.joined_faces,
            _given_patches(patch_angle, patch_fit),
            list(self._metadata().items()),
        )

    def _metadata(self) -> dict[str, str]:
        bound = self.report.hausdorff_bound if self.report.certified else None
        found: dict[str, str] = _core.voronoi_metadata(self.part, bound, len(self.report.failing))
        return found

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (core_arguments(self), self.report, self.part, self._mesh)

    def __repr__(self) -> str:
        return f"VoronoiComplex({len(self.vertices):,} vertices, {len(self.triangles):,} triangles)"


def _restored(arguments: tuple[Any, ...], report: VoronoiReport, part: str, mesh: Mesh) -> VoronoiComplex:
    return VoronoiComplex._of(_core.Complex(*arguments), report, part, mesh)


def _patch_options(patch_angle: Real, patch_fit: Real | None) -> dict[str, float]:
    options = {"patch_angle": number(patch_angle, "patch_angle")}
    return options if patch_fit is None else options | {"patch_fit": number(patch_fit, "patch_fit")}


def _given_patches(patch_angle: Real | None, patch_fit: Real | None) -> dict[str, float] | None:
    """Returns the options of patches, or None without both arguments."""
    if patch_angle is None and patch_fit is None:
        return None
    return _patch_options(30.0 if patch_angle is None else patch_angle, patch_fit)


def to_networkx(graph: VoronoiGraph, sites: Sequence[VoronoiSite] = ()) -> Any:
    """Returns the graph as a networkx.MultiGraph; see VoronoiGraph.to_networkx."""
    out = multigraph("VoronoiGraph")
    kinds = [patch.kind for patch in graph.patches] or [site.kind for site in sites]
    for index, kind in enumerate(kinds):
        out.add_node(f"region{index}", element="region", kind=kind)
    for region in graph.regions:
        out.add_node(f"region{region.site}", element="region", **attributes_of(region))
    for wall in graph.walls:
        out.add_nodes_from((f"region{wall.site_a}", f"region{wall.site_b}"), element="region")
    for element, parts in (("wall", graph.walls), ("seam", graph.seams), ("junction", graph.junctions)):
        for index, part in enumerate(parts):
            out.add_node(f"{element}{index}", element=element, **attributes_of(part))
    out.add_edges_from(_incidences(graph), element="incidence")
    for region in graph.regions:
        for other in region.neighbours:
            if other.site >= region.site:
                out.add_edge(f"region{region.site}", f"region{other.site}", element="neighbours", area=other.area)
    return out


def _incidences(graph: VoronoiGraph) -> Iterator[tuple[str, str]]:
    """Returns the names of elements that meet."""
    for index, wall in enumerate(graph.walls):
        yield from ((f"region{site}", f"wall{index}") for site in (wall.site_a, wall.site_b))
        yield from ((f"wall{index}", f"seam{seam}") for seam in wall.seams)
    for index, seam in enumerate(graph.seams):
        yield from ((f"seam{index}", f"junction{junction}") for junction in seam.junctions)


@takes("VoronoiOptions")
def voronoi_complex(
    mesh: MeshOrVertices | Solid,
    triangles: npt.ArrayLike | None = None,
    *,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[VoronoiOptions],
) -> VoronoiComplex:
    """Computes the Voronoi diagram inside a polyhedron, as a complex.

    Its sites are the faces, reflex edges and reflex vertices. If the report is `certified`, the homology of the complex
    is proven to be that of the exact diagram. If the solid is divided into cubes, a face that rounding has bent is
    several sites.

    Parameters
    ----------
    mesh, triangles
        A closed mesh, as for :func:`distance_field`, or a :class:`Solid`. If the mesh crosses itself, sites are those
        of its solid's surface, without the crossings.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    VoronoiComplex
        Triangles on walls and on the surface with `triangle_sites`, vertices with `radius` and `footprints`, and
        `.report`. ``part="walls"`` leaves out the surface. ``part="medial"`` keeps only the walls of the medial axis.

    Examples
    --------
    >>> import blum
    >>> found = blum.voronoi_complex(blum.generate("box"))
    >>> found.report.certified, found.report.found_betti
    (True, (1, 0, 6))
    """
    count = integer(threads, "threads")
    if isinstance(mesh, Solid):
        solid = mesh._core
    else:
        solid = _core.solid_of_mesh(as_mesh(mesh, triangles)._arrays, count, None)
        for warning in solid.warnings:
            is_crossing = warning.code == "crossings-removed"
            warn(warning.text + (": Solid(mesh).surface" if is_crossing else ""), warning.code)
    with reporting(progress) as report:
        core, stated = _core.voronoi_complex(solid, dict(options), count, report)
    return VoronoiComplex._of(core, stated, options.get("part", "all"), mesh_of_arrays(solid.surface))
