"""Distance transforms of voxel images."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Integer, Real, device_name, integer, label_of, optional_number
from ._errors import InvalidOption
from ._field import Field
from ._image import as_image
from ._progress import Progress, reporting


def distance_transform(
    image: Any,
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    label: Integer | None = None,
    threshold: Real | None = None,
    signed: bool = True,
    band: Real | None = None,
    threads: int = 0,
    device: str = "cpu",
    progress: Progress = False,
) -> Field:
    """Exact Euclidean distance and closest voxel at every voxel of an image, from centre to centre.

    Parameters
    ----------
    image : (z, y, x) array, Image, or path
        Booleans or numbers; selected are the voxels that are not zero, unless `label` or `threshold` says otherwise.
    spacing, origin, direction
        As for :class:`Image`, in x, y, z order: the reverse of the array's axes.
    label : int, optional
        Select the voxels of this value.
    threshold : float, optional
        Select the voxels of at least this value.
    signed : bool
        True: distance to the nearest voxel of the other kind, negative at selected voxels. False: distance to the
        nearest selected voxel, as ``scipy.ndimage.distance_transform_edt(~mask)``.
    band : float, optional
        Half-width of a band, in the units of the spacing.
    device : "cpu", "auto", "cuda" or "cuda:K"
        As for :func:`distance_field`. A device must hold the whole image, and 8 bytes per voxel.

    Returns
    -------
    Field
        `Field.site` holds flat indices of the closest voxels.

    >>> import numpy as np, blum
    >>> mask = np.zeros((3, 3, 3), dtype=bool)
    >>> mask[1, 1, 1] = True
    >>> blum.distance_transform(mask, signed=False).distance[1, 1].tolist()
    [1.0, 0.0, 1.0]
    """
    labels = [] if label is None else [label_of(label, "label")]
    return _transforms(image, spacing, origin, direction, labels, threshold, signed, band, threads, device, progress)[0]


def distance_transforms(
    image: Any,
    labels: Sequence[Integer] | npt.NDArray[Any],
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    signed: bool = True,
    band: Real | None = None,
    threads: int = 0,
    device: str = "cpu",
    progress: Progress = False,
) -> list[Field]:
    """One :func:`distance_transform` for each label, checked once and with shared working memory."""
    wanted = [label_of(label, "labels") for label in _several(labels)]
    if not wanted:
        return []
    return _transforms(image, spacing, origin, direction, wanted, None, signed, band, threads, device, progress)


def _several(labels: Any) -> list[Any]:
    if isinstance(labels, (Sequence, np.ndarray)) and not isinstance(labels, (str, bytes)) and np.ndim(labels) == 1:
        return list(labels)
    raise TypeError(f"labels must be a list of integers, not {type(labels).__name__}")


def _transforms(
    image: Any,
    spacing: Any,
    origin: Any,
    direction: Any,
    labels: list[int],
    threshold: Real | None,
    signed: bool,
    band: Real | None,
    threads: int,
    device: str,
    progress: Progress,
) -> list[Field]:
    if labels and threshold is not None:
        raise InvalidOption("label and threshold exclude each other")
    voxels = as_image(image, spacing, origin, direction)
    with reporting(progress) as report:
        fields = _core.distance_transforms(
            voxels._arrays,
            labels,
            optional_number(threshold, "threshold"),
            bool(signed),
            optional_number(band, "band"),
            integer(threads, "threads"),
            device_name(device),
            report,
        )
    return [Field._of(field, None, voxels.source, voxels.space) for field in fields]
