#include "geometry/near_angle.hpp"

#include <cmath>

namespace blum {
namespace {

/// The sum of two doubles that do not overlap: 106 bits (Dekker 1971).
struct TwoDoubles {
  double high = 0;
  double low = 0;
};

/// For |a| >= |b|.
TwoDoubles quick_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Exact (Knuth).
TwoDoubles exact_sum(double a, double b) {
  const double sum = a + b;
  const double of_b = sum - a;
  return {sum, (a - (sum - of_b)) + (b - of_b)};
}

TwoDoubles operator+(const TwoDoubles& a, const TwoDoubles& b) {
  TwoDoubles sum = exact_sum(a.high, b.high);
  const TwoDoubles rest = exact_sum(a.low, b.low);
  sum = quick_sum(sum.high, sum.low + rest.high);
  return quick_sum(sum.high, sum.low + rest.low);
}

TwoDoubles operator-(const TwoDoubles& a, const TwoDoubles& b) {
  return a + TwoDoubles{-b.high, -b.low};
}

TwoDoubles operator*(const TwoDoubles& a, const TwoDoubles& b) {
  const double product = a.high * b.high;
  const double rest = std::fma(a.high, b.high, -product);
  return quick_sum(product, rest + (a.high * b.low + a.low * b.high));
}

TwoDoubles root(const TwoDoubles& a) {
  if (!(a.high > 0)) return {};
  const double rough = std::sqrt(a.high);
  const TwoDoubles rest = a - TwoDoubles{rough, 0} * TwoDoubles{rough, 0};
  return quick_sum(rough, rest.high / (2 * rough));
}

using Vector = std::array<TwoDoubles, 3>;

Vector difference(const Vec3d& a, const Vec3d& b) {
  return {exact_sum(a.x, -b.x), exact_sum(a.y, -b.y), exact_sum(a.z, -b.z)};
}

TwoDoubles dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

HalfAngle half_solid_angle_nearby(const std::array<Vec3d, 3>& corners, const Vec3d& point) {
  const Vector a = difference(corners[0], point);
  const Vector b = difference(corners[1], point);
  const Vector c = difference(corners[2], point);
  const TwoDoubles length_a = root(dot(a, a));
  const TwoDoubles length_b = root(dot(b, b));
  const TwoDoubles length_c = root(dot(c, c));
  const Vector normal = cross(difference(corners[1], corners[0]), difference(corners[2], corners[0]));
  const TwoDoubles sine = dot(a, normal);
  const TwoDoubles cosine =
      length_a * length_b * length_c + dot(a, b) * length_c + dot(b, c) * length_a + dot(c, a) * length_b;
  return {cosine.high, sine.high};
}

}  // namespace blum
