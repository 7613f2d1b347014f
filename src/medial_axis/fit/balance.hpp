// Blum: points equally far from several walls of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Limits of balance().
struct BalanceLimits {
  /// Mesh units: side of a voxel. Footprints may move by 4 voxels. The last Newton step is at most 1e-9 voxels long.
  double voxel = 0;
  double most_moved = 0;  ///< Mesh units: greatest distance of the result from the start.
  /// True: walls that turn out to be closer are added to the given ones. False: the result is nullopt if there is such
  /// a wall.
  bool may_add = true;
};

/// Returns a vertex at a point near a start that is equally far from `walls` walls. No other part of the surface is
/// closer to it. Each Newton step is the shortest one that makes the closest wall and `walls` - 1 others equally far.
/// @param feet   footprints on the walls around the start; several may lie on one wall.
/// @param walls  number of walls: 2 on a sheet, 3 on a seam, 4 at a junction.
/// @return       the vertex, with the two footprints at the largest angle as seen from it; nullopt if no such point is
/// found.
[[nodiscard]] std::optional<AxisVertex> balance(const Surface& surface, const Vec3d& start,
                                                std::span<const Footprint> feet, std::size_t walls,
                                                const BalanceLimits& limits);

}  // namespace blum::detail
