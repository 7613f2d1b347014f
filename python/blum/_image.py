"""Voxel images."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import PathLike, as_array, existing_file, integer, source_name
from ._errors import InvalidImage, InvalidOption
from ._formats import extensions
from ._grid import Grid, image_grid
from ._progress import Progress, reporting
from ._structs import ImageValues
from ._warn import warn_all

__all__ = ["Image", "as_image", "read_image"]

_EXTENSIONS = extensions("image")


class Image:
    """3D image of numbers, with the positions of its voxel centres.

    Parameters
    ----------
    values : (z, y, x) array
        Booleans, integers or floats. C-contiguous arrays are not copied. Pass a picture with two axes as one layer:
        ``picture[None]``.
    spacing, origin : three numbers, optional
        In x, y, z order: the reverse of the array's axes. A single number stands for all three.
    direction : (3, 3) array, optional
        Orthonormal. Column a is the direction of index axis a (0: x, the array's last axis).
    space : str
        Name of the world axes in NRRD files. See :attr:`space`.

    Examples
    --------
    >>> import numpy as np, blum
    >>> blum.Image(np.zeros((4, 5, 6), dtype=np.uint8), spacing=(0.5, 0.5, 2)).grid.size
    (6, 5, 4)
    """

    def __init__(
        self, values: Any, spacing: Any = 1.0, origin: Any = 0.0, direction: Any = None, *, space: str = ""
    ) -> None:
        if _is_simpleitk(values):
            raise TypeError("image is a SimpleITK image: pass it to functions as it is, or use blum.as_image(image)")
        array = as_array(values, "image")
        if array.dtype.kind == "O":
            advice = ": blum.read_image(path) reads its file" if hasattr(values, "dataobj") else ""  # nibabel
            raise TypeError(f"image is a {type(values).__name__}, but must be an array of numbers or booleans{advice}")
        if array.dtype.kind not in "biuf" or array.dtype == np.float16:
            if array.dtype != np.float16:
                raise TypeError(f"image must hold numbers or booleans, not {array.dtype}")
            array = array.astype(np.float32)
        if array.dtype.kind == "f" and array.dtype.itemsize > 8:
            raise TypeError(f"image must hold at most 64 bits per voxel, not {array.dtype}")
        if array.ndim != 3:
            layer = "; one layer is image[None]" if array.ndim == 2 else ""
            raise ValueError(f"image has {array.ndim} axes, but must have 3: [z, y, x]{layer}")
        array = np.ascontiguousarray(array, dtype=array.dtype.newbyteorder("="))
        if not isinstance(space, str):
            raise TypeError(f"space must be a string, not {type(space).__name__}")
        self._values: npt.NDArray[Any] = array
        self._grid = image_grid(array.shape, spacing, origin, direction)
        self._space = space
        #: Name of the image's file, for the metadata of files.
        self.source: str = ""
        self._arrays = _core.ImageArrays(
            array.view(np.uint8) if array.dtype == np.bool_ else array, self._grid._spec, space
        )

    @property
    def values(self) -> npt.NDArray[Any]:
        """Voxels: (z, y, x). Values may change in place between calls. For another array, make another Image."""
        return self._values

    @property
    def grid(self) -> Grid:
        """Grid of the voxels' centres."""
        return self._grid

    def labels(self, most: int = 20, *, threads: int = 0, progress: Progress = False) -> ImageValues:
        """Returns the range of the values, and voxels, volume and Betti numbers of the most frequent labels.

        Values within 0.01 of whole numbers are rounded, with a warning, if all values are.

        Parameters
        ----------
        most : int
            Largest number of labels.
        threads, progress
            As for :func:`distance_field`.

        Examples
        --------
        >>> import blum
        >>> [(each.label, each.betti) for each in blum.generate("ball_image", size=12).labels().labels]
        [(0, None), (1, (1, 0, 0))]
        """
        with reporting(progress) as report:
            found: ImageValues = _core.image_values(
                labelled(self, [])._arrays, integer(most, "most"), integer(threads, "threads"), report
            )
        return found

    @property
    def space(self) -> str:
        """Name of the world axes, as in NRRD files: "left-posterior-superior", ... Empty if unknown."""
        return self._space

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._values, self._grid, self._space, self.source)

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Distance between voxel centres, in x, y, z order."""
        return self.grid.spacing

    def write(self, path: PathLike) -> None:
        """Writes .nrrd (with the grid) or .npy (values only).

        Examples
        --------
        >>> import blum, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = pathlib.Path(folder) / "ball.nrrd"
        ...     blum.generate("ball_image", size=12).write(path)
        ...     blum.read_image(path).values.shape
        (12, 12, 12)
        """
        _core.write_image(Path(os.fspath(path)), self._arrays)

    def __repr__(self) -> str:
        return f"Image({self.values.dtype} {self.values.shape}, {self.grid!r})"


def read_image(path: PathLike) -> Image:
    """Reads an image in any format of `file_formats("image")`. Spacing, origin and direction are those of the file.

    Raises
    ------
    FileNotFoundError, FileError, FormatError, InvalidOption

    Examples
    --------
    >>> import blum, numpy as np, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "mask.npy"
    ...     np.save(path, np.ones((2, 3, 4), dtype=np.uint8))
    ...     blum.read_image(path).grid.size
    (4, 3, 2)
    """
    parts, warnings = _core.read_image(existing_file(path))
    image = image_of_parts(*parts)
    image.source = source_name(path)
    warn_all(warnings)
    return image


def _restored(values: npt.NDArray[Any], grid: Grid, space: str, source: str) -> Image:
    image = Image(values, grid.spacing, grid.origin, grid.direction, space=space)
    image.source = source
    return image


def image_of_parts(values: npt.NDArray[Any], spec: _core.GridSpec, space: str) -> Image:
    """Returns an image from the library's arrays."""
    grid = Grid._of(spec)
    return Image(values, grid.spacing, grid.origin, grid.direction, space=space)


