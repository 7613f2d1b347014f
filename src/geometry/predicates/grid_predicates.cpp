#include "blum/geometry/grid_predicates.hpp"

#include <cmath>

#include "blum/geometry/orient2d.hpp"
#include "blum/geometry/orient3d.hpp"
#include "geometry/predicates/expansion.hpp"

namespace blum::detail {
namespace {

using Exact = Expansion<unbounded>;
using Point2 = std::array<double, 2>;

template <class T>
int sign(T value) {
  return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

/// Projects a point along an axis. The result is as seen against the axis.
Point2 seen(const Vec3d& p, std::size_t axis) {
  return {p[next_axis(axis)], p[next_axis(next_axis(axis))]};
}

Exact times(const Exact& x, const Exact& y) {
  Exact product;
  for (const double a : x.parts()) {
    for (const double b : y.parts()) product.add_product(a, b);
  }
  return product;
}

/// Returns the sign of a b - c d.
int sign_of_difference(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  Exact difference = times(a, b);
  const Exact less = times(c, d);
  for (const double part : less.parts()) difference.add(-part);
  return difference.sign();
}

/// Double with a bound on its error.
struct Rounded {
  double value = 0;
  double error = 0;
};

constexpr double unit = 1.2e-16;  // unit roundoff, rounded up

Rounded operator*(const Rounded& x, const Rounded& y) {
  const double value = x.value * y.value;
  return {value, (1 + 8 * unit) * (x.error * std::abs(y.value) + y.error * (std::abs(x.value) + x.error)) +
                     unit * std::abs(value)};
}

/// Returns the sign of x - y if it is certain, else 0.
int certain_order(const Rounded& x, const Rounded& y) {
  const double difference = x.value - y.value;
  return std::abs(difference) > (1 + 8 * unit) * (x.error + y.error) + unit * std::abs(difference) ? sign(difference)
                                                                                                   : 0;
}

/// Triangle that is crossed by a line parallel to an axis, at the other coordinates (u, v). The height of its plane
/// above a base point of the line is -volume / area.
class Crossing {
 public:
  Crossing(const TriangleCorners& triangle, std::size_t axis) : corners_(triangle), axis_(axis) {}

  /// Returns six times the volume of the tetrahedron of the triangle and a point.
  [[nodiscard]] Rounded volume(const Vec3d& p) const {
    const Vec3d u = corners_[1] - corners_[0];
    const Vec3d v = corners_[2] - corners_[0];
    const Vec3d w = p - corners_[0];
    Rounded out;
    double magnitude = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = next_axis(i);
      const std::size_t k = next_axis(j);
      const double left = v[j] * w[k];
      const double right = v[k] * w[j];
      out.value += u[i] * (left - right);
      magnitude += std::abs(u[i]) * (std::abs(left) + std::abs(right));
    }
    out.error = orient3d_rounding * magnitude;
    return out;
  }
  [[nodiscard]] Exact exact_volume(const Vec3d& p) const {
    const auto& [a, b, c] = corners_;
    Exact sum;
    sum.add_determinant(1, b, c, p);
    sum.add_determinant(-1, a, c, p);
    sum.add_determinant(1, a, b, p);
    sum.add_determinant(-1, a, b, c);
    return sum;
  }
  /// Returns twice the area of the triangle projected along the axis: a component of its normal.
  [[nodiscard]] Rounded area() const {
    const Point2 a = seen(corners_[0], axis_);
    const Point2 b = seen(corners_[1], axis_);
    const Point2 c = seen(corners_[2], axis_);
    const double left = (a[0] - c[0]) * (b[1] - c[1]);
    const double right = (a[1] - c[1]) * (b[0] - c[0]);
    return {left - right, 4e-16 * (std::abs(left) + std::abs(right))};
  }
  [[nodiscard]] Exact exact_area(std::size_t axis) const {
    Exact sum;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 p = seen(corners_[k], axis);
      const Point2 q = seen(corners_[next_axis(k)], axis);
      sum.add_product(p[0], q[1]);
      sum.add_product(-p[1], q[0]);
    }
    return sum;
  }
  /// Returns the sign of the projected area.
  [[nodiscard]] int facing() const { return normal_sign(corners_, axis_); }

 private:
  const TriangleCorners& corners_;
  std::size_t axis_;
};

}  // namespace

