// Blum: closest points of single segments and triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "blum/core/vec3.hpp"

namespace blum {

/// Returns the point of a closed segment that is closest to a query, up to rounding. The two ends may be equal.
[[nodiscard]] inline Vec3d closest_point_on_segment(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  if (!(squared > 0)) return a;
  return a + direction * std::clamp(dot(query - a, direction) / squared, 0.0, 1.0);
}

/// Returns the point of a closed triangle that is closest to a query, up to rounding. If the triangle is a sliver, the
/// returned point lies on the triangle, but may not be the closest point. If the triangle has no area, the closest
/// point of its sides is returned.
[[nodiscard]] inline Vec3d closest_point_on_triangle(const Vec3d& query, const std::array<Vec3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3d normal = cross(b - a, c - a);
  const double of_a = dot(cross(c - b, query - b), normal);
  const double of_b = dot(cross(a - c, query - c), normal);
  const double of_c = dot(cross(b - a, query - a), normal);
  const double sum = of_a + of_b + of_c;
  if (sum > 0 && of_a >= 0 && of_b >= 0 && of_c >= 0) return a + (b - a) * (of_b / sum) + (c - a) * (of_c / sum);
  Vec3d best = closest_point_on_segment(query, a, b);
  for (const Vec3d& point : {closest_point_on_segment(query, b, c), closest_point_on_segment(query, c, a)}) {
    if (squared_length(query - point) < squared_length(query - best)) best = point;
  }
  return best;
}

/// Returns the points of two closed segments that are closest to each other, up to rounding.
[[nodiscard]] inline std::array<Vec3d, 2> closest_points_of_segments(const std::array<Vec3d, 2>& first,
                                                                     const std::array<Vec3d, 2>& second) {
  const Vec3d u = first[1] - first[0];
  const Vec3d v = second[1] - second[0];
  const Vec3d w = first[0] - second[0];
  const double uu = squared_length(u);
  const double vv = squared_length(v);
  const double uv = dot(u, v);
  const double determinant = uu * vv - uv * uv;
  const double s = determinant > 0 ? std::clamp((uv * dot(v, w) - vv * dot(u, w)) / determinant, 0.0, 1.0) : 0.0;
  const Vec3d on_second = closest_point_on_segment(first[0] + u * s, second[0], second[1]);
  // If the point on the second segment was clamped, the closest point on the first segment changes.
  const Vec3d on_first = closest_point_on_segment(on_second, first[0], first[1]);
  return {on_first, closest_point_on_segment(on_first, second[0], second[1])};
}

}  // namespace blum
