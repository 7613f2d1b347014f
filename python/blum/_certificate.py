"""Certificates: whether an axis has the topology of its solid, checked by code that shares nothing with its making."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import Integer, Real, indices, integer
from ._errors import InvalidMesh
from ._field import selected_voxels
from ._grid import Grid
from ._image import as_image, is_image
from ._mesh import Betti, Mesh, as_mesh, betti_of
from ._progress import Progress, reporting

if TYPE_CHECKING:
    from ._complex import MedialComplex


@dataclass(frozen=True)
class GeometryCheck:
    """How far vertices are from what they claim; lengths in mesh units."""

    vertices: int  #: looked at
    not_finite: int
    outside: int  #: outside of the solid by more than is allowed
    outside_by: float
    radius_error: float  #: largest |radius - exact distance to the surface|
    footprint_off_surface: float  #: largest distance of a footprint from the surface
    footprint_error: float  #: largest |distance to a footprint - radius|
    site_error: float  #: largest distance of a footprint from its site
    angle_error: float  #: degrees
    tolerance: float  #: what is allowed in the largest body
    holds: bool


@dataclass(frozen=True)
class EdgeCheck:
    """Whether edges lie in the solid between their ends; lengths in mesh units."""

    edges: int  #: looked at
    pushed: int  #: those that cut a corner, and can be pushed into the solid
    pushed_by: float
    outside: int  #: those that leave the solid otherwise
    outside_by: float
    where: tuple[float, float, float]  #: where that is
    tolerance: float
    holds: bool


@dataclass(frozen=True)
class BallUnionCheck:
    """How much of the solid the balls of an axis fill: told, not judged; mesh units."""

    solid_to_balls: float  #: largest distance of the solid's surface from the union
    mean_solid_to_balls: float
    balls_beyond_solid: float  #: how far balls reach out of the solid
    balls_to_surface: float  #: largest distance of the union's surface from the solid's
    step: float  #: of the samples


@dataclass(frozen=True)
class Certificate:
    """What :func:`certify` found."""

    against: str  #: "polyhedron"; "winding" or "voxels", where the solid is only known as voxels
    solid: Betti  #: components, tunnels, voids
    axis: Betti
    bodies: tuple[tuple[Betti, Betti], ...]  #: solid and axis, body by body
    topology_holds: bool
    geometry: GeometryCheck
    edges: EdgeCheck
    balls: BallUnionCheck
    mismatches: tuple[str, ...]  #: one sentence each; empty where all holds

    @property
    def holds(self) -> bool:
        """Whether nothing differs: topology, geometry, edges."""
        return not self.mismatches

    def __bool__(self) -> bool:
        return self.holds

    def __str__(self) -> str:
        if self.holds:
            return f"certified against the {self.against}: components, tunnels, voids {self.axis}"
        return "NOT certified: " + "; ".join(self.mismatches)


def _of(cls: Any, values: dict[str, Any]) -> Any:
    return cls(
        **{
            field.name: tuple(values[field.name]) if field.name == "where" else values[field.name]
            for field in fields(cls)
        }
    )


def _certificate(found: dict[str, Any]) -> Certificate:
    return Certificate(
        found["against"],
        betti_of(found["solid"]),
        betti_of(found["axis"]),
        tuple((betti_of(solid), betti_of(axis)) for solid, axis in found["bodies"]),
        found["topology_holds"],
        _of(GeometryCheck, found["geometry"]),
        _of(EdgeCheck, found["edges"]),
        _of(BallUnionCheck, found["balls"]),
        tuple(found["mismatches"]),
    )


#: Whether to look at positions, radii, footprints, angles, sites, balls.
_Checks = tuple[bool, bool, bool, bool, bool, bool]


def certify(
    axis: MedialComplex,
    shape: Any,
    triangles: Any = None,
    *,
    label: Integer | None = None,
    threshold: Real | None = None,
    grid: Grid | None = None,
    positions: bool = True,
    radii: bool | None = None,
    footprints: bool | None = None,
    angles: bool | None = None,
    sites: bool | None = None,
    balls: bool | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> Certificate:
    """Checks an axis against the mesh or image whose solid it is said to have.

    Betti numbers are compared body by body; vertices, radii, footprints, sites and angles with exact searches; edges
    must lie in the solid. Nothing of what made the axis is used.

    Parameters
    ----------
    axis : MedialComplex
    shape, triangles
        The mesh, as for :func:`distance_field`, or the image, as for :func:`distance_transform`.
    label, threshold
        Of an image: which voxels are the solid.
    grid : Grid, optional
        Of a mesh that bounds no polyhedron: of the centres of the voxels that are the solid. Default: the axis's own.
    positions, radii, footprints, angles, sites, balls : bool, optional
        What to look at besides topology. Default: all that the axis has.

    >>> import blum
    >>> torus = blum.generate("torus")
    >>> axis = blum.medial_axis(torus, resolution=32)
    >>> print(blum.certify(axis.simplify(60), torus))
    certified against the polyhedron: components, tunnels, voids (1, 1, 0)
    """
    from ._complex import MedialComplex

    if not isinstance(axis, MedialComplex):
        raise TypeError(f"axis must be a blum.MedialComplex, not {type(axis).__name__}")
    if grid is not None and not isinstance(grid, Grid):
        raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
    has = axis.has

    def chosen(asked: bool | None, attribute: str) -> bool:
        return has[attribute] if asked is None else bool(asked)

    checks = (
        bool(positions),
        chosen(radii, "radii"),
        chosen(footprints, "footprints"),
        chosen(angles, "angles"),
        chosen(sites, "sites"),
        chosen(balls, "radii"),
    )
    count = integer(threads, "threads")
    if triangles is None and is_image(shape):
        image = as_image(shape)
        mask = selected_voxels(image, label=label, threshold=threshold)
        with reporting(progress) as report:
            return _certificate(
                _core.certify_voxels(
                    axis._core, mask.view(np.uint8), image.grid._spec, *checks, threads=count, progress=report
                )
            )
    mesh = as_mesh(shape, triangles, "shape")
    rule, reason = _core.solid_rule(mesh._arrays, count, None)
    if rule == "polyhedron":
        with reporting(progress) as report:
            return _certificate(_core.certify_mesh(axis._core, mesh._arrays, *checks, threads=count, progress=report))
    return _against_winding(axis, mesh, grid, reason, checks, count, progress)


def _against_winding(
    axis: MedialComplex, mesh: Mesh, grid: Grid | None, reason: str, checks: _Checks, threads: int, progress: Progress
) -> Certificate:
    nodes = axis.grid if grid is None else grid
    if nodes is None:
        raise InvalidMesh(
            f"the mesh bounds no polyhedron ({reason}), so its axis is that of voxels: give grid, that of their centres"
        )
    with reporting(progress) as report:
        return _certificate(
            _core.certify_winding(axis._core, mesh._arrays, nodes._spec, *checks, threads=threads, progress=report)
        )


@dataclass(frozen=True)
class SolidRule:
    """What the solid of a mesh is."""

    rule: str  #: "polyhedron": what its shells bound; "winding": where its winding number is above 1/2
    reason: str  #: one sentence


def solid_rule(mesh: Any, triangles: Any = None, *, threads: int = 0, progress: Progress = False) -> SolidRule:
    """Whether a mesh bounds a polyhedron, and if not, why.

    >>> import blum
    >>> blum.solid_rule(blum.generate("sphere")).rule
    'polyhedron'
    """
    with reporting(progress) as report:
        return SolidRule(*_core.solid_rule(as_mesh(mesh, triangles)._arrays, integer(threads, "threads"), report))


def homology(
    vertex_count: int, edges: Any = (), triangles: Any = (), *, threads: int = 0, progress: Progress = False
) -> Betti:
    """Betti numbers over Z/2 of a complex of vertices, edges, and triangles with their edges.

    >>> import blum
    >>> blum.homology(4, edges=[[0, 1], [1, 2], [2, 0]])
    (2, 1, 0)
    """
    count = integer(vertex_count, "vertex_count")
    if count < 0:
        raise ValueError(f"vertex_count is {count}, but must be at least 0")
    with reporting(progress) as report:
        return betti_of(
            _core.homology(
                count,
                indices(edges, "edges", 2, count),
                indices(triangles, "triangles", 3, count),
                integer(threads, "threads"),
                report,
            )
        )
