#include "geometry/orient2d.hpp"

#include <cmath>
#include <cstddef>

namespace blum::detail {
namespace {

/// A number held as a sum of doubles that do not overlap, by rising magnitude.
struct Expansion {
  std::array<double, 16> parts{};
  std::size_t size = 0;

  void add(double value) {
    // Knuth's two-sum, carried through all parts.
    for (std::size_t i = 0; i < size; ++i) {
      const double sum = value + parts[i];
      const double from_parts = sum - value;
      const double error = (value - (sum - from_parts)) + (parts[i] - from_parts);
      parts[i] = error;
      value = sum;
    }
    parts[size++] = value;
  }
  void add_product(double x, double y) {
    const double product = x * y;
    add(std::fma(x, y, -product));
    add(product);
  }
  [[nodiscard]] int sign() const {
    for (std::size_t i = size; i-- > 0;) {
      if (parts[i] != 0) return parts[i] > 0 ? 1 : -1;
    }
    return 0;
  }
};

}  // namespace

int orient2d(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c) {
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  const double determinant = left - right;
  constexpr double error_bound = 4e-16;  // (3 + 16 u) u, with u = 2^-53, rounded up
  if (std::abs(determinant) > error_bound * (std::abs(left) + std::abs(right))) return determinant > 0 ? 1 : -1;
  Expansion exact;
  exact.add_product(a[0], b[1]);
  exact.add_product(-a[1], b[0]);
  exact.add_product(b[0], c[1]);
  exact.add_product(-b[1], c[0]);
  exact.add_product(c[0], a[1]);
  exact.add_product(-c[1], a[0]);
  return exact.sign();
}

}  // namespace blum::detail
