// Blum: closest sites of many scattered points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/radix_sort.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/placed_sites.hpp"
#include "field/cpu/point_kernel.hpp"

namespace blum::cpu {

/// Result for a query. If the query lies outside of the engine's box, the result belongs to the point of the box that
/// is closest to the query.
struct FoundSite {
  Vec3d at;                 ///< The query.
  std::uint32_t query = 0;  ///< Index of the query.
  SiteId site;              ///< The closest site, or one that touches it; none if unknown.
  SiteId other;             ///< A second site as close as `site` within rounding; none otherwise.
  /// Squared distance from the query to some point of the surface, in the engine's units; see at_most().
  float squared = 0;
};

/// Results for queries that lie close together. All members have one entry for each query.
struct FoundGroup {
  std::span<const Vec3d> at;
  std::span<const detail::KeyedIndex> order;  ///< with the indices of the queries
  std::span<const std::uint32_t> site, other;
  std::span<const float> squared;

  [[nodiscard]] std::size_t size() const { return at.size(); }
  [[nodiscard]] FoundSite operator[](std::size_t k) const {
    return {at[k], order[k].index, known_site(site[k]), known_site(other[k]), squared[k]};
  }
  /// Converts entries of `site` and `other`.
  [[nodiscard]] static SiteId known_site(std::uint32_t record) {
    return record == dead_record ? SiteId::none() : SiteId(record);
  }
};

/// Finds the closest sites of many points at once. Points are sorted so that neighbours follow each other. Sites are
/// culled for groups of points, as for the tiles of a field, so that the groups share work. The engine computes in
/// single precision. Callers must confirm each result in double precision, so that their results do not depend on this
/// engine.
class PointEngine {
 public:
  /// Builds the records of a mesh. Cost: as for a field, 0.5 us per triangle and core.
  /// @param mesh, sites  used during construction only.
  /// @throws Cancelled.
  PointEngine(const MeshView& mesh, const SiteTable& sites, const Context& context);

  /// Largest number of queries in a group. The data of a group fit in the L1 cache.
  static constexpr std::size_t most_per_group = 256;

  /// Calls use(group) for groups of queries that lie close together. Calls are made on many threads at once. Each
  /// query is in exactly one group.
  /// @param queries  finite; fewer than 2^32.
  /// @throws Cancelled.
  void for_each_group(std::span<const Vec3d> queries, const Context& context,
                      FunctionRef<void(const FoundGroup&)> use) const;

  /// Returns true if the query lies in the engine's box, so that its result belongs to the query itself.
  [[nodiscard]] bool is_in_frame(const Vec3d& query) const { return box_.contains(query); }

  /// Returns an upper bound on the distance from a query to the surface, mesh units. The bound includes room for
  /// rounding; it is infinite if the distance is unknown.
  [[nodiscard]] double at_most(const Vec3d& query, const FoundSite& found) const;

  /// Returns a bound on the errors of distances and of the planes that separate the domains of sites, mesh units.
  [[nodiscard]] double margin() const;

 private:
  struct Ordered;
  struct Worker;
  [[nodiscard]] Vec3f position(const Vec3d& query) const;
  [[nodiscard]] Ordered order(std::span<const Vec3d> queries, const Context& context) const;
  void load(std::span<const Vec3d> queries, MortonOrder order, Worker& worker) const;

  bool is_usable_ = false;  ///< False if the mesh has no extent, or is too large or too small for single precision.
  Box3 box_;                ///< The engine's box, mesh units. Queries outside are moved to its border.
  NormalFrame frame_;
  PlacedSites placed_;
};

}  // namespace blum::cpu
