#include "certificate/missing_check.hpp"

#include <algorithm>
#include <cmath>

#include "certificate/angle.hpp"
#include "certificate/drawn_balls.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

/// The cells of an axis to look for the closest of.
TriangleSearch search_of(const MedialView& axis, const Context& context) {
  TriangleMesh cells;
  cells.vertices.assign(axis.positions.begin(), axis.positions.end());
  std::vector<bool> is_named(axis.positions.size(), false);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t v : {a, b, c}) is_named[v] = true;
    if (is_finite(cells.vertices[a]) && is_finite(cells.vertices[b]) && is_finite(cells.vertices[c])) {
      cells.triangles.push_back({a, b, c});
    }
  };
  for (const auto& [a, b, c] : axis.triangles) add(a, b, c);
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    if (axis.edge_role(e) == MedialRole::curve) add(axis.edges[e][0], axis.edges[e][1], axis.edges[e][1]);
  }
  for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
    if (!is_named[v]) add(v, v, v);
  }
  return {cells, {}, context};
}

/// Which balls count as being in the middle between two walls.
class BallJudge {
 public:
  BallJudge(const Allowances& allowed, double theta, double sought)
      : allowed_(allowed), sought_(sought), above_theta_(sought - theta) {}

  /// The k-th ball; radius 0 where that is none.
  [[nodiscard]] TouchingBall ball(const BallDraws& draws, std::size_t k) const {
    return draws.grown(
        k, sought_,
        [&](const TouchingBall& ball) { return allowed_.counts(length(ball.first - ball.second), ball.angle); },
        [&](double radius) { return reach_in(radius); });
  }

 private:
  /// The surface may reach a little into the ball, because the facets of a round thing are all near at once. On a plane
  /// that reaches by d into a ball of radius r, the closest point is up to acos(1 - d/r) aside from where the ball was
  /// thought to touch it, and the angle is less by as much: d is no more than the step from theta to the sought angle
  /// gives. In a wedge of 164 degrees, 0.1 voxel alone would show 175.
  [[nodiscard]] double reach_in(double radius) const {
    constexpr double nearly_whole = 0.1;  // voxels: the facets of round things are all near at once
    return std::min(nearly_whole * allowed_.voxel, radius * (1 - std::cos(above_theta_ / degrees_per_radian)));
  }

  const Allowances& allowed_;
  double sought_, above_theta_;
};

/// How far the axis is from the balls.
Offsets offsets_of_balls(const BallDraws& draws, const BallJudge& judge, const TriangleSearch& search,
                         const Allowances& allowed, const Context& context) {
  const auto add = [&](Offsets& offsets, std::size_t k) {
    const TouchingBall ball = judge.ball(draws, k);
    if (!(ball.radius > 0)) return;
    const double near = allowed.missing_at(ball.radius);
    // What is neither far nor the furthest so far need not be known.
    const double enough = std::min(near, offsets.furthest);
    offsets.add(search.distance_above(ball.centre, enough, no_group), near, near, near, ball.centre);
  };
  return gathered_offsets(draws.size(), "looking for what is missing", add, context);
}

}  // namespace

FoundBalls find_balls(const MedialView& axis, const KnownSolid& solid, const Allowances& allowed, double theta,
                      double sought, const Context& context) {
  const auto body_count = static_cast<std::uint32_t>(solid.bodies.size());
  FoundBalls found{{}, std::vector<Offsets>(body_count)};
  if (!(sought > theta)) return found;  // at 180 degrees there is nothing more to see
  const DrawnBalls& drawn = solid.drawn_balls();
  if (drawn.in_solid().size() == 0) return found;
  const TriangleSearch search = search_of(axis, context);
  const BallJudge judge(allowed, theta, sought);
  found.all = offsets_of_balls(drawn.in_solid(), judge, search, allowed, context);
  // Of a small body that is all that a coarse grid has for certain.
  const BallJudge steep_judge(allowed, theta, std::max(sought, Allowances::steep));
  for (std::uint32_t b = 0; b < body_count; b += drawn.every()) {
    found.bodies[b] = offsets_of_balls(drawn.in_body(b), steep_judge, search, allowed, context);
  }
  return found;
}

}  // namespace blum::verifier
