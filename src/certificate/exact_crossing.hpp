// Blum: crossings of segments and triangles without rounding, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/core/vec3.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::verifier {

/// How often the way from p to q crosses the triangle a, b, c: 1 or -1 by the side that it comes from, or 0; nullopt
/// where it meets the border of the triangle, or runs in its plane, or ends in it.
[[nodiscard]] inline std::optional<int> exact_crossing(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p,
                                                       const Vec3d& q) {
  using detail::orient3d;
  const int from = orient3d(a, b, c, p);
  const int to = orient3d(a, b, c, q);
  if (from == to && from != 0) return 0;
  const int first = orient3d(p, q, a, b);
  const int second = orient3d(p, q, b, c);
  if (first * second < 0) return 0;
  const int third = orient3d(p, q, c, a);
  if (first * third < 0 || second * third < 0) return 0;
  if (from == 0 || to == 0 || first == 0 || second == 0 || third == 0) return std::nullopt;
  return to;
}

}  // namespace blum::verifier
