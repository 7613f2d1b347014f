// Proves that rays cross triangles according to exact arithmetic: sides, borders and parameters. Closed surfaces have
// no holes for rays that graze edges and corners. A ray in a triangle's own plane does not cross it.
#include "blum/geometry/ray.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "blum/core/random.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum {
namespace {

using detail::crossing;
using detail::ray_side;

TEST(Ray, SideAgreesWithWholeNumbers) {
  // Determinants of small whole numbers are exact in int64, but not in double far from the origin.
  Random random(1);
  int zeros = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const auto number = [&] { return static_cast<std::int64_t>(random.below(9)) - 4; };
    const std::int64_t d[3] = {number(), number(), number()};
    const std::int64_t u[3] = {number(), number(), number()};
    const std::int64_t v[3] = {number(), number(), number()};
    const std::int64_t det =
        d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) + d[2] * (u[0] * v[1] - u[1] * v[0]);
    const auto vec = [](const std::int64_t(&n)[3]) {
      return Vec3d{static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])};
    };
    const int expected = det > 0 ? 1 : det < 0 ? -1 : 0;
    zeros += expected == 0 ? 1 : 0;
    const double unit = std::ldexp(1.0, -40);  // exact differences of coordinates near 1
    const Vec3d origin{0.75, -1.25, 1.5};
    EXPECT_EQ(ray_side({origin, vec(d)}, origin + vec(u) * unit, origin + vec(v) * unit), expected);
  }
  EXPECT_GT(zeros, 500);
}

TEST(Ray, SideIsExactDespiteRounding) {
  // The differences of nearly coplanar points round. orient3d is a reference, because the direction is an exact
  // difference.
  Random random(2);
  for (int trial = 0; trial < 5000; ++trial) {
    const Vec3d origin{random.uniform(), random.uniform(), random.uniform()};
    const Vec3d step{std::ldexp(1.0, -30), -std::ldexp(1.0, -29), std::ldexp(3.0, -31)};
    const Vec3d through = origin + step;
    if (through - origin != step) continue;
    const Vec3d a{random.uniform(), random.uniform(), random.uniform()};
    const Vec3d b = origin + (a - origin) * random.uniform() + step * random.uniform();
    EXPECT_EQ(ray_side({origin, step}, a, b), detail::orient3d(origin, through, a, b));
  }
}

TEST(Ray, ReportsSideBorderAndParameter) {
  const std::array<Vec3d, 3> t{Vec3d{0, 0, 1}, Vec3d{4, 0, 1}, Vec3d{0, 4, 1}};
  const auto up = crossing({{1, 1, -1}, {0, 0, 0.5}}, t);
  ASSERT_TRUE(up);
  EXPECT_EQ(up->t, 4);
  EXPECT_EQ(up->side, 1);
  EXPECT_FALSE(up->on_border);
  EXPECT_EQ(up->weights, (std::array<double, 3>{0.5, 0.25, 0.25}));
  EXPECT_EQ(crossing({{1, 1, 3}, {0, 0, -1}}, t)->side, -1);
  EXPECT_FALSE(crossing({{1, 1, 3}, {0, 0, 1}}, t)) << "the triangle lies behind";
  EXPECT_EQ(crossing({{1, 1, 1}, {0, 0, 1}}, t)->t, 0) << "it begins on the triangle";
  EXPECT_EQ(crossing({{1, 1, 1}, {0, 0, -1}}, t)->t, 0);
  EXPECT_TRUE(crossing({{2, 2, 0}, {0, 0, 1}}, t)->on_border) << "an edge";
  EXPECT_EQ(crossing({{0, 4, 0}, {0, 0, 1}}, t)->weights, (std::array<double, 3>{0, 0, 1})) << "a corner";
  EXPECT_FALSE(crossing({{-1, 1, 1}, {1, 0, 0}}, t)) << "in its plane";
  EXPECT_FALSE(crossing({{0, 0, 0}, {0, 0, 1}}, {t[0], t[0], t[1]})) << "no area";
}

TEST(Ray, ClosedSurfacesHaveNoHoles) {
  // Rays from inside aim at the corners and at points of the edges of an octahedron. With exact signs, each ray meets
  // at least one triangle, however its aim rounds.
  const std::array<Vec3d, 6> p{Vec3d{1.1, 0, 0}, Vec3d{-0.9, 0, 0}, Vec3d{0, 1.3, 0},
                               Vec3d{0, -1, 0},  Vec3d{0, 0, 0.7},  Vec3d{0, 0, -1}};
  Random random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const Vec3d origin = random.in_ball() * 0.2;
    const Vec3d& a = p[random.below(2)];
    const Vec3d& b = p[2 + random.below(2)];
    const double along = trial % 3 == 0 ? 0 : random.uniform();
    const Ray ray{origin, a + (b - a) * along - origin};
    int met = 0;
    int inner = 0;
    for (const std::size_t x : {0U, 1U}) {
      for (const std::size_t y : {2U, 3U}) {
        for (const std::size_t z : {4U, 5U}) {
          const auto found = crossing(ray, {p[x], p[y], p[z]});
          if (!found) continue;
          ++met;
          inner += found->on_border ? 0 : 1;
          EXPECT_NEAR(found->t, 1, 1e-12);
        }
      }
    }
    EXPECT_GE(met, 1);
    EXPECT_TRUE(inner == 0 || (inner == 1 && met == 1)) << trial;
  }
}

}  // namespace
}  // namespace blum
