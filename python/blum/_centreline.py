"""Centrelines of labelled images.

A centreline is a graph of curves with radii.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Unpack

import numpy.typing as npt

from . import _core
from ._arguments import FloatArray, Integer, integer, label_of
from ._axis_graph import multigraph
from ._complex import Complex
from ._errors import InvalidOption
from ._image import as_image, labelled
from ._mesh import Betti, betti_of
from ._methods import Shown
from ._options import takes
from ._progress import Progress, reporting
from ._structs import CentrelineNodeKind, CentrelineOptions
from ._warn import warn_all

__all__ = ["Centreline", "CentrelineBranch", "Centrelines", "centreline"]


@dataclass(frozen=True, eq=False, repr=False)
class CentrelineBranch(Shown):
    """Curve between two nodes, or a closed curve without nodes.

    Examples
    --------
    >>> import blum
    >>> (line,) = blum.centreline(blum.generate("tube_image", nodes=2, pitch=30))
    >>> branch = line.branches[0]
    >>> branch.is_closed, branch.points.shape == (len(branch.radii), 3)
    (False, True)
    """

    nodes: tuple[int, int]  #: Its first and last node. -1 for closed curves.
    length: float  #: Length of its polyline, world units.
    #: Mean radius along the part at least 1.5 voxels away from the balls of its junctions. If there is none, along the
    #: whole branch.
    mean_radius: float
    min_radius: float  #: Smallest radius on the same part.
    #: Points from node to node: (n, 3), world units. Closed curves repeat the first at the end.
    points: FloatArray = field(repr=False)
    #: Radius at each point, of the circle with the area of the section there: (n,).
    radii: FloatArray = field(repr=False)

    @property
    def is_closed(self) -> bool:
        """True for a curve without nodes."""
        return self.nodes[0] < 0


@dataclass(frozen=True, eq=False, repr=False)
class Centreline(Shown):
    """Centreline of the voxels of one label: a graph of curves.

    Examples
    --------
    >>> import blum
    >>> (line,) = blum.centreline(blum.generate("tube_image", nodes=2, pitch=30))
    >>> line.label, line.label_betti == line.graph_betti, len(line.kinds) == len(line.radii)
    (1, True, True)
    """

    label: int | None  #: Value of the voxels. None if a threshold selects them.
    voxels: int  #: Number of voxels.
    #: Kind of each node: "end", "junction", or "point" for a part without branches.
    kinds: tuple[CentrelineNodeKind, ...]
    positions: FloatArray = field(repr=False)  #: Positions of the nodes: (n, 3), world units.
    radii: FloatArray = field(repr=False)  #: Radii of the balls of the nodes: (n,).
    branches: tuple[CentrelineBranch, ...] = field(repr=False)  #: Curves of the graph.
    label_betti: Betti  #: Components, tunnels and voids of the voxels.
    graph_betti: Betti  #: Components, tunnels and voids of the nodes and branches.
    homotopy_kept: bool  #: True if both are equal.
    homotopy: str  #: One sentence: kept, or the difference and its reason.

    def to_networkx(self) -> Any:
        """Returns a networkx.MultiGraph.

        Nodes have `kind`, `position` and `radius`. Edges have the numeric members of the branch, `points` and `radii`.
        A closed curve gets a node of its own, of kind "closed". Raises ImportError if networkx is missing.

        Examples
        --------
        >>> import blum
        >>> (line,) = blum.centreline(blum.generate("tube_image", nodes=2, pitch=30))
        >>> graph = line.to_networkx()
        >>> graph.number_of_nodes() == len(line.kinds), graph.number_of_edges() == len(line.branches)
        (True, True)
        """
        graph = multigraph("Centreline")
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
    """Centrelines of an image, in the order of the requested labels; by default by ascending label.

    Examples
    --------
    >>> import blum
    >>> lines = blum.centreline(blum.generate("balls_image"), labels=[2, 1])
    >>> [line.label for line in lines]
    [2, 1]
    """

    def __init__(self, lines: tuple[Centreline, ...], edges: Complex, seconds: dict[str, float]) -> None:
        self._lines = lines
        self._complex = edges
        #: Wall-clock seconds of each phase.
        self.seconds = seconds

    def __getitem__(self, index: Any) -> Any:
        return self._lines[index]

    def __len__(self) -> int:
        return len(self._lines)

    def __iter__(self) -> Iterator[Centreline]:
        return iter(self._lines)

    @property
    def complex(self) -> Complex:
        """All branches as edges from point to point.

        Vertices have the column `radius`. Edges have the columns `label`, `branch`, `length`, `mean_radius` and
        `min_radius`.
        """
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
    """Computes the centreline of each label of an image, as a graph of curves with radii.

    Each nonzero value is a label, unless `labels`, `label` or `threshold` selects voxels. Voids are filled first. The
    curves have the components and tunnels of the label. The radius at a point is that of a circle with the same area as
    the cross-section there. The ball around a free end touches the tip of the label.

    Parameters
    ----------
    image : (z, y, x) array, Image, path, or image of SimpleITK
    labels : integers, optional
        Only these labels, in this order. Excludes `label` and `threshold`.
    spacing, origin, direction
        As for :class:`Image`, in x, y, z order: the reverse of the array's axes.
    **options
    threads, progress
        As for :func:`distance_field`.

    Returns
    -------
    Centrelines
        A sequence of :class:`Centreline`.

    Examples
    --------
    >>> import numpy as np, blum
    >>> mask = np.zeros((9, 9, 40), dtype=bool)
    >>> mask[2:7, 2:7, 4:36] = True
    >>> (line,) = blum.centreline(mask, spacing=0.5)
    >>> line.kinds, line.homotopy_kept, round(line.branches[0].mean_radius, 2)
    (('end', 'end'), True, 1.41)
    """
    if labels is not None and options.keys() & {"label", "threshold"}:
        raise InvalidOption("labels excludes label and threshold: each of them selects voxels")
    if isinstance(labels, (str, bytes)):
        raise TypeError(f"labels must be a list of integers, not {type(labels).__name__}")
    wanted = None if labels is None else [label_of(label, "labels") for label in labels]
    label = options.get("label")
    if options.get("threshold") is None:
        selected = wanted or ([] if label is None else [label_of(label, "label")])
    else:
        selected = None
    source = labelled(as_image(image, spacing, origin, direction), selected)
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
