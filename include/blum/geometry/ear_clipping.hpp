// Blum: triangulation of a polygon by cutting off its ears. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Order in which ears are cut off. Both orders make O(n) passes over the remaining corners.
enum class EarOrder : std::uint8_t {
  in_turn,     ///< corner by corner; corners next to an ear that was cut off are tried again after all others
  every_other  ///< never a corner next to the previous ear, which gives better-shaped triangles
};

/// Cuts a counter-clockwise polygon into counter-clockwise triangles, by cutting off ears. An ear is a corner that
/// turns left and whose triangle contains no other corner.
///
/// The polygon may be weakly simple. Bridges (edges that are traversed twice) may join holes to the outline; each end
/// of a bridge is then listed twice. The polygon may touch itself in corners, and bridges may also run outside of the
/// polygon. Corners may lie on edges. With `in_turn`, some triangles may have no area. For any choice of ears, the
/// triangles cover the interior of the polygon exactly once. At every point, the sum of the triangles' winding numbers
/// is the winding number of the polygon. The result is exact for the given points (see orient2d).
/// @param points     corners of the polygon in their order; at least 3.
/// @param triangles  receives points.size() - 2 triangles; their entries are indices of corners.
/// @param work_left  largest number of examinations of corners and of boxes of corners that is allowed. On return, it
///                   is reduced by the number of examinations that were made.
/// @return  false if the polygon crosses itself, or needs more examinations than `work_left`. Also false for some
/// polygons that are folded onto themselves several times along one line. In these cases, `triangles` must not be used.
/// @throws Cancelled.
/// Cost: usually a few dozen examinations per corner. If the polygon visits the tip of an ear twice, along the same two
/// edges, that ear costs one examination per remaining corner. O(n^2) at worst.
[[nodiscard]] bool clip_ears(std::span<const std::array<double, 2>> points, EarOrder order,
                             std::span<Triangle> triangles, std::int64_t& work_left, const Context& context = {});

}  // namespace blum::detail
