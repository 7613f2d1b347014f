"""Methods of results.

`NameMethods` becomes the base of the dataclass `Name` of _structs. `Shown` and the classes beside it have
representations with one line and at most 2,000 characters, however large a result is. `Rebuilt` is a base of objects
that can be pickled.
"""

from __future__ import annotations

import dataclasses
from types import ModuleType
from typing import Any, TypeVar

import numpy as np

_LONGEST = 1900  # Characters of the members of a result.
_LONGEST_TEXT = 200
_FEW = 7  # Entries of a list that are shown: a surface's percentiles are seven.

_Entry = TypeVar("_Entry")
_Key = TypeVar("_Key")


class Shown:
    """Base of results whose representation has their numbers, and the shapes of their arrays."""

    def __repr__(self) -> str:
        fields = [each for each in dataclasses.fields(self) if each.repr]  # type: ignore[arg-type]
        members = [f"{each.name}={_shown(getattr(self, each.name))}" for each in fields]
        return f"{type(self).__name__}({_joined(members)})"


class ShortList(list[_Entry]):
    """List whose representation shows its first entries."""

    def __repr__(self) -> str:
        return f"[{_joined([_shown(entry) for entry in self[: 10 * _FEW]], len(self))}]"


class ShortDict(dict[_Key, _Entry]):
    """Dict whose representation shows its first entries."""

    def __repr__(self) -> str:
        first = list(self.items())[: 10 * _FEW]
        return f"{{{_joined([f'{key!r}: {_shown(value)}' for key, value in first], len(self))}}}"


class Rebuilt:
    """Base of objects that keep their input. Pickles and copies build the object of the library at its first use.

    This object is the cached property that `_built` names.
    """

    _built = "_core"

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != self._built}


def shorten(structs: ModuleType) -> None:
    """Gives the results of a module this representation. The build makes that module."""
    for name in structs.__all__:
        if dataclasses.is_dataclass(getattr(structs, name)):
            getattr(structs, name).__repr__ = Shown.__repr__


def _joined(parts: list[str], count: int | None = None) -> str:
    """Returns the first parts, and the number of the others."""
    total = len(parts) if count is None else count
    shown: list[str] = []
    while len(shown) < len(parts) and sum(map(len, shown)) + len(parts[len(shown)]) + 2 * len(shown) <= _LONGEST:
        shown.append(parts[len(shown)])
    left = total - len(shown)
    return ", ".join(shown if left == 0 else [*shown, f"... {left:,} more"])


def _shown(value: Any) -> str:
    """Returns the representation of a member: long ones become their size."""
    if isinstance(value, np.generic):
        return repr(value.item())
    if isinstance(value, np.ndarray):
        return repr(value.tolist()) if value.size <= _FEW - 1 else f"{value.dtype} {value.shape}"
    if isinstance(value, str) and len(value) > _LONGEST_TEXT:
        return f"{value[:_LONGEST_TEXT]!r}..."
    if isinstance(value, (tuple, list)):
        return _shown_list(value)
    if isinstance(value, dict):
        parts = [f"{key!r}: {_shown(entry)}" for key, entry in value.items()]
        return f"{{{_joined(parts)}}}" if len(parts) <= 2 * _FEW else f"{{{len(parts)} entries}}"
    kind: Any = type(value)
    if kind.__repr__ is Shown.__repr__ and len(dataclasses.fields(value)) > _FEW:
        return f"{type(value).__name__}(...)"
    return repr(value)


def _shown_list(value: Any) -> str:
    """Returns a tuple or list of few numbers or texts. Other lists become the number and the type of their entries."""
    if len(value) > _FEW or any(dataclasses.is_dataclass(entry) or isinstance(entry, np.ndarray) for entry in value):
        kinds = {type(entry).__name__ for entry in value}
        return f"({len(value):,} {kinds.pop() if len(kinds) == 1 else 'entries'})"
    parts = [_shown(entry) for entry in value]
    if isinstance(value, list):
        return f"[{', '.join(parts)}]"
    return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"


class AxisGraphMethods:
    """Conversion of graphs of medial axes to networkx."""

    def to_networkx(self: Any) -> Any:
        """Returns a networkx.MultiGraph of sheets, seams, junctions and patches. Curves are edges between junctions.

        Nodes have names like `sheet3` (with the sheet's number), `seam0`, `junction0` and `patch0`. A closed curve is a
        node, too. The attribute `element` is the kind of a node or edge. Kinds of edges are "curve", "incidence" and
        "wall". An incidence joins a sheet and its seam, a seam and its junction, or a sheet and a junction on it. A
        wall joins a sheet and a patch, with its `share`.

        The other attributes are members of the element that are single values, for example `thickness_median` and
        `position_x`. The GraphML files of `MedialComplex.write_graph` hold the same graph. Raises ImportError if
        networkx is missing.

        Examples
        --------
        >>> import blum
        >>> plate = blum.generate("box", size_x=3, size_y=2, size_z=0.5)
        >>> graph = blum.medial_axis(plate, resolution=24).simplify(120).graph().to_networkx()
        >>> graph.nodes["sheet0"]["element"]
        'sheet'
        """
        from ._axis_graph import to_networkx

        return to_networkx(self)


class VoronoiGraphMethods:
    """Conversion of graphs of Voronoi diagrams to networkx."""

    def to_networkx(self: Any, sites: Any = ()) -> Any:
        """Returns a networkx.MultiGraph of regions, walls, seams and junctions.

        Nodes have names like `region3` (with the number of the site), `wall0`, `seam0` and `junction0`. The attribute
        `element` is the kind of a node or edge. Kinds of edges are "incidence" and "neighbours". An incidence joins a
        region and one of its walls, a wall and one of its seams, or a seam and one of its junctions. If the graph has
        regions, `neighbours` joins two regions, with the `area` of the walls between them.

        The other attributes are members of the element that are single values, for example `volume` and `position_x`.
        The GraphML files of `VoronoiComplex.write_graph` hold the same graph. Raises ImportError if networkx is
        missing.

        Parameters
        ----------
        sites : list of VoronoiSite, optional
            Result of `VoronoiComplex.sites()`. Regions then have the `kind` of their site, and sites without walls are
            also nodes.

        Examples
        --------
        >>> import blum
        >>> box = blum.voronoi_complex(blum.generate("box", size_x=3, size_y=2))
        >>> graph = box.graph().to_networkx(box.sites())
        >>> graph.nodes["region0"]["kind"], graph.nodes["wall0"]["element"]
        ('face', 'wall')
        """
        from ._voronoi import to_networkx

        return to_networkx(self, sites)


class CertificateMethods:
    """Truth value and text of certificates."""

    def __bool__(self: Any) -> bool:
        """Returns True if the certificate holds."""
        return bool(self.holds)

    def __str__(self: Any) -> str:
        """Returns one sentence with the result and all mismatches."""
        if self.holds:
            return f"certified against the {self.against}: components, tunnels, voids {self.axis_betti}"
        return "NOT certified: " + "; ".join(self.mismatches)
