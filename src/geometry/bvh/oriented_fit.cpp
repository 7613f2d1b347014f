#include "geometry/bvh/oriented_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace blum {
namespace {

using Axes = std::array<Vec3d, 3>;

/// What lies along three axes: intervals.
class Extent {
 public:
  explicit Extent(const Axes& axes) : axes_(axes) {}

  void add(const OrientedBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      double reach = 0;
      for (std::size_t j = 0; j < 3; ++j) reach += std::abs(dot(axes_[k], box.axes[j])) * box.half[j];
      const double at = dot(axes_[k], box.center);
      low_[k] = std::min(low_[k], at - reach);
      high_[k] = std::max(high_[k], at + reach);
    }
  }
  void add(const FlatTriangleBlock& block) {
    for (std::size_t k = 0; k < 3; ++k) extent_along(block, axes_[k], low_[k], high_[k]);
  }
  [[nodiscard]] OrientedBox box() const {
    OrientedBox out;
    out.axes = axes_;
    for (std::size_t k = 0; k < 3; ++k) {
      out.half[k] = (high_[k] - low_[k]) * 0.5;
      out.center += axes_[k] * ((low_[k] + high_[k]) * 0.5);
    }
    return out;
  }

 private:
  Axes axes_;
  std::array<double, 3> low_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  std::array<double, 3> high_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
};

/// Shorter sums of normals have lost digits, as squares of theirs are too small.
constexpr double least_normal = 1e-140;

/// Two directions at right angles to a third one and to each other, the first one as close as can be to another one.
std::array<Vec3d, 2> plane_axes(const Vec3d& normal, const Vec3d& along) {
  const Vec3d flat = along - normal * dot(normal, along);
  const double size = squared_length(flat);
  if (size > 1e-12 * squared_length(along)) {
    Vec3d u = flat / std::sqrt(size);
    u -= normal * dot(normal, u);  // once more: where little was left, so was what rounding left along the normal
    u = u / length(u);
    return {u, cross(normal, u)};
  }
  const Vec3d magnitude{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const Vec3d other = magnitude.x <= magnitude.y && magnitude.x <= magnitude.z ? Vec3d{1, 0, 0}
                      : magnitude.y <= magnitude.z                             ? Vec3d{0, 1, 0}
                                                                               : Vec3d{0, 0, 1};
  const Vec3d u = cross(normal, other);
  const Vec3d unit = u / length(u);
  return {unit, cross(normal, unit)};
}

/// The smaller one of two boxes: one along the coordinate axes, and the one along a plane.
/// @param normal  of the plane, of any length.
/// @param along   a direction in which what is to be in the box extends most.
/// @param add_to  (extent) adds that.
template <class AddTo>
OrientedBox smaller_box(const Box3& bounds, const Vec3d& normal, const Vec3d& along, const AddTo& add_to) {
  OrientedBox plain;
  plain.center = bounds.center();
  for (std::size_t k = 0; k < 3; ++k) plain.half[k] = (bounds.upper[k] - bounds.lower[k]) * 0.5;
  const double size = length(normal);
  if (!(size > least_normal)) return plain;
  const Vec3d unit = normal / size;
  const auto [u, v] = plane_axes(unit, along);
  Extent turned({u, v, unit});
  add_to(turned);
  const OrientedBox box = turned.box();
  return box.half_sum() <= plain.half_sum() ? box : plain;
}

}  // namespace

OrientedBox box_around(FlatTriangleBlock& block, Box3& bounds) {
  BlockShape shape;
  set_normals(block, shape);
  extent_along_axes(block, bounds);
  // Triangles of a block are cut across their longest side into halves first.
  return smaller_box(bounds, shape.normal, shape.along, [&](Extent& extent) { extent.add(block); });
}

OrientedBox box_around(std::span<const OrientedBox> boxes, const Box3& bounds) {
  Vec3d normal;
  Vec3d along;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const OrientedBox& box = boxes[k];
    const Vec3d own = box.axes[2] * (box.half[0] * box.half[1]);
    normal += dot(normal, own) < 0 ? -own : own;
    along += 2 * k < boxes.size() ? -box.center : box.center;
  }
  if (boxes.size() % 2 != 0) along += boxes.front().center;  // as many on either side
  return smaller_box(bounds, normal, along, [&](Extent& extent) {
    for (const OrientedBox& box : boxes) extent.add(box);
  });
}

}  // namespace blum
