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

/// Finds sides according to a sign plan. Sides copies the data that it needs, so the mesh may be destroyed.
///
/// If winding numbers are whole, a query has the winding number of the side of the surface that it faces. The reason:
/// nothing lies between the query and its closest point. Triangles that no other triangle touches are therefore
/// collected in patches, connected across edges of exactly two triangles. In front of a patch the winding number is the
/// same everywhere; behind it, it is greater by one. The winding number in front is computed once per patch. The
/// pseudonormal of a query's closest site decides which side of the patch the query faces. The winding number must be
/// evaluated directly for two kinds of queries. Their closest triangle touches or crosses other triangles, or belongs
/// to a patch with an uncertain winding number.
class Sides {
 public:
  /// @param bvh  search tree of this mesh, used to find points in front of patches.
  /// @throws Cancelled.
  /// Cost: with Method::crossings, unless plan.is_simple, a search for all pairs of triangles that touch.
  Sides(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  /// Returns true if a query is inside. The query must not be on the surface. Allocates nothing.
  [[nodiscard]] bool is_inside(const Vec3d& query, const NearestSite& nearest) const;

  /// Returns the result of is_inside() if the closest site decides it. Otherwise returns nullopt. The caller must then
  /// decide: the query is inside if its winding number is above 1/2.
  [[nodiscard]] std::optional<bool> is_inside_by_site(const Vec3d& query, const NearestSite& nearest) const {
    if (method_ == Method::none) return false;
    // Outside of the mesh's box the side is known. The closest site could mislead there: far away, rounding may choose
    // a wrong site, whose normal faces away.
    const bool is_beyond = min(query, bounds_.lower) != bounds_.lower || max(query, bounds_.upper) != bounds_.upper;
    if (method_ == Method::crossings && is_beyond) return level_ < 0;
    if (method_ == Method::sums) return std::nullopt;
    const bool is_behind = normals_->is_inside(query, nearest.point, nearest.site);
    if (method_ == Method::pseudonormals || !winding_) return is_behind;
    return is_inside_by_patch(query, nearest.site, is_behind);
  }
  /// Loads data of a site into the cache, for a later call of is_inside_by_site().
  void prefetch([[maybe_unused]] SiteId site) const {
#if defined(__GNUC__)
    if (normals_) __builtin_prefetch(&normals_->normal(site));
#endif
  }

  /// Returns the winding numbers; null if the closest sites decide all sides.
  [[nodiscard]] const WindingNumber* winding() const { return winding_ ? &*winding_ : nullptr; }

  /// Returns the normals of the sites; null if the sides do not depend on them.
  [[nodiscard]] const Pseudonormals* normals() const { return normals_ ? &*normals_ : nullptr; }

  /// Returns the number of sites that do not decide the side, so that queries closest to them need a winding number.
  [[nodiscard]] std::size_t open_site_count() const;

 private:
  /// Returns the result of is_inside_by_site() for a query whose closest site is known to face away from the query, or
  /// towards it.
  [[nodiscard]] std::optional<bool> is_inside_by_patch(const Vec3d& query, SiteId site, bool is_behind) const;
  void find_patches(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context);

  Method method_;
  int level_;
  Box3 bounds_;
  std::optional<Pseudonormals> normals_;
  std::optional<WindingNumber> winding_;
  /// Patch of each site; empty if all sites are in one patch, with winding number 0 in front.
  std::vector<std::uint32_t> patch_;
  std::vector<int> in_front_;  ///< winding number in front of each patch
};

}  // namespace blum::sign
