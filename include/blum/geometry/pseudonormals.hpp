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

/// A normal for every site of a mesh, such that on a closed, consistently oriented mesh that does not cross itself the
/// sign of (q - x) . normal is that of the signed distance of q, where x is the point closest to q and the normal is
/// that of the site that x lies on (Baerentzen and Aanaes, "Signed distance computation using the angle weighted
/// pseudonormal", 2005).
///
/// Face: its unit normal. Edge: the sum of its faces' unit normals. Vertex: the sum of its faces' unit normals, each
/// times the face's angle at the vertex. Only directions matter: sums are not normalised. Triangles without area
/// contribute nothing. Sites of no triangle have a zero normal.
class Pseudonormals {
 public:
  /// @param mesh   must pass validate(mesh).
  /// @param sites  the table of this mesh.
  /// @throws Cancelled.  Cost: O(triangles), 24 bytes per site.
  Pseudonormals(const MeshView& mesh, const SiteTable& sites, const Context& context = {});

  /// @param site  below sites.size().
  [[nodiscard]] const Vec3d& normal(SiteId site) const { return normals_[site.value]; }

  /// The signed distance's sign: whether a query lies inside, given the closest point and the site that it lies on.
  [[nodiscard]] bool is_inside(const Vec3d& query, const Vec3d& closest, SiteId site) const {
    return dot(query - closest, normal(site)) < 0;
  }

  /// One normal per site, indexed by SiteId.
  [[nodiscard]] const std::vector<Vec3d>& normals() const { return normals_; }

 private:
  std::vector<Vec3d> normals_;
};

}  // namespace blum
