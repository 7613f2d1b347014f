// Blum: medial balls of parts thinner than a voxel. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Ball in the solid that touches the surface at two points, or at one.
struct ThinBall {
  Vec3d centre;
  NearestPoint nearest;  ///< closest point of the surface to the centre
  NearestPoint other;    ///< equally close point on another wall; equals `nearest` if none was found
  double angle = 0;      ///< degrees: angle between both points at the centre
  /// Degrees: at least `angle`. Points of the surface at most 5 % further away than `nearest` also count, because the
  /// facets of a round part are only about equally close.
  double angle_across = 0;
};

/// Returns a medial ball of the thin part of the solid that is next to `beyond`, a point outside the solid. The search
/// starts at the deepest point on the ray from `beyond` through `touched`. The ball touches the surface at the closest
/// point to that deepest point. The largest such ball is found by shrinking (Ma, Bae, Choi, "3D medial axis point
/// approximation using nearest neighbors and the normal field", 2012). If there are larger balls next to it, the search
/// continues with these.
/// @param touched  closest point of the surface to `beyond`.
/// @param radius   mesh units. The result is nullopt if the ball would be larger, or if no point of the ray is inside.
[[nodiscard]] std::optional<ThinBall> thin_ball_behind(const Surface& surface, const NearestPoint& touched,
                                                       const Vec3d& beyond, double radius);

/// Returns a medial ball of the part of the solid around a point. First, the largest ball in the solid that touches the
/// surface at the closest point to the given point is found. It contains the given point. If there are larger balls
/// next to it, the search continues with these.
/// @param nearest  closest point of the surface to `inside`.
/// @param radius   mesh units. The result is nullopt if the ball would be larger.
/// @param enough   degrees: the search ends at a ball whose `angle_across` exceeds this and 150.
[[nodiscard]] std::optional<ThinBall> ball_around(const Surface& surface, const NearestPoint& nearest,
                                                  const Vec3d& inside, double radius, double enough = 0);

/// Returns the first ball of ball_around(), without a search for larger ones.
/// @param touched  closest point of the surface to `inside`.
[[nodiscard]] std::optional<ThinBall> ball_touching(const Surface& surface, const NearestPoint& touched,
                                                    const Vec3d& inside, double radius);

}  // namespace blum::detail
