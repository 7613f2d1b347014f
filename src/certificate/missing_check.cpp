#include "certificate/missing_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "blum/core/random.hpp"
#include "certificate/angle.hpp"
#include "certificate/maximal_ball.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

constexpr std::size_t most_points_tried = 16'384;
constexpr std::size_t most_points_of_bodies = 32'768;
constexpr std::size_t most_points_of_body = 2'048;
constexpr std::size_t least_points_of_body = 64;

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

/// Balls that are in the middle between two walls.
class BallFinder {
 public:
  BallFinder(const SolidOracle& solid, const Allowances& allowed, double theta, double sought)
      : solid_(solid), allowed_(allowed), sought_(sought), above_theta_(sought - theta) {}

  /// From a random point of a body's box; radius 0 where that gives none.
  [[nodiscard]] TouchingBall in_box(std::uint32_t body, Random& random) const {
    const Box3 box = solid_.box(body);
    const Vec3d share = random.in_cube();
    const Vec3d size = box.upper - box.lower;
    const Vec3d p = box.lower + Vec3d{share.x * size.x, share.y * size.y, share.z * size.z};
    const Location location = solid_.locate(p);
    return location.outside_by > 0 || location.body != body ? TouchingBall{} : grown(p, body);
  }

  /// From a random point of a body: beside its surface, where that has triangles.
  [[nodiscard]] TouchingBall in_body(std::uint32_t body, Random& random) const {
    if (!solid_.has_triangles()) return in_box(body, random);
    const std::optional<Vec3d> p = solid_.beside_surface(body, random);
    return p ? grown(*p, body) : TouchingBall{};
  }

 private:
  /// The surface may reach a little into the ball, because the facets of a round thing are all near at once. On a plane
  /// that reaches by d into a ball of radius r, the closest point is up to acos(1 - d/r) aside from where the ball was
  /// thought to touch it, and the angle is less by as much: d is no more than the step from theta to the sought angle
  /// gives. In a wedge of 164 degrees, 0.1 voxel alone would show 175.
  [[nodiscard]] TouchingBall grown(const Vec3d& p, std::uint32_t body) const {
    constexpr double nearly_whole = 0.1;  // voxels: the facets of round things are all near at once
    TouchingBall ball = grown_ball(solid_, body, p, sought_);
    if (!(ball.radius > 0) || !allowed_.counts(length(ball.first - ball.second), ball.angle)) return {};
    const double reaching_in =
        std::min(nearly_whole * allowed_.voxel, ball.radius * (1 - std::cos(above_theta_ / degrees_per_radian)));
    const bool fits = ball.is_whole || ball.radius - solid_.distance(ball.centre, body) <= reaching_in;
    return fits && solid_.depth(ball.centre, body) > 0 ? ball : TouchingBall{};
  }

  const SolidOracle& solid_;
  const Allowances& allowed_;
  double sought_, above_theta_;
};

/// How far the axis is from the balls that draw(k) gives for each k below `count`.
template <class Draw>
Offsets draw_balls(std::size_t count, const TriangleSearch& search, const Allowances& allowed, const Draw& draw,
                   const Context& context) {
  const auto add = [&](Offsets& offsets, std::size_t k) {
    const TouchingBall ball = draw(k);
    if (!(ball.radius > 0)) return;
    const double near = allowed.missing_at(ball.radius);
    offsets.add(search.nearest(ball.centre).distance, near, near, near, ball.centre);
  };
  return gathered_offsets(count, "looking for what is missing", add, context);
}

}  // namespace

FoundBalls find_balls(const MedialView& axis, const KnownSolid& solid, const Allowances& allowed, double theta,
                      double sought, const Context& context) {
  const auto body_count = static_cast<std::uint32_t>(solid.bodies.size());
  FoundBalls found{{}, std::vector<Offsets>(body_count)};
  if (!(sought > theta)) return found;  // at 180 degrees there is nothing more to see
  Spread boxes;
  for (std::uint32_t b = 0; b < body_count; ++b) {
    const Vec3d size = solid.solid->box(b).size();
    boxes.add(size.x * size.y * size.z, b);
  }
  if (!(boxes.total() > 0)) return found;
  const TriangleSearch search = search_of(axis, context);
  const BallFinder finder(*solid.solid, allowed, theta, sought);
  const auto in_solid = [&](std::size_t k) {
    Random random(0xb1a5ULL + k);
    return finder.in_box(boxes.at(random.uniform()), random);
  };
  found.all = draw_balls(most_points_tried, search, allowed, in_solid, context);
  // Of a small body that is all that a coarse grid has for certain.
  const BallFinder steep_finder(*solid.solid, allowed, theta, std::max(sought, Allowances::steep));
  const std::size_t each = std::clamp(most_points_of_bodies / body_count, least_points_of_body, most_points_of_body);
  const std::size_t every = (each * body_count + most_points_of_bodies - 1) / most_points_of_bodies;
  for (std::uint32_t b = 0; b < body_count; b += static_cast<std::uint32_t>(every)) {
    const auto in_body = [&](std::size_t k) {
      Random random(0xb0d1ULL + k);
      return steep_finder.in_body(b, random);
    };
    found.bodies[b] = draw_balls(each, search, allowed, in_body, context);
  }
  return found;
}

}  // namespace blum::verifier
