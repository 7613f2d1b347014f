#include "proximity/directions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace blum::detail {
namespace {

constexpr std::size_t direction_count = 10;

/// How far a point is along each direction: six diagonals of faces of a cube, then its four own.
using Heights = std::array<double, direction_count>;

Heights heights_of(const Vec3d& p) {
  return {p.x + p.y, p.x - p.y,       p.x + p.z,       p.x - p.z,       p.y + p.z,
          p.y - p.z, p.x + p.y + p.z, p.x + p.y - p.z, p.x - p.y + p.z, p.x - p.y - p.z};
}

/// More than what the difference of two heights is rounded by: each is a sum of at most three numbers.
double rounding_of(const std::array<Vec3d, 4>& points) {
  double most = 0;
  for (const Vec3d& p : points) most = std::max({most, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return 0x1p-48 * most;
}

/// Along each direction, how far the first points are above the rest, and below; negative where they are not.
struct Gaps {
  Heights above;
  Heights below;
};

Gaps gaps_of(const std::array<Vec3d, 4>& points, std::size_t first_count) {
  Heights least_first = heights_of(points[0]);
  Heights most_first = least_first;
  Heights least_rest = heights_of(points[3]);
  Heights most_rest = least_rest;
  const auto widen = [](const Vec3d& p, Heights& least, Heights& most) {
    const Heights heights = heights_of(p);
    for (std::size_t k = 0; k < direction_count; ++k) {
      least[k] = std::min(least[k], heights[k]);
      most[k] = std::max(most[k], heights[k]);
    }
  };
  for (std::size_t v = 1; v < first_count; ++v) widen(points[v], least_first, most_first);
  for (std::size_t v = first_count; v < 3; ++v) widen(points[v], least_rest, most_rest);
  Gaps gaps;
  for (std::size_t k = 0; k < direction_count; ++k) {
    gaps.above[k] = least_first[k] - most_rest[k];
    gaps.below[k] = least_rest[k] - most_first[k];
  }
  return gaps;
}

}  // namespace

bool are_apart(const FourMovingPoints& points, std::size_t first_count, double distance) {
  const Gaps start = gaps_of(points.start, first_count);
  const Gaps end = gaps_of(points.end, first_count);
  constexpr std::size_t of_faces = 6;  // directions of length sqrt(2); the others are sqrt(3) long
  double widest = -1;
  for (std::size_t k = 0; k < direction_count; ++k) {
    const double gap = std::max(std::min(start.above[k], end.above[k]), std::min(start.below[k], end.below[k]));
    widest = std::max(widest, gap - distance * (k < of_faces ? 1.4143 : 1.7321));
  }
  return widest > rounding_of(points.start) + rounding_of(points.end) + 0x1p-50 * distance;
}

}  // namespace blum::detail
