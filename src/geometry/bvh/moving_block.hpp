// Blum: eight moving boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/lanes.hpp"

namespace blum {

/// A moving box in single precision. Rounding is monotonic, so boxes that are apart here are apart exactly.
struct MovingBoxF {
  float lower[2][3];  ///< [start or end][axis]
  float upper[2][3];
};

/// Eight moving boxes. An empty box (+inf, -inf) is apart from every finite box.
struct alignas(64) MovingBlock {
  float lower[2][3][lanes];
  float upper[2][3][lanes];
};

/// Returns a bit for each box of a block that may touch `box` at some time. A bit is 0 if, along some axis, the box
/// lies on the same side of `box` at both ends, and hence always.
[[nodiscard]] unsigned touching(const MovingBlock& block, const MovingBoxF& box);

}  // namespace blum
