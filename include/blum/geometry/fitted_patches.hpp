// Blum: parts of a mesh that fit planes, spheres, cylinders and cones. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/surface_shape.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Flat faces of a mesh, and limits for shapes that replace them.
struct FlatFaces {
  /// For each triangle, the number of its flat face, below the number of triangles. A large number such as
  /// SurfacePatches::none stands for no face.
  std::span<const std::uint32_t> face_of;
  std::span<const Vec3d> normals;  ///< For each triangle, a vector in the direction of its face's normal; 0 if unknown.
  double tolerance = 0;            ///< Mesh units. Largest distance between a shape and vertices of its part.
  double angle = 0;                ///< Degrees. Largest bend at an edge between two faces of one part.
};

/// Parts of a mesh. Each is a connected set of flat faces.
struct FittedPatches {
  std::vector<std::uint32_t> patch_of;  ///< For each triangle; SurfacePatches::none without a face or normal.
  std::vector<SurfaceShape> shapes;     ///< For each part, in the order of their first triangles.
};

/// Checks the option `patch_fit`, the tolerance in mesh units.
/// @throws InvalidOption unless it is unset, or positive and finite.
void check_patch_fit(const std::optional<double>& tolerance);

/// Divides the flat faces of a mesh into parts that fit planes, spheres, cylinders and cones.
///
/// A part grows from a seed: one flat face and its neighbours, across edges that have two triangles and bend little. A
/// shape that fits the seed takes faces at its border. All vertices of a face must lie within the tolerance. At each of
/// them, the normals of face and shape may differ by at most 0.6 times the angle. Parts of spheres, cylinders and cones
/// need three faces, and three vertices more than the shape has parameters. If most faces are single triangles, they
/// need six more. No face of such a part is much coarser than its median face. A flat face of more than two triangles
/// belongs to no sphere.
///
/// Several shapes may fit the same seed. The one with the largest part is chosen. If their parts are about equal, a
/// plane comes first. Otherwise, the least mean deviation decides, over vertices, and middles of edges and triangles.
/// Afterwards, faces at the border of two parts change to the part with the smaller deviation at their vertices. Flat
/// faces that fit no other shape are planes. Section "Fitted patches" of docs/theory/voronoi.md lists all rules.
///
/// @param sites  of the mesh, which passes validate().
/// @throws Cancelled. Cost: near-linear, about 10 us per triangle. It runs on one thread.
[[nodiscard]] FittedPatches fit_patches(const MeshView& mesh, const SiteTable& sites, const FlatFaces& faces,
                                        const Context& context);

}  // namespace blum::detail
