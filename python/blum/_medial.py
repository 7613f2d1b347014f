"""Medial axes of meshes and images."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Unpack, cast

import numpy.typing as npt

from . import _core
from ._arguments import PathLike, Real, integer, number, optional_number
from ._certificate import ShapeVerifier
from ._image import Image, as_image, is_image, refuse_selection
from ._medial_columns import NestedComplex
from ._medial_complex import EVERYTHING, MedialComplex, Origin, write_complex
from ._mesh import MeshOrVertices, as_mesh
from ._options import default_of, takes
from ._progress import Progress, reporting
from ._structs import AxisGraph, AxisGraphOptions, MedialAxisOptions, MedialAxisReport, WarningCode
from ._warn import warn, warn_all


@dataclass(frozen=True)
class OtherGrids:
    """How an axis is made anew on another grid."""

    grid_shift: float  # of the first one
    on: Callable[[float, int, Progress], _core.MedialAxis]  # a shift, threads, progress


class MedialAxis:
    """The medial axis of a solid for all angles theta at once; made by :func:`medial_axis`.

    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=32)
    >>> len(axis.simplify(80).triangles) >= len(axis.simplify(120).triangles)
    True
    """

    def __init__(self, core: _core.MedialAxis, origin: Origin, grids: OtherGrids | None = None) -> None:
        self._core = core
        self._origin = origin
        self._grids = grids
        #: The smallest angle that can be asked for, degrees.
        self.least_theta: float = core.least_theta
        #: The largest angle that can be asked for, degrees.
        self.greatest_theta: float = core.greatest_theta

    @cached_property
    def report(self) -> MedialAxisReport:
        """What was taken as the solid, and what became of it."""
        found: MedialAxisReport = self._core.report
        return found

    def simplify(self, theta: Real = 60.0, *, fit: bool = False) -> MedialComplex:
        """The part where two footprints are seen at more than theta degrees apart, and what homotopy needs to join it.

        What a larger theta gives is part of what a smaller one gives, unless `fit` moves its borders to their places:
        seams to where three walls are equally far, rims to where the angle is theta. Cost: linear in the result.
        """
        angle = number(theta, "theta")
        cut = self._core.fitted if fit else self._core.simplify
        return MedialComplex._of(cut(angle), EVERYTHING, self._origin_at(angle))

    def _origin_at(self, angle: float) -> Origin:
        report = self.report
        is_image = isinstance(self._origin.shape, Image)
        return replace(
            self._origin,
            theta=angle,
            spacing=min((body.spacing for body in report.bodies), default=None),
            solid_rule=report.rule,
            grid=report.grid,
            site_ids="voxels" if is_image else "features",
        )

    def certified(
        self, theta: Real = 60.0, *, tolerance: Real | None = None, threads: int = 0, progress: Progress = False
    ) -> MedialComplex:
        """The axis at theta as `blum medial` writes it, with its certificate: look whether that holds.

        With its borders where they belong and few vertices; where that is not certified, simpler: with borders at the
        cells of the grid, then with all vertices; then on a grid that is moved a little. A warning tells what failed.

        Parameters
        ----------
        theta : float
            As for :meth:`simplify`.
        tolerance : float, optional
            As for :meth:`MedialComplex.decimate`; 0 keeps all vertices, and borders at the cells.

        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=32).certified(60)
        >>> axis.certificate.holds, axis.counts["sheets"]
        (True, 12)
        """
        most = optional_number(tolerance, "tolerance")
        assert self._origin.shape is not None  # medial_axis() says what it is of
        verifier = ShapeVerifier(self._origin.shape)
        found, failed = self._first_certified(theta, most, verifier, threads, progress)
        if not found.certificate.holds and self._grids is not None and self.report.topology_matches:
            for shift, as_it_was in _core.moved_grids(self._grids.grid_shift):
                moved = MedialAxis(self._grids.on(shift, threads, progress), self._origin)
                again, failed_there = moved._first_certified(theta, most, verifier, threads, progress)
                if again.certificate.holds:
                    text = f"{as_it_was}at theta {float(theta):g} {found.certificate.mismatches[0]}"
                    failed = [(text, "grid-moved"), *failed_there]
                    found = again
                    break
        if not found.certificate.holds:
            text = f"NOT certified: at theta {float(theta):g}: {found.certificate.mismatches[0]}"
            failed = [(text, "form-not-certified")]
        for sentence, code in failed:
            warn(sentence, code)
        return found

    def _first_certified(
        self, theta: Real, tolerance: float | None, verifier: ShapeVerifier, threads: int, progress: Progress
    ) -> tuple[MedialComplex, list[tuple[str, WarningCode]]]:
        """The first form that is certified, or the last one, and why those before it are not."""
        failed: list[tuple[str, WarningCode]] = []
        for is_fitted, most, without in self._core.forms(tolerance):
            if is_fitted and most is not None:
                found = self._lean(theta, most, threads, progress)
            else:
                found = self.simplify(theta, fit=is_fitted)
                if most is not None:
                    lean = found.decimate(most, threads=threads, progress=progress)
                    found = lean if len(lean.vertices) < len(found.vertices) else found
            found._verifier = verifier
            holds = found.certificate.holds
            found._verifier = None
            if holds:
                break
            text = f"at theta {float(theta):g} {without}{found.certificate.mismatches[0]}"
            failed.append((text, "form-not-certified"))
        return found, failed

    def _lean(self, theta: Real, tolerance: float, threads: int, progress: Progress) -> MedialComplex:
        """The same as `simplify(theta, fit=True).decimate(tolerance)`, but for insides of sheets, in less time."""
        angle = number(theta, "theta")
        with reporting(progress) as report:
            core, deviation, before = self._core.lean(angle, tolerance, integer(threads, "threads"), report)
        origin = self._origin_at(angle)
        found = MedialComplex._of(core, EVERYTHING, origin)
        if len(found.vertices) == before:
            return found
        return MedialComplex._of(core, EVERYTHING, replace(origin, deviation=deviation))

    @takes("AxisGraphOptions")
    def graph(self, theta: Real = 60.0, **options: Unpack[AxisGraphOptions]) -> AxisGraph:
        """The graph of the axis at theta degrees; see :func:`axis_graph`.

        Parameters
        ----------
        theta : float
            As for :meth:`simplify`.
        **options
        """
        return self.simplify(theta).graph(**options)

    def nested(self) -> NestedComplex:
        """What simplify() gives for all angles from `least_theta` on, in one complex: the data of a slider.

        Cost: near-linear in the axis at the least angle.
        """
        return NestedComplex(self._core.nested(), self.least_theta)

    def write(self, path: PathLike) -> None:
        """Writes the axis at the least angle with those of all larger ones, as `blum medial --nested` does: .npz.

        `blum view` and :func:`view` then have a slider for theta.
        """
        write_complex(path, self.simplify(self.least_theta), self.nested())

    def __repr__(self) -> str:
        components, tunnels, voids = self.report.solid_betti
        return f"MedialAxis(components={components}, tunnels={tunnels}, voids={voids}, rule={self.report.rule!r})"


@takes("MedialAxisOptions", "spacing")
def medial_axis(
    shape: MeshOrVertices | Image,
    triangles: npt.ArrayLike | None = None,
    *,
    spacing: Any = None,
    weld: Real | None = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[MedialAxisOptions],
) -> MedialAxis:
    """The medial axis of the solid that a mesh or an image bounds, with the topology of that solid.

    Parameters
    ----------
    shape, triangles
        A mesh, as for :func:`distance_field`; or an image: an array [z, y, x], an :class:`Image`, a path.
    spacing : float; images: three numbers, optional
        Meshes: side of a voxel, instead of `resolution`. Images: size of a voxel in x, y, z order.
    weld : float, optional
        Meshes: as for :func:`distance_field`.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    MedialAxis
        `.certified(theta)` gives the best complex at an angle that is certified, with few triangles; `.simplify(theta)`
        that of the cells, and `.simplify(theta).certificate` what is certain of it.

    Raises
    ------
    InvalidMesh, InvalidImage, InvalidOption (all ValueError), TypeError, OutOfMemory, KeyboardInterrupt

    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("torus"), resolution=32)
    >>> axis
    MedialAxis(components=1, tunnels=1, voids=0, rule='polyhedron')
    """
    count = integer(threads, "threads")
    label, threshold = options.get("label"), options.get("threshold")
    smallest = number(options.get("lambda_", default_of("MedialAxisOptions", "lambda_")), "lambda_")
    if triangles is None and is_image(shape):
        image = as_image(shape, spacing)
        with reporting(progress) as report:
            core = _core.medial_axis_of_image(image._arrays, dict(options), count, report)
        chosen = None if label is None else int(label)
        origin = Origin(image, chosen, optional_number(threshold, "threshold"), lambda_=smallest, source=image.source)
        return MedialAxis(core, origin)
    refuse_selection(label, threshold)
    mesh = as_mesh(cast(MeshOrVertices, shape), triangles, "shape", weld=weld)
    given = {**options, "spacing": spacing}

    def on_grid(shift: float, threads: int, progress: Progress) -> _core.MedialAxis:
        with reporting(progress) as report:
            return _core.medial_axis_of_mesh(mesh._arrays, {**given, "grid_shift": shift}, threads, report)

    grids = OtherGrids(float(options.get("grid_shift", default_of("MedialAxisOptions", "grid_shift"))), on_grid)

    with reporting(progress) as report:
        core = _core.medial_axis_of_mesh(mesh._arrays, given, count, report)
    axis = MedialAxis(core, Origin(mesh, lambda_=smallest, source=mesh.source, weld=mesh._weld), grids)
    warn_all(axis.report.warnings)
    return axis
