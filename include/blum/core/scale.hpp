// Blum: powers of two that bring lengths to about 1. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace blum {

/// Returns the power of two by which a length is multiplied to become at least 1 and below 2. Products of scaled
/// lengths neither overflow nor underflow. Returns 1 for the length 0 and for lengths that are not finite.
[[nodiscard]] inline double scale_to_one(double length) {
  if (!(length > 0) || !std::isfinite(length)) return 1;
  return std::ldexp(1.0, std::clamp(-std::ilogb(length), -1000, 1000));
}

}  // namespace blum
