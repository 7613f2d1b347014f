// Proves that the parts of the verifier are exact: closest points, distances to the faces of voxels, unions of balls
// and Betti numbers. The references are brute force and code that the verifier must not use.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "certificate/ball_union.hpp"
#include "certificate/triangle_search.hpp"
#include "certificate/voxel_betti.hpp"
#include "certificate/voxel_faces.hpp"
#include "support/mesh_places.hpp"

namespace blum::verifier {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

VoxelSet random_set(const std::array<std::int64_t, 3>& size, double density, Random& random) {
  VoxelSet voxels(size);
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) {
        if (random.uniform() < density) voxels.insert(i, j, k);
      }
    }
  }
  return voxels;
}

/// The voxels of an image with a value other than 0.
VoxelSet set_of(const VoxelImage& image) {
  VoxelSet voxels(image.grid.size);
  const auto visit = [&](const auto& values) {
    for (std::int64_t k = 0; k < image.grid.size[2]; ++k) {
      for (std::int64_t j = 0; j < image.grid.size[1]; ++j) {
        for (std::int64_t i = 0; i < image.grid.size[0]; ++i) {
          if (values[image.grid.index(i, j, k)] != 0) voxels.insert(i, j, k);
        }
      }
    }
  };
  std::visit(visit, image.values);
  return voxels;
}

/// A rotated grid whose voxels have three different sides.
GridSpec turned_grid(const std::array<std::int64_t, 3>& size) {
  const double c = std::cos(0.7);
  const double s = std::sin(0.7);
  GridSpec grid{{3, -20, 7}, {0.5, 1.25, 2}, size, {}};
  grid.direction.columns[0] = {c, s, 0};
  grid.direction.columns[1] = {-s * c, c * c, s};
  grid.direction.columns[2] = {s * s, -c * s, c};
  return grid;
}

TEST(TriangleSearch, EqualsTheHierarchy) {
  // Soups contain needles and points. The gear has very uneven triangles: fine teeth on large flat sides.
  for (const TriangleMesh& mesh :
       {make_soup({.triangles = 500, .awkward = 0.7, .seed = 3}), make_shape("gear", {{"teeth", 200}}),
        make_shape("menger"), test::moved(make_shape("torus_knot"), 1e-3, {500, 0, 0})}) {
    const TriangleSearch search(mesh, {}, {});
    const Bvh bvh(mesh, SiteTable(mesh));
    const double scale = bounds(mesh).diagonal() + length(bounds(mesh).center());
    for (const Vec3d& p : test::places_around(mesh, 2000, 5)) {
      const double expected = bvh.nearest(p)->distance;
      ASSERT_NEAR(search.nearest(p).distance, expected, 1e-14 * (scale + expected));
    }
  }
}

TEST(TriangleSearch, SearchesASingleGroup) {
  TriangleMesh mesh = make_box({});
  const std::size_t first = mesh.triangles.size();
  append(mesh, make_box({}), {3, 0, 0});
  std::vector<std::uint32_t> groups(mesh.triangles.size(), 0);
  std::fill(groups.begin() + static_cast<std::ptrdiff_t>(first), groups.end(), 1U);
  const TriangleSearch search(mesh, groups, {});
  EXPECT_DOUBLE_EQ(search.nearest({0.9, 0, 0}, 0).distance, 0.4);
  EXPECT_DOUBLE_EQ(search.nearest({0.9, 0, 0}, 1).distance, 1.6);
  EXPECT_DOUBLE_EQ(search.nearest({1.6, 0, 0}).distance, 0.9);
  EXPECT_EQ(search.nearest({0, 0, 0}, 7).distance, HUGE_VAL);
}

TEST(TriangleSearch, LinesCrossClosedShapesInPairs) {
  const TriangleMesh mesh = make_shape("torus");
  const TriangleSearch search(mesh, {}, {});
  Random random(4);
  std::vector<Crossing> found;
  int crossed = 0;
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const ProbeLine line = line_through(random.in_ball(), k);
    EXPECT_NEAR(dot(line.along, line.across), 0, 1e-15);
    if (!search.crossings(line, found)) continue;
    ASSERT_EQ(found.size() % 2, 0U);
    crossed += found.empty() ? 0 : 1;
    for (const Crossing& crossing : found) {
      ASSERT_LT(search.nearest(line.point + line.along * crossing.at).distance, 1e-14);
    }
  }
  EXPECT_GT(crossed, 500);
}

