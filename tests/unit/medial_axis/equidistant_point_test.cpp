// Proves that equidistant points are computed exactly if the given points determine one. Poorly determined directions
// stay unchanged.
#include "medial_axis/surface/equidistant_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "blum/core/random.hpp"

namespace blum {
namespace {

using detail::EquidistantPoints;

Vec3d direction(Random& random) {
  const Vec3d v = random.in_ball();
  return v / length(v);
}

TEST(EquidistantPoints, PointsOnASphereDetermineItsCentre) {
  Random random(1);
  int found = 0;
  for (int n = 0; n < 300; ++n) {
    const Vec3d centre = random.in_cube() * 10.0;
    const double radius = random.uniform(0.1, 5);
    std::vector<Vec3d> points;
    for (int p = 0; p < 4 + n % 5; ++p) points.push_back(centre + direction(random) * radius);
    const auto x = EquidistantPoints(points, centre + random.in_ball() * radius).of_rank(3);
    if (!x) continue;
    ++found;
    ASSERT_LT(length(*x - centre), 1e-10 * radius);
  }
  EXPECT_GT(found, 200);
}

TEST(EquidistantPoints, PointsOnACircleDetermineOnlyItsAxis) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const Vec3d centre = random.in_cube() * 10.0;
    const Vec3d axis = direction(random);
    const Vec3d u = cross(axis, std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0});
    const Vec3d v = cross(axis, u);
    std::vector<Vec3d> points;
    for (int p = 0; p < 3 + n % 6; ++p) {
      const double angle = 2 * p + 0.3 * random.uniform();
      points.push_back(centre + u * std::cos(angle) + v * std::sin(angle) * (length(u) / length(v)));
    }
    const Vec3d start = centre + random.in_ball();
    const EquidistantPoints equidistant(points, start);
    EXPECT_FALSE(equidistant.of_rank(3));
    const auto x = equidistant.of_rank(2);
    ASSERT_TRUE(x);
    const Vec3d nearest = centre + axis * dot(start - centre, axis);
    ASSERT_LT(length(*x - nearest), 1e-10);
  }
}

TEST(EquidistantPoints, TwoPointsDetermineOnlyTheirBisector) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const Vec3d p = random.in_cube();
    const Vec3d q = random.in_cube();
    const Vec3d start = random.in_cube() * 2.0;
    const EquidistantPoints equidistant(std::vector<Vec3d>{p, q, p, q, q}, start);
    EXPECT_FALSE(equidistant.of_rank(2));
    EXPECT_FALSE(equidistant.of_rank(3));
    const Vec3d across = (q - p) / length(q - p);
    const auto x = equidistant.of_rank(1);
    ASSERT_TRUE(x);
    ASSERT_LT(length(*x - (start - across * dot(start - (p + q) * 0.5, across))), 1e-12);
  }
}

TEST(EquidistantPoints, OnePointDeterminesNothing) {
  const EquidistantPoints equidistant(std::vector<Vec3d>(8, Vec3d{0.3, 0.1, 0.7}), {1, 2, 3});
  for (const int rank : {1, 2, 3}) EXPECT_FALSE(equidistant.of_rank(rank));
}

TEST(EquidistantPoints, DirectionsWeakerThanATenthAreRejected) {
  const auto box_of = [](double width, double height) {
    std::vector<Vec3d> points;
    for (int corner = 0; corner < 8; ++corner) {
      points.push_back({corner & 1 ? 1.0 : -1.0, corner & 2 ? width : -width, corner & 4 ? height : -height});
    }
    return EquidistantPoints(points, {0.2, 0.02, 0.01});
  };
  EXPECT_TRUE(box_of(0.11, 0.11).of_rank(3));
  EXPECT_FALSE(box_of(0.11, 0.09).of_rank(3));
  EXPECT_TRUE(box_of(0.11, 0.09).of_rank(2));
  EXPECT_FALSE(box_of(0.09, 0.09).of_rank(2));
  const auto x = box_of(0.09, 0.08).of_rank(1);
  ASSERT_TRUE(x);
  EXPECT_LT(length(*x - Vec3d{0, 0.02, 0.01}), 1e-13) << "moved along the strong direction only";
}

/// If no point is equidistant to all points, the result minimizes the variance of the squared distances.
TEST(EquidistantPoints, ManyPointsAreBalanced) {
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    std::vector<Vec3d> points(8);
    for (Vec3d& p : points) p = random.in_ball();
    const auto spread = [&](const Vec3d& x) {
      double sum = 0;
      double squares = 0;
      for (const Vec3d& p : points) {
        sum += squared_length(x - p);
        squares += squared_length(x - p) * squared_length(x - p);
      }
      return squares / 8 - sum * sum / 64;
    };
    const auto x = EquidistantPoints(points, random.in_ball()).of_rank(3);
    if (!x) continue;
    for (int step = 0; step < 20; ++step) ASSERT_GE(spread(*x + random.in_ball() * 1e-3), spread(*x));
  }
}

}  // namespace
}  // namespace blum
