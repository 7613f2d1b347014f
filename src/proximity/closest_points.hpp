// Blum: closest points of features, in double precision. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A point of either feature. What they are rounded by is small beside the features, but they need not be the closest
/// where these are thin.
struct ClosestPair {
  Vec3d first;
  Vec3d second;
};

/// Of a point and a triangle with a corner in the origin.
[[nodiscard]] ClosestPair closest_of_point_and_triangle(const Vec3d& point, const Vec3d& b, const Vec3d& c);

/// Of a segment that begins in the origin, and another one.
[[nodiscard]] ClosestPair closest_of_segments(const Vec3d& end, const Vec3d& other_start, const Vec3d& other_along);

}  // namespace blum::detail
