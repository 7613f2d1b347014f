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
  double voxel = 0;       ///< Mesh units. Footprints may move by 4 voxels; equal distances agree to 1e-9 voxels.
  double most_moved = 0;  ///< Mesh units, from the start.
  /// True if walls that turn out to be closer take part. Otherwise no such point exists.
  bool may_add = true;
};

/// Returns the vertex at the point near a start that is equally far from some walls. It is not further from these than
/// from the rest of the surface. Each Newton step has least length, and uses the walls that require the shortest step.
/// @param feet   footprints on walls around; several may lie on one wall.
/// @param walls  number of walls: 2 on a sheet, 3 on a seam, 4 at a junction.
/// @return       with the two footprints that are seen furthest apart; nullopt if no such point exists.
[[nodiscard]] std::optional<AxisVertex> balance(const Surface& surface, const Vec3d& start,
                                                std::span<const Footprint> feet, std::size_t walls,
                                                const BalanceLimits& limits);

}  // namespace blum::detail
