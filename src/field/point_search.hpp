// Blum: the closest sites of many points, by the kernels of fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/site_projection.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/point_engine.hpp"

namespace blum {

/// Answers many queries at once: what Bvh::nearest() answers one by one, bit for bit. Kernels in single precision say
/// which site is closest; where its domain holds the query by a margin, and no other site is as close but for rounding,
/// its distance is computed in double; else a search of the hierarchy, which knows how far to look, decides.
class PointSearch {
 public:
  PointSearch(const MeshView& mesh, const SiteTable& sites, const Context& context)
      : engine_(mesh, sites, context), projection_(mesh, sites, context) {}

  /// Fewer queries at once have too little in common.
  static constexpr std::size_t fewest = 1024;
  /// Whether so many queries are worth building a search: as many as there are faces are (docs/performance.md).
  [[nodiscard]] static bool is_worth_building(std::size_t queries, const SiteTable& sites);
  /// Whether they are worth a search that is there.
  [[nodiscard]] static bool is_worth_using(std::size_t queries, const SiteTable& sites);

  /// What is closest to a query.
  struct Answer {
    std::size_t query = 0;  ///< its index
    NearestSite nearest;    ///< without a site where nothing lies within max_distance
  };

  /// Calls tell(answers) for groups of queries, on many threads at once; over all groups, each query is told once.
  /// @param queries  finite. @param bvh  of the same mesh. @throws Cancelled.
  void nearest(std::span<const Vec3d> queries, double max_distance, const Bvh& bvh, const Context& context,
               FunctionRef<void(std::span<const Answer>)> tell) const;

 private:
  /// By the sites that the kernels have found; false where that is not certain.
  [[nodiscard]] bool project(const Vec3d& query, const cpu::FoundSite& found, NearestSite& nearest) const;
  /// By the hierarchy, which is told how far to look.
  [[nodiscard]] std::optional<NearestSite> search(const Vec3d& query, const cpu::FoundSite& found, double max_distance,
                                                  const Bvh& bvh) const;

  cpu::PointEngine engine_;
  SiteProjection projection_;
};

}  // namespace blum
