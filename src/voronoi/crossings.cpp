#include "voronoi/crossings.hpp"

#include <algorithm>
#include <cstddef>

#include "blum/geometry/orient3d.hpp"

namespace blum::voronoi {
namespace {

bool are_apart(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low_a, high_a] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [low_b, high_b] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

}  // namespace

bool crosses(const std::array<Vec3d, 2>& segment, const std::array<Vec3d, 3>& triangle) {
  const auto& [p, q] = segment;
  const auto& [a, b, c] = triangle;
  const int from = detail::orient3d(a, b, c, p);
  const int to = detail::orient3d(a, b, c, q);
  if (from * to > 0 || (from == 0 && to == 0)) return false;
  const std::array sides{detail::orient3d(p, q, a, b), detail::orient3d(p, q, b, c), detail::orient3d(p, q, c, a)};
  const auto [least, most] = std::minmax({sides[0], sides[1], sides[2]});
  return least >= 0 || most <= 0;
}

bool cross_each_other(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
  if (are_apart(a, b)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (crosses({a[k], a[(k + 1) % 3]}, b) || crosses({b[k], b[(k + 1) % 3]}, a)) return true;
  }
  return false;
}

}  // namespace blum::voronoi
