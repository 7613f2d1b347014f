// Blum: means and percentiles of values that stand for parts of an area. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <span>

namespace blum::surface {

/// A sum of many numbers that also sums the rounding error of each addition (Neumaier 1974). So millions of terms do
/// not make it less accurate.
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

/// Values that vary within their part of the area: uniformly, from `middle - spread` to `middle + spread`.
struct SpreadValue {
  double middle = 0;
  double spread = 0;  ///< at least 0
  double weight = 0;  ///< above 0
};

/// Returns the weighted root mean square of the middles.
/// @param largest  largest magnitude of the middles. They are divided by it, so that squares neither overflow nor
/// underflow.
/// @param sum      sum of the weights, above 0.
[[nodiscard]] double root_mean_square(std::span<const SpreadValue> values, double largest, double sum);

/// Returns, for each percentage, the value below which that percentage of the total weight lies.
/// @param values    at least one.
/// @param percents  in rising order, above 0 and below 100.
/// Cost: O(values log values).
[[nodiscard]] std::array<double, 7> percentiles(std::span<const SpreadValue> values,
                                                const std::array<double, 7>& percents);

}  // namespace blum::surface
