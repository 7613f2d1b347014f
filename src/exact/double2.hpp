// Blum: arithmetic with twice the digits of a double. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

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

}  // namespace blum::detail
