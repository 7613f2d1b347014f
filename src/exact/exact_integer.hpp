// Blum: integers of any size, for layers that build with the compiler alone. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace blum::detail {

/// An integer of any size: a sign and a magnitude.
class ExactInteger {
 public:
  ExactInteger() = default;
  ExactInteger(std::int64_t value);  // NOLINT(google-explicit-constructor): numbers are numbers

  /// Returns -1, 0 or 1.
  [[nodiscard]] int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }
  /// Returns the number of bits of the magnitude; 0 for 0.
  [[nodiscard]] std::size_t bits() const;
  /// Returns the largest k for which 2^k divides the number; 0 for 0.
  [[nodiscard]] std::size_t twos() const;

  [[nodiscard]] ExactInteger operator-() const;
  /// Multiplies or divides by 2^count. Division drops the bits that are shifted out, and so rounds towards 0.
  [[nodiscard]] ExactInteger operator<<(std::size_t count) const;
  [[nodiscard]] ExactInteger operator>>(std::size_t count) const;

  [[nodiscard]] friend ExactInteger operator+(const ExactInteger& a, const ExactInteger& b) {
    return sum(a, b, b.negative_);
  }
  [[nodiscard]] friend ExactInteger operator-(const ExactInteger& a, const ExactInteger& b) {
    return sum(a, b, !b.negative_);
  }
  friend ExactInteger operator*(const ExactInteger& a, const ExactInteger& b);
  [[nodiscard]] friend bool operator==(const ExactInteger&, const ExactInteger&) = default;

  /// Returns numerator / denominator * 2^exponent, rounded to the nearest double, ties to even.
  /// @param denominator  > 0.
  [[nodiscard]] static double rounded_ratio(const ExactInteger& numerator, const ExactInteger& denominator,
                                            int exponent);

 private:
  using Limb = std::uint32_t;

  static ExactInteger sum(const ExactInteger& a, const ExactInteger& b, bool b_negative);
  static int compare_magnitudes(const ExactInteger& a, const ExactInteger& b);
  static void add_magnitude(std::vector<Limb>& to, const std::vector<Limb>& what);
  /// @param to  its value is at least that of `what`.
  static void take_magnitude(std::vector<Limb>& to, const std::vector<Limb>& what);
  void trim();
  void halve();

  std::vector<Limb> limbs_;  ///< lowest limb first; the last limb is not 0
  bool negative_ = false;    ///< false if the number is 0
};

}  // namespace blum::detail
