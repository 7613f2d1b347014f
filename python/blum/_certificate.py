"""Certificates: whether an axis has the topology of its solid, checked by code that shares nothing with its making."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from . import _core
from ._arguments import Integer, Real, integer, label_of, optional_number
from ._complex import Complex
from ._errors import InvalidOption
from ._grid import Grid
from ._image import as_image, is_image
from ._mesh import Betti, as_mesh, betti_of
from ._progress import Progress, reporting


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


@dataclass(frozen=True)
class Claim:
    """An axis as its certificate sees it, with what it (or the file that it was read from) says of itself."""

    complex: Complex
    has: Mapping[str, bool]  #: which attributes are more than fillers: radii, footprints, angles, sites
    grid: Grid | None  #: of the voxels' centres, where that is known
    label: int | None  #: of an image: the voxels of this value
    threshold: float | None  #: of an image: the voxels of this value or more
    rule: str  #: of its solid; empty where it does not say
    site_ids: str
    version: str  #: of the Blum that wrote its file; empty otherwise


def certified(
    claim: Claim,
    shape: Any,
    triangles: Any = None,
    *,
    label: Integer | None = None,
    threshold: Real | None = None,
    grid: Grid | None = None,
    weld: Real | None = None,
    positions: bool = True,
    radii: bool | None = None,
    footprints: bool | None = None,
    angles: bool | None = None,
    sites: bool | None = None,
    balls: bool | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> Certificate:
    """What `blum.certify` says of an axis."""
    if grid is not None and not isinstance(grid, Grid):
        raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
    has = claim.has

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
        if label is not None and threshold is not None:
            raise InvalidOption("label and threshold exclude each other")
        image = as_image(shape)
        if label is None and threshold is None:
            label, threshold = claim.label, claim.threshold
        chosen_label = None if label is None else label_of(label, "label")
        with reporting(progress) as report:
            return _certificate(
                _core.verify_image(
                    claim.complex._core,
                    _claims(claim, grid, "voxels"),
                    image._arrays,
                    chosen_label,
                    optional_number(threshold, "threshold"),
                    *checks,
                    threads=count,
                    progress=report,
                )
            )
    mesh = as_mesh(shape, triangles, "shape", weld=weld)
    with reporting(progress) as report:
        return _certificate(
            _core.verify_mesh(
                claim.complex._core,
                _claims(claim, grid, "features"),
                mesh._arrays,
                *checks,
                threads=count,
                progress=report,
            )
        )


def _claims(claim: Claim, grid: Grid | None, sites: str) -> dict[str, Any]:
    """What an axis says of itself, for the library to check; `sites` where it does not say of what they are."""
    nodes = claim.grid if grid is None else grid
    return {
        "version": claim.version,
        "solid_rule": claim.rule,
        "site_ids": claim.site_ids if claim.rule or claim.version else sites,
        "grid": None if nodes is None else nodes._spec,
        **{f"has_{name}": claim.has[name] for name in ("radii", "footprints", "angles", "sites")},
    }


@dataclass(frozen=True)
class SolidRule:
    """What the solid of a mesh is."""

    rule: str  #: "polyhedron": what its shells bound; "winding": where its winding number is above 1/2
    reason: str  #: one sentence


def solid_rule(
    mesh: Any, triangles: Any = None, *, weld: Real | None = None, threads: int = 0, progress: Progress = False
) -> SolidRule:
    """Whether a mesh bounds a polyhedron, and if not, why.

    >>> import blum
    >>> blum.solid_rule(blum.generate("sphere")).rule
    'polyhedron'
    """
    with reporting(progress) as report:
        return SolidRule(
            *_core.solid_rule(as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report)
        )
