// Blum: closest points on single sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Projection of query points onto sites. A site should be the closest site to the query, or a neighbour of the closest
/// site. This class converts the result of a fast search in single precision into the result of Bvh::nearest(), bit for
/// bit. It copies the data that it needs.
class SiteProjection {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// Cost: O(n), 40 ms for a million triangles on one core; 200 bytes per triangle.
  /// @throws Cancelled.
  SiteProjection(const MeshView& mesh, const SiteTable& sites, const Context& context = {});
  SiteProjection(SiteProjection&&) noexcept;
  SiteProjection& operator=(SiteProjection&&) noexcept;
  ~SiteProjection();

  /// Finds the closest point of a site, if the query is certainly in the site's domain. The domain is the set of points
  /// whose projection lies on the open site, and not on a site that touches it. The query must be at least `margin`
  /// away from all planes that bound the domain.
  /// @param query   finite.
  /// @param margin  mesh units, > 0.
  /// @param found   receives the closest point. Returning the point by value would double the cost, because a copy has
  ///                to wait for data that was just written.
  /// @return        false if the query is outside of the domain or closer than `margin` to its border. Also false if
  ///                rounding may decide these conditions, for example for faces without a usable plane.
  /// Cost: about 15 ns; for a vertex, 5 ns for each edge at the vertex.
  [[nodiscard]] bool project(SiteId site, const Vec3d& query, double margin, NearestSite& found) const;

  /// Projects many queries. Results equal those of the function for single queries, bit for bit.
  /// @param sites  one for each query. Queries without a site are left out.
  /// @param found  one for each query. Entries without a closest point get no site.
  /// Cost: half that of the function for single queries, if most sites are faces.
  void project(std::span<const SiteId> sites, std::span<const Vec3d> queries, double margin,
               std::span<NearestSite> found) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

}  // namespace blum
