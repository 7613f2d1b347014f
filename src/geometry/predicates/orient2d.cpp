#include "blum/geometry/orient2d.hpp"

#include <cmath>

#include "geometry/predicates/expansion.hpp"

namespace blum::detail {
namespace {

template <class T>
int sign(T value) {
  return (value > 0 ? 1 : 0) - (value < 0 ? 1 : 0);
}

}  // namespace

int orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  const std::array<double, 4> d{a[0] - c[0], b[1] - c[1], a[1] - c[1], b[0] - c[0]};
  const double left = d[0] * d[1];
  const double right = d[2] * d[3];
  const double determinant = left - right;
  constexpr double error_bound = 4e-16;  // (3 + 16 u) u with u = 2^-53, rounded up
  if (std::abs(determinant) > error_bound * (std::abs(left) + std::abs(right))) return determinant > 0 ? 1 : -1;
  // The signs of differences are exact. If a difference is 0, for example for points aligned with an axis, these signs
  // decide.
  const int left_sign = sign(d[0]) * sign(d[1]);
  const int right_sign = sign(d[2]) * sign(d[3]);
  if (left_sign != right_sign || left_sign == 0) return sign(left_sign - right_sign);
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
