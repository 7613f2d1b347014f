// Blum: orthonormal frames of triangles of any shape. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "blum/core/vec3.hpp"

namespace blum {

/// Below this ratio of altitude to longest side, a triangle counts as its border only, because rounding loses its
/// plane.
inline constexpr double flat_ratio = 1e-14;

/// Frame of a triangle along its longest side: corner `base`, unit vector u along that side, unit vector v along the
/// altitude over it. A vector without its parts along u and v is its part along the normal. The length of this part is
/// accurate on needles and slivers, unlike a product with a computed normal.
struct TriangleFrame {
  Vec3d base, u, v;
  double length = 0;    ///< longest side
  double altitude = 0;  ///< over the longest side
  double apex = 0;      ///< position of the altitude's foot along the longest side, from base

  /// Returns true if the triangle has no usable plane.
  [[nodiscard]] bool is_flat() const { return !(altitude > flat_ratio * length); }
  /// Returns the unit normal, counter-clockwise in the given order of corners; zero if the triangle is flat.
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
  v -= frame.u * dot(v, frame.u);  // again: the first step leaves rounding along u
  frame.altitude = length(v);
  if (frame.altitude > 0) frame.v = v / frame.altitude;
  return frame;
}

}  // namespace blum
