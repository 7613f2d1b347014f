"""Smooth surfaces of voxels."""

from __future__ import annotations

from typing import Any, Unpack

from . import _core
from ._arguments import Integer, Real, integer, label_of, optional_number
from ._image import as_image, labelled
from ._mesh import Mesh, mesh_of_arrays
from ._options import takes
from ._progress import Progress, reporting
from ._structs import SmoothSurfaceOptions

__all__ = ["smooth_surface"]


@takes("SmoothSurfaceOptions")
def smooth_surface(
    image: Any,
    *,
    label: Integer | None = None,
    threshold: Real | None = None,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[SmoothSurfaceOptions],
) -> Mesh:
    """Returns a smooth, closed mesh between the selected voxels of an image and all others.

    The centres of the selected voxels are inside, all other centres outside. Each vertex stays within half a voxel,
    along each axis, of its initial position on the surface of the voxels' boxes. The mesh is manifold and does not
    cross itself. Its solid has the same numbers of components, tunnels and voids as the voxels. The medial axis of the
    mesh lacks the small sheets that the steps of the voxels' boxes cause.

    Parameters
    ----------
    image : (z, y, x) array, Image, path, or image of SimpleITK
    label : int, optional
        Selects the voxels of this value. Default without a threshold: the nonzero voxels.
    threshold : float, optional
        Selects the voxels of at least this value. Excludes `label`.
    spacing, origin, direction
        As for :class:`Image`, in x, y, z order: the reverse of the array's axes.
    **options
    threads, progress
        As for :func:`distance_field`.

    Returns
    -------
    Mesh

    Raises
    ------
    InvalidImage, InvalidOption (both ValueError), TypeError, OutOfMemory, KeyboardInterrupt

    Examples
    --------
    >>> import blum
    >>> tubes = blum.smooth_surface(blum.generate("tube_image", nodes=2))
    >>> blum.topology(tubes).betti
    (1, 5, 0)
    >>> blum.medial_axis(tubes, spacing=1).simplify(60).certificate.holds
    True
    """
    chosen = None if label is None else label_of(label, "label")
    given = labelled(as_image(image, spacing, origin, direction), None if chosen is None else [chosen])
    with reporting(progress) as report:
        arrays, _ = _core.smooth_surface(
            given._arrays,
            chosen,
            optional_number(threshold, "threshold"),
            dict(options),
            integer(threads, "threads"),
            report,
        )
    mesh = mesh_of_arrays(arrays)
    mesh.source = given.source
    return mesh
