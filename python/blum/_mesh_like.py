"""What the meshes of other packages have, as types: none of these packages needs to be there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

# Members are Any: each package has array types of its own, all of which NumPy converts.


class TrimeshLike(Protocol):
    """A trimesh.Trimesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class Open3DLike(Protocol):
    """An open3d.geometry.TriangleMesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def triangles(self) -> Any: ...


class Open3DTensorLike(Protocol):
    """An open3d.t.geometry.TriangleMesh, whose arrays are vertex.positions and triangle.indices."""

    @property
    def vertex(self) -> Any: ...
    @property
    def triangle(self) -> Any: ...


class MeshioLike(Protocol):
    """A meshio.Mesh: its triangles, quads, lines and vertices count."""

    @property
    def points(self) -> Any: ...
    @property
    def cells_dict(self) -> Mapping[str, Any]: ...


class PyVistaLike(Protocol):
    """A pyvista.PolyData, or another dataset of PyVista, whose surface counts."""

    @property
    def points(self) -> Any: ...
    def extract_surface(self, *arguments: Any, **options: Any) -> Any: ...
