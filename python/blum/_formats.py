"""The table of file formats."""

from __future__ import annotations

from typing import NamedTuple

from . import _core


class FileFormat(NamedTuple):
    """A format of files of one content; a name that stands for several contents (PLY) is there for each."""

    content: str
    """"mesh", "image", "field" or "complex" (medial axes are complexes)."""
    name: str
    extensions: list[str]
    """Those that are read, in lower case, with their dots."""
    written: list[str]
    """Those of them that are written as well."""
    holds: str
    """What a file can hold, for people."""
    opens_in: str
    """Other programs, for people."""


def file_formats(content: str | None = None) -> list[FileFormat]:
    """All formats that are read and written, or those of one content.

    >>> import blum
    >>> [one.name for one in blum.file_formats("mesh")][:2]
    ['OBJ', 'OFF']
    """
    rows = [FileFormat(*row) for row in _core.file_formats()]
    return [row for row in rows if content is None or row.content == content]


def extensions(content: str) -> tuple[str, ...]:
    """Those that are read as this content."""
    return tuple(end for row in file_formats(content) for end in row.extensions)
