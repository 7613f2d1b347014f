"""Verifiers of several axes."""

from __future__ import annotations

from typing import Unpack

import numpy.typing as npt

from ._arguments import Integer, Real
from ._certificate import ShapeVerifier
from ._grid import Grid
from ._image import Image
from ._medial_complex import MedialComplex, claim_of
from ._mesh import MeshOrVertices
from ._options import takes
from ._progress import Progress
from ._structs import Certificate, CertificateOptions

__all__ = ["AxisVerifier"]


class AxisVerifier:
    """Certifier of axes of one mesh or image, which is read only once. Six axes take little longer than one axis.

    The certificates are those of :func:`certify`.

    Parameters
    ----------
    shape, triangles
        The mesh, as for :func:`distance_field`, or the image, as for :func:`distance_transform`. The arrays of the
        shape must not change while the verifier is used.
    weld : float, optional
        Meshes: as for :func:`certify`.

    Examples
    --------
    >>> import blum
    >>> torus = blum.generate("torus")
    >>> axis = blum.medial_axis(torus, resolution=32)
    >>> verifier = blum.AxisVerifier(torus)
    >>> [verifier.certify(axis.simplify(theta)).holds for theta in (20, 60)]
    [True, True]
    """

    def __init__(
        self, shape: MeshOrVertices | Image, triangles: npt.ArrayLike | None = None, *, weld: Real | None = None
    ) -> None:
        self._verifier = ShapeVerifier(shape, triangles, weld)

    @takes("CertificateOptions")
    def certify(
        self,
        axis: MedialComplex,
        *,
        label: Integer | None = None,
        threshold: Real | None = None,
        grid: Grid | None = None,
        threads: int = 0,
        progress: Progress = False,
        **checks: Unpack[CertificateOptions],
    ) -> Certificate:
        """Returns the same certificate as `blum.certify(axis, shape)`.

        Parameters
        ----------
        axis : MedialComplex
        label, threshold, grid, threads, progress
            As for :func:`certify`.
        **options
            By default, a check runs if the axis has the attribute that this check needs.

        Examples
        --------
        >>> import blum
        >>> box = blum.generate("box")
        >>> blum.AxisVerifier(box).certify(blum.medial_axis(box, resolution=16).simplify(60)).holds
        True
        """
        return self._verifier.certified(
            claim_of(axis), label=label, threshold=threshold, grid=grid, threads=threads, progress=progress, **checks
        )

    def __repr__(self) -> str:
        return f"AxisVerifier({self._verifier.kind})"
