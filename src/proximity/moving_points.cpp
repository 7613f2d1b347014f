#include "proximity/moving_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace blum::detail {
namespace {

/// A finite double as mantissa * 2^exponent, the mantissa odd or zero.
struct Parts {
  std::int64_t mantissa;
  int exponent;
};

Parts parts_of(double value) {
  if (value == 0) return {0, std::numeric_limits<int>::max()};
  int exponent = 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
  exponent -= digits;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa / (std::int64_t{1} << zeros), exponent + zeros};
}

}  // namespace

IntegerPoints integer_points(const FourMovingPoints& points, double distance) {
  int least = parts_of(distance).exponent;
  for (const auto* ends : {&points.start, &points.end}) {
    for (const Vec3d& p : *ends) {
      for (const double x : {p.x, p.y, p.z}) least = std::min(least, parts_of(x).exponent);
    }
  }
  const auto integer = [&](double x) {
    const Parts parts = parts_of(x);
    return parts.mantissa == 0 ? Integer(0) : Integer(parts.mantissa) << static_cast<unsigned>(parts.exponent - least);
  };
  IntegerPoints out;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Integer start = integer(points.start[k][axis]);
      out.at[k][axis] = {start, integer(points.end[k][axis]) - start};
    }
  }
  out.distance = integer(distance);
  return out;
}

MovingVector operator-(const MovingVector& a, const MovingVector& b) {
  MovingVector out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = {a[axis].start - b[axis].start, a[axis].slope - b[axis].slope};
  }
  return out;
}

Polynomial operator*(const Linear& a, const Linear& b) {
  return {a.start * b.start, a.start * b.slope + a.slope * b.start, a.slope * b.slope};
}

Polynomial cross_component(const MovingVector& a, const MovingVector& b, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  return a[next] * b[last] - a[last] * b[next];
}

Polynomial dot(const MovingVector& a, const MovingVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

PolynomialVector cross(const MovingVector& a, const MovingVector& b) {
  return {cross_component(a, b, 0), cross_component(a, b, 1), cross_component(a, b, 2)};
}

Polynomial dot(const PolynomialVector& a, const PolynomialVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Polynomial dot(const PolynomialVector& a, const MovingVector& b) {
  Polynomial sum;
  for (std::size_t axis = 0; axis < 3; ++axis) sum = sum + a[axis] * Polynomial{b[axis].start, b[axis].slope};
  return sum;
}

unsigned depth_of(double tolerance) {
  int exponent = 0;
  std::frexp(tolerance, &exponent);
  return static_cast<unsigned>(std::max(1 - exponent, 0)) + 1;
}

}  // namespace blum::detail
