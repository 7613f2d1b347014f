// Blum: balls that touch the surface of a solid, from random points of it, for the verifier.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/sampling.hpp"
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

/// Balls that shrink from random points until they touch two walls. The points are the same for every axis, and so are
/// the balls: what one axis asked for is kept for the next one. May be asked from many threads at once.
class BallDraws {
 public:
  struct Start {
    Vec3d point;
    std::uint32_t body = 0;
  };
  /// @param draw  gives the k-th point, the same each time; nullopt where it lies in no body.
  BallDraws(const SolidOracle& solid, std::size_t count, std::function<std::optional<Start>(std::size_t)> draw);

  [[nodiscard]] std::size_t size() const { return list_.size(); }

  /// The ball from the k-th point whose two walls are seen at `floor` degrees or more, as grown_ball() gives it; radius
  /// 0 where there is none that counts.
  /// @param counts    whether a ball does.
  /// @param reach_in  how far the surface may reach into a ball of that radius.
  template <class Counts, class ReachIn>
  [[nodiscard]] TouchingBall grown(std::size_t k, double floor, const Counts& counts, const ReachIn& reach_in) const;

 private:
  static constexpr std::size_t per_lock = 64;

  /// A ball, and what was asked of its centre so far.
  struct Known {
    TouchingBall ball;
    std::optional<double> distance;  ///< from the surface of its body
    std::optional<bool> is_inside;
  };
  struct Shrinking {
    bool is_drawn = false;
    std::uint32_t body = 0;
    std::optional<ShrinkingBall> next;
    std::vector<Known> balls;  ///< from the largest one on
  };

  /// The last ball before the first one that is seen at less than a floor; nullptr where there is none.
  [[nodiscard]] Known* shrunk(std::size_t k, double floor) const;
  [[nodiscard]] double distance(const Shrinking& from, Known& known) const;
  [[nodiscard]] bool is_inside(const Shrinking& from, Known& known) const;

  const SolidOracle& solid_;
  std::function<std::optional<Start>(std::size_t)> draw_;
  mutable std::vector<Shrinking> list_;
  mutable std::vector<std::mutex> locks_;
};

/// Balls from random points of a solid as a whole, and of some of its bodies.
class DrawnBalls {
 public:
  DrawnBalls(const SolidOracle& solid, std::uint32_t body_count);
  DrawnBalls(const DrawnBalls&) = delete;
  DrawnBalls& operator=(const DrawnBalls&) = delete;

  /// From random points of the boxes of the bodies; none where these have no volume.
  [[nodiscard]] const BallDraws& in_solid() const { return in_solid_; }
  /// Every so many-th body has draws of its own: body 0, and so on.
  [[nodiscard]] std::uint32_t every() const { return every_; }
  /// From random points beside the surface of a body, where that has triangles; else of its box.
  [[nodiscard]] const BallDraws& in_body(std::uint32_t body) const { return in_bodies_[body / every_]; }

 private:
  [[nodiscard]] std::optional<BallDraws::Start> in_box(std::uint32_t body, Random& random) const;
  [[nodiscard]] std::optional<BallDraws::Start> in_boxes(std::size_t k) const;
  [[nodiscard]] std::optional<BallDraws::Start> beside(std::uint32_t body, std::size_t k) const;

  const SolidOracle& solid_;
  Spread boxes_;
  std::uint32_t every_;
  BallDraws in_solid_;
  std::deque<BallDraws> in_bodies_;
};

template <class Counts, class ReachIn>
TouchingBall BallDraws::grown(std::size_t k, double floor, const Counts& counts, const ReachIn& reach_in) const {
  const std::scoped_lock lock(locks_[k / per_lock]);
  Known* const known = shrunk(k, floor);
  if (known == nullptr || !counts(known->ball)) return {};
  const TouchingBall& ball = known->ball;
  const bool fits = ball.is_whole || ball.radius - distance(list_[k], *known) <= reach_in(ball.radius);
  return fits && is_inside(list_[k], *known) ? ball : TouchingBall{};
}

}  // namespace blum::verifier
