#include "blum/geometry/ray.hpp"

#include <algorithm>
#include <cmath>

#include "blum/geometry/orient3d.hpp"
#include "geometry/predicates/expansion.hpp"

namespace blum::detail {
ScaledRay scaled_direction(const Ray& ray) {
  const Vec3d& d = ray.direction;
  const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  if (!(largest > 0) || !std::isfinite(largest)) return {ray, 1};
  const int exponent = std::ilogb(largest);
  const auto scale = [&](double x) { return std::ldexp(x, -exponent); };
  return {{ray.origin, {scale(d.x), scale(d.y), scale(d.z)}}, std::ldexp(1.0, std::min(exponent, 1023))};
}

int ray_side(const Ray& ray, const Vec3d& a, const Vec3d& b) {
  const Vec3d& d = ray.direction;
  const Vec3d u = a - ray.origin;
  const Vec3d v = b - ray.origin;
  double rough = 0;
  double magnitude = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double left = u[(i + 1) % 3] * v[(i + 2) % 3];
    const double right = u[(i + 2) % 3] * v[(i + 1) % 3];
    rough += d[i] * (left - right);
    magnitude += std::abs(d[i]) * (std::abs(left) + std::abs(right));
  }
  constexpr double bound = 8e-16;  // as for orient3d(), plus one more rounding in the first row
  if (std::abs(rough) > bound * magnitude) return rough > 0 ? 1 : -1;
  if (magnitude == 0) return 0;  // each product has an exact 0 as factor
  // Expands det(d, a - o, b - o). The term that contains o twice vanishes.
  Expansion<72> exact;
  exact.add_determinant(1, d, a, b);
  exact.add_determinant(-1, d, ray.origin, b);
  exact.add_determinant(-1, d, a, ray.origin);
  return exact.sign();
}

std::optional<TriangleCrossing> crossing(const Ray& ray, const std::array<Vec3d, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const std::array<int, 3> sides{ray_side(ray, b, c), ray_side(ray, c, a), ray_side(ray, a, b)};
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least * *most < 0 || (*least == 0 && *most == 0)) return std::nullopt;
  TriangleCrossing out;
  out.side = *least < 0 ? -1 : 1;
  out.on_border = *least == 0 || *most == 0;
  // Along the ray, the determinant of the triangle and the current point changes towards the sign `side`. If it already
  // has this sign at the ray's origin, the ray starts beyond the triangle.
  const int start = orient3d(a, b, c, ray.origin);
  if (start == out.side) return std::nullopt;
  const auto weight = [&](const Vec3d& from, const Vec3d& to) {
    return std::max(0.0, out.side * dot(ray.direction, cross(from - ray.origin, to - ray.origin)));
  };
  out.weights = {sides[0] == 0 ? 0 : weight(b, c), sides[1] == 0 ? 0 : weight(c, a), sides[2] == 0 ? 0 : weight(a, b)};
  const double sum = out.weights[0] + out.weights[1] + out.weights[2];
  for (std::size_t k = 0; k < 3; ++k) {
    // If all three weights are lost in rounding, the point is chosen so that the exact signs are respected.
    out.weights[k] = sum > 0 ? out.weights[k] / sum : (sides[k] == 0 ? 0.0 : 1.0);
  }
  if (!(sum > 0)) {
    const double count = out.weights[0] + out.weights[1] + out.weights[2];
    for (double& w : out.weights) w /= count;
  }
  // t is computed from the point in the triangle. If the ray is nearly parallel to its plane, other formulas lose all
  // digits.
  const Vec3d point = a * out.weights[0] + b * out.weights[1] + c * out.weights[2];
  const double along = dot(point - ray.origin, ray.direction) / squared_length(ray.direction);
  out.t = start == 0 ? 0 : std::max(0.0, along);
  return out;
}

}  // namespace blum::detail
