"""Blum: exact distance fields, Voronoi diagrams and certified medial axes of 3D shapes.

A mesh is any object with vertices and triangles. An image is an array indexed [z, y, x]. Lengths have the units of the
input, and distances are negative inside. The verbs are those of the C++ library and the command-line tool:

    field = blum.distance_field(vertices, triangles, resolution=256)
    found = blum.closest_points(mesh, points)
    axis = blum.medial_axis("part.stl").simplify(60)
    axis.certificate.holds
"""

from . import _structs, reference
from ._axis_graph import axis_graph
from ._centreline import Centreline, CentrelineBranch, Centrelines, centreline
from ._certificate import solid_rule
from ._clean import CleanedMesh, OrientedMesh, clean_mesh, oriented_mesh
from ._closest import ClosestPointQuery, ClosestPoints, NearPrimitives, closest_points, winding_number
from ._complex import Complex, homology
from ._complex_files import ComplexFile, read_complex, write_complex
from ._core import thread_count
from ._core import version as __version__
from ._device import DeviceArray, DeviceDistanceTransform, DeviceField, DeviceFieldSolver, cuda_devices
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
    NotCertified,
    OutOfMemory,
)
from ._extend import ExtendedAxis, extend_axis
from ._features import FeaturePairs, close_features
from ._field import (
    Field,
    FieldSolver,
    distance_field,
    read_field,
    selected_voxels,
    voxel_topology,
)
from ._formats import file_formats
from ._grid import Grid
from ._image import Image, read_image
from ._medial import MedialAxis, medial_axis
from ._medial_columns import ROLES, NestedComplex, Present
from ._medial_complex import MedialComplex, ball_union_field, certify, read_medial
from ._mesh import (
    Mesh,
    MeshLike,
    SelfIntersections,
    Sites,
    WindingNumber,
    pseudonormals,
    read_mesh,
    self_intersections,
    topology,
    weld,
    weld_clusters,
)
from ._points import NearSamples, SignedDistances, SurfaceSamples, sample_near, sample_surface, signed_distance
from ._proximity import ContinuousCollisions, continuous_collisions, edge_edge_impacts, vertex_face_impacts
from ._proximity_results import Penetration, PrimitivePair, ProximityPairs, SceneCollisions
from ._proximity_scene import (
    ProximityScene,
    TriangleDistances,
    closest_primitives,
    closest_rotation,
    collisions,
    separation,
    triangle_distances,
)
from ._shapes import ShapeInfo, ShapeParameter, extrusion, generate, known_betti, noisy, shapes, subdivided
from ._smooth import smooth_surface
from ._solid import CellularModel, Solid, SolidBody
from ._structs import *  # noqa: F403
from ._surface_map import (
    SurfaceMap,
    SurfaceMapper,
    Thickness,
    directed_hausdorff_distance,
    hausdorff_distance,
    read_surface_map,
    self_distance_map,
    surface_deviation,
    surface_distance_map,
    thickness,
    thickness_map,
)
from ._transform import distance_transform, distance_transforms
from ._verifier import AxisVerifier
from ._view import view
from ._voronoi import VoronoiComplex, voronoi_complex

__all__ = [
    "ROLES",
    "AxisVerifier",
    "Cancelled",
    "CellularModel",
    "Centreline",
    "CentrelineBranch",
    "Centrelines",
    "CleanedMesh",
    "ClosestPointQuery",
    "ClosestPoints",
    "Complex",
    "ComplexFile",
    "ContinuousCollisions",
    "DeviceArray",
    "DeviceDistanceTransform",
    "DeviceError",
    "DeviceField",
    "DeviceFieldSolver",
    "Error",
    "ExtendedAxis",
    "FeaturePairs",
    "Field",
    "FieldSolver",
    "FileError",
    "FormatError",
    "Grid",
    "Image",
    "InputWarning",
    "InvalidGrid",
    "InvalidImage",
    "InvalidMesh",
    "InvalidOption",
    "MedialAxis",
    "MedialComplex",
    "Mesh",
    "MeshLike",
    "NearPrimitives",
    "NearSamples",
    "NestedComplex",
    "NotCertified",
    "OrientedMesh",
    "OutOfMemory",
    "Penetration",
    "Present",
    "PrimitivePair",
    "ProximityPairs",
    "ProximityScene",
    "SceneCollisions",
    "SelfIntersections",
    "ShapeInfo",
    "ShapeParameter",
    "SignedDistances",
    "Sites",
    "Solid",
    "SolidBody",
    "SurfaceMap",
    "SurfaceMapper",
    "SurfaceSamples",
    "Thickness",
    "TriangleDistances",
    "VoronoiComplex",
    "WindingNumber",
    "__version__",
    "axis_graph",
    "ball_union_field",
    "centreline",
    "certify",
    "clean_mesh",
    "close_features",
    "closest_points",
    "closest_primitives",
    "closest_rotation",
    "collisions",
    "continuous_collisions",
    "cuda_devices",
    "directed_hausdorff_distance",
    "distance_field",
    "distance_transform",
    "distance_transforms",
    "edge_edge_impacts",
    "extend_axis",
    "extrusion",
    "file_formats",
    "generate",
    "hausdorff_distance",
    "homology",
    "known_betti",
    "medial_axis",
    "noisy",
    "oriented_mesh",
    "pseudonormals",
    "read_complex",
    "read_field",
    "read_image",
    "read_medial",
    "read_mesh",
    "read_surface_map",
    "reference",
    "sample_near",
    "sample_surface",
    "selected_voxels",
    "self_distance_map",
    "self_intersections",
    "separation",
    "shapes",
    "signed_distance",
    "smooth_surface",
    "solid_rule",
    "subdivided",
    "surface_deviation",
    "surface_distance_map",
    "thickness",
    "thickness_map",
    "thread_count",
    "topology",
    "triangle_distances",
    "vertex_face_impacts",
    "view",
    "voronoi_complex",
    "voxel_topology",
    "weld",
    "weld_clusters",
    "winding_number",
    "write_complex",
]
__all__ += _structs.__all__
