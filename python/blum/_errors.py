"""What Blum raises. Each class is also the built-in one that a caller would expect."""


class Error(Exception):
    """Base of everything that Blum raises on purpose; its text says what was wrong, where, and what to do."""


class InputWarning(UserWarning):
    """An input that can be used, but looks as if something else were meant: `warnings.filterwarnings` silences it."""

    def __init__(self, text: str = "", code: str = "") -> None:
        super().__init__(text)
        #: What it is about, in one word that stays while texts change, such as "facing"; empty where it has none.
        self.code = code


class InvalidMesh(Error, ValueError):
    """A mesh that cannot be used: nothing in it, coordinates that are not finite, indices out of range."""


class InvalidGrid(Error, ValueError):
    """A grid that cannot be used: spacing that is not positive, no nodes, too many nodes."""


class InvalidImage(Error, ValueError):
    """An image that cannot be used, or in which nothing is selected."""


class InvalidOption(Error, ValueError):
    """An argument out of its range, or arguments that exclude each other."""


class NotCertified(Error, RuntimeError):
    """An axis that is not certified, where one that is was asked for; the text says all that does not hold."""


class OutOfMemory(Error, MemoryError):
    """The memory that a call needs is not there; the text says how much it asked for."""


class DeviceError(Error, RuntimeError):
    """A device that was asked for is not there, or failed; the text says which and what to do."""


class Cancelled(Error):
    """The call was asked to stop."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""


class FormatError(FileError, ValueError):
    """A file whose content is not what its format asks for."""
