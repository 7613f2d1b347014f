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
  /// For each triangle, the number of its flat face, below the number of triangles. A larger number, such as
  /// SurfacePatches::none, means that the triangle belongs to no face.
  std::span<const std::uint32_t> face_of;
  std::span<const Vec3d> normals;  ///< For each triangle, a vector in the direction of its face's normal; 0 if unknown.
  double tolerance = 0;            ///< Mesh units. Largest distance between a shape and vertices of its part.
  double angle = 0;                ///< Degrees. Largest bend at an edge between two faces of one part.
};

/// Parts of a mesh. Each part is a connected set of flat faces.
struct FittedPatches {
  std::vector<std::uint32_t> patch_of;  ///< For each triangle, its part; SurfacePatches::none if the triangle has no
                                        ///< face or no normal.
  std::vector<SurfaceShape> shapes;     ///< For each part, in the order of their first triangles.
};

/// Checks the option `patch_fit`, the tolerance in mesh units.
/// @throws InvalidOption if the tolerance is set, but is not positive and finite.
void check_patch_fit(const std::optional<double>& tolerance);

/// Divides the flat faces of a mesh into parts that fit planes, spheres, cylinders and cones.
///
/// A part grows from a seed: one flat face and its neighbours, across edges that have two triangles and bend little. A
/// part whose shape fits the seed grows by faces at its border. All vertices of such a face must be within the
/// tolerance of the shape. At each of these vertices, the normals of face and shape may differ by at most 0.6 times the
/// angle. Parts of spheres, cylinders and cones need at least three faces, and three vertices more than the shape has
/// parameters. If most faces of a part are single triangles, it needs six more vertices. A sphere, cylinder or cone
/// contains no face that deviates from the shape much more than the part's median face. A flat face of more than two
/// triangles belongs to no sphere.
///
/// Several shapes may fit the same seed. The shape with the largest part is chosen. If these parts have about equal
/// areas, a plane comes first. Otherwise, the smallest mean deviation of vertices, and of middles of edges and
/// triangles, decides. Afterwards, a face at the border of two parts changes to the part whose shape is closer to its
/// vertices. Flat faces that fit no other shape are planes. Section "Fitted patches" of docs/theory/voronoi.md lists
/// all rules.
///
/// @param sites  of the mesh, which passes validate().
/// @throws Cancelled. Cost: near-linear, about 10 us per triangle. The function runs on one thread.
[[nodiscard]] FittedPatches fit_patches(const MeshView& mesh, const SiteTable& sites, const FlatFaces& faces,
                                        const Context& context);

}  // namespace blum::detail
