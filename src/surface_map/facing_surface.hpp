// Blum: the mesh that distances are measured to, with neighbours of sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::surface {

/// Finds closest sites, and the primitives that touch them.
class FacingSurface {
 public:
  /// @param mesh  must outlive this object.
  /// @throws Cancelled.
  /// Cost: that of building a Bvh, and 5 ms more for 70,000 triangles.
  FacingSurface(const MeshView& mesh, const Context& context);

  [[nodiscard]] const MeshView& mesh() const { return mesh_; }
  [[nodiscard]] const Bvh& hierarchy() const { return bvh_; }
  [[nodiscard]] const SiteTable& sites() const { return sites_; }

  /// Returns the primitives that contain a site, in rising order.
  [[nodiscard]] std::span<const std::uint32_t> primitives_at(SiteId site) const;
  /// Returns the vertices of a primitive. For segments and points, a vertex is repeated.
  [[nodiscard]] Triangle vertices_of(std::uint32_t primitive) const { return primitive_vertices(mesh_, primitive); }
  [[nodiscard]] const Vec3d& position(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }
  [[nodiscard]] std::array<Vec3d, 3> corners_of(std::uint32_t primitive) const;

 private:
  MeshView mesh_;
  SiteTable sites_;
  Bvh bvh_;
  /// Primitives of vertex or edge s: primitives_[first_[s] .. first_[s + 1]).
  std::vector<std::uint32_t> first_, primitives_;
  std::vector<std::uint32_t> all_;  ///< 0, 1, 2, ...: the list of face f is the item f
};

}  // namespace blum::surface
