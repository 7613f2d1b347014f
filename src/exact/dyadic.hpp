// Blum: exact sums and products of doubles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>

#include "exact/integer.hpp"

namespace blum::detail {

/// An integer times a power of two.
class Dyadic {
 public:
  Dyadic() = default;
  /// @param value  finite.
  explicit Dyadic(double value) {
    int exponent = 0;
    const double part = std::frexp(value, &exponent);
    integer_ = static_cast<std::int64_t>(std::ldexp(part, digits));
    exponent_ = exponent - digits;
  }

  [[nodiscard]] int sign() const { return integer_.sign(); }

  [[nodiscard]] friend Dyadic operator+(const Dyadic& a, const Dyadic& b) {
    if (a.exponent_ < b.exponent_) return b + a;
    return {times_power(a.integer_, a.exponent_ - b.exponent_) + b.integer_, b.exponent_};
  }
  [[nodiscard]] friend Dyadic operator-(const Dyadic& a, const Dyadic& b) {
    return a + Dyadic(-b.integer_, b.exponent_);
  }
  [[nodiscard]] friend Dyadic operator*(const Dyadic& a, const Dyadic& b) {
    return {a.integer_ * b.integer_, a.exponent_ + b.exponent_};
  }

 private:
  static constexpr int digits = 53;

  Dyadic(Integer integer, int exponent) : integer_(std::move(integer)), exponent_(exponent) {}

  Integer integer_ = 0;
  int exponent_ = 0;
};

}  // namespace blum::detail
