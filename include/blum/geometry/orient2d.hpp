// Blum: the side of a line that a point lies on, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace blum::detail {

/// The sign (-1, 0, 1) of the area of the triangle a, b, c: 1 when it turns counter-clockwise. Exact as long as no
/// product of coordinates overflows or falls below the normal range: coordinates of magnitude 1e-140 to 1e150, or 0.
/// A filter answers nearly always; else the determinant is summed without error (Shewchuk 1997).
[[nodiscard]] int orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b,
                           const std::array<double, 2>& c);

}  // namespace blum::detail
