#include "medial_axis/fit/balance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "medial_axis/surface/governors.hpp"

namespace blum::detail {
namespace {

constexpr int most_steps = 24;
constexpr double equal_distances = 1e-9;  ///< voxels
/// Voxels: a wall gets no equation if its distance exceeds that of the closest wall by more than this.
constexpr double nearly_as_close = 3;
/// Two equations are treated as dependent if the squared sine of the angle between their slopes is below
/// `least_sine_squared`. Three equations are treated as dependent if the volume spanned by their unit slopes is below
/// `least_volume`.
constexpr double least_sine_squared = 0.02;
constexpr double least_volume = 0.1;

/// Equation of a wall: after a move of the point with dot(slope, move) = difference, the wall is as close as the
/// closest wall.
struct Equation {
  Vec3d slope;
  double difference = 0;
  std::size_t wall = 0;
};

/// Shortest move that solves one to three equations, its squared length, and the walls of these equations.
struct Move {
  Vec3d by;
  double squared = std::numeric_limits<double>::infinity();
  std::array<std::size_t, 3> walls{};
};

Vec3d solve(const Equation& e) {
  return e.slope * (e.difference / squared_length(e.slope));
}

std::optional<Vec3d> solve(const Equation& e, const Equation& f) {
  const double a = squared_length(e.slope);
  const double b = dot(e.slope, f.slope);
  const double c = squared_length(f.slope);
  const double determinant = a * c - b * b;
  if (determinant < least_sine_squared * a * c) return std::nullopt;
  return e.slope * ((c * e.difference - b * f.difference) / determinant) +
         f.slope * ((a * f.difference - b * e.difference) / determinant);
}

std::optional<Vec3d> solve(const Equation& e, const Equation& f, const Equation& g) {
  const Vec3d fg = cross(f.slope, g.slope);
  const double volume = dot(e.slope, fg);
  const double scale = std::sqrt(squared_length(e.slope) * squared_length(f.slope) * squared_length(g.slope));
  if (std::abs(volume) < least_volume * scale) return std::nullopt;
  return (fg * e.difference + cross(g.slope, e.slope) * f.difference + cross(e.slope, f.slope) * g.difference) / volume;
}

/// Returns the shortest of the moves that solve `count` equations, over all choices of `count` equations.
Move shortest(std::span<const Equation> equations, std::size_t count) {
  Move best;
  const auto offer = [&](const std::optional<Vec3d>& move, std::array<std::size_t, 3> walls) {
    if (!move || squared_length(*move) >= best.squared) return;
    best = {*move, squared_length(*move), walls};
  };
  for (std::size_t i = 0; i < equations.size(); ++i) {
    const Equation& e = equations[i];
    if (count == 1) offer(solve(e), {e.wall});
    for (std::size_t j = i + 1; count > 1 && j < equations.size(); ++j) {
      const Equation& f = equations[j];
      if (count == 2) offer(solve(e, f), {e.wall, f.wall});
      for (std::size_t k = j + 1; count > 2 && k < equations.size(); ++k) {
        offer(solve(e, f, equations[k]), {e.wall, f.wall, equations[k].wall});
      }
    }
  }
  return best;
}

/// Returns the vertex at a point x. Its footprints are the two at the largest angle as seen from x.
AxisVertex vertex_at(const Surface& surface, const Vec3d& x, const NearestPoint& nearest,
                     std::span<const Footprint> feet) {
  AxisVertex vertex = vertex_of_one_wall(x, nearest);
  const auto offer = [&](const Vec3d& p, SiteId p_site, std::uint32_t p_element, const Footprint& q) {
    const double angle = angle_at(x, p, q.point);
    if (angle <= vertex.separation_angle) return;
    vertex.footprints = {p, q.point};
    vertex.sites = {p_site, surface.site_of(q)};
    vertex.elements = {p_element, q.element};
    vertex.separation_angle = angle;
  };
  for (std::size_t i = 0; i < feet.size(); ++i) {
    offer(nearest.point, nearest.site, nearest.element, feet[i]);
    for (std::size_t j = i + 1; j < feet.size(); ++j) {
      offer(feet[i].point, surface.site_of(feet[i]), feet[i].element, feet[j]);
    }
  }
  return vertex;
}

/// Returns the equations of walls that are nearly as close to x as the closest wall.
std::vector<Equation> equations_of(const Walls& walls, const Vec3d& x, double voxel) {
  std::vector<Equation> equations;
  const Walls::Wall& closest = walls.closest();
  const Vec3d towards = (x - closest.foot.point) / closest.distance;
  for (std::size_t w = 0; w < walls.all().size(); ++w) {
    const Walls::Wall& wall = walls.all()[w];
    const double difference = wall.distance - closest.distance;
    if (difference > nearly_as_close * voxel) continue;
    const Vec3d slope = towards - (x - wall.foot.point) / wall.distance;
    if (squared_length(slope) >= two_walls) equations.push_back({slope, difference, w});
  }
  return equations;
}

}  // namespace

std::optional<AxisVertex> balance(const Surface& surface, const Vec3d& start, std::span<const Footprint> feet,
                                  std::size_t walls, const BalanceLimits& limits) {
  Walls around(surface, 4 * limits.voxel);
  for (const Footprint& foot : feet) {
    if (!around.is_full()) around.add(foot, {});
  }
  Vec3d x = start;
  for (int step = 0; step < most_steps; ++step) {
    around.follow_to(x);
    if (around.touch()) return std::nullopt;
    const Move move = shortest(equations_of(around, x, limits.voxel), walls - 1);
    if (!(move.squared < std::numeric_limits<double>::infinity())) return std::nullopt;
    const double closest = around.closest().distance;
    if (move.squared > equal_distances * equal_distances * limits.voxel * limits.voxel) {
      x += move.by;
      if (squared_length(x - start) > limits.most_moved * limits.most_moved) return std::nullopt;
      continue;
    }
    const NearestPoint nearest = surface.nearest(x, around.closest().foot);
    if (nearest.distance < closest - 1e-7 * limits.voxel) {
      if (!limits.may_add || around.is_full()) return std::nullopt;
      around.add({nearest.point, nearest.element, 7}, {});
      continue;
    }
    if (!surface.is_inside(x, nearest)) return std::nullopt;
    std::vector<Footprint> meet;
    const double limit = nearest.distance + 1e-6 * limits.voxel + 1e-9 * nearest.distance;
    for (const Walls::Wall& wall : around.all()) {
      if (wall.distance <= limit) meet.push_back(wall.foot);
    }
    return vertex_at(surface, x, nearest, meet);
  }
  return std::nullopt;
}

}  // namespace blum::detail
