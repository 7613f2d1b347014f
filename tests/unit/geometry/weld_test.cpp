// Proves that weld() finds the clusters of a comparison of all pairs, renumbers in the promised order, and keeps the
// shape if triangles collapse. Crowded or far-off vertices take only a moment.
#include "blum/geometry/weld.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// Compares all pairs. Returns the smallest vertex that a chain of steps no longer than the tolerance reaches.
std::vector<std::uint32_t> slow_clusters(const std::vector<Vec3d>& vertices, double tolerance) {
  std::vector<std::uint32_t> cluster(vertices.size());
  for (std::uint32_t i = 0; i < cluster.size(); ++i) cluster[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::uint32_t i = 0; i < cluster.size(); ++i) {
      for (std::uint32_t j = 0; j < cluster.size(); ++j) {
        const Vec3d& a = vertices[i];
        const Vec3d& b = vertices[j];
        if (cluster[j] < cluster[i] && (a == b || std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) <= tolerance)) {
          cluster[i] = cluster[j];
          changed = true;
        }
      }
    }
  }
  return cluster;
}

double seconds(const auto& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Weld, ExactDuplicatesTakeTheOrderOfTheirFirstMember) {
  const TriangleMesh mesh = {
      .vertices = {{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-0.0, 0, -0.0}, {1, 0, 0}, {5, 5, 5}, {0, 0, 1}},
      .triangles = {{0, 2, 1}, {3, 4, 6}}};
  const TriangleMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertices, (std::vector<Vec3d>{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {5, 5, 5}, {0, 0, 1}}));
  EXPECT_EQ(welded.triangles, (std::vector<Triangle>{{0, 2, 1}, {1, 0, 4}}));
  EXPECT_TRUE(welded.segments.empty());
  EXPECT_TRUE(welded.points.empty());
}

TEST(Weld, NeighbouringDoublesAreNotEqual) {
  const double next = std::nextafter(1.0, 2.0);
  EXPECT_EQ(weld_clusters(std::vector<Vec3d>{{1, 1, 1}, {1, 1, next}, {1, next, 1}, {next, 1, 1}}, 0),
            (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(Weld, ClustersAgreeWithAllPairs) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 300; ++round) {
    // Random, on a grid (many exact ties with the tolerance), on a line, far from the origin, or at all scales at once.
    std::uniform_real_distribution<double> unit(-1, 1);
    std::uniform_int_distribution<int> whole(0, 4);
    std::vector<Vec3d> vertices(1 + random() % 150);
    const double tolerance = std::pow(10.0, -3.0 * std::abs(unit(random)));
    for (Vec3d& v : vertices) {
      switch (round % 5) {
        case 0:
          v = {unit(random), unit(random), unit(random)};
          break;
        case 1:
          v = Vec3d{1.0 * whole(random), 1.0 * whole(random), 1.0 * whole(random)} * tolerance;
          break;
        case 2:
          v = {unit(random), 0, 0};
          break;
        case 3:
          v = {1e15 + whole(random), 1e15 + whole(random), -1e15 + 4 * whole(random)};
          break;
        default:
          for (std::size_t axis = 0; axis < 3; ++axis) v[axis] = unit(random) * std::pow(10.0, 6 * unit(random));
      }
    }
    ASSERT_EQ(weld_clusters(vertices, tolerance), slow_clusters(vertices, tolerance)) << "round " << round;
    ASSERT_EQ(weld_clusters(vertices, 0), slow_clusters(vertices, 0)) << "round " << round;
  }
}

TEST(Weld, CrowdsNearTheToleranceAgreeWithAllPairs) {
  // Two crowds in different cells, slightly closer or farther than the tolerance, need the search by halving.
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 200; ++round) {
    const double gap = 1 + 1e-3 * unit(random);
    std::vector<Vec3d> vertices;
    for (int i = 0; i < 60; ++i) {
      vertices.push_back({0.01 * unit(random), 0.1 * unit(random), 0.1 * unit(random)});
      vertices.push_back({gap + 0.01 * unit(random), 0.1 * unit(random), 0.1 * unit(random)});
    }
    ASSERT_EQ(weld_clusters(vertices, 0.99), slow_clusters(vertices, 0.99)) << "round " << round;
  }
}

