// Blum: search for a path of one body. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/planning/certified_motion.hpp"
#include "blum/planning/plan.hpp"

namespace blum::detail {

/// Search for a path of one body, while all others rest.
struct PathSearch {
  Vec3d centre;  ///< of the body, in its coordinates
  RigidTransform start, goal;
  Box3 bounds;      ///< of the centre
  double size = 0;  ///< largest distance of the body's points from its centre, mesh units
  double time = 0;  ///< seconds
  PathPlanner planner = PathPlanner::rrt_connect;
  /// Returns how far a motion from one pose to another is proven: 1 if it is free.
  std::function<double(const RigidTransform&, const RigidTransform&)> free_until;
  std::function<bool()> stops;  ///< true if the search must end early; also called for progress
};

struct FoundPath {
  std::vector<RigidTransform> poses;  ///< from start to goal; empty if none was found
  std::size_t states = 0;
};

/// Sets the seed of all later searches.
void set_search_seed(std::uint32_t seed);
/// Searches for a path, and shortens the path that is found. Only motions for which free_until() returns 1 are used.
[[nodiscard]] FoundPath search_path(const PathSearch& search);

}  // namespace blum::detail
