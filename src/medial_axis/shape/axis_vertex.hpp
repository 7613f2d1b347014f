// Blum: vertices of medial axes while they are made. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/surface/surface.hpp"
#include "medial_axis/surface/thin_ball.hpp"

namespace blum::detail {

/// All that is known of a vertex in one place; medial_columns says what the members are.
struct AxisVertex {
  Vec3d position;
  double radius = 0;
  std::array<Vec3d, 2> footprints;
  std::array<SiteId, 2> sites;
  double separation_angle = 0;
  std::array<std::uint32_t, 2> elements{};  ///< of the surface, that footprints lie on
};

/// A vertex that knows of one wall only.
inline AxisVertex vertex_of_one_wall(const Vec3d& x, const NearestPoint& nearest) {
  return {x,
          nearest.distance,
          {nearest.point, nearest.point},
          {nearest.site, nearest.site},
          0,
          {nearest.element, nearest.element}};
}

/// The centre of a ball in a thin part.
inline AxisVertex vertex_of_ball(const ThinBall& ball) {
  return {ball.centre,
          ball.nearest.distance,
          {ball.nearest.point, ball.other.point},
          {ball.nearest.site, ball.other.site},
          ball.angle,
          {ball.nearest.element, ball.other.element}};
}

}  // namespace blum::detail
