#include "geometry/bvh/triangle_group.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum {
namespace {

/// Returns the sign of a height, 1 or -1, or 0 if it is uncertain because of rounding.
int certain_sign(double height, double magnitude) {
  return std::abs(height) > detail::orient3d_rounding * magnitude ? (height > 0 ? 1 : -1) : 0;
}

/// Vector with a bound on the rounding of each component: the sum of the magnitudes of its products.
struct RoundedNormal {
  Vec3d normal;
  Vec3d magnitude;

  explicit RoundedNormal(const std::array<Vec3d, 3>& p) {
    const Vec3d v = p[1] - p[0];
    const Vec3d w = p[2] - p[0];
    for (std::size_t x = 0; x < 3; ++x) {
      const double left = v[(x + 1) % 3] * w[(x + 2) % 3];
      const double right = v[(x + 2) % 3] * w[(x + 1) % 3];
      normal[x] = left - right;
      magnitude[x] = std::abs(left) + std::abs(right);
    }
  }

  /// Returns true if the exact normal certainly has a nonzero component. The 2x2 determinants of components round less
  /// than 3x3 ones.
  [[nodiscard]] bool is_certain() const {
    bool found = false;
    for (std::size_t x = 0; x < 3; ++x) found |= certain_sign(normal[x], magnitude[x]) != 0;
    return found;
  }
};

int side_of_plane(const GroupTriangle& plane, const Vec3d& p) {
  const Vec3d offset = p - plane.points[0];
  const Vec3d size{std::abs(offset.x), std::abs(offset.y), std::abs(offset.z)};
  return certain_sign(dot(plane.normal, offset), dot(plane.magnitude, size));
}

/// Returns the orientation of the path a -> b -> c, seen along an axis.
int turn(const Vec3d& a, const Vec3d& b, const Vec3d& c, std::size_t axis) {
  const auto flat = [axis](const Vec3d& p) { return std::array{p[(axis + 1) % 3], p[(axis + 2) % 3]}; };
  return detail::orient2d(flat(a), flat(b), flat(c));
}

/// Returns true if side(p) has one nonzero sign for all corners p of `triangle` that `other` lacks. At least one such
/// corner must exist.
/// @param wanted  required sign, 1 or -1; 0 allows either.
template <class Side>
bool has_own_corners_on_one_side(const GroupTriangle& triangle, const GroupTriangle& other, int wanted,
                                 const Side& side) {
  int common = wanted;
  bool has_own = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (other.has_corner(triangle.corners[k])) continue;
    const int found = side(triangle.points[k]);
    if (found == 0 || found == -common) return false;
    common = found;
    has_own = true;
  }
  return has_own;
}

std::size_t largest_axis(const Vec3d& v) {
  const double x = std::abs(v.x);
  const double y = std::abs(v.y);
  const double z = std::abs(v.z);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

Vec3d vector_at(const double (&rows)[3][lanes], std::size_t lane) {
  return {rows[0][lane], rows[1][lane], rows[2][lane]};
}

}  // namespace

TriangleGroup::TriangleGroup() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      box.lower[axis][lane] = std::numeric_limits<double>::infinity();
      box.upper[axis][lane] = -std::numeric_limits<double>::infinity();
    }
  }
}

void TriangleGroup::set(std::size_t lane, const detail::ContactTriangle& triangle) {
  const RoundedNormal plane(triangle.points);
  if (!plane.is_certain() && detail::has_no_area(triangle.points)) return;
  const auto& [a, b, c] = triangle.points;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis][lane] = std::min({a[axis], b[axis], c[axis]});
    box.upper[axis][lane] = std::max({a[axis], b[axis], c[axis]});
    normal[axis][lane] = plane.normal[axis];
    magnitude[axis][lane] = plane.magnitude[axis];
    for (std::size_t k = 0; k < 3; ++k) point[k][axis][lane] = triangle.points[k][axis];
    corner[axis][lane] = triangle.corners[axis];
  }
}

GroupTriangle::GroupTriangle(const TriangleGroup& group, std::size_t lane)
    : box(box_at(group.box, lane)),
      points{vector_at(group.point[0], lane), vector_at(group.point[1], lane), vector_at(group.point[2], lane)},
      corners{group.corner[0][lane], group.corner[1][lane], group.corner[2][lane]},
      normal(vector_at(group.normal, lane)),
      magnitude(vector_at(group.magnitude, lane)) {}

bool GroupTriangle::has_corner(double number) const {
  return number == corners[0] || number == corners[1] || number == corners[2];
}

detail::ContactTriangle GroupTriangle::for_contact() const {
  return {points,
          {static_cast<std::uint32_t>(corners[0]), static_cast<std::uint32_t>(corners[1]),
           static_cast<std::uint32_t>(corners[2])}};
}

bool is_beside(const GroupTriangle& triangle, const GroupTriangle& other) {
  return has_own_corners_on_one_side(triangle, other, 0, [&](const Vec3d& p) { return side_of_plane(other, p); });
}

bool is_beyond_an_edge(const GroupTriangle& triangle, const GroupTriangle& other) {
  const std::size_t axis = largest_axis(other.normal);
  const int way = certain_sign(other.normal[axis], other.magnitude[axis]);
  if (way == 0) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    // The corner of `other` that is not on this edge lies on the wrong side. If it is a common corner, this edge is
    // skipped.
    if (triangle.has_corner(other.corners[(k + 2) % 3])) continue;
    const Vec3d& a = other.points[k];
    const Vec3d& b = other.points[(k + 1) % 3];
    const auto side = [&](const Vec3d& p) { return turn(a, b, p, axis); };
    if (has_own_corners_on_one_side(triangle, other, -way, side)) return true;
  }
  return false;
}

}  // namespace blum
