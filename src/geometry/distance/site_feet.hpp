// Blum: feet of perpendiculars on edges and triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"
#include "geometry/distance/triangle_frame.hpp"

namespace blum {

/// Foot of the perpendicular from a query onto an edge's line. All evaluations of a site use these functions, with the
/// site's vertices in ascending order, so that results are bitwise equal.
struct EdgeFoot {
  double t = 0;  ///< the foot is a + t (b - a)
  Vec3d point;   ///< the foot; valid if 0 < t < 1
};

[[nodiscard]] inline EdgeFoot foot_on_edge(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  const double t = squared == 0 ? 0.0 : dot(query - a, direction) / squared;
  // The foot is computed from the nearer end, so that the rounding of t does not grow with the edge's length.
  return {t, t <= 0.5 ? a + direction * t : b - direction * (1 - t)};
}

/// Foot of the perpendicular from a query onto a triangle's plane. The triangle must not be flat.
struct FaceFoot {
  double s = 0;  ///< position of the foot along the longest side
  double t = 0;  ///< position of the foot along the altitude
  Vec3d rest;    ///< vector from the foot to the query

  FaceFoot(const Vec3d& query, const TriangleFrame& f) {
    const Vec3d w = query - f.base;
    s = dot(w, f.u);
    t = dot(w, f.v);
    rest = w - f.u * s - f.v * t;
  }
  /// Returns true if the foot lies in the triangle, without its border.
  [[nodiscard]] bool is_inside(const TriangleFrame& f) const {
    return t > 0 && s * f.altitude > t * f.apex && (f.length - s) * f.altitude > t * (f.length - f.apex);
  }
  /// Returns true if the foot certainly lies in the triangle, further than `margin` from its border.
  [[nodiscard]] bool is_inside(const TriangleFrame& f, double margin) const {
    const double rest_of_side = f.length - f.apex;
    return t > margin && s * f.altitude - t * f.apex > margin * (f.altitude + std::abs(f.apex)) &&
           (f.length - s) * f.altitude - t * rest_of_side > margin * (f.altitude + std::abs(rest_of_side));
  }
};

}  // namespace blum
