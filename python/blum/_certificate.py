"""Certificates: whether an axis has the topology of its solid, checked by code that shares nothing with its making."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Unpack, cast

import numpy.typing as npt

from . import _core
from ._arguments import Integer, Real, integer, label_of, optional_number
from ._complex import Complex
from ._grid import Grid
from ._image import Image, as_image, is_image
from ._mesh import MeshOrVertices, as_mesh
from ._progress import Progress, reporting
from ._structs import Certificate, CertificateOptions, MeshSolidRule
from ._warn import warn_all


@dataclass(frozen=True)
class Claim:
    """An axis as its certificate sees it, with what it (or the file that it was read from) says of itself."""

    complex: Complex
    has: Mapping[str, bool]  #: which attributes are more than fillers: radii, footprints, angles, sites, labels
    grid: Grid | None  #: of the voxels' centres, where that is known
    label: int | None  #: of an image: the voxels of this value
    threshold: float | None  #: of an image: the voxels of this value or more
    weld: float | None  #: of a mesh: how its vertices were merged
    rule: str  #: of its solid; empty where it does not say
    site_ids: str
    version: str  #: of the Blum that wrote its file; empty otherwise
    theta: float | None = None  #: degrees
    lambda_: float | None = None  #: mesh units
    spacing: float | None = None  #: smallest side of a voxel, mesh units
    deviation: float | None = None  #: from the axis with all vertices, mesh units
    smooth: int | None = None  #: of an image: iterations of the smooth surface of its voxels; None: of their boxes


class ShapeVerifier:
    """Certifies axes of one mesh or image. What is read of it is read once, so it must not change meanwhile."""

    def __init__(
        self,
        shape: MeshOrVertices | Image,
        triangles: npt.ArrayLike | None = None,
        weld: Real | None = None,
    ) -> None:
        self._shape = shape
        self._triangles = triangles
        self._weld = weld
        self._is_image = triangles is None and is_image(shape)
        self._image: _core.ImageAxisVerifier | None = None
        self._mesh: _core.MeshAxisVerifier | None = None
        self._merged: Real | None = None  # how the vertices of the mesh are

    @property
    def kind(self) -> str:
        """What it is of."""
        return "image" if self._is_image else "mesh"

    def certified(
        self,
        claim: Claim,
        *,
        label: Integer | None = None,
        threshold: Real | None = None,
        grid: Grid | None = None,
        threads: int = 0,
        progress: Progress = False,
        **checks: Unpack[CertificateOptions],
    ) -> Certificate:
        """What `blum.certify` says of an axis."""
        if grid is not None and not isinstance(grid, Grid):
            raise TypeError(f"grid must be a blum.Grid, not {type(grid).__name__}")
        has = dict(claim.has)
        asked: dict[str, Any] = {name: has[name] for name in ("radii", "footprints", "angles", "sites", "labels")}
        asked |= {"balls": has["radii"], **checks}
        count = integer(threads, "threads")
        said = _claims(claim, grid, "voxels" if self._is_image else "features")
        chosen, least, merged, found_out = _core.solid_of_axis(
            said,
            self._is_image,
            None if label is None else label_of(label, "label"),
            optional_number(threshold, "threshold"),
            optional_number(self._weld, "weld"),
        )
        warn_all(found_out)
        found: Certificate
        core = claim.complex._core
        if self._is_image:
            image = self._of_image()
            with reporting(progress) as report:
                found = image.verify(core, said, has, chosen, least, asked, count, report)
        else:
            mesh = self._of_mesh(merged)
            with reporting(progress) as report:
                found = mesh.verify(core, said, has, asked, count, report)
        return found

    def _of_image(self) -> _core.ImageAxisVerifier:
        if self._image is None:
            self._image = _core.ImageAxisVerifier(as_image(self._shape)._arrays)
        return self._image

    def _of_mesh(self, merged: Real | None) -> _core.MeshAxisVerifier:
        # Meshes in memory are as they are.
        weld = merged if isinstance(self._shape, (str, os.PathLike)) else self._weld
        if self._mesh is None or weld != self._merged:
            self._mesh = _core.MeshAxisVerifier(
                as_mesh(cast(MeshOrVertices, self._shape), self._triangles, "shape", weld=weld)._arrays
            )
            self._merged = weld
        return self._mesh


def _claims(claim: Claim, grid: Grid | None, sites: str) -> dict[str, Any]:
    """What an axis says of itself, for the library to check; `sites` where it does not say of what they are."""
    return {
        "version": claim.version,
        "solid_rule": claim.rule,
        "site_ids": claim.site_ids if claim.rule or claim.version else sites,
        "grid": claim.grid if grid is None else grid,
        "label": claim.label,
        "threshold": claim.threshold,
        "weld": claim.weld,
        "theta": claim.theta,
        "lambda_": claim.lambda_,
        "spacing": claim.spacing,
        "deviation": claim.deviation,
        "smooth": claim.smooth,
    }


def solid_rule(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> MeshSolidRule:
    """Whether a mesh bounds a polyhedron, and if not, why.

    >>> import blum
    >>> blum.solid_rule(blum.generate("sphere")).rule
    'polyhedron'
    """
    with reporting(progress) as report:
        found: MeshSolidRule = _core.solid_rule(
            as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
        )
    return found
