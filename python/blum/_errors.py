"""Exceptions and warnings.

Each exception also derives from a built-in exception of the same kind.
"""

__all__ = [
    "Cancelled",
    "DeviceError",
    "Error",
    "FileError",
    "FormatError",
    "InputWarning",
    "InvalidGrid",
    "InvalidImage",
    "InvalidMesh",
    "InvalidOption",
    "NotCertified",
    "OutOfMemory",
]


class Error(Exception):
    """Base class of all exceptions that Blum raises on purpose. Messages state the problem, its place and a remedy.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.distance_field([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 7]])
    ... except blum.Error as error:
    ...     print(error)
    triangles[0, 2] is 7, but must be 0 to 2
    """


class InputWarning(UserWarning):
    """Warning about an input that can be used, but may not be the intended one.

    `warnings.filterwarnings` silences it. `code` identifies the kind of warning.

    Examples
    --------
    >>> import blum, warnings
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     _ = blum.thickness(blum.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    >>> [warning.message.code for warning in caught]
    ['open-mesh']
    """

    def __init__(self, text: str = "", code: str = "") -> None:
        super().__init__(text)
        #: Kind of warning, for example "facing". Codes stay the same when texts change. Empty if it has none.
        self.code = code


class InvalidMesh(Error, ValueError):
    """Error for a mesh that cannot be used: empty, with non-finite coordinates, or with indices out of range.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.Mesh([[0, 0, 0]], [[0, 1, 2]])
    ... except blum.InvalidMesh as error:
    ...     print(error)
    triangles[0, 1] is 1, but must be 0 to 0
    """


class InvalidGrid(Error, ValueError):
    """Error for a grid that cannot be used: with a spacing that is not positive, without nodes, or with too many nodes.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.Grid(origin=(0, 0, 0), spacing=0, size=(2, 2, 2))
    ... except blum.InvalidGrid:
    ...     print("the spacing must be positive")
    the spacing must be positive
    """


class InvalidImage(Error, ValueError):
    """Error for an image that cannot be used, or in which no voxel is selected.

    Examples
    --------
    >>> import blum, numpy as np
    >>> try:
    ...     blum.distance_transform(np.zeros((2, 2, 2), dtype=bool))
    ... except blum.InvalidImage:
    ...     print("no voxel is selected")
    no voxel is selected
    """


class InvalidOption(Error, ValueError):
    """Error for an argument out of range, or for arguments that exclude each other.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.distance_field(blum.generate("box"), resolution=1)
    ... except blum.InvalidOption:
    ...     print("the resolution must be at least 2")
    the resolution must be at least 2
    """


class NotCertified(Error, RuntimeError):
    """Error for an axis that is not certified, although a certified one was requested. The message lists all failed
    checks.

    Examples
    --------
    >>> import blum
    >>> issubclass(blum.NotCertified, RuntimeError)
    True
    """


class OutOfMemory(Error, MemoryError):
    """Error for a call that needs more memory than is available. The message states the amount.

    Examples
    --------
    >>> import blum
    >>> issubclass(blum.OutOfMemory, MemoryError)
    True
    """


class DeviceError(Error, RuntimeError):
    """Error for a requested device that does not exist or failed. The message names the device and a remedy.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.distance_field(blum.generate("box"), resolution=8, device="cuda:1000")
    ... except blum.DeviceError:
    ...     print("no such device")
    no such device
    """


class Cancelled(Error):
    """Error for a call that was asked to stop.

    Examples
    --------
    >>> import blum
    >>> issubclass(blum.Cancelled, blum.Error)
    True
    """


class FileError(Error, OSError):
    """Error for a file that cannot be opened, read or written.

    Examples
    --------
    >>> import blum
    >>> try:
    ...     blum.generate("box").write("no such folder/box.ply")
    ... except blum.FileError:
    ...     print("not written")
    not written
    """


class FormatError(FileError, ValueError):
    """Error for a file whose content violates its format.

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder) / "part.off"
    ...     _ = path.write_text("not a mesh")
    ...     try:
    ...         blum.read_mesh(path)
    ...     except blum.FormatError:
    ...         print("not an OFF file")
    not an OFF file
    """
