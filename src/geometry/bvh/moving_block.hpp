// Blum: eight moving boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/lanes.hpp"

namespace blum {

/// A moving box in single precision: rounding keeps the order of numbers, so boxes that are apart were so before.
struct MovingBoxF {
  float lower[2][3];  ///< at the start, at the end
  float upper[2][3];
};

/// Eight of them. An empty box (+inf, -inf) is apart from everything that is finite.
struct alignas(64) MovingBlock {
  float lower[2][3][lanes];
  float upper[2][3][lanes];
};

/// A bit for each box of a block that may touch this one at some time: not where along some axis it is on the same side
/// of it at both ends, and so all the time.
[[nodiscard]] unsigned touching(const MovingBlock& block, const MovingBoxF& box);

}  // namespace blum
