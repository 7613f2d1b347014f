// Proves that orient2d has the sign of the exact determinant, by comparison with integers of 128 bits. Points lie on
// small grids, where most determinants are 0, and on lines that miss a point by one unit in the last place.
#include "blum/geometry/orient2d.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

#include "blum/core/random.hpp"

namespace blum::detail {
namespace {

using Whole = std::array<std::int64_t, 2>;

int exact_sign(const Whole& a, const Whole& b, const Whole& c) {
  const __int128 determinant =
      static_cast<__int128>(a[0] - c[0]) * (b[1] - c[1]) - static_cast<__int128>(a[1] - c[1]) * (b[0] - c[0]);
  return (determinant > 0 ? 1 : 0) - (determinant < 0 ? 1 : 0);
}

/// Checks the sign for the points as doubles times a power of two, in four orders of the points.
void expect_exact(const Whole& a, const Whole& b, const Whole& c, double scale) {
  const auto point = [&](const Whole& p) {
    return std::array<double, 2>{static_cast<double>(p[0]) * scale, static_cast<double>(p[1]) * scale};
  };
  const int expected = exact_sign(a, b, c);
  ASSERT_EQ(orient2d(point(a), point(b), point(c)), expected);
  ASSERT_EQ(orient2d(point(b), point(c), point(a)), expected);
  ASSERT_EQ(orient2d(point(c), point(a), point(b)), expected);
  ASSERT_EQ(orient2d(point(b), point(a), point(c)), -expected);
}

TEST(Orient2d, IsExactOnSmallGrids) {
  for (std::int64_t k = 0; k < 4 * 4 * 4 * 4 * 4 * 4; ++k) {
    const auto digit = [&](int place) { return ((k >> (2 * place)) & 3) - 1; };
    expect_exact({digit(0), digit(1)}, {digit(2), digit(3)}, {digit(4), digit(5)}, 1);
  }
}

TEST(Orient2d, IsExactFarFromTheOriginAndNearlyInLine) {
  Random random(7);
  const auto below = [&](std::int64_t most) {
    return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(most)));
  };
  for (int run = 0; run < 20000; ++run) {
    const Whole start{below(std::int64_t{1} << 50), below(std::int64_t{1} << 50)};
    const Whole step{below(1 << 20) - (1 << 19), below(1 << 20) - (1 << 19)};
    const auto along = [&](std::int64_t times) {
      return Whole{start[0] + times * step[0] + below(3) - 1, start[1] + times * step[1] + below(3) - 1};
    };
    expect_exact(along(0), along(below(1 << 20)), along(below(1 << 30)), 0x1p-40);
  }
}

}  // namespace
}  // namespace blum::detail