TEST(TriangleSearch, LinesThroughVerticesAndEdgesAreDoubtful) {
  const TriangleMesh mesh = make_box({});
  const TriangleSearch search(mesh, {}, {});
  std::vector<Crossing> found;
  EXPECT_FALSE(search.crossings(line_through(mesh.vertices[3], 0), found));
  EXPECT_FALSE(search.crossings(line_through({0.5, 0.5, 0.1}, 1), found)) << "on an edge";
  EXPECT_TRUE(search.crossings(line_through({0.1, 0.2, 0.3}, 1), found));
}

TEST(TriangleSearchSlow, AHundredThousandQueries) {
  const TriangleMesh mesh = make_shape("sphere", {{"frequency", 70}});
  const auto start = std::chrono::steady_clock::now();
  const TriangleSearch search(mesh, {}, {});
  std::cout << mesh.triangles.size() << " triangles built in " << seconds_since(start) << " s\n";
  for (const double reach : {0.05, 0.5, 1.0, 5.0}) {
    Random random(6);
    const auto begin = std::chrono::steady_clock::now();
    double sum = 0;
    for (int k = 0; k < 100000; ++k) {
      Vec3d p = random.in_ball();
      if (reach < 1) p = p * ((1 + reach * (random.uniform() - 0.5)) / length(p));
      if (reach > 1) p = p * (reach / length(p));
      sum += search.nearest(p).distance;
    }
    std::cout << "100,000 queries, reach " << reach << ": " << seconds_since(begin) << " s\n";
    EXPECT_GT(sum, 0);
  }
}

/// The distance to the closest of all faces, one by one.
double slow_distance(const VoxelSet& voxels, const GridSpec& grid, const Vec3d& p) {
  const Vec3d q = grid.direction.transposed_times(p - grid.origin);
  double best = HUGE_VAL;
  for (std::int64_t k = 0; k <= grid.size[2]; ++k) {
    for (std::int64_t j = 0; j <= grid.size[1]; ++j) {
      for (std::int64_t i = 0; i <= grid.size[0]; ++i) {
        const std::array<std::int64_t, 3> voxel{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const bool before =
              voxels.contains(i - (axis == 0 ? 1 : 0), j - (axis == 1 ? 1 : 0), k - (axis == 2 ? 1 : 0));
          if (before == voxels.contains(i, j, k)) continue;
          Vec3d off;
          for (std::size_t a = 0; a < 3; ++a) {
            const double low = (static_cast<double>(voxel[a]) - 0.5) * grid.spacing[a];
            const double high = a == axis ? low : low + grid.spacing[a];
            off[a] = q[a] - std::clamp(q[a], low, high);
          }
          best = std::min(best, length(off));
        }
      }
    }
  }
  return best;
}

TEST(VoxelFaces, DistancesAreThoseOfAllFaces) {
  Random random(11);
  for (const std::array<std::int64_t, 3>& size :
       {std::array<std::int64_t, 3>{1, 1, 1}, {7, 6, 5}, {66, 3, 2}, {4, 8, 12}, {9, 1, 4}}) {
    for (const double density : {0.01, 0.3, 0.9, 1.0}) {
      const GridSpec grid = turned_grid(size);
      const VoxelSet voxels = random_set(size, density, random);
      const VoxelFaces surface(voxels, grid, {});
      const Vec3d middle = (grid.position(0, 0, 0) + grid.position(size[0] - 1, size[1] - 1, size[2] - 1)) * 0.5;
      for (int k = 0; k < 60; ++k) {
        const Vec3d p = middle + random.in_ball() * (k % 5 == 0 ? 200.0 : 20.0);
        const double expected = slow_distance(voxels, grid, p);
        if (expected == HUGE_VAL) {
          ASSERT_EQ(surface.distance(p), HUGE_VAL);
        } else {
          ASSERT_NEAR(surface.distance(p), expected, 1e-12);
        }
      }
    }
  }
}

