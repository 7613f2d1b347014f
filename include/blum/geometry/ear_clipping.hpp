// Blum: triangulation of a polygon by cutting off its ears. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Which ear goes next; both are O(n) passes over what is left.
enum class EarOrder : std::uint8_t {
  in_turn,     ///< corner by corner; those beside a new ear get another turn after all others
  every_other  ///< never right beside the last one, for triangles of better shape
};

/// Cuts a polygon into triangles that turn as it does, counter-clockwise, by cutting off ears: corners that turn left
/// and whose triangle holds no other corner. The polygon may be weakly simple: holes joined to the outline by bridges,
/// whose ends come twice at the same place, parts that meet in a corner or are joined by a bridge outside, corners on
/// edges. Where `in_turn`, triangles of no area may be among the others. Triangles cover the inside exactly once,
/// whatever ears were taken, because their winding numbers add up to the polygon's. Exact for the points as given (see
/// orient2d).
/// @param points     of the corners, in order; at least 3.
/// @param triangles  receives indices of corners: points.size() - 2 entries.
/// @param work_left  looks at a corner or at a box of corners that may be taken; becomes what is left.
/// @return  false where the polygon crosses itself or takes too much work, and for some that are folded upon themselves
/// along one line several times; `triangles` is then of no use.
/// @throws Cancelled.
/// Cost: a few dozen looks a corner for usual polygons, and one at each corner where an ear's tip is that of another
/// part and both edges lie upon that part's; O(n^2) at worst.
[[nodiscard]] bool clip_ears(std::span<const std::array<double, 2>> points, EarOrder order,
                             std::span<Triangle> triangles, std::int64_t& work_left, const Context& context = {});

}  // namespace blum::detail
