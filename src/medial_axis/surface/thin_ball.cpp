#include "medial_axis/surface/thin_ball.hpp"

#include <algorithm>
#include <cmath>

#include "medial_axis/surface/governors.hpp"

namespace blum::detail {
namespace {

constexpr int most_steps = 24;
/// Degrees: two footprints of a ball count as one if the angle between them at the ball's centre is smaller.
constexpr double least_angle = 1;
/// The point opposite of a footprint is the closest point to a query beyond the centre of the ball. These are the
/// distance of the query from the centre, and the largest excess of the point's distance, as shares of the radius.
constexpr double opposite_step = 0.3;
constexpr double facets = 0.05;
constexpr double rounding = 1e-9;
/// Number of points tried on a ray behind the surface. Each is 3/4 as deep as the one before, down to 1/2400 of the
/// first depth.
constexpr int most_depths = 28;
constexpr int most_climbs = 3;
/// The same if balls of a larger angle than `opposite` are looked for. They are only a little larger.
constexpr int most_steep_climbs = 8;
/// A ball counts as larger if its radius is at least this many times that of the ball before. If the walls of the ball
/// before are already opposite, `larger_opposite` applies.
constexpr double larger = 1.01;
constexpr double larger_opposite = 1.0001;
/// Degrees: if the angle between two footprints exceeds this, the walls are opposite, and no ball next to it is larger.
constexpr double opposite = 150;

Footprint footprint_of(const NearestPoint& at) {
  return {at.point, at.element, 7};
}

/// Compares a ball with the point of the surface opposite of its footprint. In a round part of many facets, the
/// footprints found on the way to the ball may all be on one side.
void look_opposite(const Surface& surface, ThinBall& ball) {
  const double radius = ball.nearest.distance;
  const Vec3d beyond = ball.centre + (ball.centre - ball.nearest.point) * opposite_step;
  const NearestPoint found = surface.nearest(beyond, footprint_of(ball.other));
  const Footprint foot = surface.follow(footprint_of(found), ball.centre, radius);
  const NearestPoint across{foot.point, length(foot.point - ball.centre), surface.site_of(foot), foot.element};
  if (across.distance > radius * (1 + facets)) return;
  const double angle = angle_at(ball.centre, ball.nearest.point, across.point);
  ball.angle_across = std::max(ball.angle_across, angle);
  if (across.distance > radius * (1 + rounding) || angle <= ball.angle) return;
  ball.other = across;
  ball.angle = angle;
}

}  // namespace

std::optional<ThinBall> ball_touching(const Surface& surface, const NearestPoint& touched, const Vec3d& inside,
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
      ball.angle_across = ball.angle;
      look_opposite(surface, ball);
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

namespace {

/// Deepest of some points on a ray into the solid.
struct Deepest {
  Vec3d point;
  NearestPoint nearest;  ///< its distance is 0 if no point is inside
};

/// @param own  radius of a ball around `from`. Only points count whose largest inner ball overlaps it.
Deepest deepest_along(const Surface& surface, const Vec3d& from, const Vec3d& direction, double furthest,
                      const NearestPoint& near, double own = HUGE_VAL) {
  Deepest best;
  for (int n = 0; n < most_depths; ++n, furthest *= 0.75) {
    const Vec3d x = from + direction * furthest;
    const NearestPoint nearest = surface.nearest(x, footprint_of(near));
    if (nearest.distance <= best.nearest.distance || furthest > own + nearest.distance) continue;
    if (!surface.is_inside(x, nearest)) continue;
    best = {x, nearest};
  }
  return best;
}

/// Returns a larger ball next to a ball in a corner of a part of the solid. The centre moves away from both walls.
/// @param overlaps  true: the balls around both centres overlap, so both are in one component of the solid.
/// @param enough    degrees: the result is nullopt if the ball's angle exceeds this.
std::optional<ThinBall> climb(const Surface& surface, const ThinBall& ball, double radius, bool overlaps,
                              double enough) {
  if (ball.angle_across > enough) return std::nullopt;
  const double own = ball.nearest.distance;
  const Vec3d away = (ball.centre - ball.nearest.point) / own + (ball.centre - ball.other.point) / own;
  const double size = length(away);
  if (!(size > 0)) return std::nullopt;
  const Deepest deepest =
      deepest_along(surface, ball.centre, away / size, radius, ball.nearest, overlaps ? own : HUGE_VAL);
  if (deepest.nearest.distance < (ball.angle_across > opposite ? larger_opposite : larger) * own) return std::nullopt;
  return ball_touching(surface, deepest.nearest, deepest.point, radius);
}

/// Follows larger balls, starting from a ball.
std::optional<ThinBall> largest_from(const Surface& surface, std::optional<ThinBall> ball, double radius, bool overlaps,
                                     double enough = opposite) {
  const int most = enough > opposite ? most_steep_climbs : most_climbs;
  for (int n = 0; ball && n < most; ++n) {
    const std::optional<ThinBall> next = climb(surface, *ball, radius, overlaps, enough);
    if (!next || next->nearest.distance <= ball->nearest.distance) break;
    ball = next;
  }
  return ball;
}

}  // namespace

std::optional<ThinBall> ball_around(const Surface& surface, const NearestPoint& nearest, const Vec3d& inside,
                                    double radius, double enough) {
  const std::optional<ThinBall> first = ball_touching(surface, nearest, inside, radius);
  return largest_from(surface, first, radius, true, std::max(opposite, enough));
}

std::optional<ThinBall> thin_ball_behind(const Surface& surface, const NearestPoint& touched, const Vec3d& beyond,
                                         double radius) {
  if (!(touched.distance > 0)) return std::nullopt;
  const Vec3d inwards = (touched.point - beyond) / touched.distance;
  const Deepest deepest = deepest_along(surface, touched.point, inwards, radius, touched);
  if (deepest.nearest.distance == 0) return std::nullopt;
  return largest_from(surface, ball_touching(surface, deepest.nearest, deepest.point, radius), radius, false);
}

}  // namespace blum::detail
