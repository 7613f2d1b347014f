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

/// What is found of a query, or where that lies outside of the frame, of the closest point in it.
struct FoundSite {
  std::uint32_t query = 0;  ///< its index
  SiteId site;              ///< the closest one, or one that touches it; none where that is not known
  SiteId other;             ///< for the site, where two are as close but for rounding
  float squared = 0;        ///< distance to a point of the surface, in the engine's units; see at_most()
};

/// Looks at many points at once, in an order in which neighbours come together, as tiles of a field are looked at: what
/// they have in common is done once. It computes in single precision and leaves the last word to others, in double: no
/// result of theirs may depend on it.
class PointEngine {
 public:
  /// @param mesh, sites  are not looked at later. Cost: that of the records of a field, 0.5 us per triangle and core.
  /// @throws Cancelled.
  PointEngine(const MeshView& mesh, const SiteTable& sites, const Context& context);

  /// Groups are so small that what is looked up of their queries stays in the nearest cache.
  static constexpr std::size_t most_per_group = 256;

  /// Calls use(what is found) for groups of queries that lie close together, on many threads at once; over all groups,
  /// each query is found once.
  /// @param queries  finite; less than 2^32.
  /// @throws Cancelled.
  void for_each_group(std::span<const Vec3d> queries, const Context& context,
                      FunctionRef<void(std::span<const FoundSite>)> use) const;

  /// Whether what is found is found of the query itself.
  [[nodiscard]] bool is_in_frame(const Vec3d& query) const { return box_.contains(query); }

  /// How far the surface is from a query, with room for rounding, mesh units; infinite where that is not known.
  [[nodiscard]] double at_most(const Vec3d& query, const FoundSite& found) const;

  /// How far distances, and planes between the domains of sites, may be off, mesh units.
  [[nodiscard]] double margin() const;

 private:
  struct Ordered;
  [[nodiscard]] Ordered order(std::span<const Vec3d> queries, const Context& context) const;

  bool is_usable_ = false;  ///< false for meshes without extent, or too large or small for single precision
  Box3 box_;                ///< of the frame, mesh units: queries beyond are moved to its border
  NormalFrame frame_;
  PlacedSites placed_;
};

}  // namespace blum::cpu
