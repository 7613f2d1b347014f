#include "medial_axis/surface/thin_ball.hpp"

#include <algorithm>

#include "medial_axis/surface/governors.hpp"

namespace blum::detail {
namespace {

constexpr int most_steps = 24;
/// Degrees: two footprints of a ball count as one if the angle between them at the ball's centre is smaller.
constexpr double least_angle = 1;
/// Number of points tried on a ray behind the surface. Each is 3/4 as deep as the one before, down to 1/2400 of the
/// first depth.
constexpr int most_depths = 28;
constexpr int most_climbs = 3;
/// Least length of the sum of the unit directions from both walls to the centre. If it is shorter, the angle between
/// the footprints is above 150 degrees: the walls are opposite.
constexpr double least_slope = 0.5;

Footprint footprint_of(const NearestPoint& at) {
  return {at.point, at.element, 7};
}

/// Returns the largest inner ball that touches the surface at `touched`, the closest point to the point `inside`.
std::optional<ThinBall> touching_ball(const Surface& surface, const NearestPoint& touched, const Vec3d& inside,
                                      double radius) {
  const Vec3d inwards = (inside - touched.point) / touched.distance;
  NearestPoint other = touched;
  for (int step = 0; step < most_steps; ++step) {
    const Vec3d x = touched.point + inwards * radius;
    const NearestPoint nearest = surface.nearest(x, footprint_of(other));
    if (nearest.distance >= radius * (1 - 1e-10)) {
      if (step == 0 || !surface.is_inside(x, nearest)) return std::nullopt;
      ThinBall ball{x, nearest, nearest, 0};
      for (const NearestPoint& wall : {touched, other}) {
        const double angle = angle_at(x, nearest.point, wall.point);
        if (angle <= std::max(ball.angle, least_angle)) continue;
        ball.other = wall;
        ball.angle = angle;
      }
      return ball;
    }
    const Vec3d across = nearest.point - touched.point;
    const double along = dot(across, inwards);
    if (!(along > 0)) return std::nullopt;
    radius = squared_length(across) / (2 * along);
    other = nearest;
  }
  return std::nullopt;
}

/// Deepest of some points on a ray into the solid.
struct Deepest {
  Vec3d point;
  NearestPoint nearest;  ///< its distance is 0 if no point is inside
};

Deepest deepest_along(const Surface& surface, const Vec3d& from, const Vec3d& direction, double furthest,
                      const NearestPoint& near) {
  Deepest best;
  for (int n = 0; n < most_depths; ++n, furthest *= 0.75) {
    const Vec3d x = from + direction * furthest;
    const NearestPoint nearest = surface.nearest(x, footprint_of(near));
    if (nearest.distance <= best.nearest.distance || !surface.is_inside(x, nearest)) continue;
    best = {x, nearest};
  }
  return best;
}

/// Returns a larger ball next to a ball in a corner of a part of the solid. The centre moves away from both walls.
std::optional<ThinBall> climb(const Surface& surface, const ThinBall& ball, double radius) {
  const double own = ball.nearest.distance;
  const Vec3d away = (ball.centre - ball.nearest.point) / own + (ball.centre - ball.other.point) / own;
  const double size = length(away);
  if (!(size > least_slope)) return std::nullopt;
  const Deepest deepest = deepest_along(surface, ball.centre, away / size, radius, ball.nearest);
  if (deepest.nearest.distance < 1.01 * own) return std::nullopt;
  return touching_ball(surface, deepest.nearest, deepest.point, radius);
}

}  // namespace

std::optional<ThinBall> ball_around(const Surface& surface, const NearestPoint& nearest, const Vec3d& inside,
                                    double radius) {
  return touching_ball(surface, nearest, inside, radius);
}

std::optional<ThinBall> thin_ball_behind(const Surface& surface, const NearestPoint& touched, const Vec3d& beyond,
                                         double radius) {
  if (!(touched.distance > 0)) return std::nullopt;
  const Vec3d inwards = (touched.point - beyond) / touched.distance;
  const Deepest deepest = deepest_along(surface, touched.point, inwards, radius, touched);
  if (deepest.nearest.distance == 0) return std::nullopt;
  std::optional<ThinBall> ball = touching_ball(surface, deepest.nearest, deepest.point, radius);
  for (int n = 0; ball && n < most_climbs; ++n) {
    const std::optional<ThinBall> larger = climb(surface, *ball, radius);
    if (!larger || larger->nearest.distance <= ball->nearest.distance) break;
    ball = larger;
  }
  return ball;
}

}  // namespace blum::detail
