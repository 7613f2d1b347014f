"""Files of complexes with columns."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from . import _core
from ._arguments import PathLike, existing_file, text
from ._complex import Complex
from ._methods import Shown

__all__ = ["ComplexFile", "read_complex", "write_complex"]


@dataclass(frozen=True, eq=False, repr=False)
class ComplexFile(Shown):
    """Result of :func:`read_complex`: the content of a file.

    Examples
    --------
    >>> import blum, pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     blum.write_complex(pathlib.Path(folder) / "one.npz", blum.Complex([[0, 0, 0]]))
    ...     file = blum.read_complex(pathlib.Path(folder) / "one.npz")
    >>> len(file.complex.vertices), dict(file.metadata), dict(file.further)
    (1, {}, {})
    """

    complex: Complex  #: The first complex.
    metadata: Mapping[str, str]  #: Texts of the file, for example `content` and `certified`.
    further: Mapping[str, Complex]  #: Complexes beside the first one, by name. Only .npz files hold them.


def read_complex(path: PathLike) -> ComplexFile:
    """Reads any complex: .vtp, .ply and .npz with columns, .obj without columns, .ma with radii.

    It reads the files of ``blum voronoi`` and :meth:`VoronoiComplex.write`, medial axes as plain complexes, and files
    of other programs.

    Raises
    ------
    FileNotFoundError, FileError, FormatError, InvalidOption

    Examples
    --------
    >>> import blum, tempfile, os
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     blum.voronoi_complex(blum.generate("box")).write(os.path.join(folder, "box.npz"))
    ...     file = blum.read_complex(os.path.join(folder, "box.npz"))
    >>> file.metadata["certified"], sorted(file.complex.triangle_columns)
    ('true', ['separation_angle', 'site_a', 'site_b'])
    """
    core, metadata, further = _core.read_complex(existing_file(path))
    others = {name: Complex._from_core(one) for name, one in further.items()}
    return ComplexFile(Complex._from_core(core), metadata, others)


def write_complex(
    path: PathLike,
    complex: Complex,
    *,
    metadata: Mapping[str, str] = MappingProxyType({}),
    further: Mapping[str, Complex] = MappingProxyType({}),
    allow_loss: bool = False,
) -> None:
    """Writes a complex with all its columns to .vtp, .ply, .npz, .obj, .ma or .glb.

    The file appears under its name only when it is complete.

    Parameters
    ----------
    path : path
        Its extension selects the format.
    complex : Complex
        A plain complex. Diagrams and medial axes have their own ``write``, which records their kind and certificate.
    metadata : mapping of strings to strings, optional
        Texts for the file.
    further : mapping of names to complexes, optional
        Further complexes for the same file, which must be .npz. Names consist of letters and digits.
    allow_loss : bool
        True: columns and metadata that the format cannot hold (.obj: all of them) are left out. False: such columns and
        metadata are rejected.

    Raises
    ------
    FileError, InvalidOption, TypeError

    Examples
    --------
    >>> import blum, tempfile, os
    >>> path = blum.Complex([[0, 0, 0], [1, 0, 0]], edges=[[0, 1]], edge_columns={"cost": [2.5]})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     blum.write_complex(os.path.join(folder, "path.vtp"), path, metadata={"made by": "hand"})
    ...     file = blum.read_complex(os.path.join(folder, "path.vtp"))
    >>> file.metadata, file.complex.edge_columns["cost"]
    ({'made by': 'hand'}, array([2.5]))
    """
    _check_plain(complex, "complex")
    others = _entries(further, "further")
    for name, one in others:
        _check_plain(one, f"further[{name!r}]")
    texts = [(key, text(value, f"metadata[{key!r}]")) for key, value in _entries(metadata, "metadata")]
    _core.write_complex(
        Path(os.fspath(path)), complex._core, texts, [(name, one._core) for name, one in others], bool(allow_loss)
    )


def _check_plain(complex: Any, argument: str) -> None:
    """Raises TypeError unless the argument is a Complex itself, not an instance of a subclass."""
    if not isinstance(complex, Complex):
        raise TypeError(f"{argument} must be a blum.Complex, not {type(complex).__name__}")
    if type(complex) is not Complex:
        raise TypeError(
            f"{argument} is a {type(complex).__name__}: use its method write(), which records its kind and whether it "
            "is certified"
        )


def _entries(mapping: Any, argument: str) -> list[tuple[str, Any]]:
    """Returns the entries of a mapping with checked names."""
    if not isinstance(mapping, Mapping):
        raise TypeError(f"{argument} must be a mapping with names as keys, not {type(mapping).__name__}")
    return [(text(key, f"a name of {argument}"), value) for key, value in mapping.items()]
