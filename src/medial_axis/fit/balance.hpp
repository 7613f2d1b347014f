// Blum: points as far from one wall of a solid as from others. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// What balance() may do.
struct BalanceLimits {
  double voxel = 0;       ///< mesh units: footprints may move by some of them, and distances count as equal at 1e-9
  double most_moved = 0;  ///< mesh units, from the start
  /// Whether walls that turn out to be closer take part; else there is no such point.
  bool may_add = true;
};

/// The vertex at the point near a start that is equally far from some walls and not further from these than from the
/// rest of the surface. Newton steps of least length over the walls that ask for the shortest ones.
/// @param feet   footprints on walls around; several may lie on one.
/// @param walls  how many: 2 on a sheet, 3 on a seam, 4 at a junction.
/// @return       with the two footprints that are seen furthest apart; nullopt where there is no such point.
[[nodiscard]] std::optional<AxisVertex> balance(const Surface& surface, const Vec3d& start,
                                                std::span<const Footprint> feet, std::size_t walls,
                                                const BalanceLimits& limits);

}  // namespace blum::detail
