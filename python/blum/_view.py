"""Views in a browser.

`view()` makes a page that shows objects in memory. The command `blum view` makes such pages from files.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import webbrowser
from pathlib import Path
from typing import Any

import numpy.typing as npt

from ._arguments import PathLike, existing_file
from ._errors import Error, FileError, InvalidOption
from ._field import Field
from ._image import Image, as_image, is_image
from ._medial import MedialAxis
from ._medial_columns import NestedComplex
from ._medial_complex import MedialComplex
from ._mesh import Mesh, MeshLike, as_mesh
from ._surface_map import SurfaceMap

__all__ = ["view"]

_TOOL = Path(__file__).parent / "_bin" / "blum"
_UNREADABLE = 1  # Exit status.
_PREFIX = re.compile(r"^blum: (?:error|warning): ")


#: Objects that a page can show.
Viewable = MeshLike | Image | Field | MedialAxis | MedialComplex | SurfaceMap | npt.NDArray[Any]


def view(*things: Viewable, output: PathLike | None = None, show: bool | None = None, **named: Viewable) -> Path:
    """Writes one HTML page that shows meshes, images, fields, medial axes and surface maps, and opens it.

    The page is one file that needs neither a network nor this process. It shows slices and isosurfaces of fields, a
    slider for theta of a :class:`MedialAxis`, and the values under the pointer.

    Parameters
    ----------
    things
        Meshes as for :func:`distance_field`, each as one object. Objects of the classes :class:`Field`,
        :class:`MedialAxis`, :class:`MedialComplex`, :class:`SurfaceMap` and :class:`Image`. Arrays [z, y, x], and paths
        of files that `blum view` shows.
    named
        The same kinds of objects with names: ``view(part=mesh, distance=field)``.
    output : path, optional
        The page, .html or .htm. Default: a file in a new temporary folder, which is not removed.
    show : bool, optional
        True: opens the page in the desktop's browser. Default: True if `output` is not given.

    Returns
    -------
    Path
        Path of the page.

    Raises
    ------
    InvalidOption, TypeError, KeyboardInterrupt
    FileError
        Also if one of several files cannot be read. The page then shows the other files, and lists the unreadable file.

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> part = blum.generate("bracket")
    >>> axis = blum.medial_axis(part, resolution=32)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = blum.view(part, axis, output=pathlib.Path(folder) / "part.html")
    ...     page.name, page.stat().st_size > 100_000
    ('part.html', True)
    """
    shown = [(f"things[{place}]", "", thing) for place, thing in enumerate(things)]
    shown += [(name, name, thing) for name, thing in named.items()]
    if not shown:
        raise InvalidOption("view() needs at least one object to show")
    if output is not None and not os.fspath(output).lower().endswith((".html", ".htm")):
        raise InvalidOption(f"output is '{os.fspath(output)}', but must end in .html or .htm")
    with tempfile.TemporaryDirectory(prefix="blum-") as folder:
        names: set[str] = set()
        files = [_file_of(thing, argument, name, Path(folder), names) for argument, name, thing in shown]
        if output is not None:
            page = Path(os.fspath(output))
            _make_page(files, page)
        else:
            made = Path(folder, "page", "page.html")
            made.parent.mkdir()
            _make_page(files, made)
            page = Path(shutil.move(made, Path(tempfile.mkdtemp(prefix="blum-"), "page.html")))
    if output is None if show is None else show:
        webbrowser.open(page.absolute().as_uri())
    return page


def _make_page(files: list[Path], page: Path) -> None:
    """Runs the command-line tool on files, and raises an error with its messages if it reports any."""
    if not _TOOL.exists():
        raise Error(f"the command-line tool that makes the page is not installed with this package: {_TOOL}")
    done = subprocess.run([_TOOL, "view", "--quiet", "--output", page, "--", *files], capture_output=True, check=False)
    lines = done.stderr.decode("utf-8", "backslashreplace").strip().splitlines()
    stated = "\n".join(_PREFIX.sub("", line) for line in lines)
    if done.returncode == 0 and not stated:
        return
    if done.returncode < 0:
        raise Error(
            f"the tool that makes the page was ended by signal {-done.returncode} (9 may mean that memory ran out)"
        )
    if done.returncode in (0, _UNREADABLE):  # 0: only some could be read. Scripts need an error.
        raise FileError(stated)
    raise InvalidOption(stated)


def _file_of(thing: Any, argument: str, name: str, folder: Path, names: set[str]) -> Path:
    """Returns the file that shows an object: a path as given, or a newly written file."""
    if isinstance(thing, (str, os.PathLike)):
        return existing_file(thing).absolute()
    if isinstance(thing, (MedialAxis, MedialComplex)):
        path = _fresh(folder, names, name or "axis", ".npz")
        thing.write(path)
    elif isinstance(thing, NestedComplex):
        raise TypeError(f"{argument} is a NestedComplex: pass its MedialAxis instead")
    elif isinstance(thing, Field):
        path = _fresh(folder, names, name or "field", ".npz")
        thing.write(path)
    elif isinstance(thing, SurfaceMap):
        path = _fresh(folder, names, name or "map", ".npz")
        thing.write(path)
    elif is_image(thing):
        path = _fresh(folder, names, name or "image", ".nrrd")
        image: Image = as_image(thing)
        image.write(path)
    else:
        mesh: Mesh = as_mesh(thing, None, argument)
        path = _fresh(folder, names, name or Path(mesh.source).stem or "mesh", ".ply")
        mesh.write(path)
    return path


def _fresh(folder: Path, names: set[str], stem: str, extension: str) -> Path:
    """Returns a path with a name that the page can show and that is not in use."""
    name, number = stem, 1
    while name + extension in names:
        number += 1
        name = f"{stem} {number}"
    names.add(name + extension)
    return folder / (name + extension)
