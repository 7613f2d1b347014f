// Blum: footprints of points on walls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "blum/core/vec3.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// What is closest to a point: of all points of labels that are as close, but for 1e-9 of the size, the two that are
/// seen furthest apart; the same one twice where there is one.
struct WallPoint {
  double radius = 0;                ///< exact distance from the closest label
  std::array<Vec3d, 2> footprints;  ///< relative to the centre of the labels
  std::array<LabelIndex, 2> labels{};
  double separation_angle = 0;  ///< between them, degrees
};

/// @param among  labels that hold all that may be closest.  @param q  relative to the centre of the labels.
/// Cost: linear in the labels, quadratic in those that are closest.
[[nodiscard]] WallPoint wall_point(const LabelGeometry& geometry, std::span<const LabelIndex> among, const Vec3d& q);

/// The angle at a point between two others, degrees.
[[nodiscard]] double separation_angle(const Vec3d& at, const Vec3d& first, const Vec3d& second);

}  // namespace blum::voronoi
