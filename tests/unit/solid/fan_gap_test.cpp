// Proves that the bound on the displacement of a fan of triangles whose apex moves is valid. It is compared with the
// distances of many points of both fans, and is seldom much larger for flat fans.
#include "solid/clean/mesh_cleaner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/closest_point.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using Points = std::array<Vec3d, 3>;

std::vector<Points> fan_of(const std::vector<Vec3d>& ring, const Vec3d& apex, bool closed) {
  std::vector<Points> out;
  for (std::size_t k = 0; k + (closed ? 0 : 1) < ring.size(); ++k) {
    out.push_back({apex, ring[k], ring[(k + 1) % ring.size()]});
  }
  return out;
}

/// The largest distance of many points of one fan from another fan.
double sampled_distance(const std::vector<Points>& from, const std::vector<Points>& to) {
  constexpr int steps = 24;
  double most = 0;
  for (const auto& [a, b, c] : from) {
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const Vec3d p = a + (b - a) * (i / double{steps}) + (c - a) * (j / double{steps});
        double least = std::numeric_limits<double>::infinity();
        for (const Points& other : to) least = std::min(least, length(p - closest_point_on_triangle(p, other)));
        most = std::max(most, least);
      }
    }
  }
  return most;
}

struct Fan {
  std::vector<Vec3d> ring;
  Vec3d apex;
  bool closed = true;
};

/// A rotated star-shaped polygon around a point, or on one side of it, with heights up to a limit.
Fan random_fan(Random& random, bool closed, double height) {
  Fan out;
  out.closed = closed;
  const auto corners = static_cast<int>(4 + random.below(5));
  for (int k = 0; k < corners; ++k) {
    const double turn = closed ? 2 * std::numbers::pi / corners : std::numbers::pi / (corners - 1);
    const bool is_end = !closed && (k == 0 || k == corners - 1);
    const double angle = turn * (k + (is_end ? 0 : random.uniform(-0.4, 0.4)));
    const double radius = random.uniform(0.3, 1);
    out.ring.push_back({radius * std::cos(angle), radius * std::sin(angle), random.uniform(0, height)});
  }
  out.apex = {0, 0, random.uniform(0, height)};
  if (!closed) out.apex = closest_point_on_segment({}, out.ring.front(), out.ring.back());
  for (Vec3d& p : out.ring) p = test::turned(p);
  out.apex = test::turned(out.apex);
  return out;
}

void check_bound(const Fan& fan, std::size_t& known, std::size_t& tight) {
  const double bound = detail::fan_gap(fan.ring, fan.apex, fan.closed, 0);
  if (bound == std::numeric_limits<double>::infinity()) return;
  ++known;
  const std::vector<Points> before = fan_of(fan.ring, fan.apex, fan.closed);
  const std::vector<Points> after = fan_of(fan.ring, fan.ring.front(), fan.closed);
  const double found = std::max(sampled_distance(before, after), sampled_distance(after, before));
  EXPECT_GE(bound * (1 + 1e-9), found) << fan.ring.size() << " corners, closed " << fan.closed;
  const double quick = detail::fan_gap(fan.ring, fan.apex, fan.closed, 1e9);
  EXPECT_GE(quick * (1 + 1e-9), bound) << "the quick bound is the looser one";
  if (bound <= 1.5 * found + 1e-12) ++tight;
}

TEST(FanGap, BoundsDistancesOfRandomFans) {
  Random random(1);
  for (const double height : {1e-6, 0.01, 0.2, 1.0}) {
    for (const bool closed : {true, false}) {
      std::size_t known = 0;
      std::size_t tight = 0;
      for (int k = 0; k < 120; ++k) check_bound(random_fan(random, closed, height), known, tight);
      EXPECT_GT(known, height < 0.5 ? 10U : 0U) << height << closed;
      if (height < 0.1) {
        EXPECT_GT(2 * tight, known) << height << closed;
      }
    }
  }
}

TEST(FanGap, IsNearlyZeroInAPlane) {
  const std::vector<Vec3d> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_LT(detail::fan_gap(square, {0.5, 0.4, 0}, true, 0), 1e-13);
  EXPECT_NEAR(detail::fan_gap(square, {0.5, 0.5, 0.25}, true, 0), 0.25, 1e-4);
}

TEST(FanGap, IsInfiniteForFansThatAreNotGraphs) {
  const std::vector<Vec3d> dart{{0, 0, 0}, {2, 1, 0}, {0.5, 0.9, 0}, {0, 2, 0}};
  EXPECT_LT(detail::fan_gap(dart, {0.4, 0.6, 0}, true, 0), 1e-13);
  // The fan folds over at the dent, as seen from the second corner.
  const std::vector<Vec3d> from_tip{dart[1], dart[2], dart[3], dart[0]};
  EXPECT_EQ(detail::fan_gap(from_tip, {0.4, 0.6, 0}, true, 0), std::numeric_limits<double>::infinity());
  // A ring that winds around the apex twice.
  std::vector<Vec3d> twice;
  for (int k = 0; k < 10; ++k) twice.push_back({std::cos(1.2566370614 * k), std::sin(1.2566370614 * k), 0.01 * k});
  EXPECT_EQ(detail::fan_gap(twice, {}, true, 0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace blum
