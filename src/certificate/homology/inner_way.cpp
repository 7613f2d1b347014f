#include "certificate/homology/inner_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "certificate/segments.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

constexpr int most_moves = 32;

/// The best of some directions from a point, by steps that become longer.
/// @param prefers  whether a point is better than others that are as deep.
template <class Prefers>
std::optional<Vec3d> best_step(const SolidOracle& solid, std::uint32_t body, const Vec3d& point, double step,
                               std::span<const Vec3d> directions, const Prefers& prefers) {
  constexpr double deep_enough = 1.0 / 8;
  std::optional<Vec3d> deepest;
  double depth_of_deepest = 0;
  for (const double longer : {1.0, 4.0, 16.0}) {
    std::optional<Vec3d> best;
    double depth_of_best = deep_enough * longer * step;
    for (const Vec3d& direction : directions) {
      const Vec3d moved = point + direction * (longer * step);
      const double depth = solid.depth(moved, body);
      if (depth > depth_of_deepest) std::tie(deepest, depth_of_deepest) = std::pair(moved, depth);
      if (depth > depth_of_best && prefers(moved)) std::tie(best, depth_of_best) = std::pair(moved, depth);
    }
    if (best) return best;
  }
  return deepest;
}

/// A point beside one of the segment from a to b.
std::optional<Vec3d> moved_aside(const SolidOracle& solid, std::uint32_t body, const Vec3d& a, const Vec3d& b,
                                 double along, double step) {
  constexpr std::size_t count = 12;
  constexpr double turn = 0.1;  // from directions along axes
  const ProbeLine line = line_between(a, b);
  std::array<Vec3d, count> directions;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = turn + 2 * std::numbers::pi * static_cast<double>(k) / count;
    directions[k] = line.across * std::cos(angle) + line.up * std::sin(angle);
  }
  // Across a gap narrower than the step a point is inside, too.
  const auto is_beside = [&](const Vec3d& p) { return solid.is_clear(a, p, body) && solid.is_clear(p, b, body); };
  return best_step(solid, body, a + (b - a) * along, step, directions, is_beside);
}

/// Adds what lies between a and b, and b.
bool lead_between(const SolidOracle& solid, std::uint32_t body, const Curtains& curtains, double step, const Vec3d& a,
                  const Vec3d& b, int& moves_left, Way& way) {
  const auto touched = curtains.first_touched(a, b, body);
  if (!touched) {
    way.push_back(b);
    return true;
  }
  if (moves_left-- <= 0) return false;
  const auto middle = moved_aside(solid, body, a, b, closest_along({a, b}, *touched), step);
  return middle && lead_between(solid, body, curtains, step, a, *middle, moves_left, way) &&
         lead_between(solid, body, curtains, step, *middle, b, moves_left, way);
}

}  // namespace

std::optional<Vec3d> moved_inside(const SolidOracle& solid, std::uint32_t body, const Vec3d& point, double step) {
  std::vector<Vec3d> directions;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const ProbeLine line = line_through(point, k);
    directions.insert(directions.end(), {line.along, -line.along});
  }
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    directions.insert(directions.end(), {axis, -axis});
  }
  return best_step(solid, body, point, step, directions, [](const Vec3d&) { return true; });
}

bool lead_inside(const SolidOracle& solid, std::uint32_t body, const Curtains& curtains, double step, Way& way) {
  for (std::size_t k = 1; k + 1 < way.size(); ++k) {
    if (solid.depth(way[k], body) >= step) continue;
    way[k] = moved_inside(solid, body, way[k], step).value_or(way[k]);
  }
  int moves_left = most_moves;
  Way led{way.front()};
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    if (!lead_between(solid, body, curtains, step, way[k], way[k + 1], moves_left, led)) return false;
  }
  way = std::move(led);
  return true;
}

}  // namespace blum::verifier
