// Blum: means and percentiles of values that stand for parts of an area. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <span>

namespace blum::surface {

/// A sum of many numbers that keeps the rounding error of each addition (Neumaier 1974). Millions of terms cost no
/// digits.
class LongSum {
 public:
  void add(double term) {
    const double next = sum_ + term;
    rest_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
  }
  [[nodiscard]] double value() const { return sum_ + rest_; }

 private:
  double sum_ = 0;
  double rest_ = 0;
};

/// Returns the weighted root mean square.
/// @param largest  magnitude of the values; they are divided by it, so that squares neither overflow nor underflow.
/// @param sum      of the weights, > 0.
[[nodiscard]] double root_mean_square(std::span<const double> values, std::span<const double> weights, double largest,
                                      double sum);

/// Returns the values below which the given percentages of the weight lie.
/// @param values    one or more, fewer than 2^32.
/// @param sum      of the weights, > 0.
/// @param percents  in rising order.
/// Cost: O(values log values).
[[nodiscard]] std::array<double, 7> percentiles(std::span<const double> values, std::span<const double> weights,
                                                double sum, const std::array<double, 7>& percents);

}  // namespace blum::surface
