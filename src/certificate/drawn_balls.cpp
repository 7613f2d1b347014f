#include "certificate/drawn_balls.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "blum/core/random.hpp"
#include "certificate/angle.hpp"

namespace blum::verifier {
namespace {

constexpr std::size_t most_points_tried = 16'384;
constexpr std::size_t most_points_of_bodies = 32'768;
constexpr std::size_t most_points_of_body = 2'048;
constexpr std::size_t least_points_of_body = 64;

std::size_t points_of_each(std::uint32_t body_count) {
  return std::clamp(most_points_of_bodies / body_count, least_points_of_body, most_points_of_body);
}

/// Returns all bodies, to be sampled in proportion to the volumes of their boxes.
Spread boxes_of(const SolidOracle& solid, std::uint32_t body_count) {
  Spread boxes;
  for (std::uint32_t b = 0; b < body_count; ++b) {
    const Vec3d size = solid.box(b).size();
    boxes.add(size.x * size.y * size.z, b);
  }
  return boxes;
}

}  // namespace

ShrinkingBall::ShrinkingBall(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                             double more)
    : body_(body), nothing_(1e-9 * solid.diagonal(body)), first_(first) {
  const double depth = length(p - first);
  has_ended_ = !(depth > nothing_);
  if (has_ended_) return;
  along_ = (p - first) / depth;
  // Grows the ball until the surface reaches into it.
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

TouchingBall grown_ball_from_near(const SolidOracle& solid, std::uint32_t body, const Vec3d& p, const Vec3d& first,
                                  double floor, double near) {
  const TouchingBall ball = grown_ball(solid, body, p, first, floor, near);
  return ball.radius > 0 ? ball : grown_ball(solid, body, p, first, floor);
}

double distance_to_middle(const Vec3d& p, const TouchingBall& ball) {
  return length(p - ball.centre) * std::sin(0.5 * ball.angle / degrees_per_radian);
}

BallDraws::BallDraws(const SolidOracle& solid, std::size_t count, std::function<std::optional<Start>(std::size_t)> draw)
    : solid_(solid), draw_(std::move(draw)), list_(count), locks_(count / per_lock + 1) {}

bool BallDraws::draw(std::size_t k) const {
  Shrinking& from = list_[k];
  if (!from.is_drawn) {
    from.start = draw_(k);
    if (from.start) from.first = solid_.closest_point(from.start->point, from.start->body);
    from.is_drawn = true;
  }
  return from.start.has_value();
}

BallDraws::Known* BallDraws::shrunk(std::size_t k, double floor) const {
  Shrinking& from = list_[k];
  if (!from.next) from.next.emplace(solid_, from.start->body, from.start->point, from.first, 0);
  const auto end =
      std::find_if(from.balls.begin(), from.balls.end(), [&](const Known& known) { return known.ball.angle < floor; });
  if (end != from.balls.end()) return end == from.balls.begin() ? nullptr : &*std::prev(end);
  TouchingBall ball;
  while (from.next->shrink(solid_, floor, ball)) from.balls.push_back({ball, {}, {}});
  return from.balls.empty() ? nullptr : &from.balls.back();
}

double BallDraws::distance(const Shrinking& from, Known& known) const {
  if (!known.distance) known.distance = solid_.distance(known.ball.centre, from.start->body);
  return *known.distance;
}

bool BallDraws::is_inside(const Shrinking& from, Known& known) const {
  if (!known.is_inside) known.is_inside = solid_.depth(known.ball.centre, from.start->body) > 0;
  return *known.is_inside;
}

DrawnBalls::DrawnBalls(const SolidOracle& solid, std::uint32_t body_count)
    : solid_(solid),
      boxes_(boxes_of(solid, body_count)),
      every_(static_cast<std::uint32_t>((points_of_each(body_count) * body_count + most_points_of_bodies - 1) /
                                        most_points_of_bodies)),
      in_solid_(solid, boxes_.total() > 0 ? most_points_tried : 0, [this](std::size_t k) { return in_boxes(k); }) {
  if (!(boxes_.total() > 0)) return;
  for (std::uint32_t b = 0; b < body_count; b += every_) {
    in_bodies_.emplace_back(solid, points_of_each(body_count), [this, b](std::size_t k) { return beside(b, k); });
    const std::size_t corners = solid.corners(b);
    const std::size_t count = std::min(corners, points_of_each(body_count));
    at_corners_.emplace_back(solid, count, [this, b, corners, count](std::size_t k) -> std::optional<BallDraws::Start> {
      const std::optional<Vec3d> p = solid_.behind_corner(b, k * corners / count);
      return p ? std::optional(BallDraws::Start{*p, b}) : std::nullopt;
    });
  }
}

std::optional<BallDraws::Start> DrawnBalls::in_box(std::uint32_t body, Random& random) const {
  const Box3 box = solid_.box(body);
  const Vec3d share = random.in_cube();
  const Vec3d size = box.upper - box.lower;
  const Vec3d p = box.lower + Vec3d{share.x * size.x, share.y * size.y, share.z * size.z};
  const Location location = solid_.locate(p);
  if (location.outside_by > 0 || location.body != body) return std::nullopt;
  return BallDraws::Start{p, body};
}

std::optional<BallDraws::Start> DrawnBalls::in_boxes(std::size_t k) const {
  Random random(0xb1a5ULL + k);
  return in_box(boxes_.at(random.uniform()), random);
}

std::optional<BallDraws::Start> DrawnBalls::beside(std::uint32_t body, std::size_t k) const {
  Random random(0xb0d1ULL + k);
  if (!solid_.has_triangles()) return in_box(body, random);
  const std::optional<Vec3d> p = solid_.beside_surface(body, random);
  return p ? std::optional(BallDraws::Start{*p, body}) : std::nullopt;
}

}  // namespace blum::verifier
