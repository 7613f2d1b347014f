"""Blum: exact distance fields, Voronoi diagrams and certified medial axes of 3D shapes.

Meshes are anything with vertices and triangles, images are arrays [z, y, x]; lengths have the units of the input, and
inside is negative. The same verbs as in C++ and on the command line:

    field = blum.distance_field(vertices, triangles, resolution=256)
    found = blum.closest_points(mesh, points)
    axis = blum.medial_axis("part.stl").simplify(60)
    axis.certificate.holds
"""

from . import reference
from ._certificate import (
    BallUnionCheck,
    Certificate,
    EdgeCheck,
    GeometryCheck,
    SolidRule,
    solid_rule,
)
from ._complex import Complex, homology
from ._core import thread_count
from ._core import version as __version__
from ._device import DeviceArray, DeviceDistanceTransform, DeviceField, DeviceFieldSolver
from ._errors import (
    Cancelled,
    DeviceError,
    Error,
    FileError,
    FormatError,
    InputWarning,
    InvalidGrid,
    InvalidImage,
    InvalidMesh,
    InvalidOption,
    OutOfMemory,
)
from ._field import (
    ClosestPointQuery,
    ClosestPoints,
    Field,
    FieldSolver,
    VoxelTopology,
    closest_points,
    distance_field,
    read_field,
    selected_voxels,
    voxel_topology,
)
from ._formats import FileFormat, file_formats
from ._grid import Grid
from ._image import Image, read_image
from ._medial import BodyReport, MedialAxis, MedialAxisReport, medial_axis
from ._medial_columns import ROLES, NestedComplex, Present
from ._medial_complex import MedialComplex, ball_union_field, certify, read_medial
from ._mesh import (
    Mesh,
    SelfIntersections,
    Shell,
    Sites,
    Topology,
    WindingNumber,
    pseudonormals,
    read_mesh,
    self_intersections,
    topology,
    weld,
    weld_clusters,
)
from ._shapes import ShapeInfo, ShapeParameter, extrusion, generate, known_betti, noisy, shapes, subdivided
from ._transform import distance_transform, distance_transforms
from ._view import view

__all__ = [
    "ROLES",
    "BallUnionCheck",
    "BodyReport",
    "Cancelled",
    "Certificate",
    "ClosestPointQuery",
    "ClosestPoints",
    "Complex",
    "DeviceArray",
    "DeviceDistanceTransform",
    "DeviceError",
    "DeviceField",
    "DeviceFieldSolver",
    "EdgeCheck",
    "Error",
    "Field",
    "FieldSolver",
    "FileError",
    "FileFormat",
    "FormatError",
    "GeometryCheck",
    "Grid",
    "Image",
    "InputWarning",
    "InvalidGrid",
    "InvalidImage",
    "InvalidMesh",
    "InvalidOption",
    "MedialAxis",
    "MedialAxisReport",
    "MedialComplex",
    "Mesh",
    "NestedComplex",
    "OutOfMemory",
    "Present",
    "SelfIntersections",
    "ShapeInfo",
    "ShapeParameter",
    "Shell",
    "Sites",
    "SolidRule",
    "Topology",
    "VoxelTopology",
    "WindingNumber",
    "__version__",
    "ball_union_field",
    "certify",
    "closest_points",
    "distance_field",
    "distance_transform",
    "distance_transforms",
    "extrusion",
    "file_formats",
    "generate",
    "homology",
    "known_betti",
    "medial_axis",
    "noisy",
    "pseudonormals",
    "read_field",
    "read_image",
    "read_medial",
    "read_mesh",
    "reference",
    "selected_voxels",
    "self_intersections",
    "shapes",
    "solid_rule",
    "subdivided",
    "thread_count",
    "topology",
    "view",
    "voxel_topology",
    "weld",
    "weld_clusters",
]
