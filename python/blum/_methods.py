"""What results do besides holding their members: `NameMethods` becomes the base of the dataclass `Name` of _structs."""

from typing import Any


class CertificateMethods:
    """A certificate is true where it holds, and reads as a sentence."""

    def __bool__(self: Any) -> bool:
        return bool(self.holds)

    def __str__(self: Any) -> str:
        if self.holds:
            return f"certified against the {self.against}: components, tunnels, voids {self.axis_betti}"
        return "NOT certified: " + "; ".join(self.mismatches)