TEST(VoxelFaces, PointsLieInTheirVoxels) {
  Random random(12);
  const GridSpec grid = turned_grid({5, 4, 6});
  const VoxelSet voxels = random_set(grid.size, 0.5, random);
  const VoxelFaces surface(voxels, grid, {});
  for (int k = 0; k < 2000; ++k) {
    const std::array<std::int64_t, 3> at{static_cast<std::int64_t>(random.below(7)) - 1,
                                         static_cast<std::int64_t>(random.below(6)) - 1,
                                         static_cast<std::int64_t>(random.below(8)) - 1};
    const Vec3d off{random.uniform(-0.49, 0.49), random.uniform(-0.49, 0.49), random.uniform(-0.49, 0.49)};
    const Vec3d p = grid.position(at[0], at[1], at[2]) +
                    grid.direction * Vec3d{off.x * grid.spacing.x, off.y * grid.spacing.y, off.z * grid.spacing.z};
    ASSERT_EQ(surface.contains(p), voxels.contains(at[0], at[1], at[2]));
  }
}

TEST(BallUnion, GapsAreThoseOfAllBalls) {
  Random random(13);
  for (const std::size_t count : {1U, 5U, 300U}) {
    std::vector<Ball> balls;
    for (std::size_t b = 0; b < count; ++b) balls.push_back({random.in_cube(), 0.3 * random.uniform()});
    const BallUnion all(balls, {});
    std::uint32_t first = 0;
    BallUnion::Holders holders{};
    int held = 0;
    for (int k = 0; k < 1000; ++k) {
      const Vec3d p = random.in_cube() * 1.5;
      double expected = HUGE_VAL;
      for (const Ball& ball : balls) expected = std::min(expected, length(p - ball.centre) - ball.radius);
      const double gap = all.gap(p, first);
      if (expected > 0) {
        ASSERT_DOUBLE_EQ(gap, expected);
      } else {
        ASSERT_LE(gap, 0);
      }
      ASSERT_EQ(all.holds(p, 0.05, holders), expected < -0.05);
      held += expected < -0.05 ? 1 : 0;
    }
    EXPECT_GT(held, count > 1 ? 10 : -1);
  }
}

TEST(VoxelBetti, EqualsBettiNumbersOfTheGrid) {
  Random random(14);
  for (const std::array<std::int64_t, 3>& size : {std::array<std::int64_t, 3>{1, 1, 1},
                                                  {7, 6, 5},
                                                  {62, 4, 3},
                                                  {63, 4, 3},
                                                  {64, 3, 4},
                                                  {65, 9, 9},
                                                  {130, 4, 3},
                                                  {1, 9, 9},
                                                  {9, 1, 9},
                                                  {9, 9, 1}}) {
    for (const double density : {0.0, 0.05, 0.3, 0.6, 0.9, 1.0}) {
      const VoxelSet voxels = random_set(size, density, random);
      ASSERT_EQ(voxel_betti_numbers(voxels, {}), betti_numbers(voxels)) << size[0] << ", density " << density;
    }
  }
  EXPECT_EQ(voxel_betti_numbers(set_of(make_ball_image({.size = 40, .inner_radius = 0.4})), {}),
            (BettiNumbers{1, 0, 1}));
  // A cubic graph of 27 nodes and 54 edges.
  EXPECT_EQ(voxel_betti_numbers(set_of(make_tube_image({})), {}), (BettiNumbers{1, 28, 0}));
}

TEST(VoxelBettiSlow, HalfABillionCells) {
  const VoxelSet ball = set_of(make_ball_image({.size = 512, .inner_radius = 0.5}));
  auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(voxel_betti_numbers(ball, {}), (BettiNumbers{1, 0, 1}));
  std::cout << "hollow ball of 512^3: " << seconds_since(start) << " s\n";
  start = std::chrono::steady_clock::now();
  const VoxelFaces surface(ball, {{}, {1, 1, 1}, ball.size(), {}}, {.threads = 1});
  std::cout << surface.brick_count() << " bricks found in " << seconds_since(start) << " s\n";
  start = std::chrono::steady_clock::now();
  Random random(1);
  double sum = 0;
  for (int k = 0; k < 100000; ++k) sum += surface.distance(random.in_cube() * 511);
  std::cout << "100,000 distances: " << seconds_since(start) << " s\n";
  EXPECT_GT(sum, 0);
  const VoxelSet noise = random_set({256, 256, 256}, 0.4, random);
  start = std::chrono::steady_clock::now();
  EXPECT_EQ(voxel_betti_numbers(noise, {}), betti_numbers(noise));
  std::cout << "noise of 256^3: " << seconds_since(start) << " s\n";
}

}  // namespace
}  // namespace blum::verifier
