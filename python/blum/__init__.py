"""Blum: exact distance fields, Voronoi diagrams and certified medial axes of 3D shapes.

A mesh is any object with vertices and triangles. An image is an array indexed [z, y, x]. Lengths have the units of the
input, and distances are negative inside. Functions are named as in the C++ library and the command-line tool:

    field = blum.distance_field(vertices, triangles, resolution=256)
    found = blum.closest_points(mesh, points)
    axis = blum.medial_axis("part.stl").simplify(60)
    axis.certificate.holds
"""

# ruff: noqa: F403  (each module lists its public names in __all__, so that a new one needs no line here)
from . import (
    _axis_graph,
    _centreline,
    _certificate,
    _clean,
    _closest,
    _complex,
    _complex_files,
    _device,
    _errors,
    _extend,
    _features,
    _field,
    _formats,
    _grid,
    _image,
    _medial,
    _medial_columns,
    _medial_complex,
    _mesh,
    _methods,
    _plan,
    _planning,
    _points,
    _proximity,
    _proximity_results,
    _proximity_scene,
    _rigid,
    _shapes,
    _smooth,
    _solid,
    _structs,
    _surface_map,
    _transform,
    _translation,
    _triangle_distances,
    _verifier,
    _view,
    _voronoi,
    reference,
)
from ._axis_graph import *
from ._centreline import *
from ._certificate import *
from ._clean import *
from ._closest import *
from ._complex import *
from ._complex_files import *
from ._core import thread_count
from ._core import version as __version__
from ._device import *
from ._errors import *
from ._extend import *
from ._features import *
from ._field import *
from ._formats import *
from ._grid import *
from ._image import *
from ._medial import *
from ._medial_columns import *
from ._medial_complex import *
from ._mesh import *
from ._plan import *
from ._planning import *
from ._points import *
from ._proximity import *
from ._proximity_results import *
from ._proximity_scene import *
from ._rigid import *
from ._shapes import *
from ._smooth import *
from ._solid import *
from ._structs import *
from ._surface_map import *
from ._transform import *
from ._translation import *
from ._triangle_distances import *
from ._verifier import *
from ._view import *
from ._voronoi import *

_methods.shorten(_structs)

__all__ = ["__version__", "reference", "thread_count"]
__all__ += _axis_graph.__all__
__all__ += _centreline.__all__
__all__ += _certificate.__all__
__all__ += _clean.__all__
__all__ += _closest.__all__
__all__ += _complex.__all__
__all__ += _complex_files.__all__
__all__ += _device.__all__
__all__ += _errors.__all__
__all__ += _extend.__all__
__all__ += _features.__all__
__all__ += _field.__all__
__all__ += _formats.__all__
__all__ += _grid.__all__
__all__ += _image.__all__
__all__ += _medial.__all__
__all__ += _medial_columns.__all__
__all__ += _medial_complex.__all__
__all__ += _mesh.__all__
__all__ += _plan.__all__
__all__ += _planning.__all__
__all__ += _points.__all__
__all__ += _proximity.__all__
__all__ += _proximity_results.__all__
__all__ += _proximity_scene.__all__
__all__ += _rigid.__all__
__all__ += _triangle_distances.__all__
__all__ += _shapes.__all__
__all__ += _smooth.__all__
__all__ += _solid.__all__
__all__ += _structs.__all__
__all__ += _surface_map.__all__
__all__ += _transform.__all__
__all__ += _translation.__all__
__all__ += _verifier.__all__
__all__ += _view.__all__
__all__ += _voronoi.__all__
