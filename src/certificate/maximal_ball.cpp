#include "certificate/maximal_ball.hpp"

#include <algorithm>
#include <cmath>

#include "certificate/angle.hpp"

namespace blum::verifier {

ShrinkingBall::ShrinkingBall(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                             double more)
    : body_(body), nothing_(1e-9 * solid.diagonal(body)), first_(first) {
  const double depth = length(p - first);
  has_ended_ = !(depth > nothing_);
  if (has_ended_) return;
  along_ = (p - first) / depth;
  // Outwards, until a ball reaches over the surface.
  const double furthest = 2 * solid.diagonal(body);
  bool reaches_over = false;
  radius_ = more > 0 ? depth + more : 2 * depth;
  for (;; radius_ *= 2) {
    other_ = solid.closest_point_within(first + along_ * radius_, radius_, body);
    reaches_over = length(first + along_ * radius_ - other_) < radius_ - nothing_;
    if (reaches_over || radius_ > furthest) break;
  }
  has_ended_ = !reaches_over;
}

bool ShrinkingBall::shrink(const SolidOracle& solid, double floor, TouchingBall& ball) {
  constexpr int most_steps = 64;
  if (has_ended_ || steps_ >= most_steps) return false;
  const Vec3d apart = other_ - first_;
  const double next = squared_length(apart) / (2 * dot(apart, along_));
  if (!(next > 0) || !(next < radius_)) {
    has_ended_ = true;
    return false;
  }
  const Vec3d centre = first_ + along_ * next;
  const double angle = degrees_between(first_ - centre, other_ - centre);
  if (angle < floor) return false;
  ++steps_;
  radius_ = next;
  ball = {centre, next, first_, other_, angle, false};
  other_ = solid.closest_point_within(centre, next, body_);
  has_ended_ = ball.is_whole = length(centre - other_) >= next - nothing_;
  return true;
}

TouchingBall grown_ball(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first, double floor,
                        double more) {
  TouchingBall ball;
  ShrinkingBall shrinking(solid, body, p, first, more);
  while (shrinking.shrink(solid, floor, ball)) {
  }
  return ball;
}

double distance_to_middle(const Vec3d& p, const TouchingBall& ball) {
  return length(p - ball.centre) * std::sin(0.5 * ball.angle / degrees_per_radian);
}

}  // namespace blum::verifier
