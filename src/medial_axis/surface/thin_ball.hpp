// Blum: medial balls of parts thinner than a voxel. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// A ball in the solid that touches the surface in two points, or in one.
struct ThinBall {
  Vec3d centre;
  NearestPoint nearest;  ///< to the centre
  NearestPoint other;    ///< as far, on another wall; the nearest point again where none shows
  double angle = 0;      ///< between the two, degrees
};

/// A medial ball of a thin part next to a point beyond the surface: the largest one that touches the surface where the
/// deepest point straight behind it does, found by shrinking (Ma, Bae, Choi, "3D medial axis point approximation using
/// nearest neighbors and the normal field", 2012), and from there towards larger ones.
/// @param touched  the closest point of the surface.
/// @param radius   mesh units; nullopt where the ball would be larger, and where nothing behind is inside.
[[nodiscard]] std::optional<ThinBall> thin_ball_behind(const Surface& surface, const NearestPoint& touched,
                                                       const Vec3d& beyond, double radius);

/// The largest ball that touches the surface where the one around a point in the solid does, so that it holds this
/// point. @param nearest  to the point.  @param radius  mesh units; nullopt where the ball would be larger.
[[nodiscard]] std::optional<ThinBall> ball_around(const Surface& surface, const NearestPoint& nearest,
                                                  const Vec3d& inside, double radius);

}  // namespace blum::detail
