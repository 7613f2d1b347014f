"""Methods of results: `NameMethods` becomes the base of the dataclass `Name` of _structs."""

from typing import Any


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
