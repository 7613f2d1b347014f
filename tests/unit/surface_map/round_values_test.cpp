// Proves that means and fractions of the distances of a triangle's points agree with dense samples.
#include "surface_map/round_values.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "blum/core/random.hpp"

namespace blum::surface {
namespace {

/// The slow reference: distances of the centroids of n * n equal parts.
std::vector<double> sampled(const std::array<Vec3d, 3>& p, int n) {
  std::vector<double> out;
  const auto add = [&](double x, double y) {
    out.push_back(length(p[0] + (p[1] - p[0]) * (x / n) + (p[2] - p[0]) * (y / n)));
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      add(i + 1 / 3.0, j + 1 / 3.0);
      if (i + j + 1 < n) add(i + 2 / 3.0, j + 2 / 3.0);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

void expect_agreement(const std::array<Vec3d, 3>& p, int which) {
  const RoundValues round(p);
  ASSERT_TRUE(round.is_accurate()) << which;
  const std::vector<double> distances = sampled(p, 200);
  const auto count = static_cast<double>(distances.size());
  double mean = 0;
  double square = 0;
  for (const double d : distances) {
    mean += d / count;
    square += d * d / count;
  }
  EXPECT_NEAR(round.mean().value, mean, 2e-5 + round.mean().error + round.value_error()) << which;
  EXPECT_NEAR(round.mean_square(), square, 1e-4) << which;
  EXPECT_LE(round.lowest(), distances.front()) << which;
  EXPECT_GE(round.highest(), distances.back()) << which;
  double before = 0;
  for (int k = 1; k < 20; ++k) {
    const double value = round.lowest() + (round.highest() - round.lowest()) * k / 20;
    const auto below = std::upper_bound(distances.begin(), distances.end(), value) - distances.begin();
    const double fraction = round.fraction_below(value);
    EXPECT_NEAR(fraction, static_cast<double>(below) / count, 0.02 + round.fraction_error()) << which << " " << k;
    EXPECT_GE(fraction, before - 1e-9) << which << " " << k;
    before = fraction;
  }
  EXPECT_EQ(round.fraction_below(round.highest()), 1);
  EXPECT_EQ(round.fraction_below(round.lowest() / 2 - 1e-12), 0);
}

TEST(RoundValues, AgreeWithDenseSamples) {
  Random random(3);
  for (int k = 0; k < 100; ++k) {
    std::array<Vec3d, 3> p{random.in_cube(), random.in_cube(), random.in_cube()};
    if (k % 4 == 1) {  // a plane through the origin, as for the closest points of an edge
      for (Vec3d& v : p) v.z = 0;
    } else if (k % 4 == 2) {  // a segment
      for (Vec3d& v : p) v = {v.x, 0.3, 0.1};
    } else if (k % 4 == 3) {  // a corner at the origin
      p[static_cast<std::size_t>(k / 4 % 3)] = {};
    }
    expect_agreement(p, k);
  }
}

TEST(RoundValues, OfKnownTriangles) {
  // A right isosceles triangle with the origin at a sharp corner: the integral of 1 / cos^3 is known.
  const RoundValues flat({Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{1, 1, 0}});
  EXPECT_NEAR(flat.mean().value, (std::sqrt(2.0) + std::asinh(1.0)) / 3, 1e-14);
  EXPECT_NEAR(flat.fraction_below(1), std::acos(-1.0) / 4, 1e-14);
  EXPECT_NEAR(flat.mean_square(), 2.0 / 3, 1e-14);
  // Positions along a segment: |x| for x from -1 to 1, twice as often in the middle.
  const RoundValues segment({Vec3d{-1, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 0, 0}});
  EXPECT_NEAR(segment.mean().value, 1.0 / 3, 1e-14);
  EXPECT_NEAR(segment.fraction_below(0.5), 0.75, 1e-14);
  EXPECT_FALSE(RoundValues({Vec3d{1, 2, 3}, Vec3d{1, 2, 3}, Vec3d{1, 2, 3}}).is_accurate());
}

}  // namespace
}  // namespace blum::surface
