#include "blum/geometry/orient2d.hpp"

#include <cmath>

#include "geometry/expansion.hpp"

namespace blum::detail {
int orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  const double determinant = left - right;
  constexpr double error_bound = 4e-16;  // (3 + 16 u) u, with u = 2^-53, rounded up
  if (std::abs(determinant) > error_bound * (std::abs(left) + std::abs(right))) return determinant > 0 ? 1 : -1;
  Expansion<12> exact;
  exact.add_product(a[0], b[1]);
  exact.add_product(-a[1], b[0]);
  exact.add_product(b[0], c[1]);
  exact.add_product(-b[1], c[0]);
  exact.add_product(c[0], a[1]);
  exact.add_product(-c[1], a[0]);
  return exact.sign();
}

}  // namespace blum::detail
