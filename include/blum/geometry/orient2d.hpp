// Blum: the exact side of a line on which a point lies. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace blum::detail {

/// Returns the sign (-1, 0, 1) of the area of the triangle a, b, c. The sign is 1 if the triangle turns
/// counter-clockwise. It is exact if no product of coordinates overflows or falls below the normal range. For example,
/// it is exact for coordinates that are 0 or of magnitude 1e-140 to 1e150. A rounded determinant nearly always decides;
/// otherwise, the determinant is summed without error (Shewchuk 1997).
[[nodiscard]] int orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b,
                           const std::array<double, 2>& c);

}  // namespace blum::detail
