// Blum: triangulation of a polygon by cutting off its ears. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Order in which ears are cut. Both orders make O(n) passes over the remaining corners.
enum class EarOrder : std::uint8_t {
  in_turn,     ///< corner by corner; corners next to a new ear are tried again after all others
  every_other  ///< never next to the last ear, which gives better-shaped triangles
};

/// Cuts a counter-clockwise polygon into counter-clockwise triangles, by cutting off ears. An ear is a corner that
/// turns left and whose triangle contains no other corner.
///
/// The polygon may be weakly simple. Bridges may join holes to the outline; their ends then appear twice at one place.
/// Parts may meet in a corner, or be joined by a bridge outside. Corners may lie on edges. With `in_turn`, some
/// triangles may have no area. The triangles cover the inside exactly once, whatever ears are cut, because their
/// winding numbers add up to the polygon's. The result is exact for the given points (see orient2d).
/// @param points     corners in order; at least 3.
/// @param triangles  receives indices of corners: points.size() - 2 entries.
/// @param work_left  number of corners and boxes of corners that may be examined; receives the remaining number.
/// @return  false if the polygon crosses itself or takes too much work. Also false for some polygons that are folded
/// onto themselves along one line several times. `triangles` is then unusable.
/// @throws Cancelled.
/// Cost: a few dozen examinations per corner of usual polygons. An ear whose tip is also the tip of another part, with
/// both edges along that part's, costs one per remaining corner. O(n^2) at worst.
[[nodiscard]] bool clip_ears(std::span<const std::array<double, 2>> points, EarOrder order,
                             std::span<Triangle> triangles, std::int64_t& work_left, const Context& context = {});

}  // namespace blum::detail
