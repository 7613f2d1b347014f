// Blum: the least translation that separates two convex hulls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Bounds on the least translation of the first hull that separates it from the second.
struct HullDepth {
  double lower = 0;
  double upper = 0;
  Vec3d direction;  ///< Unit vector. A translation by `upper` along `direction` separates the hulls. Zero if the hulls
                    ///< are apart.
};

/// Returns the least translation that separates the convex hulls of two sets of points.
/// @param first, second  points with coordinates of at most about 1. Both hulls must have a volume.
/// @param tolerance      the search ends if the bounds differ by at most this fraction of the upper bound.
/// @param most_planes    the search ends after this number of planes.
/// @throws Cancelled.
/// Cost: about a microsecond per plane, and 2 ns per plane and point.
/// Method: docs/theory/proximity.md.
[[nodiscard]] HullDepth hull_depth(std::span<const Vec3d> first, std::span<const Vec3d> second, double tolerance,
                                   std::size_t most_planes, const Context& context);

}  // namespace blum::detail
