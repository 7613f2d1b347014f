// Blum: balls from random points of a solid that touch its surface, for the verifier.
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

/// A ball in a solid that touches the surface at two points.
struct TouchingBall {
  Vec3d centre;
  double radius = 0;
  Vec3d first, second;    ///< touching points
  double angle = 0;       ///< between these, seen from the centre, degrees
  bool is_whole = false;  ///< true if the surface does not reach into it
};

/// Balls through a point of the surface, with centres on one line from there. They shrink from a large ball to the one
/// that nothing reaches into. Each touches a point that reaches into the previous one.
///
/// Method: shrinking balls, from outside inwards, with exact closest points. Source: Ma, Bae, Choi, "3D medial axis
/// point approximation using nearest neighbors and the normal field", The Visual Computer 28(1), 2012.
class ShrinkingBall {
 public:
  /// @param first  the closest point of the surface to p.
  /// @param more   see grown_ball().
  ShrinkingBall(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first, double more);

  /// Computes the next ball. Returns false and changes nothing if none exists, or if its centre sees the two points at
  /// less than `floor` degrees. In the latter case a call with a lower floor may succeed.
  [[nodiscard]] bool shrink(const SolidOracle& solid, double floor, TouchingBall& ball);

 private:
  std::uint32_t body_;
  int steps_ = 0;
  bool has_ended_ = false;
  double nothing_;
  double radius_ = 0;
  Vec3d first_, along_, other_;
};

/// Grows the ball that touches the wall next to p until it touches another wall. It touches the first wall at the
/// closest point, and its centre lies on the line from there through p. Touching points that the centre sees at less
/// than `floor` from the first one count as the same wall. Examples are shallow edges between facets.
/// @param p       in the body, and not on its surface.
/// @param first   the closest point of the surface.
/// @param floor   degrees, above 0.
/// @param more    by how much the radius of the first ball tried exceeds the distance of p; 0: twice that distance. The
/// first walls that a small ball finds may be the same wall, where a larger ball finds another.
/// @return        radius 0 if nothing is touched at that angle, or p lies on the surface.
[[nodiscard]] TouchingBall grown_ball(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                                      double floor, double more = 0);

/// Returns the approximate distance of a point from the middle between the two walls that a ball touches.
[[nodiscard]] double distance_to_middle(const Vec3d& p, const TouchingBall& ball);

/// Balls that shrink from random points until they touch two walls. The points, and so the balls, are the same for
/// every axis. Balls computed for one axis are kept for the next one. Thread-safe.
class BallDraws {
 public:
  struct Start {
    Vec3d point;
    std::uint32_t body = 0;
  };
  /// @param draw  returns the k-th point, the same each time; nullopt if it lies in no body.
  BallDraws(const SolidOracle& solid, std::size_t count, std::function<std::optional<Start>(std::size_t)> draw);

  [[nodiscard]] std::size_t size() const { return list_.size(); }

  /// Returns the ball from the k-th point whose two walls are seen at `floor` degrees or more, as grown_ball() defines
  /// it. Returns radius 0 if no ball counts.
  /// @param counts    returns true if a ball counts.
  /// @param reach_in  returns how far the surface may reach into a ball of that radius.
  template <class Counts, class ReachIn>
  [[nodiscard]] TouchingBall grown(std::size_t k, double floor, const Counts& counts, const ReachIn& reach_in) const;

 private:
  static constexpr std::size_t per_lock = 64;

  /// A ball, and the results computed for its centre so far.
  struct Known {
    TouchingBall ball;
    std::optional<double> distance;  ///< from the surface of its body
    std::optional<bool> is_inside;
  };
  struct Shrinking {
    bool is_drawn = false;
    std::uint32_t body = 0;
    std::optional<ShrinkingBall> next;
    std::vector<Known> balls;  ///< largest first
  };

  /// Returns the last ball before the first one that is seen at less than `floor`; nullptr if none exists.
  [[nodiscard]] Known* shrunk(std::size_t k, double floor) const;
  [[nodiscard]] double distance(const Shrinking& from, Known& known) const;
  [[nodiscard]] bool is_inside(const Shrinking& from, Known& known) const;

  const SolidOracle& solid_;
  std::function<std::optional<Start>(std::size_t)> draw_;
  mutable std::vector<Shrinking> list_;
  mutable std::vector<std::mutex> locks_;
};

/// Balls from random points of a whole solid, and of some of its bodies.
class DrawnBalls {
 public:
  DrawnBalls(const SolidOracle& solid, std::uint32_t body_count);
  DrawnBalls(const DrawnBalls&) = delete;
  DrawnBalls& operator=(const DrawnBalls&) = delete;

  /// Returns balls from random points of the boxes of the bodies; none if these have no volume.
  [[nodiscard]] const BallDraws& in_solid() const { return in_solid_; }
  /// Returns n: every n-th body, from body 0, has draws of its own.
  [[nodiscard]] std::uint32_t every() const { return every_; }
  /// Returns balls from random points beside the surface of a body if that has triangles, else from its box.
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
