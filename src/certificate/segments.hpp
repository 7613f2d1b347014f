// Blum: distances of segments, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "blum/core/vec3.hpp"

namespace blum::verifier {

struct Segment3 {
  Vec3d a, b;

  [[nodiscard]] Vec3d at(double along) const { return a + (b - a) * along; }
  /// Returns the parameter, 0 to 1, of the segment's point closest to p.
  [[nodiscard]] double closest(const Vec3d& p) const {
    const double squared = squared_length(b - a);
    return squared > 0 ? std::clamp(dot(p - a, b - a) / squared, 0.0, 1.0) : 0.0;
  }
  [[nodiscard]] Vec3d closest_point(const Vec3d& p) const { return at(closest(p)); }
};

/// Returns the parameter, 0 to 1, of the point of a segment closest to another segment. If the segments are parallel,
/// it is that of the middle of the common part.
[[nodiscard]] inline double closest_along(const Segment3& segment, const Segment3& other) {
  constexpr double parallel = 1e-12;  // squared sine of the angle between them
  const Vec3d along = segment.b - segment.a;
  const Vec3d across = other.b - other.a;
  const double product = squared_length(along) * squared_length(across);
  const double both = dot(along, across);
  const double room = product - both * both;
  if (!(room > parallel * product)) return 0.5 * (segment.closest(other.a) + segment.closest(other.b));
  const Vec3d between = segment.a - other.a;
  const double s = (both * dot(across, between) - dot(along, between) * squared_length(across)) / room;
  return segment.closest(other.at(other.closest(segment.at(std::clamp(s, 0.0, 1.0)))));
}

/// Returns the squared distance of two segments.
[[nodiscard]] inline double squared_distance(const Segment3& segment, const Segment3& other) {
  const Vec3d p = segment.at(closest_along(segment, other));
  double best = squared_length(p - other.closest_point(p));
  for (const Vec3d& end : {segment.a, segment.b}) {
    best = std::min(best, squared_length(end - other.closest_point(end)));
  }
  for (const Vec3d& end : {other.a, other.b}) {
    best = std::min(best, squared_length(end - segment.closest_point(end)));
  }
  return best;
}

}  // namespace blum::verifier
