#include "blum/geometry/orient3d.hpp"

#include <cmath>
#include <cstddef>

#include "geometry/predicates/double2_rows.hpp"
#include "geometry/predicates/expansion.hpp"

namespace blum::detail {
namespace {

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
  if (magnitude == 0) return 0;  // each product has an exact 0 as factor

  const Row u2 = row(b, a);
  const Row v2 = row(c, a);
  const Row w2 = row(d, a);
  const double fine = determinant(u2, v2, w2);
  constexpr double fine_bound = 4e-30;  // 2^-98: about ten roundings of 2^-103 each, with a margin
  if (std::abs(fine) > fine_bound * magnitude) return fine > 0 ? 1 : -1;
  return exact_sign(a, b, c, d, u2, v2, w2);
}

}  // namespace blum::detail
