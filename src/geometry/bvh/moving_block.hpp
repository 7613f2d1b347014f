// Blum: eight moving boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/lanes.hpp"

namespace blum {

/// Moving box in single precision. Rounding preserves order, so boxes that are apart in single precision are also apart
/// in double.
struct MovingBoxF {
  float lower[2][3];  ///< [start or end][axis]
  float upper[2][3];
};

/// Eight moving boxes. An empty box (+inf, -inf) does not touch any finite box.
struct alignas(64) MovingBlock {
  float lower[2][3][lanes];
  float upper[2][3][lanes];
};

/// Returns a bit for each box of a block that may touch `box` at some time. A bit is 0 if, along some axis, the box is
/// on the same side of `box` at the start and at the end. The box is then on this side at all times.
[[nodiscard]] unsigned touching(const MovingBlock& block, const MovingBoxF& box);

}  // namespace blum
