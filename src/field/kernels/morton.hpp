// Blum: indices of points on a space-filling curve (Morton order). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/host_device.hpp"

namespace blum::kernels {

/// Spreads the low 10 bits of x: bit k moves to bit 3 k.
BLUM_HD constexpr std::uint32_t spread_bits(std::uint32_t x) {
  x = (x | (x << 16)) & 0x030000ffU;
  x = (x | (x << 8)) & 0x0300f00fU;
  x = (x | (x << 4)) & 0x030c30c3U;
  x = (x | (x << 2)) & 0x09249249U;
  return x;
}

/// Returns the index along a Morton curve through a cube of 1024 cells per side. The cube is [-1/2, 1/2]^3. Coordinates
/// outside are moved to the nearest cell, and NaN to the first cell.
BLUM_HD constexpr std::uint32_t morton_code(const Vec3d& p) {
  std::uint32_t code = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double x = (p[axis] + 0.5) * 1023.0;
    // NaN is moved to the first cell, because it cannot be converted to an integer.
    const auto cell = x > 0 ? static_cast<std::uint32_t>(smaller(x, 1023.0)) : 0U;
    code |= spread_bits(cell) << axis;
  }
  return code;
}
inline constexpr int morton_bits = 30;

}  // namespace blum::kernels
