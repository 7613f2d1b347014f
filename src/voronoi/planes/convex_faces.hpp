// Blum: the planes of a convex polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/planes/half_spaces.hpp"

namespace blum::voronoi {

/// The planes of a convex polyhedron.
struct ConvexFaces {
  HalfSpaces spaces;                ///< of the planes, relative to `origin`
  std::vector<std::uint32_t> site;  ///< for each plane: its smallest face in PolyhedronSites; ascending
  std::vector<std::vector<std::uint32_t>> triangles;   ///< for each plane: its triangles, ascending
  std::vector<std::vector<std::uint32_t>> neighbours;  ///< for each plane: the planes across its edges, ascending
  std::vector<Vec3d> middle;  ///< for each plane: a point in its polygon, mesh units, relative to `origin`
  std::vector<std::array<std::uint32_t, 2>> joined;  ///< {face, the smallest face of its plane} if these differ
  double flatness = 0;  ///< largest distance of a corner of a plane's triangles from the plane, mesh units
  Vec3d origin;
};

/// Returns the distance that rounding of a mesh's coordinates explains, mesh units. The distance is 16 times the
/// rounding error of the largest coordinate. The error is that of single precision if the longest coordinate has 21 to
/// 24 binary digits. For more digits, it is that of double precision. Shorter coordinates are treated as not rounded,
/// and the result is 0.
[[nodiscard]] double rounding_of_coordinates(const MeshView& mesh);

/// Returns the planes of one component of a mesh, or nothing if it is not a convex polyhedron.
///
/// Faces that share an edge become one plane if they face the same way. Their corners must lie within `flatness` of the
/// plane of the largest one, or of the plane fitted to all. If faces were joined, their plane is fitted to their
/// corners; corners of the component may then lie up to twice `flatness` outside planes. If no faces were joined, the
/// planes are exact.
/// @param component  triangles of the component, ascending.
/// @param flatness   >= 0, mesh units.
/// @throws Cancelled.
[[nodiscard]] std::optional<ConvexFaces> convex_faces(const MeshView& mesh, const SiteTable& table,
                                                      const PolyhedronSites& sites,
                                                      std::span<const std::uint32_t> component, double flatness,
                                                      const Context& context);

}  // namespace blum::voronoi
