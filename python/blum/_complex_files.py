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


@dataclass(frozen=True, eq=False)
class ComplexFile:
    """What a file of a complex holds: what :func:`read_complex` returns."""

    complex: Complex
    metadata: Mapping[str, str]  #: what the file says in words, such as `content` and `certified`
    further: Mapping[str, Complex]  #: complexes beside the first, by name; of .npz files


def read_complex(path: PathLike) -> ComplexFile:
    """Reads any complex: .vtp, .ply and .npz with columns, .obj without, .ma with radii. What ``blum voronoi`` and
    :meth:`VoronoiComplex.write` write, medial axes as plain complexes, and files of other programs.

    Raises
    ------
    FileNotFoundError, FileError, FormatError, InvalidOption

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
    """Writes a complex with all its columns to .vtp, .ply, .npz, .obj, .ma or .glb; the file appears complete or not at
    all.

    Parameters
    ----------
    path : path
        Its extension tells the format.
    complex : Complex
        Diagrams and medial axes have a ``write`` of their own, which says what they are and whether that is certified.
    metadata : mapping of texts to texts, optional
        What the file is to say in words.
    further : mapping of names to complexes, optional
        Complexes beside the first, by names of letters and digits, which only .npz files hold.
    allow_loss : bool
        Whether columns and metadata that the format cannot hold (.obj: all of them) are left out instead of refused.

    Raises
    ------
    FileError, InvalidOption, TypeError

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
    if not isinstance(complex, Complex):
        raise TypeError(f"{argument} must be a complex, not {type(complex).__name__}")
    if type(complex) is not Complex:
        raise TypeError(
            f"{argument} is a {type(complex).__name__}, whose write() says what it is and whether that is certified: "
            "use that"
        )


def _entries(mapping: Any, argument: str) -> list[tuple[str, Any]]:
    if not isinstance(mapping, Mapping):
        raise TypeError(f"{argument} must be a mapping with names, not {type(mapping).__name__}")
    return [(text(key, f"a name of {argument}"), value) for key, value in mapping.items()]
