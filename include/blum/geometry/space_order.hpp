// Blum: orders that keep neighbours in space together. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Returns an order of points that keeps neighbours in space together. For any k, the points at positions 8 k to 8 k +
/// 7 of the order lie in a compact box. Groups of 64, 512, ... consecutive points lie in compact boxes, too. The points
/// are split recursively, across the longest side of their box. In each split, the number of points in the first group
/// is a power of two. A space-filling curve is not suitable: where the curve leaves a surface and meets the surface
/// elsewhere, a group would contain points of both regions.
///
/// @param position  called once per index from 0 to count - 1, from several threads; must return finite points.
/// @return          the indices of the points in this order. Points at equal positions keep their order. The result is
///                  the same for any number of threads.
/// Cost: O(count log count); about 0.08 us per point if there are 70,000 points.
[[nodiscard]] std::vector<std::uint32_t> space_order(std::size_t count,
                                                     const std::function<Vec3d(std::size_t)>& position,
                                                     const Context& context);

}  // namespace blum
