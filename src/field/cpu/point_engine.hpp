// Blum: closest sites of many scattered points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/ids.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/cpu/adjacency.hpp"
#include "field/cpu/placed_sites.hpp"
#include "field/cpu/point_kernel.hpp"

namespace blum::cpu {

/// Result for a query. If the query lies outside of the frame, the result is that of the closest point in the frame.
struct FoundSite {
  std::uint32_t query = 0;  ///< Index of the query.
  SiteId site;              ///< The closest one, or one that touches it; none if it is not known.
  SiteId other;             ///< Alternative to `site`, if both are equally close within rounding.
  float squared = 0;        ///< Squared distance to a point of the surface, in the engine's units; see at_most().
};

/// Finds the closest sites of many points at once. Points are ordered so that neighbours follow each other, and are
/// culled as tiles of a field are, so that common work is done once. Results are in single precision. Callers decide in
/// double precision, and none of their results may depend on this engine.
class PointEngine {
 public:
  /// Builds the records of a mesh. Cost: that of the records of a field, 0.5 us per triangle and core.
  /// @param mesh, sites  are not used later.
  /// @throws Cancelled.
  PointEngine(const MeshView& mesh, const SiteTable& sites, const Context& context);

  /// Largest number of queries in a group. Their data then stay in the nearest cache.
  static constexpr std::size_t most_per_group = 256;

  /// Calls use(results) for groups of queries that lie close together, on many threads at once. Each query is in
  /// exactly one group.
  /// @param queries  finite; fewer than 2^32.
  /// @throws Cancelled.
  void for_each_group(std::span<const Vec3d> queries, const Context& context,
                      FunctionRef<void(std::span<const FoundSite>)> use) const;

  /// Returns true if the result for a query is that of the query itself.
  [[nodiscard]] bool is_in_frame(const Vec3d& query) const { return box_.contains(query); }

  /// Returns an upper bound on the distance of a query from the surface, with room for rounding, mesh units; infinite
  /// if it is not known.
  [[nodiscard]] double at_most(const Vec3d& query, const FoundSite& found) const;

  /// Returns the error bound of distances, and of planes between the domains of sites, mesh units.
  [[nodiscard]] double margin() const;

 private:
  struct Ordered;
  [[nodiscard]] Ordered order(std::span<const Vec3d> queries, const Context& context) const;

  bool is_usable_ = false;  ///< False for meshes without extent, or too large or small for single precision.
  Box3 box_;                ///< Box of the frame, mesh units: queries beyond are moved to its border.
  NormalFrame frame_;
  PlacedSites placed_;
};

}  // namespace blum::cpu
