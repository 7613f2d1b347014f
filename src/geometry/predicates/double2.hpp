// Blum: arithmetic with twice the digits of a double. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Number stored as the sum of a double and a smaller correction.
struct Double2 {
  double high = 0;
  double low = 0;
};

inline Double2 quick_sum(double large, double small) {
  const double sum = large + small;
  return {sum, small - (sum - large)};
}

/// Returns x - y exactly.
inline Double2 difference(double x, double y) {
  const double high = x - y;
  const double from_y = x - high;
  return {high, (x - (high + from_y)) + (from_y - y)};
}

/// Returns the product of two numbers, with a relative error of at most 2^-103.
inline Double2 product(const Double2& x, const Double2& y) {
  const double high = x.high * y.high;
  return quick_sum(high, std::fma(x.high, y.high, -high) + (x.high * y.low + x.low * y.high));
}

/// Returns the sum of two numbers. Its error is at most 2^-103 of the sum of their magnitudes.
inline Double2 sum(const Double2& x, const Double2& y) {
  const double high = x.high + y.high;
  const double from_y = high - x.high;
  const double error = (x.high - (high - from_y)) + (y.high - from_y);
  return quick_sum(high, error + (x.low + y.low));
}

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
