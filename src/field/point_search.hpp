// Blum: closest sites of many points, by the kernels of fields. SPDX-License-Identifier: Apache-2.0
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

/// Answers many queries at once. The answers are those of Bvh::nearest(), bit for bit. Kernels in single precision find
/// the closest site, and a second one if both are equally close within rounding. If the domains of these sites hold the
/// query by a margin, their distances are computed in double precision. Otherwise a search of the hierarchy decides,
/// which already has a bound on the distance.
class PointSearch {
 public:
  PointSearch(const MeshView& mesh, const SiteTable& sites, const Context& context)
      : engine_(mesh, sites, context), projection_(mesh, sites, context) {}

  /// Fewest queries at once that have enough in common.
  static constexpr std::size_t fewest = 1024;
  /// Returns true if this many queries justify building a search: at least 4096, and as many as the mesh has faces
  /// (docs/performance.md).
  [[nodiscard]] static bool is_worth_building(std::size_t queries, const SiteTable& sites);
  /// Returns true if this many queries justify using a search that exists.
  [[nodiscard]] static bool is_worth_using(std::size_t queries, const SiteTable& sites);

  /// Closest site of one query.
  struct Answer {
    std::size_t query = 0;  ///< index of the query
    NearestSite nearest;    ///< without a site if nothing lies within max_distance
  };

  /// Calls `receive(answers)` for groups of queries, on many threads at once. Each query is in exactly one group.
  /// @param queries  finite points.
  /// @param bvh      tree of the same mesh.
  /// @throws Cancelled.
  void nearest(std::span<const Vec3d> queries, double max_distance, const Bvh& bvh, const Context& context,
               FunctionRef<void(std::span<const Answer>)> receive) const;

 private:
  /// Computes the answer from the sites that the kernels found. Returns false if it is not certain.
  [[nodiscard]] bool project(const Vec3d& query, const cpu::FoundSite& found, NearestSite& nearest) const;
  /// Searches the hierarchy, with the kernels' bound on the distance.
  [[nodiscard]] std::optional<NearestSite> search(const Vec3d& query, const cpu::FoundSite& found, double max_distance,
                                                  const Bvh& bvh) const;

  cpu::PointEngine engine_;
  SiteProjection projection_;
};

}  // namespace blum
