#include "blum/geometry/orient3d.hpp"

#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/expansion.hpp"

namespace blum::detail {
namespace {

/// A number as the sum of a double and what it was rounded by.
struct Double2 {
  double high = 0;
  double low = 0;
};

Double2 quick_sum(double large, double small) {
  const double sum = large + small;
  return {sum, small - (sum - large)};
}

/// Exact.
Double2 difference(double x, double y) {
  const double high = x - y;
  const double from_y = x - high;
  return {high, (x - (high + from_y)) + (from_y - y)};
}

/// Within 2^-103 of the exact product, relatively.
Double2 product(const Double2& x, const Double2& y) {
  const double high = x.high * y.high;
  return quick_sum(high, std::fma(x.high, y.high, -high) + (x.high * y.low + x.low * y.high));
}

/// Within 2^-103 of the sum of magnitudes.
Double2 sum(const Double2& x, const Double2& y) {
  const double high = x.high + y.high;
  const double from_y = high - x.high;
  const double error = (x.high - (high - from_y)) + (y.high - from_y);
  return quick_sum(high, error + (x.low + y.low));
}

Double2 minor(const Double2& a, const Double2& b, const Double2& c, const Double2& d) {
  const Double2 left = product(b, c);
  return sum(product(a, d), {-left.high, -left.low});
}

using Row = std::array<Double2, 3>;

Row row(const Vec3d& p, const Vec3d& q) {
  return {difference(p.x, q.x), difference(p.y, q.y), difference(p.z, q.z)};
}

double determinant(const Row& u, const Row& v, const Row& w) {
  const Double2 x = product(u[0], minor(v[1], v[2], w[1], w[2]));
  const Double2 y = product(u[1], minor(v[2], v[0], w[2], w[0]));
  const Double2 z = product(u[2], minor(v[0], v[1], w[0], w[1]));
  return sum(sum(x, y), z).high;
}

bool is_rounded(const Row& row) {
  return row[0].low != 0 || row[1].low != 0 || row[2].low != 0;
}

int exact_sign(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d, const Row& u, const Row& v,
               const Row& w) {
  if (!is_rounded(u) && !is_rounded(v) && !is_rounded(w)) {
    const auto high = [](const Row& r) { return Vec3d{r[0].high, r[1].high, r[2].high}; };
    Expansion<24> exact;
    exact.add_determinant(1, high(u), high(v), high(w));
    return exact.sign();
  }
  Expansion<96> exact;
  exact.add_determinant(1, b, c, d);
  exact.add_determinant(-1, a, c, d);
  exact.add_determinant(1, a, b, d);
  exact.add_determinant(-1, a, b, c);
  return exact.sign();
}

}  // namespace

int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d u = b - a;
  const Vec3d v = c - a;
  const Vec3d w = d - a;
  const double xy = v.x * w.y;
  const double yx = v.y * w.x;
  const double yz = v.y * w.z;
  const double zy = v.z * w.y;
  const double zx = v.z * w.x;
  const double xz = v.x * w.z;
  const double rough = u.x * (yz - zy) + u.y * (zx - xz) + u.z * (xy - yx);
  const double magnitude = std::abs(u.x) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(u.y) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(u.z) * (std::abs(xy) + std::abs(yx));
  if (std::abs(rough) > orient3d_rounding * magnitude) return rough > 0 ? 1 : -1;
  if (magnitude == 0) return 0;  // every product has a factor that is 0, and differences are 0 only where exact

  const Row u2 = row(b, a);
  const Row v2 = row(c, a);
  const Row w2 = row(d, a);
  const double fine = determinant(u2, v2, w2);
  constexpr double fine_bound = 4e-30;  // 2^-98: some ten roundings of 2^-103, with room
  if (std::abs(fine) > fine_bound * magnitude) return fine > 0 ? 1 : -1;
  return exact_sign(a, b, c, d, u2, v2, w2);
}

}  // namespace blum::detail
