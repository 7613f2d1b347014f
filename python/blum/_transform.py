"""Distance transforms of voxel images."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Integer, device_name, integer, label_of
from ._errors import InvalidOption
from ._field import Field
from ._image import Image, as_image, labelled
from ._methods import ShortList
from ._options import takes
from ._progress import Progress, reporting
from ._structs import DistanceTransformOptions

__all__ = ["distance_transform", "distance_transforms"]


@takes("DistanceTransformOptions")
def distance_transform(
    image: Any,
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    threads: int = 0,
    device: str = "cpu",
    progress: Progress = False,
    **options: Unpack[DistanceTransformOptions],
) -> Field:
    """Computes the exact Euclidean distance and the closest voxel at every voxel of an image, between voxel centres.

    Parameters
    ----------
    image : (z, y, x) array, Image, path, or image of SimpleITK
        Booleans or numbers. The nonzero voxels are selected, unless `label` or `threshold` selects others.
    spacing, origin, direction
        As for :class:`Image`, in x, y, z order: the reverse of the array's axes.
    device : "cpu", "auto", "cuda" or "cuda:K"
        As for :func:`distance_field`. A device must hold the whole image, and 8 bytes per voxel, also without sites.
    threads, progress
        As for :func:`distance_field`.
    **options

    Returns
    -------
    Field
        `Field.site` holds flat indices of the closest voxels. With `sites=False`, `site` is None.

    Examples
    --------
    >>> import numpy as np, blum
    >>> mask = np.zeros((3, 3, 3), dtype=bool)
    >>> mask[1, 1, 1] = True
    >>> blum.distance_transform(mask, signed=False).distance[1, 1].tolist()
    [1.0, 0.0, 1.0]
    """
    return _transforms(as_image(image, spacing, origin, direction), [], options, threads, device, progress)[0]


@takes("DistanceTransformOptions", "label", "threshold")
def distance_transforms(
    image: Any,
    labels: Sequence[Integer] | npt.NDArray[Any],
    *,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    threads: int = 0,
    device: str = "cpu",
    progress: Progress = False,
    **options: Unpack[DistanceTransformOptions],
) -> list[Field]:
    """Returns one :func:`distance_transform` for each label. The image is checked once, and working memory is shared.

    Parameters
    ----------
    labels : integers
    image, spacing, origin, direction, threads, device, progress
        As for :func:`distance_transform`.
    **options

    Examples
    --------
    >>> import blum
    >>> one, two = blum.distance_transforms([[[1, 0, 2]]], [1, 2], signed=False)
    >>> one.distance.tolist(), two.distance.tolist()
    ([[[0.0, 1.0, 2.0]]], [[[2.0, 1.0, 0.0]]])
    """
    if options.keys() & {"label", "threshold"}:
        raise InvalidOption("labels excludes label and threshold: each of them selects voxels")
    wanted = [label_of(label, "labels") for label in _several(labels)]
    if not wanted:
        return []
    return _transforms(as_image(image, spacing, origin, direction), wanted, options, threads, device, progress)


def _several(labels: Any) -> list[Any]:
    """Returns a list of labels."""
    if isinstance(labels, (Sequence, np.ndarray)) and not isinstance(labels, (str, bytes)) and np.ndim(labels) == 1:
        return list(labels)
    raise TypeError(f"labels must be a list of integers, not {type(labels).__name__}")


def _transforms(
    image: Image, labels: list[int], options: DistanceTransformOptions, threads: int, device: str, progress: Progress
) -> list[Field]:
    """Returns the transforms of several labels; without labels, that of the options' selection."""
    label = options.get("label")
    selected = labels or (None if label is None else [label_of(label, "label")])
    image = labelled(image, selected)
    with reporting(progress) as report:
        fields = _core.distance_transforms(
            image._arrays, labels, dict(options), integer(threads, "threads"), device_name(device), report
        )
    return ShortList(Field._of(field, None, image.source, image.space) for field in fields)
