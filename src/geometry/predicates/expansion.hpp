// Blum: exact sums of doubles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Value of `capacity` for expansions without a limit.
inline constexpr std::size_t unbounded = 0;

/// Number stored as a sum of non-overlapping doubles, in ascending order of magnitude (Shewchuk 1997). The sum is exact
/// unless something overflows or falls below the normal range. `capacity` is the number of doubles that can be added,
/// or `unbounded`. A product of two doubles counts as two, a product of three as four.
template <std::size_t capacity>
class Expansion {
 public:
  void add(double value) {
    // Adds the value to each part in turn, by Knuth's two-sum. Parts that become 0 are dropped.
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double sum = value + parts_[i];
      const double from_parts = sum - value;
      const double error = (value - (sum - from_parts)) + (parts_[i] - from_parts);
      if (error != 0) parts_[kept++] = error;
      value = sum;
    }
    if (value != 0) {
      if constexpr (capacity == unbounded) {
        if (kept == parts_.size()) parts_.push_back(0);
      }
      parts_[kept++] = value;
    }
    size_ = kept;
  }
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  void add_product(double x, double y, double z) {
    const double product = x * y;
    add_product(std::fma(x, y, -product), z);
    add_product(product, z);
  }
  /// Adds sign * det(u, v, w).
  /// @param sign  1 or -1.
  void add_determinant(double sign, const Vec3d& u, const Vec3d& v, const Vec3d& w) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::size_t k = (i + 2) % 3;
      add_product(sign * u[i], v[j], w[k]);
      add_product(-sign * u[i], v[k], w[j]);
    }
  }
  /// Returns the number, rounded to a double. The error is at most a few units in the last place.
  [[nodiscard]] double value() const { return size_ == 0 ? 0 : parts_[size_ - 1]; }
  /// Returns the summands, in ascending order of magnitude.
  [[nodiscard]] std::span<const double> parts() const { return {parts_.data(), size_}; }
  [[nodiscard]] int sign() const { return size_ == 0 ? 0 : parts_[size_ - 1] > 0 ? 1 : -1; }

 private:
  std::conditional_t<capacity == unbounded, std::vector<double>, std::array<double, capacity>> parts_{};
  std::size_t size_ = 0;
};

}  // namespace blum::detail
