#include "voronoi/unit_normal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace blum::voronoi {
namespace {

/// A sum of two doubles that do not overlap.
struct DoubleDouble {
  double high = 0, low = 0;
};

DoubleDouble exact_difference(double a, double b) {
  const double high = a - b;
  const double part = a - high;
  return {high, (a - (high + part)) + (part - b)};
}

/// a b - c d, to a few units of the last place of the products times 1e-16.
double difference_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                              const DoubleDouble& d) {
  const double ab = a.high * b.high;
  const double cd = c.high * d.high;
  const double ab_low = std::fma(a.high, b.high, -ab) + (a.high * b.low + a.low * b.high);
  const double cd_low = std::fma(c.high, d.high, -cd) + (c.high * d.low + c.low * d.high);
  const DoubleDouble high = exact_difference(ab, cd);
  return high.high + (high.low + (ab_low - cd_low));
}

}  // namespace

Vec3d unit(const Vec3d& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  const Vec3d scaled = v / largest;
  return scaled / length(scaled);
}

Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  std::array<DoubleDouble, 3> u;
  std::array<DoubleDouble, 3> v;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = exact_difference(b[k], a[k]);
    v[k] = exact_difference(c[k], a[k]);
  }
  return unit({difference_of_products(u[1], v[2], u[2], v[1]), difference_of_products(u[2], v[0], u[0], v[2]),
               difference_of_products(u[0], v[1], u[1], v[0])});
}

}  // namespace blum::voronoi
