"""Rules for solids of certificates.

The checking code is independent of the construction, except for the parts that docs/decisions/0007-certificate.md
lists.
"""

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
from ._image import Image, as_image, is_image, labelled
from ._mesh import MeshOrVertices, as_mesh
from ._progress import Progress, reporting
from ._structs import Certificate, CertificateOptions, MeshSolidRule
from ._warn import warn_all

__all__ = ["solid_rule"]


@dataclass(frozen=True)
class Claim:
    """Axis in the form that certification needs, with its claims. An axis from a file has the claims of the file."""

    complex: Complex  #: The axis.
    has: Mapping[str, bool]  #: Attributes that exist: radii, footprints, angles, sites, labels. Others are fillers.
    grid: Grid | None  #: Grid of the voxels' centres, if known.
    label: int | None  #: Image: voxels of this value.
    threshold: float | None  #: Image: voxels of this value or more.
    weld: float | None  #: Mesh: tolerance with which its vertices were merged.
    rule: str  #: Rule of its solid. Empty if it states none.
    site_ids: str  #: Kind of its sites.
    version: str  #: Version of the Blum that wrote its file. Empty otherwise.
    theta: float | None = None  #: Angle, degrees.
    lambda_: float | None = None  #: Mesh units.
    spacing: float | None = None  #: Smallest side of a voxel, mesh units.
    deviation: float | None = None  #: Deviation from the axis with all vertices, mesh units.
    #: Image: iterations of the smooth surface of its voxels. None: the surface of their boxes.
    smooth: int | None = None
    fitted: bool = False  #: True if its borders were fitted to the surface.


class ShapeVerifier:
    """Certifier of axes of one mesh or image. It reads the shape once, so the shape must not change meanwhile."""

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
        self._has_labels = False
        self._mesh: _core.MeshAxisVerifier | None = None
        self._merged: Real | None = None  # Tolerance with which the vertices of _mesh were merged.

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_image": None, "_mesh": None}

    @property
    def kind(self) -> str:
        """Kind of the shape: "image" or "mesh"."""
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
        """Returns the certificate of an axis; see `blum.certify`."""
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
            image = self._of_image(chosen)
            with reporting(progress) as report:
                found = image.verify(core, said, has, chosen, least, asked, count, report)
        else:
            mesh = self._of_mesh(merged)
            with reporting(progress) as report:
                found = mesh.verify(core, said, has, asked, count, report)
        return found

    def _of_image(self, label: int | None) -> _core.ImageAxisVerifier:
        has_labels = label is not None  # If so, labels may be rounded.
        if self._image is None or has_labels != self._has_labels:
            image = labelled(as_image(self._shape), None if label is None else [label])
            self._image, self._has_labels = _core.ImageAxisVerifier(image._arrays), has_labels
        return self._image

    def _of_mesh(self, merged: Real | None) -> _core.MeshAxisVerifier:
        # Meshes in memory are not welded again.
        weld = merged if isinstance(self._shape, (str, os.PathLike)) else self._weld
        if self._mesh is None or weld != self._merged:
            self._mesh = _core.MeshAxisVerifier(
                as_mesh(cast(MeshOrVertices, self._shape), self._triangles, "shape", weld=weld)._arrays
            )
            self._merged = weld
        return self._mesh


def _claims(claim: Claim, grid: Grid | None, sites: str) -> dict[str, Any]:
    """Returns the claims of an axis, for the library to check. `sites` is the default kind of sites."""
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
        "fitted": claim.fitted,
    }


def solid_rule(
    mesh: MeshOrVertices,
    triangles: npt.ArrayLike | None = None,
    *,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> MeshSolidRule:
    """Returns the rule of a mesh's solid: whether the mesh bounds a polyhedron, and the reason.

    Parameters
    ----------
    mesh, triangles, weld, threads, progress
        As for :func:`distance_field`.

    Examples
    --------
    >>> import blum
    >>> blum.solid_rule(blum.generate("sphere")).rule
    'polyhedron'
    """
    with reporting(progress) as report:
        found: MeshSolidRule = _core.solid_rule(
            as_mesh(mesh, triangles, weld=weld)._arrays, integer(threads, "threads"), report
        )
    return found
