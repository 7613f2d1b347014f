// Blum: angle-weighted pseudonormals. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Normals of the sites of a mesh, which decide the sign of the distance of a query q. Let x be the point of the mesh
/// closest to q, and n the normal of the site that contains x. Then (q - x) . n has the sign of the signed distance of
/// q. The mesh must be closed and consistently oriented, without self-intersections (Baerentzen and Aanaes, "Signed
/// distance computation using the angle weighted pseudonormal", 2005).
///
/// The normal of a face is its unit normal. The normal of an edge is the sum of the unit normals of its faces. The
/// normal of a vertex is a weighted sum of the unit normals of its faces. The weights are the angles of the faces at
/// the vertex. Sums are not normalised, because only their directions matter. Triangles without area contribute
/// nothing. Sites without a triangle have a zero normal.
class Pseudonormals {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// @throws Cancelled.  Cost: O(triangles), 24 bytes per site.
  Pseudonormals(const MeshView& mesh, const SiteTable& sites, const Context& context = {});

  /// @param site  below sites.size().
  [[nodiscard]] const Vec3d& normal(SiteId site) const { return normals_[site.value]; }

  /// Returns true if a query lies inside, so that its signed distance is negative.
  /// @param closest  point of the mesh closest to the query.
  /// @param site     site that contains `closest`.
  [[nodiscard]] bool is_inside(const Vec3d& query, const Vec3d& closest, SiteId site) const {
    return dot(query - closest, normal(site)) < 0;
  }

  /// Returns one normal per site, indexed by SiteId.
  [[nodiscard]] const std::vector<Vec3d>& normals() const { return normals_; }

 private:
  std::vector<Vec3d> normals_;
};

}  // namespace blum
