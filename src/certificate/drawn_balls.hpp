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
  Vec3d first, second;    ///< the two touching points
  double angle = 0;       ///< separation angle of these points at the centre, degrees
  bool is_whole = false;  ///< true if the surface does not reach into the ball
};

/// A sequence of balls that touch the surface at the same point, with centres on the same line. The sequence starts
/// with a large ball, and ends with a ball into which the surface does not reach. Each ball touches a second point of
/// the surface, which lies in the previous ball.
///
/// Method: shrinking balls, from outside inwards, with exact closest points. Source: Ma, Bae, Choi, "3D medial axis
/// point approximation using nearest neighbors and the normal field", The Visual Computer 28(1), 2012.
class ShrinkingBall {
 public:
  /// @param first  the closest point of the surface to p.
  /// @param more   see grown_ball().
  ShrinkingBall(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first, double more);

  /// Computes the next ball. Returns false and changes nothing if there is none, or if the separation angle of its two
  /// points is below `floor` degrees. If only the floor prevents a ball, a call with a lower floor may succeed.
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
/// surface point closest to p, and its centre lies on the line from this point through p. A second touching point at a
/// separation angle below `floor` counts as the same wall, for example behind a shallow edge between facets.
/// @param p       lies in the body, and not on its surface.
/// @param first   the surface point closest to p.
/// @param floor   degrees, above 0.
/// @param more    by how much the first ball's radius exceeds the distance of p from the surface; 0: the radius is
///                twice that distance. A small first ball may find only the same wall where a larger one finds another.
/// @return        a ball of radius 0 if nothing is touched at that angle, or if p lies on the surface.
[[nodiscard]] TouchingBall grown_ball(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                                      double floor, double more = 0);

/// Calls grown_ball() with a first ball that exceeds the distance of p from the surface by `near`. In most cases
/// another wall is that close. If no other wall is found, a first ball of twice the radius is tried.
[[nodiscard]] TouchingBall grown_ball_from_near(const SolidOracle& solid, std::uint32_t body, const Vec3d& p,
                                                const Vec3d& first, double floor, double near);

/// Returns the approximate distance of a point from the middle between the two walls that a ball touches.
[[nodiscard]] double distance_to_middle(const Vec3d& p, const TouchingBall& ball);

/// Balls from random points, shrunk until they touch two walls. The points, and so the balls, are the same for every
/// axis. Balls computed for one axis are kept for the next axis. Thread-safe.
class BallDraws {
 public:
  struct Start {
    Vec3d point;
    std::uint32_t body = 0;
  };
  /// @param draw  returns the k-th point, the same in every call; nullopt if it lies in no body.
  BallDraws(const SolidOracle& solid, std::size_t count, std::function<std::optional<Start>(std::size_t)> draw);

  [[nodiscard]] std::size_t size() const { return list_.size(); }
  /// Returns the body of the k-th point, of which grown() returned a ball.
  [[nodiscard]] std::uint32_t body(std::size_t k) const { return list_[k].start->body; }

  /// Returns the ball from the k-th point that touches two walls at a separation angle of at least `floor` degrees, as
  /// grown_ball() defines it. Returns a ball of radius 0 if that ball does not count.
  /// @param counts    returns true if a ball counts.
  /// @param reach_in  returns how far the surface may reach into a ball of the given radius.
  template <class Counts, class ReachIn>
  [[nodiscard]] TouchingBall grown(std::size_t k, double floor, const Counts& counts, const ReachIn& reach_in) const;
  /// Does the same, but skips points that are further from the surface than `most_depth`. This costs less.
  template <class Counts, class ReachIn>
  [[nodiscard]] TouchingBall grown(std::size_t k, double floor, double most_depth, const Counts& counts,
                                   const ReachIn& reach_in) const;

 private:
  static constexpr std::size_t per_lock = 64;

  /// A ball, and the results computed for its centre so far.
  struct Known {
    TouchingBall ball;
    std::optional<double> distance;  ///< distance of the centre from the surface of its body
    std::optional<bool> is_inside;
  };
  struct Shrinking {
    bool is_drawn = false;
    std::optional<Start> start;
    Vec3d first;  ///< the closest point of the surface
    std::optional<ShrinkingBall> next;
    std::vector<Known> balls;  ///< largest first
  };

  /// Draws the k-th point if that has not been done. Returns false if it lies in no body.
  bool draw(std::size_t k) const;
  /// Returns the last ball before the first one with a separation angle below `floor`; nullptr if there is none.
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

  /// Returns balls from random points in the boxes of the bodies; none if the boxes have no volume.
  [[nodiscard]] const BallDraws& in_solid() const { return in_solid_; }
  /// Returns n: every n-th body, starting with body 0, has balls of its own.
  [[nodiscard]] std::uint32_t every() const { return every_; }
  /// Returns balls from random points just inside the surface of a body, or in its box if the surface has no triangles.
  [[nodiscard]] const BallDraws& in_body(std::uint32_t body) const { return in_bodies_[body / every_]; }
  /// Returns balls from points behind vertices of the surface of a body. These balls reach the ends of rods, and the
  /// borders of plates, however small these are. There are no such balls if the surface has no triangles.
  [[nodiscard]] const BallDraws& at_corners(std::uint32_t body) const { return at_corners_[body / every_]; }

 private:
  [[nodiscard]] std::optional<BallDraws::Start> in_box(std::uint32_t body, Random& random) const;
  [[nodiscard]] std::optional<BallDraws::Start> in_boxes(std::size_t k) const;
  [[nodiscard]] std::optional<BallDraws::Start> beside(std::uint32_t body, std::size_t k) const;

  const SolidOracle& solid_;
  Spread boxes_;
  std::uint32_t every_;
  BallDraws in_solid_;
  std::deque<BallDraws> in_bodies_, at_corners_;
};

template <class Counts, class ReachIn>
TouchingBall BallDraws::grown(std::size_t k, double floor, const Counts& counts, const ReachIn& reach_in) const {
  return grown(k, floor, HUGE_VAL, counts, reach_in);
}

template <class Counts, class ReachIn>
TouchingBall BallDraws::grown(std::size_t k, double floor, double most_depth, const Counts& counts,
                              const ReachIn& reach_in) const {
  const std::scoped_lock lock(locks_[k / per_lock]);
  if (!draw(k) || length(list_[k].start->point - list_[k].first) > most_depth) return {};
  Known* const known = shrunk(k, floor);
  if (known == nullptr || !counts(known->ball)) return {};
  const TouchingBall& ball = known->ball;
  const bool fits = ball.is_whole || ball.radius - distance(list_[k], *known) <= reach_in(ball.radius);
  return fits && is_inside(list_[k], *known) ? ball : TouchingBall{};
}

}  // namespace blum::verifier
