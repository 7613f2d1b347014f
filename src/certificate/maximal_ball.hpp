// Blum: the largest ball that touches a solid's surface in a point, for the verifier. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstdint>

#include "blum/core/vec3.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// A ball inside of a solid whose surface it touches in two points.
struct TouchingBall {
  Vec3d centre;
  double radius = 0;
  Vec3d first, second;    ///< where it touches
  double angle = 0;       ///< between these as the centre sees them, degrees
  bool is_whole = false;  ///< whether a body holds all of it
};

/// The balls through a point of the surface, with centres on one line from there, from a large one down to the one that
/// nothing reaches into. Each touches what reaches into the one before.
/// Method: shrinking balls (Ma, Bae, Choi, "3D medial axis point approximation using nearest neighbors and the normal
/// field", The Visual Computer 28(1), 2012), from outside inwards, with exact closest points.
class ShrinkingBall {
 public:
  /// @param first  the closest point of the surface to p.  @param more  see grown_ball().
  ShrinkingBall(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first, double more);

  /// Goes to the next ball. False, and nothing is changed, where there is none; or where its centre sees the two points
  /// at less than `floor` degrees: then it may be asked for again, at a lower floor.
  [[nodiscard]] bool shrink(const SolidOracle& solid, double floor, TouchingBall& ball);

 private:
  std::uint32_t body_;
  int steps_ = 0;
  bool has_ended_ = false;
  double nothing_;
  double radius_ = 0;
  Vec3d first_, along_, other_;
};

/// What is furthest away from the wall next to a point: the ball through the closest point of the surface, with its
/// centre on the line from there through the point, is grown until it touches another wall. Touching points that the
/// centre sees at less than `floor` from the first one count as the same wall: shallow edges between facets, say.
/// @param p       in the body, and not on its surface.
/// @param first   the closest point of the surface.
/// @param floor   degrees, above 0.
/// @param more    how much larger than the distance of p the first ball is that is tried; 0: twice as large. The walls
///                that are first found from a small one may be the same wall, where those of a larger one are not.
/// @return        radius 0 where nothing is touched at that angle, or p lies on the surface.
[[nodiscard]] TouchingBall grown_ball(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                                      double floor, double more = 0);

/// How far a point is from the middle between the two walls that a ball around it would touch, about.
[[nodiscard]] double distance_to_middle(const Vec3d& p, const TouchingBall& ball);

}  // namespace blum::verifier
