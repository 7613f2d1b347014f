// Proves that ball_union_field() computes the smallest |x - centre| - radius over all balls. Balls are points, nested,
// equal, far away or around one point. Grids have any direction. The result has the same bytes for any number of
// threads.
#include "blum/field/ball_union.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <stop_token>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/zero_surface.hpp"
#include "blum/geometry/topology.hpp"

namespace blum {
namespace {

using Size = std::array<std::int64_t, 3>;

double smallest(const std::vector<Ball>& balls, const Vec3d& x) {
  double best = std::numeric_limits<double>::infinity();
  for (const Ball& ball : balls) best = std::min(best, length(x - ball.centre) - ball.radius);
  return best;
}

/// Compares every `step`-th node. The library may round doubles differently, so floats may differ in their last bit.
void expect_smallest(const std::vector<Ball>& balls, const GridSpec& grid, std::size_t step = 1) {
  const Field field = ball_union_field(balls, grid);
  ASSERT_EQ(field.distance.size(), grid.node_count());
  EXPECT_TRUE(field.site.empty());
  std::size_t wrong = 0;
  for (std::size_t node = 0; node < field.distance.size(); node += step) {
    const auto n = static_cast<std::int64_t>(node);
    const Vec3d x = grid.position(n % grid.size[0], n / grid.size[0] % grid.size[1], n / (grid.size[0] * grid.size[1]));
    const double expected = smallest(balls, x);
    const double tolerance = 6e-8 * std::abs(expected) + 1e-13 * (length(x) + length(balls.front().centre));
    if (!(std::abs(static_cast<double>(field.distance[node]) - expected) <= tolerance)) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
}

std::vector<Ball> random_balls(std::size_t count, double largest_radius, std::uint64_t seed) {
  Random random(seed);
  std::vector<Ball> balls(count);
  for (Ball& ball : balls) ball = {random.in_cube(), random.uniform(0, largest_radius)};
  return balls;
}

GridSpec grid_of(const Size& size, const Vec3d& spacing, const Vec3d& origin = {}) {
  GridSpec grid;
  grid.size = size;
  grid.spacing = spacing;
  grid.origin = origin;
  return grid;
}

/// A grid around the unit cube.
GridSpec unit_grid(std::int64_t nodes) {
  const double spacing = 1.4 / static_cast<double>(nodes - 1);
  return grid_of({nodes, nodes, nodes}, {spacing, spacing, spacing}, {-0.2, -0.2, -0.2});
}

Mat3 skew_direction() {
  const Vec3d a = Vec3d{1, 2, -0.5} / length(Vec3d{1, 2, -0.5});
  const Vec3d other = cross(a, {0.3, -0.2, 1});
  const Vec3d b = other / length(other);
  return {{a, b, -cross(a, b)}};
}

TEST(BallUnion, RandomBalls) {
  for (const double largest_radius : {0.0, 0.01, 0.1, 1.0}) {
    for (const std::size_t count : {1U, 2U, 7U, 300U, 3000U}) {
      expect_smallest(random_balls(count, largest_radius, count), unit_grid(33), count > 300 ? 13 : 1);
    }
  }
}

TEST(BallUnion, GridsLargerThanABlock) {
  expect_smallest(random_balls(500, 0.05, 3), unit_grid(101), 17);
  expect_smallest(random_balls(500, 0.05, 3), grid_of({400, 90, 3}, {0.003, 0.01, 0.3}), 7);
}

TEST(BallUnion, AnyDirectionAndSpacing) {
  GridSpec grid = grid_of({40, 11, 25}, {0.02, 0.13, 0.05}, {0.5, -0.5, 0.2});
  for (const Mat3& direction : {Mat3{}, skew_direction()}) {
    grid.direction = direction;
    expect_smallest(random_balls(400, 0.1, 4), grid);
  }
}

TEST(BallUnion, FlatAndSingleGrids) {
  const std::vector<Ball> balls = random_balls(200, 0.2, 5);
  expect_smallest(balls, grid_of({50, 60, 1}, {0.02, 0.02, 0.02}));
  expect_smallest(balls, grid_of({1, 1, 500}, {1, 1, 0.002}));
  expect_smallest(balls, grid_of({1, 1, 1}, {1, 1, 1}, {0.3, 0.3, 0.3}));
}

TEST(BallUnion, PointsOnASphere) {
  // Near the centre, all points are almost equally far.
  Random random(6);
  std::vector<Ball> balls;
  while (balls.size() < 2000) {
    const Vec3d p = random.in_ball();
    if (length(p) > 0.1) balls.push_back({Vec3d{0.5, 0.5, 0.5} + p * (0.5 / length(p)), 0});
  }
  expect_smallest(balls, unit_grid(29), 3);
}

TEST(BallUnion, MedialBallsOfASlab) {
  // All radii on the lattice are equal, so that ties occur everywhere.
  std::vector<Ball> balls;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) balls.push_back({{i / 60.0, j / 60.0, 0.5}, 0.125});
  }
  expect_smallest(balls, unit_grid(29));
}

TEST(BallUnion, NestedBalls) {
  std::vector<Ball> balls;
  for (int i = 1; i <= 200; ++i) balls.push_back({{0.5 + 1e-3 * i, 0.5, 0.5}, 2e-3 * i});
  expect_smallest(balls, unit_grid(25));
  for (Ball& ball : balls) ball.centre = {0.5, 0.5, 0.5};
  expect_smallest(balls, unit_grid(25));
}

TEST(BallUnion, FarAwayBalls) {
  std::vector<Ball> balls = random_balls(300, 0.1, 7);
  for (Ball& ball : balls) ball.centre += {1e5, -2e5, 1e4};
  expect_smallest(balls, unit_grid(21));
  // Large distant balls nearly touch the grid.
  for (Ball& ball : balls) ball.radius += length(balls.front().centre) - 2;
  expect_smallest(balls, unit_grid(21));
}

TEST(BallUnion, ManyEqualBallsCostNoMoreThanOne) {
  const std::vector<Ball> balls(200000, Ball{{0.4, 0.5, 0.6}, 0.25});
  const GridSpec grid = unit_grid(64);
  const Field many = ball_union_field(balls, grid);
  const Field one = ball_union_field(std::span(balls).first(1), grid);
  EXPECT_EQ(std::memcmp(many.distance.data(), one.distance.data(), one.distance.span().size_bytes()), 0);
}

TEST(BallUnion, SurfaceOfTwoBalls) {
  for (const double apart : {0.3, 1.2}) {
    const std::vector<Ball> balls{{{0, 0, 0}, 0.5}, {{apart, 0, 0}, 0.5}};
    const GridSpec grid = grid_around(bounds(balls), 64);
    const TriangleMesh mesh = zero_surface(ball_union_field(balls, grid));
    const Topology t = topology(mesh);
    EXPECT_TRUE(t.closed && t.manifold && t.faces_outwards);
    EXPECT_EQ(t.betti, (std::array<std::int64_t, 3>{apart < 1 ? 1 : 2, 0, 0}));
    for (const Vec3d& v : mesh.vertices) EXPECT_NEAR(smallest(balls, v), 0, 0.2 * grid.spacing.x);
  }
}

TEST(BallUnion, Bounds) {
  EXPECT_TRUE(bounds(std::span<const Ball>{}).is_empty());
  const std::vector<Ball> balls{{{0, 1, 2}, 1}, {{5, 0, 2}, 0}};
  EXPECT_EQ(bounds(balls).lower, (Vec3d{-1, 0, 1}));
  EXPECT_EQ(bounds(balls).upper, (Vec3d{5, 2, 3}));
}

TEST(BallUnion, SameBytesOnAnyNumberOfThreads) {
  const std::vector<Ball> balls = random_balls(2000, 0.05, 8);
  const GridSpec grid = unit_grid(130);
  const Field one = ball_union_field(balls, grid, {.threads = 1});
  for (const int threads : {2, 7}) {
    const Field field = ball_union_field(balls, grid, {.threads = threads});
    EXPECT_EQ(std::memcmp(field.distance.data(), one.distance.data(), one.distance.span().size_bytes()), 0);
  }
}

TEST(BallUnion, RejectsInvalidBallsAndGrids) {
  const GridSpec grid = unit_grid(4);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)ball_union_field({}, grid), InvalidOption);
  for (const Ball& bad : {Ball{{0, 0, 0}, -1}, Ball{{0, 0, 0}, nan}, Ball{{0, 0, 0}, infinity}, Ball{{nan, 0, 0}, 1},
                          Ball{{0, nan, 0}, 1}, Ball{{0, 0, infinity}, 1}, Ball{{0, -1e200, 0}, 1}}) {
    EXPECT_THROW((void)ball_union_field(std::vector<Ball>{{{0, 0, 0}, 1}, bad}, grid), InvalidOption);
  }
  EXPECT_THROW((void)ball_union_field(std::vector<Ball>{{{0, 0, 0}, 1}}, GridSpec{}), InvalidGrid);
}

TEST(BallUnion, CanBeCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)ball_union_field(random_balls(10, 0.1, 9), unit_grid(20), {.cancel = stop.get_token()}),
               Cancelled);
}

}  // namespace
}  // namespace blum
