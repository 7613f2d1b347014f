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

/// Finds sides as planned. It copies the data it needs, so the mesh may be destroyed.
///
/// If winding numbers are whole, the one of a query is that of the side of the surface that it faces. Nothing lies
/// between the query and its closest point. So triangles that nothing touches are gathered in patches, connected across
/// edges that two of them share. In front of a patch the winding number is the same everywhere; behind it, it is
/// greater by one. It is computed once per patch. The pseudonormal of a query's closest site decides which side the
/// query faces. Some queries are evaluated themselves: those closest to a triangle that others touch or cross, and
/// those of a patch that is not certain.
class Sides {
 public:
  /// @param bvh  tree of this mesh, to find places beside patches.
  /// @throws Cancelled.
  /// Cost: with Method::crossings, unless plan.is_simple, the search for all pairs of triangles that touch.
  Sides(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  /// Returns true if a query that is not on the surface lies inside. Allocates nothing.
  [[nodiscard]] bool is_inside(const Vec3d& query, const NearestSite& nearest) const;

  /// Returns the same, or nullopt if the caller must decide: inside if the query's own winding number is above 1/2.
  [[nodiscard]] std::optional<bool> is_inside_by_site(const Vec3d& query, const NearestSite& nearest) const;
  /// Returns the winding numbers; null if sites decide all sides.
  [[nodiscard]] const WindingNumber* winding() const { return winding_ ? &*winding_ : nullptr; }

  /// Returns the number of sites whose queries are evaluated themselves.
  [[nodiscard]] std::size_t open_site_count() const;

 private:
  void find_patches(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  Method method_;
  int level_;
  Box3 bounds_;
  std::optional<Pseudonormals> normals_;
  std::optional<WindingNumber> winding_;
  std::vector<std::uint32_t> patch_;  ///< per site; empty if all are in one patch with 0 in front
  std::vector<int> in_front_;         ///< winding number in front of each patch
};

}  // namespace blum::sign
