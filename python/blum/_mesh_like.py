"""Attributes of other packages' meshes, as types. None of these packages need be installed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

# Members are Any, because each package has its own array types. NumPy converts all of them.


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
    """An open3d.t.geometry.TriangleMesh, with the arrays vertex.positions and triangle.indices."""

    @property
    def vertex(self) -> Any: ...
    @property
    def triangle(self) -> Any: ...


class MeshioLike(Protocol):
    """A meshio.Mesh, of which triangles, quads, lines and vertices are used."""

    @property
    def points(self) -> Any: ...
    @property
    def cells_dict(self) -> Mapping[str, Any]: ...


class PyVistaLike(Protocol):
    """A dataset of PyVista, of which the surface, lines and vertex cells are used."""

    @property
    def points(self) -> Any: ...
    def extract_surface(self, *arguments: Any, **options: Any) -> Any: ...
