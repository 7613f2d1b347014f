// Blum: percentiles of values that change linearly over triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "blum/core/context.hpp"

namespace blum::surface {

/// Values at the corners of a triangle, in rising order. Between the corners, the value changes linearly.
struct LinearValue {
  double lowest = 0;
  double middle = 0;
  double highest = 0;
  double weight = 0;  ///< above 0, proportional to the triangle's area
};

/// Sorts the values of three corners.
[[nodiscard]] LinearValue linear_value(double a, double b, double c, double weight);

/// Returns the fraction of a triangle's area on which its value is at most `value`.
[[nodiscard]] double fraction_below(const LinearValue& triangle, double value);

/// Returns, for each percentage, a bound on the value below which that percentage of the total weight lies. Bounds are
/// at most `error`, or 1e-15 times the range of the values, from that value.
/// @param values    at least one.
/// @param percents  above 0 and below 100.
/// @param is_upper  true for upper bounds, false for lower bounds.
/// @return          the same for any number of threads.
/// @throws Cancelled.
/// Cost: 30 ns per value.
[[nodiscard]] std::vector<double> percentiles(std::span<const LinearValue> values, std::span<const double> percents,
                                              double error, bool is_upper, const Context& context);

}  // namespace blum::surface
