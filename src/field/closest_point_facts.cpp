// What follows from a closest point: directions and weights.
#include <algorithm>
#include <array>
#include <cmath>

#include "blum/field/closest_points.hpp"

namespace blum {
namespace {

/// Of a point on the line through two others, the part of the second one, between 0 and 1.
double part_between(const Vec3d& a, const Vec3d& b, const Vec3d& p) {
  const double squared = squared_length(b - a);
  return squared > 0 ? std::clamp(dot(p - a, b - a) / squared, 0.0, 1.0) : 0.0;
}

/// Weights of three corners whose first two are the furthest apart; p lies in the triangle, but for rounding. However
/// narrow the triangle is, the mean of its corners is p.
std::array<double, 3> weights_of(const std::array<Vec3d, 3>& corners, const Vec3d& p) {
  const Vec3d& a = corners[0];
  const Vec3d along = corners[1] - a;
  const double squared = squared_length(along);
  if (!(squared > 0)) return {1, 0, 0};
  double foot = dot(corners[2] - a, along) / squared;
  Vec3d height = corners[2] - a - along * foot;
  // Of a narrow triangle rounding leaves too much along the side: once more.
  const double left = dot(height, along) / squared;
  foot += left;
  height -= along * left;
  const double squared_height = squared_length(height);
  const double third = squared_height > 0 ? std::min(dot(p - a, height) / squared_height, 1.0) : 0.0;
  const double second = dot(p - a, along) / squared - third * foot;
  // Beyond a side by rounding, which the height of a narrow triangle enlarges: on it.
  if (!(third > 0)) {
    const double part = part_between(a, corners[1], p);
    return {1 - part, part, 0};
  }
  if (second < 0) {
    const double part = part_between(a, corners[2], p);
    return {1 - part, 0, part};
  }
  if (second + third > 1) {
    const double part = part_between(corners[1], corners[2], p);
    return {0, 1 - part, part};
  }
  return {std::max(1 - second - third, 0.0), second, third};
}

}  // namespace

std::optional<Vec3d> gradient(const Vec3d& query, const ClosestPoint& found) {
  const double rounding = 1e-13 * (length(query) + length(found.point));
  if (!(std::abs(found.distance) > rounding) || !std::isfinite(found.distance)) return std::nullopt;
  // By its own length: next to the surface rounding takes more from the point than from the distance.
  const Vec3d away = (query - found.point) / std::abs(found.distance);
  const double size = length(away);
  if (!(size > 0)) return std::nullopt;
  return away / std::copysign(size, found.distance) + Vec3d{};  // no -0
}

std::optional<std::array<double, 3>> barycentric(const MeshView& mesh, const ClosestPoint& found) {
  if (!found.triangle.has_value()) return std::nullopt;
  const Triangle& triangle = mesh.triangles[found.triangle.value];
  for (std::size_t k = 0; k < 3; ++k) {
    if (found.site.value != triangle[k]) continue;
    std::array<double, 3> out{};
    out[k] = 1;
    return out;
  }
  // About 1 long, so that nothing overflows.
  const Vec3d& origin = mesh.vertices[triangle[0]];
  double size = 0;
  for (const std::uint32_t v : triangle) {
    const Vec3d from = mesh.vertices[v] - origin;
    size = std::max({size, std::abs(from.x), std::abs(from.y), std::abs(from.z)});
  }
  if (!(size > 0)) return std::array<double, 3>{1, 0, 0};
  const auto corner = [&](std::size_t k) { return (mesh.vertices[triangle[k % 3]] - origin) / size; };
  const auto side = [&](std::size_t k) { return squared_length(corner(k + 1) - corner(k)); };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (side(k) > side(longest)) longest = k;
  }
  const std::array<double, 3> weights =
      weights_of({corner(longest), corner(longest + 1), corner(longest + 2)}, (found.point - origin) / size);
  std::array<double, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) out[(longest + k) % 3] = weights[k];
  return out;
}

}  // namespace blum