TEST(Weld, ChainsBecomeOneVertexAtTheirSmallestIndex) {
  TriangleMesh mesh;
  for (int i = 0; i < 1000; ++i) mesh.vertices.push_back({0.9 * ((i * 7 + 500) % 1000), 0, 0});
  mesh.points = {999, 3, 0};
  const TriangleMesh welded = weld(mesh, 1.0);
  EXPECT_EQ(welded.vertices, (std::vector<Vec3d>{{450, 0, 0}}));
  EXPECT_EQ(welded.points, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(weld(mesh, 0.89).vertices.size(), 1000U);
}

TEST(Weld, CollapsedTrianglesLeaveTheirUnsharedEdges) {
  const TriangleMesh mesh = {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {9, 9, 9}, {8, 8, 8}},
                             .triangles = {{0, 1, 2}, {0, 0, 1}, {3, 1, 3}, {1, 3, 3}, {4, 4, 4}, {0, 0, 0}},
                             .segments = {{2, 3}, {5, 5}, {3, 2}},
                             .points = {2, 2}};
  const TriangleMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertices, mesh.vertices);
  EXPECT_EQ(welded.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  // 0-1 is an edge of the triangle. Two collapsed triangles lost 1-3.
  EXPECT_EQ(welded.segments, (std::vector<Segment>{{2, 3}, {3, 2}, {1, 3}}));
  // 4 and 5 lost their triangle and segment. 0 is a corner of a triangle. The input lists point 2.
  EXPECT_EQ(welded.points, (std::vector<std::uint32_t>{2, 4, 5}));
}

TEST(Weld, RepeatedTrianglesAreKept) {
  const TriangleMesh mesh = {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}, {0, 1, 2}}};
  EXPECT_EQ(weld(mesh).triangles, mesh.triangles);
}

TEST(Weld, BadInputIsRefused) {
  const TriangleMesh mesh = {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 3}}};
  EXPECT_THROW((void)weld(mesh), InvalidMesh);
  EXPECT_THROW((void)weld(TriangleMesh{.vertices = mesh.vertices, .segments = {{0, 7}}}), InvalidMesh);
  EXPECT_THROW((void)weld(TriangleMesh{.vertices = mesh.vertices, .points = {3}}), InvalidMesh);
  EXPECT_THROW((void)weld(MeshView{}, -1e-9), InvalidOption);
  EXPECT_THROW((void)weld(MeshView{}, std::nan("")), InvalidOption);
  EXPECT_THROW((void)weld(MeshView{}, std::numeric_limits<double>::infinity()), InvalidOption);
  EXPECT_TRUE(weld(MeshView{}, 1.0).vertices.empty());
}

TEST(Weld, CoordinatesOfAnyMagnitude) {
  constexpr double huge = std::numeric_limits<double>::max();
  constexpr double tiny = std::numeric_limits<double>::denorm_min();
  const double nan = std::nan("");
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Vec3d> vertices = {{huge, -huge, 0}, {-huge, huge, 0},    {0, 0, tiny},     {0, 0, 0},
                                       {nan, 0, 0},      {nan, 0, 0},         {infinity, 0, 0}, {infinity, 0, 0},
                                       {huge, -huge, 0}, {huge, -huge, 1e-7}, {1e-7, 0, 0}};
  EXPECT_EQ(weld_clusters(vertices, 0), (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 4, 6, 6, 0, 9, 10}));
  EXPECT_EQ(weld_clusters(vertices, 1e-6), (std::vector<std::uint32_t>{0, 1, 2, 2, 4, 4, 6, 6, 0, 0, 2}));
  EXPECT_EQ(weld_clusters(vertices, tiny), weld_clusters(vertices, 0));
  EXPECT_EQ(weld_clusters(vertices, huge), (std::vector<std::uint32_t>{0, 1, 2, 2, 4, 4, 6, 6, 0, 0, 2}));
}

TEST(WeldSlow, CrowdsTakeNoMoreThanAMoment) {
  // Each of these needs minutes if pairs of vertices are compared.
  constexpr std::uint32_t count = 200000;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3d> same(count, Vec3d{1, 2, 3});
  std::vector<Vec3d> crowd(count), two_crowds(count), outlier(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    crowd[i] = {unit(random), unit(random), unit(random)};
    two_crowds[i] =
        Vec3d{i % 2 == 0 ? 0.0 : 1.0 + 1e-3, 0, 0} + Vec3d{1e-4 * unit(random), unit(random), unit(random)} * 0.1;
    outlier[i] = i == 0 ? Vec3d{1e300, 1e300, 1e300} : crowd[i];
  }
  EXPECT_LT(seconds([&] { EXPECT_EQ(weld_clusters(same, 1e-3), std::vector<std::uint32_t>(count, 0)); }), 20.0);
  EXPECT_LT(seconds([&] { EXPECT_EQ(weld_clusters(crowd, 10.0), std::vector<std::uint32_t>(count, 0)); }), 20.0);
  EXPECT_LT(seconds([&] { EXPECT_EQ(weld_clusters(two_crowds, 1.0)[1], 1U); }), 20.0);
  EXPECT_LT(seconds([&] { EXPECT_EQ(weld_clusters(outlier, 1e-12)[count - 1], count - 1); }), 20.0);
}

}  // namespace
}  // namespace blum
