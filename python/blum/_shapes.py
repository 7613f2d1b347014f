"""Generated shapes and images."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, cast, overload

from . import _core
from ._arguments import Integer, Real, float_rows, integer, number
from ._errors import InvalidOption
from ._image import Image, image_of_parts
from ._mesh import Betti, Mesh, MeshLike, as_mesh, mesh_of_arrays
from ._methods import ShortDict, Shown

__all__ = ["ShapeInfo", "ShapeParameter", "extrusion", "generate", "known_betti", "noisy", "shapes", "subdivided"]

_ImageName = Literal["ball_image", "balls_image", "noise_image", "tube_image"]


@dataclass(frozen=True, repr=False)
class ShapeParameter(Shown):
    """Parameter of a shape.

    Examples
    --------
    >>> import blum
    >>> parameter = blum.shapes()["torus"].parameters[0]
    >>> parameter.name, parameter.default, parameter.integer
    ('ring_radius', 1.0, False)
    """

    name: str
    description: str
    default: float
    minimum: float  #: Inclusive.
    maximum: float  #: Inclusive.
    integer: bool  #: True if only integers are valid.


@dataclass(frozen=True, repr=False)
class ShapeInfo(Shown):
    """Shape that :func:`generate` makes.

    Examples
    --------
    >>> import blum
    >>> blum.shapes()["torus"].kind
    'mesh'
    """

    name: str
    description: str
    kind: Literal["mesh", "image"]
    parameters: tuple[ShapeParameter, ...]


def shapes() -> dict[str, ShapeInfo]:
    """Returns all shapes by name, with their parameters.

    Examples
    --------
    >>> import blum
    >>> [parameter.name for parameter in blum.shapes()["torus"].parameters]
    ['ring_radius', 'tube_radius', 'ring_segments', 'tube_segments']
    """
    return ShortDict(
        (
            entry["name"],
            ShapeInfo(
                entry["name"],
                entry["description"],
                entry["kind"],
                tuple(ShapeParameter(*parameter) for parameter in entry["parameters"]),
            ),
        )
        for entry in _core.catalogue()
    )


def _arguments(name: str, parameters: dict[str, Any]) -> tuple[ShapeInfo, dict[str, float]]:
    """Returns the facts of a shape and its checked parameters."""
    known = shapes()
    if name not in known:
        raise InvalidOption(f"there is no shape {name!r}: name must be one of {', '.join(sorted(known))}")
    return known[name], {key: number(value, key) for key, value in parameters.items()}


@overload
def generate(name: _ImageName, **parameters: Real) -> Image: ...  # type: ignore[overload-overlap]
@overload
def generate(name: str, **parameters: Real) -> Mesh: ...
def generate(name: str, **parameters: Real) -> Mesh | Image:
    """Makes the shape with the given name: a :class:`Mesh`, or an :class:`Image` if the name ends in ``_image``.

    :func:`shapes` and ``blum make NAME --help`` list the parameters.

    Examples
    --------
    >>> import blum
    >>> blum.generate("sphere", frequency=4)
    Mesh(162 vertices, 320 triangles)
    >>> blum.generate("ball_image", size=16).values.shape
    (16, 16, 16)
    """
    shape, given = _arguments(name, parameters)
    if shape.kind == "image":
        return image_of_parts(*_core.make_image(name, given))
    return mesh_of_arrays(_core.make_shape(name, given))


def known_betti(name: str, **parameters: Real) -> Betti | None:
    """Returns components, tunnels and voids of a shape, from its construction. None if it bounds no solid.

    Examples
    --------
    >>> import blum
    >>> blum.known_betti("plate", holes_x=2, holes_y=2)
    (1, 4, 0)
    """
    shape, given = _arguments(name, parameters)
    return cast("Betti | None", _core.known_betti(name, shape.kind, given))


def extrusion(outline: Any, holes: Any = (), *, thickness: Real = 1.0, stacks: Integer = 1) -> Mesh:
    """Extrudes a polygon with holes along z, from -thickness / 2 to thickness / 2.

    Parameters
    ----------
    outline : (n, 2) array
        A simple polygon, in either direction.
    holes : list of (k, 2) arrays
        Simple polygons inside the outline, in either direction. Holes must not touch the outline or each other.
    thickness : float
        Mesh units.
    stacks : int
        Number of bands along the thickness.

    Examples
    --------
    >>> import blum
    >>> frame = blum.extrusion([[0, 0], [4, 0], [4, 3], [0, 3]], [[[1, 1], [3, 1], [3, 2], [1, 2]]])
    >>> blum.topology(frame).betti
    (1, 1, 0)
    """
    return mesh_of_arrays(
        _core.extrusion(
            float_rows(outline, "outline", 2),
            [float_rows(hole, f"holes[{place}]", 2) for place, hole in enumerate(holes)],
            number(thickness, "thickness"),
            integer(stacks, "stacks"),
        )
    )


def noisy(mesh: MeshLike, amplitude: Real, *, seed: Integer = 1, weld: Real | None = None) -> Mesh:
    """Returns a copy whose vertices are moved by random vectors, uniform in a ball. The copy may cross itself.

    Parameters
    ----------
    mesh, weld
        As for :func:`distance_field`.
    amplitude : float
        Radius of the ball, mesh units.
    seed : int
        0 to 2^64 - 1.

    Examples
    --------
    >>> import blum, numpy as np
    >>> box = blum.generate("box")
    >>> moved = blum.noisy(box, 0.01).vertices - box.vertices
    >>> bool(np.linalg.norm(moved, axis=1).max() <= 0.01)
    True
    """
    chosen = integer(seed, "seed")
    if not 0 <= chosen < 2**64:
        raise InvalidOption(f"seed is {chosen}, but must be 0 to 2^64 - 1")
    return mesh_of_arrays(_core.noisy(as_mesh(mesh, weld=weld)._arrays, number(amplitude, "amplitude"), chosen))


def subdivided(mesh: MeshLike, levels: Integer = 1, *, weld: Real | None = None) -> Mesh:
    """Returns the same shape with each triangle cut into four at the midpoints of its edges, and each segment into two.

    Parameters
    ----------
    mesh, weld
        As for :func:`distance_field`.
    levels : int
        Number of subdivisions, 0 to 12.

    Examples
    --------
    >>> import blum
    >>> blum.subdivided(blum.generate("box"), 2)
    Mesh(98 vertices, 192 triangles)
    """
    return mesh_of_arrays(_core.subdivided(as_mesh(mesh, weld=weld)._arrays, integer(levels, "levels")))
