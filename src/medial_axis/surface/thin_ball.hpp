// Blum: medial balls of parts thinner than a voxel. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Ball in the solid that touches the surface in two points, or in one.
struct ThinBall {
  Vec3d centre;
  NearestPoint nearest;  ///< to the centre
  NearestPoint other;    ///< as far, on another wall; equals `nearest` if none was found
  double angle = 0;      ///< between the two, degrees
};

/// Returns a medial ball of a thin part next to a point outside the solid. It touches the surface where the ball around
/// the deepest point straight behind the surface does. The largest such ball is found by shrinking (Ma, Bae, Choi, "3D
/// medial axis point approximation using nearest neighbors and the normal field", 2012). From there the search goes on
/// to larger balls.
/// @param touched  closest point of the surface.
/// @param radius   mesh units. Returns nullopt if the ball would be larger, or if no point behind the surface is
/// inside.
[[nodiscard]] std::optional<ThinBall> thin_ball_behind(const Surface& surface, const NearestPoint& touched,
                                                       const Vec3d& beyond, double radius);

/// Returns the largest ball that touches the surface where the ball around a point of the solid does. It contains this
/// point.
/// @param nearest  to the point.
/// @param radius  mesh units. Returns nullopt if the ball would be larger.
[[nodiscard]] std::optional<ThinBall> ball_around(const Surface& surface, const NearestPoint& nearest,
                                                  const Vec3d& inside, double radius);

}  // namespace blum::detail
