// Blum: orders that keep neighbours in space together. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Returns an order of points in which every aligned run of 8, 64, 512, ... fills a compact box of its own. The points
/// are cut at coordinates, across the longest side each time, at powers of two. A space-filling curve would not do: it
/// jumps where it leaves a surface and meets it again elsewhere, so that runs span both places.
///
/// @param position  called once per index in [0, count), from several threads; must return finite points.
/// @return          indices; equal positions keep their order. The same for any number of threads.
/// Cost: O(count log count); about 0.08 us per point for 70,000 points.
[[nodiscard]] std::vector<std::uint32_t> space_order(std::size_t count,
                                                     const std::function<Vec3d(std::size_t)>& position,
                                                     const Context& context);

}  // namespace blum
