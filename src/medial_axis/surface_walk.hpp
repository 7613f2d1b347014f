// Blum: footprints that follow a moving point over a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// A point of a mesh and a triangle that it lies on.
struct Footprint {
  Vec3d point;
  std::uint32_t triangle = 0;
  unsigned corners = 7;  ///< a bit for each corner of the triangle that the smallest feature around the point has
};

/// The site that a footprint lies on.
[[nodiscard]] SiteId site_of(const Footprint& foot, const SiteTable& sites, const MeshView& mesh);

/// Walks from a footprint to the nearest local minimum of the distance: what the footprint on this part of the surface
/// becomes when the point moves a little, while another part may be closer.
class SurfaceWalk {
 public:
  explicit SurfaceWalk(const MeshView& mesh);

  /// The closest point of a site.
  /// @param triangle  one that the site lies on.
  [[nodiscard]] Footprint closest_on(std::uint32_t triangle, const Vec3d& query) const;

  /// Steps to neighbouring triangles while they are closer.
  /// @param reach  how far the footprint may move, mesh units; beyond that the last one within is returned.
  [[nodiscard]] Footprint follow(const Footprint& start, const Vec3d& query, double reach) const;

 private:
  MeshView mesh_;
  std::vector<std::uint32_t> first_;      ///< per vertex, into triangles_
  std::vector<std::uint32_t> triangles_;  ///< around each vertex
};

}  // namespace blum
