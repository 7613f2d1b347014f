"""Centrelines of labelled images: graphs of curves with radii."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Unpack

import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, Integer, integer, label_of
from ._complex import Complex
from ._errors import InvalidOption
from ._image import as_image
from ._mesh import Betti, betti_of
from ._options import takes
from ._progress import Progress, reporting
from ._structs import CentrelineNodeKind, CentrelineOptions
from ._warn import warn_all


@dataclass(frozen=True, eq=False)
class CentrelineBranch:
    """A curve between two nodes, or a closed one without any."""

    nodes: tuple[int, int]  #: its first and last node; -1 for closed curves
    length: float  #: of its polyline, world units
    mean_radius: float  #: along its length, outside of the balls of its junctions
    min_radius: float  #: the smallest, likewise
    points: FloatArray = field(repr=False)  #: (n, 3): from node to node; of closed curves the first is also the last
    radii: FloatArray = field(repr=False)  #: (n,): at each point, of the circle with the area of the section there

    @property
    def is_closed(self) -> bool:
        """Whether it has no nodes."""
        return self.nodes[0] < 0


@dataclass(frozen=True, eq=False)
class Centreline:
    """The centreline of the voxels of one label: a graph of curves."""

    label: int | None  #: their value; None where a threshold selects
    voxels: int  #: how many there are
    kinds: tuple[CentrelineNodeKind, ...]  #: of nodes: "end", "junction", or "point", a blob without branches
    positions: FloatArray = field(repr=False)  #: (n, 3): of nodes, world units
    radii: FloatArray = field(repr=False)  #: (n,): of the balls of nodes
    branches: tuple[CentrelineBranch, ...] = field(repr=False)
    label_betti: Betti  #: components, tunnels, voids of the voxels
    graph_betti: Betti  #: of nodes and branches
    homotopy_kept: bool  #: whether these are equal
    homotopy: str  #: kept, or what differs and why, as a sentence

    def to_networkx(self) -> Any:
        """A networkx.MultiGraph: nodes with `kind`, `position`, `radius`, edges with the branch's numbers, `points` and
        `radii`. Closed curves get a node of their own, of the kind "closed"."""
        import networkx as nx

        graph = nx.MultiGraph()
        for node, kind in enumerate(self.kinds):
            graph.add_node(node, kind=kind, position=self.positions[node], radius=float(self.radii[node]))
        for branch in self.branches:
            first, last = branch.nodes
            if branch.is_closed:
                first = last = graph.number_of_nodes()
                graph.add_node(first, kind="closed", position=branch.points[0], radius=float(branch.radii[0]))
            graph.add_edge(
                first,
                last,
                length=branch.length,
                mean_radius=branch.mean_radius,
                min_radius=branch.min_radius,
                points=branch.points,
                radii=branch.radii,
            )
        return graph


class Centrelines(Sequence[Centreline]):
    """The centrelines of an image, by rising label, or in the order in which labels were given."""

    def __init__(self, lines: tuple[Centreline, ...], edges: Complex, seconds: dict[str, float]) -> None:
        self._lines = lines
        self._complex = edges
        #: By phase.
        self.seconds = seconds

    def __getitem__(self, index: Any) -> Any:
        return self._lines[index]

    def __len__(self) -> int:
        return len(self._lines)

    def __iter__(self) -> Iterator[Centreline]:
        return iter(self._lines)

    @property
    def complex(self) -> Complex:
        """All branches as edges from point to point; columns `radius` of vertices; `label`, `branch`, `length`,
        `mean_radius` and `min_radius` of edges."""
        return self._complex

    def __repr__(self) -> str:
        branches = sum(len(line.branches) for line in self)
        counts = [
            f"{count} {one if count == 1 else many}"
            for count, one, many in ((len(self), "label", "labels"), (branches, "branch", "branches"))
        ]
        return f"Centrelines({', '.join(counts)})"


@takes("CentrelineOptions")
def centreline(
    image: Any,
    *,
    labels: Sequence[Integer] | npt.NDArray[Any] | None = None,
    spacing: Any = None,
    origin: Any = None,
    direction: Any = None,
    threads: int = 0,
    progress: Progress = False,
    **options: Unpack[CentrelineOptions],
) -> Centrelines:
    """The centreline of each label of an image, as a graph of curves with radii.

    Each value that is not zero is a label, unless `labels`, `label` or `threshold` says otherwise. The curves have the
    components and tunnels of the label, voids are filled first. Radii are those of circles with the areas of the
    sections across the curves; free ends lie where their ball touches the tip.

    Parameters
    ----------
    image : (z, y, x) array, Image, or path
    labels : integers, optional
        Only these, in this order.
    spacing, origin, direction
        As for :class:`Image`, in x, y, z order: the reverse of the array's axes.
    **options
    threads, progress
        As for :func:`distance_field`.

    Returns
    -------
    Centrelines
        A sequence of :class:`Centreline`.

    >>> import numpy as np, blum
    >>> mask = np.zeros((9, 9, 40), dtype=bool)
    >>> mask[2:7, 2:7, 4:36] = True
    >>> (line,) = blum.centreline(mask, spacing=0.5)
    >>> line.kinds, line.homotopy_kept, round(line.branches[0].mean_radius, 2)
    (('end', 'end'), True, 1.41)
    """
    if labels is not None and options.keys() & {"label", "threshold"}:
        raise InvalidOption("labels excludes label and threshold: each selects the voxels")
    if isinstance(labels, (str, bytes)):
        raise TypeError(f"labels must be a list of integers, not {type(labels).__name__}")
    wanted = None if labels is None else [label_of(label, "labels") for label in labels]
    source = as_image(image, spacing, origin, direction)
    with reporting(progress) as report:
        parts, edges, seconds, found = _core.centreline(
            source._arrays, wanted, dict(options), integer(threads, "threads"), report
        )
    lines = tuple(_line(*each) for each in parts)
    warn_all(found)
    return Centrelines(lines, Complex._from_core(edges), seconds)


def _line(
    label: int | None, voxels: int, nodes: Any, branches: Any, label_betti: Any, graph_betti: Any, kept: bool, why: str
) -> Centreline:
    kinds, positions, radii = nodes
    return Centreline(
        label,
        voxels,
        kinds,
        positions,
        radii,
        tuple(CentrelineBranch(*branch) for branch in branches),
        betti_of(label_betti),
        betti_of(graph_betti),
        kept,
        why,
    )
