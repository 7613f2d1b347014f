// Blum: orthonormal frames of triangles of any shape. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "blum/core/vec3.hpp"

namespace blum {

/// If altitude / longest side is at most this, a triangle is treated as its border only. Its plane is lost in rounding.
inline constexpr double flat_ratio = 1e-14;

/// Frame of a triangle along its longest side: corner `base`, unit vector u along that side, and unit vector v along
/// the altitude over it. To find a vector's component along the normal, subtract its components along u and v. The
/// length of the result is accurate for needles and slivers, unlike a product with a computed normal.
struct TriangleFrame {
  Vec3d base, u, v;
  double length = 0;    ///< length of the longest side
  double altitude = 0;  ///< over the longest side
  double apex = 0;      ///< distance of the altitude's foot from `base`, along the longest side

  /// Returns true if the triangle has no usable plane.
  [[nodiscard]] bool is_flat() const { return !(altitude > flat_ratio * length); }
  /// Returns the unit normal, for which the given order of corners is counter-clockwise; zero if the triangle is flat.
  [[nodiscard]] Vec3d normal() const { return is_flat() ? Vec3d{} : cross(u, v); }
};

[[nodiscard]] inline TriangleFrame make_triangle_frame(const std::array<Vec3d, 3>& p) {
  const double squared[3] = {squared_length(p[1] - p[0]), squared_length(p[2] - p[1]), squared_length(p[0] - p[2])};
  const std::size_t k = squared[0] >= squared[1] && squared[0] >= squared[2] ? 0 : squared[1] >= squared[2] ? 1 : 2;
  TriangleFrame frame;
  frame.base = p[k];
  frame.length = std::sqrt(squared[k]);
  if (!(frame.length > 0)) return frame;
  frame.u = (p[(k + 1) % 3] - p[k]) / frame.length;
  const Vec3d side = p[(k + 2) % 3] - p[k];
  frame.apex = dot(side, frame.u);
  Vec3d v = side - frame.u * frame.apex;
  // Repeated, because after the first step v still has a component along u from rounding.
  v -= frame.u * dot(v, frame.u);
  frame.altitude = length(v);
  if (frame.altitude > 0) frame.v = v / frame.altitude;
  return frame;
}

}  // namespace blum
