// Blum: feet of perpendiculars on edges and triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {

/// Foot of a perpendicular on an edge's line. Every evaluation of a site uses these functions, with the site's vertices
/// in rising order, to get the same bits.
struct EdgeFoot {
  double t = 0;  ///< the foot is a + t (b - a)
  Vec3d point;   ///< valid if 0 < t < 1
};

[[nodiscard]] inline EdgeFoot foot_on_edge(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  const double t = squared == 0 ? 0.0 : dot(query - a, direction) / squared;
  // From the nearer end, so that rounding of t does not grow with the edge's length.
  return {t, t <= 0.5 ? a + direction * t : b - direction * (1 - t)};
}

/// Foot of a perpendicular on the plane of a triangle that is not flat.
struct FaceFoot {
  double s = 0;  ///< along the longest side
  double t = 0;  ///< along the altitude
  Vec3d rest;    ///< from the foot to the query

  FaceFoot(const Vec3d& query, const TriangleFrame& f) {
    const Vec3d w = query - f.base;
    s = dot(w, f.u);
    t = dot(w, f.v);
    rest = w - f.u * s - f.v * t;
  }
  /// Returns true if the foot lies in the open triangle.
  [[nodiscard]] bool is_inside(const TriangleFrame& f) const {
    return t > 0 && s * f.altitude > t * f.apex && (f.length - s) * f.altitude > t * (f.length - f.apex);
  }
  /// Returns true if the foot certainly lies in it, further than `margin` from the border.
  [[nodiscard]] bool is_inside(const TriangleFrame& f, double margin) const {
    const double rest_of_side = f.length - f.apex;
    return t > margin && s * f.altitude - t * f.apex > margin * (f.altitude + std::abs(f.apex)) &&
           (f.length - s) * f.altitude - t * rest_of_side > margin * (f.altitude + std::abs(rest_of_side));
  }
};

}  // namespace blum
