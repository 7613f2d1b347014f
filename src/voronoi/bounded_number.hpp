// Blum: doubles with a bound on their rounding error. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

namespace blum::voronoi {

/// A double with a bound on its difference from the result of exact arithmetic. It is a filter that decides most
/// predicates before exact arithmetic is needed. Each operation adds its largest rounding error, half a unit in the
/// last place, to the bound. The bounds themselves are rounded: after n operations a bound may be too small by 2 n
/// units. To compensate, every operation enlarges its bound by 8 units, by the factor `grow`.
class BoundedNumber {
 public:
  BoundedNumber() = default;
  /// Makes an exact number.
  explicit BoundedNumber(double value) : value_(value) {}

  /// Result of sign() if the sign is uncertain; otherwise sign() returns -1, 0 or 1.
  static constexpr int unknown = 2;
  [[nodiscard]] int sign() const {
    if (!(std::abs(value_) <= std::numeric_limits<double>::max())) return unknown;
    if (value_ > error_) return 1;
    if (value_ < -error_) return -1;
    return error_ == 0 ? 0 : unknown;
  }

  [[nodiscard]] friend BoundedNumber operator+(const BoundedNumber& a, const BoundedNumber& b) {
    return rounded(a.value_ + b.value_, a.error_ + b.error_);
  }
  [[nodiscard]] friend BoundedNumber operator-(const BoundedNumber& a, const BoundedNumber& b) {
    return rounded(a.value_ - b.value_, a.error_ + b.error_);
  }
  [[nodiscard]] friend BoundedNumber operator*(const BoundedNumber& a, const BoundedNumber& b) {
    BoundedNumber out = rounded(a.value_ * b.value_,
                                std::abs(a.value_) * b.error_ + std::abs(b.value_) * a.error_ + a.error_ * b.error_);
    // Products of values or bounds may underflow and lose more than half a unit. Products with an exact 0 do not.
    if (!is_zero(a) && !is_zero(b)) out.error_ += 16 * std::numeric_limits<double>::min();
    return out;
  }

 private:
  static constexpr double half_unit = std::numeric_limits<double>::epsilon() / 2;
  static constexpr double grow = 1 + 16 * half_unit;

  static bool is_zero(const BoundedNumber& number) { return number.value_ == 0 && number.error_ == 0; }
  static BoundedNumber rounded(double value, double error) {
    BoundedNumber out(value);
    out.error_ = (error + std::abs(value) * half_unit) * grow;
    return out;
  }

  double value_ = 0;
  double error_ = 0;
};

}  // namespace blum::voronoi
