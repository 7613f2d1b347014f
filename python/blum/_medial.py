"""Medial axes of meshes and images."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, Unpack, cast

import numpy.typing as npt

from . import _core
from ._arguments import PathLike, Real, integer, number, optional_number
from ._certificate import ShapeVerifier
from ._errors import NotCertified
from ._image import Image, as_image, is_image, refuse_selection
from ._medial_columns import NestedComplex
from ._medial_complex import EVERYTHING, MedialComplex, Origin, write_complex
from ._mesh import MeshOrVertices, as_mesh
from ._options import default_of, takes
from ._progress import Progress, reporting
from ._structs import AxisGraph, AxisGraphOptions, MedialAxisOptions, MedialAxisReport
from ._warn import warn, warn_all


class MedialAxis:
    """The medial axis of a solid for all angles theta at once; made by :func:`medial_axis`.

    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=32)
    >>> len(axis.simplify(80).triangles) >= len(axis.simplify(120).triangles)
    True
    """

    def __init__(self, core: _core.MedialAxis, origin: Origin, options: dict[str, Any] | None = None) -> None:
        self._core = core
        self._origin = origin
        self._options = {} if options is None else options  # of a mesh: to make it again on another grid
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
        return _origin_of(self._origin, self.report, angle)

    def certified(
        self,
        theta: Real = 60.0,
        *,
        tolerance: Real | None = None,
        allow_uncertified: bool = False,
        threads: int = 0,
        progress: Progress = False,
    ) -> MedialComplex:
        """The axis at theta as `blum medial` writes it: with its certificate, which holds.

        With its borders where they belong and few vertices; where that is not certified, simpler: with borders at the
        cells of the grid, then with all vertices; then on a grid that is moved a little. A warning says what failed.
        The mesh or image must be as it was. With another `least_theta`, sheets may end elsewhere within a voxel.

        Parameters
        ----------
        theta : float
            As for :meth:`simplify`.
        tolerance : float, optional
            As for :meth:`MedialComplex.decimate`; 0 keeps all vertices, and borders at the cells.
        allow_uncertified : bool
            Give the best axis even where it is not certified, with a warning: look at `.certificate`.

        Raises
        ------
        NotCertified
            Where no form is certified.

        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=32).certified(60)
        >>> axis.certificate.holds, axis.counts["sheets"]
        (True, 12)
        """
        angle, most = number(theta, "theta"), optional_number(tolerance, "tolerance")
        shape = self._origin.shape
        assert shape is not None  # medial_axis() says what it is of
        count = integer(threads, "threads")
        verifier = ShapeVerifier(shape)
        with reporting(progress) as report:
            if isinstance(shape, Image):
                label, threshold = self._origin.label, self._origin.threshold
                made = _core.certified_axis_of_image(
                    self._core, verifier._of_image(), label, threshold, angle, most, count, report
                )
            else:
                of_mesh = verifier._of_mesh(None)
                made = _core.certified_axis_of_mesh(
                    self._core, of_mesh, shape._arrays, self._options, angle, most, count, report
                )
        core, deviation, of_grid, certificate, mismatches, told = made
        warn_all(told)
        if mismatches:
            text = "NOT certified: " + "; ".join(mismatches)
            if not allow_uncertified:
                raise NotCertified(text)
            warn(text, "not-certified")
        found = MedialComplex._of(
            core, EVERYTHING, replace(_origin_of(self._origin, of_grid, angle), deviation=deviation)
        )
        found.__dict__["certificate"] = certificate
        return found

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


def _origin_of(origin: Origin, report: MedialAxisReport, angle: float) -> Origin:
    return replace(
        origin,
        theta=angle,
        spacing=min((body.spacing for body in report.bodies), default=None),
        solid_rule=report.rule,
        grid=report.grid,
        site_ids="voxels" if isinstance(origin.shape, Image) else "features",
    )


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

    with reporting(progress) as report:
        core = _core.medial_axis_of_mesh(mesh._arrays, given, count, report)
    axis = MedialAxis(core, Origin(mesh, lambda_=smallest, source=mesh.source, weld=mesh._weld), given)
    warn_all(axis.report.warnings)
    return axis
