// Blum: orders that keep neighbours in space together. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// The order of points along a Hilbert curve (21 bits per axis) through their box: consecutive points form compact
/// clusters, without the jumps of a Morton curve. Points of one cell keep their own order.
///
/// @param position  called once per index in [0, count), from several threads.
/// @return          indices in curve order. count must be at most 2^32 - 1.
/// Cost: O(count); about 0.1 us per point. Method: Skilling, "Programming the Hilbert curve", 2004.
[[nodiscard]] std::vector<std::uint32_t> space_order(std::size_t count,
                                                     const std::function<Vec3d(std::size_t)>& position,
                                                     const Context& context);

}  // namespace blum
