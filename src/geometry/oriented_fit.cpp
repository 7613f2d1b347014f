#include "geometry/oriented_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace blum {
namespace {

using Axes = std::array<Vec3d, 3>;

constexpr Axes coordinate_axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};

/// The sum of vectors that may be turned around, so that they point to one side.
class SumOfNormals {
 public:
  void add(const Vec3d& normal) { sum_ += dot(sum_, normal) < 0 ? -normal : normal; }
  /// Its direction; 0 where there is none.
  [[nodiscard]] Vec3d direction() const {
    const double size = length(sum_);
    return size > 0 ? sum_ / size : Vec3d{};
  }

 private:
  Vec3d sum_;
};

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

/// Adds a box: its middle, and how far it spreads around that.
void add_moments(const OrientedBox& box, const Vec3d& from, const Vec3d& u, const Vec3d& v, PlaneMoments& out) {
  const double x = dot(u, box.center - from);
  const double y = dot(v, box.center - from);
  out.count += 1;
  out.x += x;
  out.y += y;
  out.xx += x * x;
  out.xy += x * y;
  out.yy += y * y;
  for (std::size_t j = 0; j < 3; ++j) {
    const double a = dot(u, box.axes[j]) * box.half[j];
    const double b = dot(v, box.axes[j]) * box.half[j];
    out.xx += a * a;
    out.xy += a * b;
    out.yy += b * b;
  }
}

/// The direction along which points of a plane spread most around their mean.
Vec3d widest(const PlaneMoments& m, const Vec3d& u, const Vec3d& v) {
  const double xx = m.xx - m.x * m.x / m.count;
  const double xy = m.xy - m.x * m.y / m.count;
  const double yy = m.yy - m.y * m.y / m.count;
  const double half = 0.5 * (xx - yy);
  const double root = std::sqrt(half * half + xy * xy);
  // Of the two forms of the eigenvector the one in which nothing cancels.
  const Vec3d way = half >= 0 ? u * (half + root) + v * xy : u * xy + v * (root - half);
  const double size = length(way);
  return size > 0 ? way / size : u;
}

/// Two directions at right angles to a third one and to each other.
std::array<Vec3d, 2> plane_axes(const Vec3d& normal) {
  const Vec3d size{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const Vec3d other = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                      : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                           : Vec3d{0, 0, 1};
  const Vec3d u = cross(normal, other);
  const Vec3d unit = u / length(u);
  return {unit, cross(normal, unit)};
}

/// @param plain           the box along the coordinate axes.
/// @param add_moments_of  (from, u, v, moments) adds all that is to be in the box.
/// @param add_to          (extent) likewise.
template <class AddMoments, class AddTo>
OrientedBox smaller_box(const OrientedBox& plain, const Vec3d& normal, const AddMoments& add_moments_of,
                        const AddTo& add_to) {
  if (normal == Vec3d{}) return plain;
  const auto [u, v] = plane_axes(normal);
  PlaneMoments moments;
  // From the middle, or far from the origin rounding would drown them.
  add_moments_of(plain.center, u, v, moments);
  const Vec3d along = widest(moments, u, v);
  Extent turned({along, cross(normal, along), normal});
  add_to(turned);
  const OrientedBox box = turned.box();
  return box.half_sum() <= plain.half_sum() ? box : plain;
}

}  // namespace

OrientedBox box_around(FlatTriangleBlock& block, Box3& bounds) {
  alignas(64) double area[3][lanes];
  set_normals(block, area);
  SumOfNormals sum;
  for (std::size_t i = 0; i < lanes; ++i) sum.add({area[0][i], area[1][i], area[2][i]});
  for (std::size_t k = 0; k < 3; ++k) {
    extent_along(block, coordinate_axes[k], bounds.lower[k], bounds.upper[k]);
  }
  OrientedBox plain;
  plain.center = bounds.center();
  for (std::size_t k = 0; k < 3; ++k) plain.half[k] = (bounds.upper[k] - bounds.lower[k]) * 0.5;
  return smaller_box(
      plain, sum.direction(),
      [&](const Vec3d& from, const Vec3d& u, const Vec3d& v, PlaneMoments& out) {
        add_moments(block, from, u, v, out);
      },
      [&](Extent& extent) { extent.add(block); });
}

OrientedBox box_around(std::span<const OrientedBox> boxes) {
  SumOfNormals sum;
  Extent straight(coordinate_axes);
  for (const OrientedBox& box : boxes) {
    sum.add(box.axes[2] * (box.half[0] * box.half[1]));
    straight.add(box);
  }
  return smaller_box(
      straight.box(), sum.direction(),
      [&](const Vec3d& from, const Vec3d& u, const Vec3d& v, PlaneMoments& out) {
        for (const OrientedBox& box : boxes) add_moments(box, from, u, v, out);
      },
      [&](Extent& extent) {
        for (const OrientedBox& box : boxes) extent.add(box);
      });
}

}  // namespace blum
