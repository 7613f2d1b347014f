"""What results do besides holding their members: `NameMethods` becomes the base of the dataclass `Name` of _structs."""

from typing import Any


class AxisGraphMethods:
    """Graphs of medial axes become those of networkx."""

    def to_networkx(self: Any) -> Any:
        """A networkx.MultiGraph of sheets, seams, junctions and patches, with curves as edges between junctions.

        Nodes are named as in `sheet3` (by the sheet's number), `seam0`, `junction0`, `patch0`; a closed curve is one,
        too. Their attribute `element` tells what they are, and that of edges: "curve", "incidence" (a sheet and its
        seams, a seam and its junctions, a sheet and the junctions on it) or "wall" (a sheet and a patch, with its
        `share`). The others are the members that are values, as `thickness_median`, `position_x`. The same as the
        GraphML files of `MedialComplex.write_graph`. Raises ImportError where networkx is missing.
        """
        from ._axis_graph import to_networkx

        return to_networkx(self)


class CertificateMethods:
    """A certificate is true where it holds, and reads as a sentence."""

    def __bool__(self: Any) -> bool:
        return bool(self.holds)

    def __str__(self: Any) -> str:
        if self.holds:
            return f"certified against the {self.against}: components, tunnels, voids {self.axis_betti}"
        return "NOT certified: " + "; ".join(self.mismatches)
