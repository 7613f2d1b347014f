// Blum: percentiles of values over triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"

namespace blum::surface {

class RoundValues;

/// Values over a triangle.
struct LinearValue {
  /// Values at the corners, in rising order. Between the corners, the value changes linearly. If there are round
  /// values, all values are in this range.
  double lowest = 0;
  double middle = 0;
  double highest = 0;
  double weight = 0;  ///< above 0, proportional to the triangle's area
  /// nullptr, or the values are `sign` times these distances, plus `shift`. Must outlive this object.
  const RoundValues* round = nullptr;
  double sign = 1;
  double shift = 0;
};

/// Sorts the values of three corners.
[[nodiscard]] LinearValue linear_value(double a, double b, double c, double weight);

/// Returns the fraction of a triangle's area on which its value is at most `value`.
[[nodiscard]] double fraction_below(const LinearValue& triangle, double value);

/// Returns, for each percentage, a lower and an upper bound on the value below which that percentage of the total
/// weight lies. If no errors of fractions intervene, the bounds differ by at most `error`, or 1e-15 times the range of
/// the values.
/// @param values    at least one.
/// @param percents  above 0 and below 100.
/// @return          the same for any number of threads.
/// @throws Cancelled.
/// Cost: 30 ns per value without round values.
[[nodiscard]] std::vector<std::pair<double, double>> percentiles(std::span<const LinearValue> values,
                                                                 std::span<const double> percents, double error,
                                                                 const Context& context);

}  // namespace blum::surface
