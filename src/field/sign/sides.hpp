// Blum: the side of a point whose closest site is known. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/winding_number.hpp"
#include "field/sign/policy.hpp"

namespace blum::sign {

/// Tells sides as planned. What it needs it copies; the mesh may go away.
///
/// Where winding numbers are whole, the one of a query is that of the side of the surface that it looks at, since
/// nothing lies between it and its closest point. So triangles that nothing touches are gathered in patches, connected
/// across edges that two of them share: in front of a patch the winding number is the same everywhere, and by one more
/// behind it. It is found once per patch; which side a query looks at, the pseudonormal of its closest site tells.
/// Queries that are closest to a triangle that others touch or cross (or where a patch is not certain) ask for
/// themselves.
class Sides {
 public:
  /// @param bvh  of this mesh, to find places beside patches with.
  /// @throws Cancelled.
  /// Cost: with Method::crossings, unless plan.is_simple, all pairs of triangles that touch are searched for.
  Sides(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  /// Whether a query that is not on the surface lies inside. Allocates nothing.
  [[nodiscard]] bool is_inside(const Vec3d& query, const NearestSite& nearest) const;

  /// The same as far as it takes no winding number of the query itself: where that is above 1/2 decides, nullopt.
  [[nodiscard]] std::optional<bool> is_inside_by_site(const Vec3d& query, const NearestSite& nearest) const;
  /// Null where all sides are told by sites.
  [[nodiscard]] const WindingNumber* winding() const { return winding_ ? &*winding_ : nullptr; }

  /// How many sites have queries that ask for themselves.
  [[nodiscard]] std::size_t open_site_count() const;

 private:
  void find_patches(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  Method method_;
  int level_;
  Box3 bounds_;
  std::optional<Pseudonormals> normals_;
  std::optional<WindingNumber> winding_;
  std::vector<std::uint32_t> patch_;  ///< of each site; empty where all are in one patch with 0 in front
  std::vector<int> in_front_;         ///< winding number in front of each patch
};

}  // namespace blum::sign
