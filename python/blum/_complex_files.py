"""Files of complexes with columns."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from . import _core
from ._arguments import PathLike, existing_file
from ._complex import Complex


@dataclass(frozen=True, eq=False)
class ComplexFile:
    """What a file of a complex holds: what :func:`read_complex` returns."""

    complex: Complex
    metadata: Mapping[str, str]  #: what the file says in words, such as `content` and `certified`
    further: Mapping[str, Complex]  #: complexes beside the first, by name; of .npz files


def read_complex(path: PathLike) -> ComplexFile:
    """Reads any complex: .vtp, .ply and .npz with columns, .obj without. What ``blum voronoi`` and
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
    return ComplexFile(Complex._from_core(core), MappingProxyType(metadata), MappingProxyType(others))


def write_complex(
    path: PathLike,
    complex: Complex,
    *,
    metadata: Mapping[str, str] = MappingProxyType({}),
    allow_loss: bool = False,
) -> None:
    """Writes a complex with all its columns to .vtp, .ply, .npz, .obj or .glb; the file appears complete or not at all.

    Parameters
    ----------
    path : path
        Its extension tells the format.
    complex : Complex
    metadata : mapping of texts to texts, optional
        What the file is to say in words.
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
    >>> dict(file.metadata), file.complex.edge_columns["cost"]
    ({'made by': 'hand'}, array([2.5]))
    """
    if not isinstance(complex, Complex):
        raise TypeError(f"a complex is needed, not {type(complex).__name__}")
    _core.write_complex(Path(os.fspath(path)), complex._core, list(metadata.items()), bool(allow_loss))
