// Blum: how numbers are spread over sheets and lines. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "blum/medial_axis/axis_graph.hpp"

namespace blum {

/// A number that is linear over an edge or a triangle.
struct LinearPart {
  static LinearPart on_edge(double a, double b, double length) {
    return {{std::min(a, b), std::min(a, b), std::max(a, b)}, length, true};
  }
  static LinearPart on_triangle(std::array<double, 3> values, double area) {
    std::sort(values.begin(), values.end());
    return {values, area, false};
  }

  std::array<double, 3> values;  ///< at the corners, rising; of an edge, the first two are those of one end
  double weight;                 ///< length or area
  bool is_edge;

  /// Where the number is at most this, as a share of the edge or triangle.
  [[nodiscard]] double share_up_to(double value) const;
};

/// The low value and the median of a number over parts: those up to which 5 % and half of the weight lie; of parts
/// without weight, of their number.
/// @param parts   not empty.
/// @param spread  its minimum and maximum are there.
/// Cost: O(parts), some ten times.
void add_quantiles(std::vector<LinearPart> parts, AxisSpread& spread);

}  // namespace blum
