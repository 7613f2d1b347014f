// Distances and contacts of two triangles match rational arithmetic over all pairs of their parts.
#include "blum/geometry/triangle_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "support/nasty_soup.hpp"
#include "support/slow_triangles.hpp"

namespace blum {
namespace {

using Points = std::array<Vec3d, 3>;

double exact_distance(const Points& a, const Points& b) {
  const auto square = test::slow_squared_distance(a, b);
  return std::sqrt(static_cast<double>(square));
}

double largest_difference(const Points& a, const Points& b) {
  double largest = 0;
  for (const Vec3d& p : a) largest = std::max(largest, length(p - a[0]));
  for (const Vec3d& p : b) largest = std::max(largest, length(p - a[0]));
  return largest;
}

/// The distance from a point to a part of a triangle, by rational arithmetic.
double distance_from(const Vec3d& p, const TriangleFeature& feature, const Points& t) {
  const Points point{p, p, p};
  const Vec3d& first = t[feature.index];
  const Vec3d& next = t[(feature.index + 1) % 3];
  if (feature.kind == SiteKind::vertex) return length(p - first);
  return exact_distance(point, feature.kind == SiteKind::edge ? Points{first, next, next} : t);
}

void expect_distance(const Points& a, const Points& b) {
  const TriangleDistance found = triangle_distance(a, b);
  const bool do_meet = test::slow_squared_distance(a, b) == 0;
  ASSERT_EQ(found.distance == 0, do_meet);
  ASSERT_EQ(triangles_meet(a, b), do_meet);
  ASSERT_EQ(triangles_meet(b, a), do_meet);
  const double size = largest_difference(a, b);
  const double rounding = 4e-15 * size + 2e-300;
  ASSERT_NEAR(found.distance, exact_distance(a, b), rounding);
  ASSERT_NEAR(triangle_distance(b, a).distance, found.distance, rounding);
  // The reported points lie on the reported parts, at the reported distance.
  const double far = 4e-15 * (size + std::max({length(a[0]), length(a[1]), length(b[0])})) + 2e-300;
  if (do_meet) {
    ASSERT_EQ(found.first_point, found.second_point);
  }
  const double near =
      do_meet ? 1e-7 * size + far : far;  // the common points of nearly parallel triangles are imprecise
  ASSERT_LE(distance_from(found.first_point, found.first_feature, a), near);
  ASSERT_LE(distance_from(found.second_point, found.second_feature, b), near);
  ASSERT_NEAR(length(found.first_point - found.second_point), found.distance, far);
}

TEST(TriangleDistance, OfRandomTrianglesIsExact) {
  Random random(1);
  for (int k = 0; k < 600; ++k) {
    const double apart = random.uniform() < 0.5 ? 0.5 : 2;
    Points a, b;
    for (Vec3d& p : a) p = random.in_cube();
    for (Vec3d& p : b) p = random.in_cube() + Vec3d{apart, 0, 0};
    expect_distance(a, b);
  }
}

TEST(TriangleDistance, OfNastyTrianglesIsExact) {
  const TriangleMesh soup = test::nasty_soup(2, 70);
  const auto corners = [&](std::size_t k) {
    const auto& [a, b, c] = soup.triangles[k];
    return Points{soup.vertices[a], soup.vertices[b], soup.vertices[c]};
  };
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    for (std::size_t j = 0; j < soup.triangles.size(); j += 3) expect_distance(corners(i), corners(j));
  }
}

/// Corners lie on a small grid: most pairs touch, overlap in a plane, share corners, or have no area.
TEST(TriangleDistance, OfTrianglesOnAGridIsExact) {
  for (const std::uint64_t sides : {2U, 3U, 5U}) {
    Random random(sides);
    const auto whole = [&] {
      const auto one = [&] { return static_cast<double>(random.below(sides)); };
      const double x = one();
      const double y = one();
      return Vec3d{x, y, one()};
    };
    for (int k = 0; k < 600; ++k) {
      Points a, b;
      for (Vec3d& p : a) p = whole();
      for (Vec3d& p : b) p = whole();
      expect_distance(a, b);
      // Coordinates become inexact numbers. Triangles in one grid plane stay coplanar.
      for (std::size_t i = 0; i < 3; ++i) {
        a[i] = a[i] * 0.1 + Vec3d{1e3, 0, 0};
        b[i] = b[i] * 0.1 + Vec3d{1e3, 0, 0};
      }
      expect_distance(a, b);
    }
  }
}

/// A point of one triangle lies on the other one, or one rounding away from it.
TEST(TriangleDistance, OfOneRoundingIsDetected) {
  Random random(3);
  for (int k = 0; k < 400; ++k) {
    Points a, b;
    for (Vec3d& p : a) p = random.in_cube();
    for (Vec3d& p : b) p = random.in_cube();
    const double s = random.uniform();
    const double t = random.uniform() * (1 - s);
    b[0] = k % 2 == 0 ? a[0] + (a[1] - a[0]) * s + (a[2] - a[0]) * t : a[0] + (a[1] - a[0]) * s;
    expect_distance(a, b);
  }
}

TEST(TriangleDistance, OfAnySizeIsExact) {
  Random random(4);
  for (const double scale : {1e-140, 1e-60, 1e-20, 1e20, 1e60, 1e140}) {
    for (int k = 0; k < 40; ++k) {
      Points a, b;
      for (Vec3d& p : a) p = random.in_cube() * scale;
      for (Vec3d& p : b) p = (random.in_cube() + Vec3d{0.7, 0, 0}) * scale;
      expect_distance(a, b);
    }
  }
}

TEST(TriangleDistance, OfNearlyParallelEdgesIsExact) {
  Random random(5);
  for (int k = 0; k < 400; ++k) {
    const Vec3d way = random.in_ball();
    const double turn = std::pow(10.0, -random.uniform(1.0, 16.0));
    const double gap = std::pow(10.0, -random.uniform(0.0, 16.0));
    const Vec3d from = random.in_cube();
    const Vec3d other = from + random.in_ball() * gap + way * random.uniform(-0.5, 0.5);
    expect_distance({from, from + way, from + way}, {other, other + way + random.in_ball() * turn, other});
  }
}

TEST(TriangleDistance, OfABatchMatchesSingleQueries) {
  const TriangleMesh soup = test::nasty_soup(6, 2500);
  std::vector<Points> a, b;
  for (std::size_t k = 0; k < soup.triangles.size(); ++k) {
    const auto& [p, q, r] = soup.triangles[k];
    a.push_back({soup.vertices[p], soup.vertices[q], soup.vertices[r]});
  }
  b.assign(a.rbegin(), a.rend());
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    const std::vector<TriangleDistance> found = triangle_distances(a, b, context);
    ASSERT_EQ(found.size(), a.size());
    for (std::size_t k = 0; k < a.size(); ++k) ASSERT_EQ(found[k].distance, triangle_distance(a[k], b[k]).distance);
  }
}

TEST(TriangleDistance, OfBadInputIsRefused) {
  const std::vector<Points> one{Points{}};
  std::vector<Points> bad{Points{}};
  EXPECT_THROW(static_cast<void>(triangle_distances(one, {})), InvalidOption);
  bad[0][1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(triangle_distances(one, bad)), InvalidMesh);
  bad[0][1].y = 1e151;
  EXPECT_THROW(static_cast<void>(triangle_distances(bad, one)), InvalidMesh);
}

}  // namespace
}  // namespace blum