int side_of_line(const EdgeEnds& edge, std::size_t axis, double u, double v) {
  const Point2 a = seen(edge[0], axis);
  const Point2 b = seen(edge[1], axis);
  if (const int side = orient2d(a, b, {u, v}); side != 0) return side;
  // The line counts as moved infinitesimally down along u and v, which changes the side by these terms. The term of the
  // axis with the smaller index decides first.
  const int along_u = sign(b[1] - a[1]);
  const int along_v = sign(a[0] - b[0]);
  const bool is_u_first = next_axis(axis) < next_axis(next_axis(axis));
  const int decides = is_u_first ? along_u : along_v;
  return decides != 0 ? decides : is_u_first ? along_v : along_u;
}

int normal_sign(const TriangleCorners& triangle, std::size_t axis) {
  return orient2d(seen(triangle[0], axis), seen(triangle[1], axis), seen(triangle[2], axis));
}

int side_of_node(const TriangleCorners& triangle, const Vec3d& node) {
  if (const int side = orient3d(triangle[0], triangle[1], triangle[2], node); side != 0) return side;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (const int component = normal_sign(triangle, axis); component != 0) return -component;
  }
  return 0;
}

bool is_crossed_before(const TriangleCorners& first, const TriangleCorners& second, std::size_t axis, double u,
                       double v) {
  const Crossing x(first, axis);
  const Crossing y(second, axis);
  Vec3d base;
  base[axis] = first[0][axis];  // near both triangles, so that the volumes are small
  base[next_axis(axis)] = u;
  base[next_axis(next_axis(axis))] = v;
  // The heights satisfy -Vx / Ax < -Vy / Ay if Vy Ax < Vx Ay; the order is reversed if exactly one area is negative.
  const int turned = x.facing() * y.facing();
  int order = certain_order(y.volume(base) * x.area(), x.volume(base) * y.area());
  if (order == 0) {
    const Exact area_x = x.exact_area(axis);
    const Exact area_y = y.exact_area(axis);
    order = sign_of_difference(y.exact_volume(base), area_x, x.exact_volume(base), area_y);
    // Both planes meet the line at the same point. If the line moves down along an axis, the height of a plane rises
    // with the normal's component along that axis.
    for (std::size_t other = 0; order == 0 && other < 3; ++other) {
      if (other != axis) order = sign_of_difference(x.exact_area(other), area_y, y.exact_area(other), area_x);
    }
  }
  return order * turned < 0;
}

namespace {

/// Returns the dividend and divisor of the position in passes_before(), in double.
std::array<Rounded, 2> rounded_place(const EdgeEnds& edge, std::size_t across, double plane, std::size_t along) {
  const auto& [a, b] = edge;
  const double below = a[along] * (b[across] - plane);
  const double above = b[along] * (plane - a[across]);
  const double under = b[across] - a[across];
  return {Rounded{below + above, 5 * unit * (std::abs(below) + std::abs(above))},
          Rounded{under, unit * std::abs(under)}};
}

}  // namespace

bool passes_before(const EdgeEnds& first, const EdgeEnds& second, std::size_t across, double plane, std::size_t along) {
  // An edge passes the plane at (a' (b - plane) + b' (plane - a)) / (b - a). Here a and b are its ends' coordinates
  // across the plane; a' and b' are their coordinates along the other axis.
  const auto [x, x_under] = rounded_place(first, across, plane, along);
  const auto [y, y_under] = rounded_place(second, across, plane, along);
  if (const int certain = certain_order(x * y_under, y * x_under); certain != 0) {
    return certain * sign(x_under.value) * sign(y_under.value) < 0;
  }
  const auto parts = [&](const EdgeEnds& edge, Exact& over, Exact& under, Exact& slope) {
    const auto& [a, b] = edge;
    over.add_product(a[along], b[across]);
    over.add_product(-a[along], plane);
    over.add_product(b[along], plane);
    over.add_product(-b[along], a[across]);
    under.add(b[across]);
    under.add(-a[across]);
    slope.add(b[along]);
    slope.add(-a[along]);
  };
  Exact over_x, under_x, slope_x, over_y, under_y, slope_y;
  parts(first, over_x, under_x, slope_x);
  parts(second, over_y, under_y, slope_y);
  const int turned = under_x.sign() * under_y.sign();
  int order = sign_of_difference(over_x, under_y, over_y, under_x);
  // The plane counts as moved infinitesimally down.
  if (order == 0) order = -sign_of_difference(slope_x, under_y, slope_y, under_x);
  return order * turned < 0;
}

}  // namespace blum::detail
