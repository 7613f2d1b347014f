// Blum: orthonormal frames of triangles, whatever their shape. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "blum/core/vec3.hpp"

namespace blum {

/// Below this ratio of altitude to longest side a triangle is nothing but its border: its plane is lost in rounding.
inline constexpr double flat_ratio = 1e-14;

/// A triangle seen from its longest side: corner `base`, unit vector u along that side, unit vector v along the
/// altitude over it. What is left of a vector after both are removed is its part along the normal; unlike a product
/// with a computed normal, its length keeps its precision on needles and slivers.
struct TriangleFrame {
  Vec3d base, u, v;
  double length = 0;    ///< of the longest side
  double altitude = 0;  ///< over it
  double apex = 0;      ///< where the altitude's foot lies along the longest side, from base

  /// Whether the triangle has no usable plane.
  [[nodiscard]] bool is_flat() const { return !(altitude > flat_ratio * length); }
  /// Unit normal, counter-clockwise as the corners were given; zero where flat.
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
  v -= frame.u * dot(v, frame.u);  // once more: what the first step left along u is rounding
  frame.altitude = length(v);
  if (frame.altitude > 0) frame.v = v / frame.altitude;
  return frame;
}

}  // namespace blum
