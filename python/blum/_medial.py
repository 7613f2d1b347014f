"""Medial axes of meshes and images."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from . import _core
from ._arguments import Integer, PathLike, Real, integer, label_of, number, optional_number
from ._errors import InputWarning, InvalidOption
from ._grid import Grid
from ._image import Image, as_image, is_image
from ._medial_columns import NestedComplex
from ._medial_complex import EVERYTHING, MedialComplex, Origin, write_complex
from ._mesh import Betti, as_mesh, betti_of
from ._progress import Progress, reporting


@dataclass(frozen=True)
class BodyReport:
    """How one connected part of a solid was voxelised."""

    solid: Betti
    voxels: Betti  #: of the voxels that stand for it
    topology_matches: bool  #: whether they are equal
    spacing: float  #: smallest side of a voxel, mesh units
    voxel_count: int
    left_out: int  #: voxels whose centre is inside, but that are left out
    taken_in: int  #: voxels whose centre is outside, but that are taken in
    deviation: float  #: how far from the surface the centre of such a voxel lies at most


@dataclass(frozen=True)
class MedialAxisReport:
    """What :func:`medial_axis` took as the solid, and what became of it."""

    rule: str  #: "polyhedron", "winding" or "voxels"
    reason: str  #: one sentence: why this rule
    reversed_shells: int  #: shells that faced the solid and were reversed
    solid: Betti
    voxels: Betti  #: the axis has these, at every theta
    topology_matches: bool  #: whether they are equal
    grid: Grid  #: voxel centres: of the first body, or of the image
    bodies: tuple[BodyReport, ...]
    seconds: dict[str, float]  #: wall-clock, of each phase


class MedialAxis:
    """The medial axis of a solid for all angles theta at once; made by :func:`medial_axis`.

    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=32)
    >>> len(axis.simplify(80).triangles) >= len(axis.simplify(120).triangles)
    True
    """

    def __init__(self, core: _core.MedialAxis, origin: Origin, least_theta: Real) -> None:
        self._core = core
        self._origin = origin
        #: The smallest angle that can be asked for, degrees.
        self.least_theta = least_theta

    @cached_property
    def report(self) -> MedialAxisReport:
        """What was taken as the solid, and what became of it."""
        found = self._core.report
        bodies = tuple(
            BodyReport(**{**body, "solid": betti_of(body["solid"]), "voxels": betti_of(body["voxels"])})
            for body in found["bodies"]
        )
        return MedialAxisReport(
            found["rule"],
            found["reason"],
            found["reversed_shells"],
            betti_of(found["solid"]),
            betti_of(found["voxels"]),
            found["topology_matches"],
            Grid._of(found["grid"]),
            bodies,
            dict(_summed(found["phases"])),
        )

    def simplify(self, theta: Real = 60.0) -> MedialComplex:
        """The part where two footprints are seen at more than theta degrees apart, and what homotopy needs to join it.

        What a larger theta gives is part of what a smaller one gives. Cost: linear in the result.
        """
        angle = number(theta, "theta")
        report = self.report
        is_image = isinstance(self._origin.shape, Image)
        origin = Origin(
            self._origin.shape,
            self._origin.label,
            self._origin.threshold,
            angle,
            self._origin.lambda_,
            min((body.spacing for body in report.bodies), default=None),
            report.rule,
            report.grid,
            self._origin.source,
            self._origin.weld,
            "voxels" if is_image else "features",
        )
        return MedialComplex._of(self._core.simplify(angle), EVERYTHING, origin)

    def nested(self) -> NestedComplex:
        """What simplify() gives for all angles from `least_theta` on, in one complex: the data of a slider.

        Cost: near-linear in the axis at the least angle.
        """
        return NestedComplex(self._core.nested(), float(self.least_theta))

    def write(self, path: PathLike) -> None:
        """Writes the axis at the least angle with those of all larger ones, as `blum medial --nested` does: .npz.

        `blum view` and :func:`view` then have a slider for theta.
        """
        write_complex(path, self.simplify(self.least_theta), self.nested())

    def __repr__(self) -> str:
        components, tunnels, voids = self.report.voxels
        return f"MedialAxis(components={components}, tunnels={tunnels}, voids={voids}, rule={self.report.rule!r})"


def _summed(phases: Sequence[tuple[str, float]]) -> dict[str, float]:
    """Seconds by phase; those of several bodies are added up."""
    out: dict[str, float] = {}
    for phase, seconds in phases:
        out[phase] = out.get(phase, 0.0) + seconds
    return out


def medial_axis(
    shape: Any,
    triangles: Any = None,
    *,
    resolution: Integer = 256,
    spacing: Any = None,
    max_resolution: Integer = 512,
    lambda_: Real = 0.0,
    least_theta: Real = 0.0,
    label: Integer | None = None,
    threshold: Real | None = None,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
) -> MedialAxis:
    """The medial axis of the solid that a mesh or an image bounds, with the topology of that solid.

    Parameters
    ----------
    shape, triangles
        A mesh, as for :func:`distance_field`; or an image: an array [z, y, x], an :class:`Image`, a path.
    resolution : int
        Meshes: voxels along the longest side of the box around the mesh, 8 to 800.
    spacing : float; images: three numbers, optional
        Meshes: side of a voxel, instead of `resolution`. Images: size of a voxel in x, y, z order.
    max_resolution : int
        Meshes: a body whose topology its voxels cannot take is done again with finer ones, up to this.
    lambda_ : float
        Pieces whose two footprints are closer than this count for nothing, mesh units.
    least_theta : float
        The smallest theta that will be asked for, degrees: more is faster.
    weld : float, optional
        Meshes: as for :func:`distance_field`.
    label, threshold
        Images: which voxels are the solid; default: those that are not zero.

    Returns
    -------
    MedialAxis
        `.simplify(theta)` gives the complex at an angle, `.simplify(theta).certificate` what is certain of it.

    Raises
    ------
    InvalidMesh, InvalidImage, InvalidOption (all ValueError), TypeError, OutOfMemory, KeyboardInterrupt

    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("torus"), resolution=32)
    >>> axis
    MedialAxis(components=1, tunnels=1, voids=0, rule='polyhedron')
    """
    least = number(least_theta, "least_theta")
    smallest = number(lambda_, "lambda_")
    count = integer(threads, "threads")
    if triangles is None and is_image(shape):
        if label is not None and threshold is not None:
            raise InvalidOption("label and threshold exclude each other")
        image = as_image(shape, spacing)
        chosen = None if label is None else label_of(label, "label")
        least_value = optional_number(threshold, "threshold")
        with reporting(progress) as report:
            core = _core.medial_axis_of_image(image._arrays, chosen, least_value, smallest, least, count, report)
        return MedialAxis(core, Origin(image, chosen, least_value, lambda_=smallest, source=image.source), least)
    if label is not None or threshold is not None:
        raise InvalidOption("label and threshold select voxels of an image, and shape is a mesh")
    mesh = as_mesh(shape, triangles, "shape", weld=weld)
    with reporting(progress) as report:
        core = _core.medial_axis_of_mesh(
            mesh._arrays,
            integer(resolution, "resolution"),
            optional_number(spacing, "spacing"),
            integer(max_resolution, "max_resolution"),
            smallest,
            least,
            count,
            report,
        )
    axis = MedialAxis(core, Origin(mesh, lambda_=smallest, source=mesh.source, weld=mesh._weld), least)
    turned = axis.report.reversed_shells
    if turned:
        text = (
            f"{turned} shell{'s' if turned > 1 else ''} faced the solid, and {'were' if turned > 1 else 'was'} reversed"
        )
        warnings.warn(text, InputWarning, stacklevel=2)
    if axis.report.rule == "winding":
        warnings.warn(f"{axis.report.reason}, as voxels", InputWarning, stacklevel=2)
    return axis
