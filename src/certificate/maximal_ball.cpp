#include "certificate/maximal_ball.hpp"

#include <algorithm>
#include <cmath>

#include "certificate/angle.hpp"

namespace blum::verifier {

TouchingBall grown_ball(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, double floor, double more) {
  constexpr int most_steps = 64;
  const double diagonal = solid.diagonal(body);
  const double nothing = 1e-9 * diagonal;
  TouchingBall ball;
  ball.first = solid.closest_point(p, body);
  const double depth = length(p - ball.first);
  if (!(depth > nothing)) return ball;
  const Vec3d along = (p - ball.first) / depth;
  // Outwards, until a ball reaches over the surface.
  Vec3d other;
  bool reaches_over = false;
  double radius = more > 0 ? depth + more : 2 * depth;
  for (;; radius *= 2) {
    other = solid.closest_point_within(ball.first + along * radius, radius, body);
    reaches_over = length(ball.first + along * radius - other) < radius - nothing;
    if (reaches_over || radius > 2 * diagonal) break;
  }
  for (int step = 0; reaches_over && step < most_steps; ++step) {
    const Vec3d apart = other - ball.first;
    const double next = squared_length(apart) / (2 * dot(apart, along));
    if (!(next > 0) || !(next < radius)) break;
    const Vec3d centre = ball.first + along * next;
    const double angle = degrees_between(ball.first - centre, other - centre);
    if (angle < floor) break;
    ball.centre = centre;
    ball.radius = radius = next;
    ball.second = other;
    ball.angle = angle;
    other = solid.closest_point_within(centre, radius, body);
    if (length(centre - other) >= radius - nothing) {
      ball.is_whole = true;
      break;
    }
  }
  return ball;
}

double distance_to_middle(const Vec3d& p, const TouchingBall& ball) {
  return length(p - ball.centre) * std::sin(0.5 * ball.angle / degrees_per_radian);
}

}  // namespace blum::verifier
