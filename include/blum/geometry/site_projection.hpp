// Blum: closest points of single sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Projects points onto sites that are known to be closest, or next to the closest ones: what a fast search in single
/// precision has found becomes, bit for bit, what Bvh::nearest() says. It copies what it needs.
class SiteProjection {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// Cost: O(n), 40 ms for a million triangles and core; 200 bytes per triangle.
  /// @throws Cancelled.
  SiteProjection(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  SiteProjection(SiteProjection&&) noexcept;
  SiteProjection& operator=(SiteProjection&&) noexcept;
  ~SiteProjection();

  /// The closest point of a site, where the query is within the site's domain (the points that project onto the open
  /// site, and onto none of the sites that touch it) by a margin: all planes that bound the domain are at least that
  /// far.
  /// @param query   finite.
  /// @param margin  mesh units, > 0.
  /// @param found   becomes the closest point. (It is written where it is kept: what is copied right after it was
  ///                written is waited for, which would double the cost.)
  /// @return        false where it is not, or where that is not certain, as on faces with no usable plane.
  /// Cost: about 15 ns; of a vertex 5 ns for each of its edges.
  [[nodiscard]] bool project(SiteId site, const Vec3d& query, double margin, NearestSite& found) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace blum
