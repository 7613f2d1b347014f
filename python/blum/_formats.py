"""File formats."""

from __future__ import annotations

from . import _core
from ._methods import ShortList
from ._structs import FileFormat

__all__ = ["file_formats"]


def file_formats(content: str | None = None) -> list[FileFormat]:
    """Returns all file formats that Blum reads or writes, or those for one content.

    Parameters
    ----------
    content : str, optional
        For example "mesh", "image", "field", "complex" or "surface map". Default: all contents.

    Examples
    --------
    >>> import blum
    >>> [one.name for one in blum.file_formats("mesh")][:2]
    ['OBJ', 'OFF']
    """
    rows: tuple[FileFormat, ...] = _core.file_formats()
    return ShortList(row for row in rows if content is None or row.content == content)


def extensions(content: str) -> tuple[str, ...]:
    """Returns the extensions of the formats that are read as this content."""
    return tuple(end for row in file_formats(content) for end in row.extensions)