def labelled(image: Image, labels: Sequence[int] | None) -> Image:
    """Returns an image whose labels are whole numbers, because selections by label compare exactly.

    If values are nearly whole, as after a scale in single precision, they are rounded with a warning.

    Parameters
    ----------
    labels : integers
        Labels that are selected; empty: all. None: nothing is selected by label, and the image is returned as it is.
    """
    if labels is None or image.values.dtype.kind != "f":
        return image
    found: Any = _core.rounded_labels(image._arrays, list(labels))
    if found is None:
        return image
    parts, warnings = found
    rounded = image_of_parts(*parts)
    rounded.source = image.source
    warn_all(warnings)
    return rounded


def refuse_selection(label: Any, threshold: Any) -> None:
    """Raises InvalidOption if voxels are selected, but the shape is a mesh."""
    if label is not None or threshold is not None:
        raise InvalidOption("label and threshold select voxels of an image, but shape is a mesh")


def is_image_path(value: Any) -> bool:
    """Returns True if a path has the extension of an image."""
    return isinstance(value, (str, os.PathLike)) and os.fspath(value).lower().endswith(_EXTENSIONS)


def is_image(value: Any) -> bool:
    """Returns True for an image, a path of one, or an array with three axes; False for a mesh."""
    if isinstance(value, Image) or is_image_path(value) or _is_simpleitk(value):
        return True
    return hasattr(value, "ndim") and value.ndim == 3


def _is_simpleitk(value: Any) -> bool:
    """Returns True for a SimpleITK.Image."""
    return all(hasattr(value, word) for word in ("GetSpacing", "GetDirection", "GetPixelIDTypeAsString"))


def _of_simpleitk(image: Any) -> Image:
    """Returns a SimpleITK.Image as an Image. Its voxels are copied, and their world axes are those of ITK."""
    import SimpleITK

    if image.GetDimension() != 3 or image.GetNumberOfComponentsPerPixel() != 1:
        raise InvalidImage(
            f"image has {image.GetDimension()} axes and {image.GetNumberOfComponentsPerPixel()} numbers per voxel, but "
            "must have 3 axes and 1 number: see SimpleITK.JoinSeries and SimpleITK.VectorIndexSelectionCast"
        )
    values = SimpleITK.GetArrayFromImage(image)
    direction = np.reshape(image.GetDirection(), (3, 3))
    return Image(values, image.GetSpacing(), image.GetOrigin(), direction, space="left-posterior-superior")


def as_image(image: Any, spacing: Any = None, origin: Any = None, direction: Any = None) -> Image:
    """Returns an array [z, y, x], a path, an Image or an image of SimpleITK as an Image.

    All functions of images call this. Voxels of SimpleITK are copied; C-contiguous arrays are not. An image of
    SimpleITK keeps its coordinates, and its :attr:`Image.space` is "left-posterior-superior".

    Parameters
    ----------
    image : (z, y, x) array, Image, path, or image of SimpleITK
    spacing, origin, direction
        Arrays only: as for :class:`Image`, in x, y, z order.

    Raises
    ------
    InvalidImage, InvalidOption (both ValueError), TypeError, FileNotFoundError, FileError, FormatError

    Examples
    --------
    >>> import blum, numpy as np
    >>> blum.as_image(np.ones((2, 3, 4)), spacing=0.5).grid.size
    (4, 3, 2)
    """
    stated = [
        name
        for name, value in (("spacing", spacing), ("origin", origin), ("direction", direction))
        if value is not None
    ]
    if isinstance(image, (str, os.PathLike)):
        image = read_image(image)
    if _is_simpleitk(image):
        image = _of_simpleitk(image)
    if isinstance(image, Image):
        if stated:
            raise InvalidOption(f"{stated[0]} is given, but the image has its own: leave it out, or pass an array")
        return image
    return Image(image, 1.0 if spacing is None else spacing, 0.0 if origin is None else origin, direction)
