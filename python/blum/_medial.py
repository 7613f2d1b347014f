"""Medial axes."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, Unpack, cast

import numpy.typing as npt

from . import _core
from ._arguments import PathLike, Real, integer, label_of, number, optional_number
from ._certificate import ShapeVerifier
from ._errors import NotCertified
from ._grid import check_one
from ._image import Image, as_image, is_image, labelled, refuse_selection
from ._medial_columns import NestedComplex
from ._medial_complex import EVERYTHING, MedialComplex, Origin, write_complex
from ._mesh import MeshOrVertices, as_mesh
from ._methods import Rebuilt
from ._options import default_of, takes
from ._progress import Progress, reporting
from ._structs import AxisGraph, AxisGraphOptions, MedialAxisOptions, MedialAxisReport
from ._warn import warn, warn_all

__all__ = ["MedialAxis", "medial_axis"]

# A class that has a member `_core` cannot name the module in its annotations.
_CoreAxis = _core.MedialAxis


class MedialAxis(Rebuilt):
    """Medial axis of a solid for all thresholds theta of the separation angle; the result of :func:`medial_axis`.

    A pickle or copy holds the shape, the options and the report. The copy computes the axis again at its first use, in
    the same time as :func:`medial_axis`. The arrays of the shape must not have changed in place. :meth:`simplify`
    returns an axis at one angle, whose pickles hold all its parts.

    Examples
    --------
    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("box"), resolution=32)
    >>> len(axis.simplify(80).triangles) >= len(axis.simplify(120).triangles)
    True
    """

    def __init__(self, core: _CoreAxis, origin: Origin, options: dict[str, Any]) -> None:
        self._core = core
        self._origin = origin
        self._options = options  # For another grid of the same mesh, and for pickles.
        #: Smallest valid theta, degrees.
        self.least_theta: float = core.least_theta
        #: Largest valid theta, degrees.
        self.greatest_theta: float = core.greatest_theta

    @cached_property
    def _core(self) -> _CoreAxis:
        shape = self._origin.shape
        assert shape is not None  # Set by medial_axis().
        make: Any = _core.medial_axis_of_image if isinstance(shape, Image) else _core.medial_axis_of_mesh
        made: _CoreAxis = make(shape._arrays, self._options, 0, None)
        return made

    def __getstate__(self) -> dict[str, Any]:
        return {**super().__getstate__(), "report": self.report}

    @cached_property
    def report(self) -> MedialAxisReport:
        """Rule of the solid, facts of its bodies, and whether the axis has the topology of the solid."""
        found: MedialAxisReport = self._core.report
        return found

    def simplify(self, theta: Real = 60.0, *, fit: bool = False) -> MedialComplex:
        """Returns the part of the axis whose separation angle exceeds theta, and the cells that connect this part.

        The homotopy type is the same for every theta. The result for a larger theta is a part of the result for a
        smaller theta, unless `fit` moves borders. The cost is linear in the result.

        Parameters
        ----------
        theta : float
            Threshold of the separation angle, in degrees: `least_theta` to `greatest_theta`.
        fit : bool
            True: moves seams to points at the same distance from three walls, and rims to points with the separation
            angle theta.

        Raises
        ------
        InvalidOption, TypeError

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16)
        >>> axis.simplify(60).sheet_count, axis.simplify(120).sheet_count
        (13, 1)
        """
        angle = number(theta, "theta")
        cut = self._core.fitted if fit else self._core.simplify
        return MedialComplex._of(cut(angle), EVERYTHING, replace(self._origin_at(angle), fitted=fit))

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
        """Returns the axis at theta with a certificate that holds, as `blum medial` writes it.

        Up to four forms are tried. The first form has fitted borders and few vertices. The second form has all
        vertices. The third form has few vertices, with borders at the cells of the grid. The fourth form has all
        vertices of these cells. If no form is certified, all four forms are tried again on a grid that is shifted by
        part of a voxel. A warning names the checks that failed. The mesh or image must not have changed since the call
        of :func:`medial_axis`. A different `least_theta` may move the ends of sheets by up to a voxel.

        Parameters
        ----------
        theta : float
            As for :meth:`simplify`.
        tolerance : float, optional
            As for :meth:`MedialComplex.decimate`. 0 keeps all vertices, and leaves borders at the cells of the grid.
        allow_uncertified : bool
            True: returns the best axis even if it is not certified, with a warning. Check `.certificate` then.
        threads, progress
            As for :func:`distance_field`.

        Raises
        ------
        NotCertified
            If no form is certified.

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=32).certified(60)
        >>> axis.certificate.holds, axis.counts["sheets"]
        (True, 12)
        """
        angle, most = number(theta, "theta"), optional_number(tolerance, "tolerance")
        shape = self._origin.shape
        assert shape is not None  # Set by medial_axis().
        count = integer(threads, "threads")
        verifier = ShapeVerifier(shape)
        with reporting(progress) as report:
            if isinstance(shape, Image):
                label, threshold = self._origin.label, self._origin.threshold
                made = _core.certified_axis_of_image(
                    self._core, verifier._of_image(label), label, threshold, angle, most, count, report
                )
            else:
                of_mesh = verifier._of_mesh(None)
                made = _core.certified_axis_of_mesh(
                    self._core, of_mesh, shape._arrays, self._options, angle, most, count, report
                )
        core, deviation, fitted, of_grid, certificate, mismatches, stated = made
        warn_all(stated)
        if mismatches:
            text = "NOT certified: " + "; ".join(mismatches)
            if not allow_uncertified:
                raise NotCertified(text)
            warn(text, "not-certified")
        found = MedialComplex._of(
            core, EVERYTHING, replace(_origin_of(self._origin, of_grid, angle), deviation=deviation, fitted=fitted)
        )
        found.__dict__["certificate"] = certificate
        return found

    @takes("AxisGraphOptions")
    def graph(self, theta: Real = 60.0, **options: Unpack[AxisGraphOptions]) -> AxisGraph:
        """Returns the graph of the axis at theta degrees; see :func:`axis_graph`.

        Parameters
        ----------
        theta : float
            As for :meth:`simplify`.
        **options

        Examples
        --------
        >>> import blum
        >>> axis = blum.medial_axis(blum.generate("box", size_x=3, size_y=2, size_z=0.5), resolution=24)
        >>> [round(sheet.thickness.median, 6) for sheet in axis.graph(120).sheets]
        [0.5]
        """
        return self.simplify(theta).graph(**options)

    def nested(self) -> NestedComplex:
        """Returns the results of simplify() for all angles from `least_theta` to 180, in one complex.

        Such a complex can serve a slider for theta, for example. The cost is near-linear in the size of the axis at
        `least_theta`. Raises InvalidOption unless `greatest_theta` is 180.

        Examples
        --------
        >>> import blum
        >>> blum.medial_axis(blum.generate("box"), resolution=16, least_theta=60).nested().least_theta
        60.0
        """
        return NestedComplex(self._core.nested(), self.least_theta)

    def write(self, path: PathLike) -> None:
        """Writes the axes of `least_theta` and of all larger theta to .npz, as `blum medial --nested` does.

        `blum view` and :func:`view` show such a file with a slider for theta.

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> axis = blum.medial_axis(blum.generate("box"), resolution=16, least_theta=60)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     axis.write(pathlib.Path(folder) / "box.npz")
        ...     blum.read_medial(pathlib.Path(folder) / "box.npz").nested.least_theta
        60.0
        """
        write_complex(path, self.simplify(self.least_theta), self.nested())

    def __repr__(self) -> str:
        components, tunnels, voids = self.report.solid_betti
        return f"MedialAxis(components={components}, tunnels={tunnels}, voids={voids}, rule={self.report.rule!r})"


def _origin_of(origin: Origin, report: MedialAxisReport, angle: float) -> Origin:
    """Returns the origin of the axis at one theta."""
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
    """Computes the medial axis of the solid of a mesh or an image. The axis has the topology of the solid.

    Parameters
    ----------
    shape, triangles
        A mesh, as for :func:`distance_field`, or an image, as for :func:`distance_transform`.
    spacing : float; images: three numbers, optional
        Meshes: side of a voxel, mesh units; excludes `resolution`. Images: size of a voxel in x, y, z order.
    weld : float, optional
        Meshes: as for :func:`distance_field`.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    MedialAxis
        `.certified(theta)` returns the best certified complex at an angle, with few triangles. `.simplify(theta)`
        returns the complex of the cells, and `.simplify(theta).certificate` its certificate.

    Raises
    ------
    InvalidMesh, InvalidImage, InvalidOption (all ValueError), TypeError, OutOfMemory, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> axis = blum.medial_axis(blum.generate("torus"), resolution=32)
    >>> axis
    MedialAxis(components=1, tunnels=1, voids=0, rule='polyhedron')
    """
    count = integer(threads, "threads")
    label, threshold = options.get("label"), options.get("threshold")
    smallest = number(options.get("lambda_", default_of("MedialAxisOptions", "lambda_")), "lambda_")
    if triangles is None and is_image(shape):
        chosen = None if label is None else label_of(label, "label")
        image = labelled(as_image(shape, spacing), None if chosen is None else [chosen])
        with reporting(progress) as report:
            core = _core.medial_axis_of_image(image._arrays, dict(options), count, report)
        origin = Origin(image, chosen, optional_number(threshold, "threshold"), lambda_=smallest, source=image.source)
        return MedialAxis(core, origin, dict(options))
    refuse_selection(label, threshold)
    check_one(options.get("resolution"), spacing, "size of a voxel")
    mesh = as_mesh(cast(MeshOrVertices, shape), triangles, "shape", weld=weld)
    given = {**options, "spacing": spacing}

    with reporting(progress) as report:
        core = _core.medial_axis_of_mesh(mesh._arrays, given, count, report)
    axis = MedialAxis(core, Origin(mesh, lambda_=smallest, source=mesh.source, weld=mesh._weld), given)
    warn_all(axis.report.warnings)
    return axis
