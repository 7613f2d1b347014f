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

/// Answers many queries at once. The answers are bitwise those of Bvh::nearest(). Kernels in single precision find the
/// closest site, and a second site if both are equally close within rounding. If the query lies in the domains of these
/// sites by a margin, their distances are computed in double precision. Otherwise the Bvh is searched, with the bound
/// on the distance that is already known.
class PointSearch {
 public:
  PointSearch(const MeshView& mesh, const SiteTable& sites, const Context& context)
      : engine_(mesh, sites, context), projection_(mesh, sites, context) {}

  /// Smallest number of queries for which answering them together saves time.
  static constexpr std::size_t fewest = 1024;
  /// Returns true if it pays to build a PointSearch for this many queries. There must be at least 4096 queries, and at
  /// least as many queries as faces of the mesh (docs/performance.md).
  [[nodiscard]] static bool is_worth_building(std::size_t queries, std::size_t faces);
  /// Returns true if it pays to use an existing PointSearch for this many queries.
  [[nodiscard]] static bool is_worth_using(std::size_t queries, const SiteTable& sites);

  /// Answer to one query.
  struct Answer {
    std::size_t query = 0;  ///< index of the query
    Vec3d at;               ///< the query
    NearestSite nearest;    ///< has no site if no site lies within max_distance
  };

  /// Calls `receive(answers)` for groups of queries, on many threads at once. Each query is in exactly one group.
  /// @param queries  finite points.
  /// @param bvh      search tree of the same mesh.
  /// @throws Cancelled.
  void nearest(std::span<const Vec3d> queries, double max_distance, const Bvh& bvh, const Context& context,
               FunctionRef<void(std::span<const Answer>)> receive) const;

 private:
  /// Returns true if a query's answer is certain. A second site that the kernels found is compared, too.
  /// @param nearest  the closest point on the first site, in double precision; no site if it is uncertain.
  [[nodiscard]] bool is_certain(const cpu::FoundSite& found, NearestSite& nearest) const;
  /// Searches the Bvh. The kernels' distance limits the search.
  [[nodiscard]] std::optional<NearestSite> search(const Vec3d& query, const cpu::FoundSite& found, double max_distance,
                                                  const Bvh& bvh) const;

  cpu::PointEngine engine_;
  SiteProjection projection_;
};

}  // namespace blum
