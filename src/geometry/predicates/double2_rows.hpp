// Blum: determinants of rows with twice the digits of a double. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/vec3.hpp"
#include "exact/double2.hpp"

namespace blum::detail {

/// Returns a d - b c.
inline Double2 minor(const Double2& a, const Double2& b, const Double2& c, const Double2& d) {
  const Double2 left = product(b, c);
  return sum(product(a, d), {-left.high, -left.low});
}

using Row = std::array<Double2, 3>;

/// Returns p - q exactly.
inline Row row(const Vec3d& p, const Vec3d& q) {
  return {difference(p.x, q.x), difference(p.y, q.y), difference(p.z, q.z)};
}

/// Returns u . (v x w).
inline double determinant(const Row& u, const Row& v, const Row& w) {
  const Double2 x = product(u[0], minor(v[1], v[2], w[1], w[2]));
  const Double2 y = product(u[1], minor(v[2], v[0], w[2], w[0]));
  const Double2 z = product(u[2], minor(v[0], v[1], w[0], w[1]));
  return sum(sum(x, y), z).high;
}

}  // namespace blum::detail
