// Proves that random points of surfaces lie on them, by area, and are the same for any threads. If requested, the
// points are even. Points near surfaces have exact distances.
#include "blum/points/sample_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

double area_of(const MeshView& mesh, std::uint32_t t) {
  const auto [a, b, c] = triangle_corners(mesh, t);
  return length(cross(b - a, c - a)) / 2;
}

/// The distance of each point to the closest other one, by comparison of all pairs.
std::vector<double> nearest_others(const std::vector<Vec3d>& points) {
  std::vector<double> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double best = HUGE_VAL;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (j != i) best = std::min(best, squared_length(points[i] - points[j]));
    }
    out.push_back(std::sqrt(best));
  }
  return out;
}

TEST(SampleSurface, LiesOnItsTriangles) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  const SurfaceSamples found = sample_surface(mesh, 5000);
  ASSERT_EQ(found.points.size(), 5000U);
  ASSERT_EQ(found.normals.size(), 5000U);
  ASSERT_EQ(found.triangles.size(), 5000U);
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    const auto [a, b, c] = triangle_corners(mesh, found.triangles[k].value);
    const Vec3d n = cross(b - a, c - a);
    EXPECT_NEAR(length(found.normals[k] - n / length(n)), 0, 1e-12);
    EXPECT_NEAR(dot(found.points[k] - a, found.normals[k]), 0, 1e-14);
    const Vec3d p = found.points[k];
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      EXPECT_GE(dot(cross(to - from, p - from), n), -1e-14);
    }
  }
}

/// Counts per triangle of a mesh whose areas differ by a thousand pass a chi-square test at about 6 sigma.
TEST(SampleSurface, IsUniformByArea) {
  TriangleMesh mesh = make_sphere({.frequency = 4});
  for (Vec3d& v : mesh.vertices) v = {v.x * 10, v.y, v.z * (1.1 + v.x)};
  constexpr std::size_t count = 400000;
  const SurfaceSamples found = sample_surface(mesh, count, {.seed = 5});
  std::vector<double> seen(mesh.triangles.size(), 0);
  for (const TriangleId t : found.triangles) ++seen[t.value];
  double total = 0;
  for (std::uint32_t t = 0; t < seen.size(); ++t) total += area_of(mesh, t);
  double chi = 0;
  for (std::uint32_t t = 0; t < seen.size(); ++t) {
    const double expected = area_of(mesh, t) / total * count;
    chi += (seen[t] - expected) * (seen[t] - expected) / expected;
  }
  const auto freedom = static_cast<double>(seen.size() - 1);
  EXPECT_LT(std::abs(chi - freedom), 6 * std::sqrt(2 * freedom));
  // The mean of the points within a triangle is its middle.
  const TriangleMesh one{{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}}, {{0, 1, 2}}};
  Vec3d mean;
  for (const Vec3d& p : sample_surface(one, 100000).points) mean += p / 100000.0;
  EXPECT_NEAR(length(mean - Vec3d{1, 1, 0}), 0, 0.02);
}

TEST(SampleSurface, IsTheSameForAnyThreadsAndOtherForOtherSeeds) {
  const TriangleMesh mesh = make_torus({});
  for (const bool blue_noise : {false, true}) {
    const SurfaceSamples one = sample_surface(mesh, 9000, {.seed = 3, .blue_noise = blue_noise}, {.threads = 1});
    const SurfaceSamples seven = sample_surface(mesh, 9000, {.seed = 3, .blue_noise = blue_noise}, {.threads = 7});
    EXPECT_EQ(one.points, seven.points);
    EXPECT_EQ(one.triangles, seven.triangles);
    EXPECT_NE(one.points, sample_surface(mesh, 9000, {.seed = 4, .blue_noise = blue_noise}).points);
  }
  // The first points do not depend on the number of points.
  const auto few = sample_surface(mesh, 100).points;
  const auto many = sample_surface(mesh, 5000).points;
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

/// If points are further apart than the plate is thick, its two sides count as one. No two points coincide.
TEST(SampleSurface, OfBlueNoiseKeepsItsDistanceOnThinPlates) {
  for (const double thin : {0.1, 0.05, 0.03, 0.01}) {
    const TriangleMesh plate = make_box({.size = {4, 3, thin}});
    const double area = 2 * (12 + 7 * thin);
    const double lattice = std::sqrt(2 * area / (std::numbers::sqrt3 * 2000));
    const auto even = nearest_others(sample_surface(plate, 2000, {.blue_noise = true}).points);
    EXPECT_GT(*std::min_element(even.begin(), even.end()), lattice * 0.3) << thin;
  }
}

/// A lattice of triangles is the most even: its points lie sqrt(2 area / (sqrt(3) count)) apart.
TEST(SampleSurface, OfBlueNoiseKeepsItsDistance) {
  const TriangleMesh mesh = make_sphere({.frequency = 10});
  double area = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) area += area_of(mesh, t);
  constexpr std::size_t count = 1500;
  const double most = std::sqrt(2 * area / (std::numbers::sqrt3 * count));
  const auto even = nearest_others(sample_surface(mesh, count, {.blue_noise = true}).points);
  const auto random = nearest_others(sample_surface(mesh, count).points);
  EXPECT_GT(*std::min_element(even.begin(), even.end()), 0.6 * most);
  EXPECT_LT(*std::max_element(even.begin(), even.end()), 1.2 * most);
  EXPECT_LT(*std::min_element(random.begin(), random.end()), 0.2 * most);
  // The result does not depend on the scale.
  for (const double scale : {1e-150, 1e150}) {
    TriangleMesh scaled = mesh;
    for (Vec3d& v : scaled.vertices) v = v * scale;
    EXPECT_EQ(sample_surface(scaled, 300, {.blue_noise = true}).triangles,
              sample_surface(mesh, 300, {.blue_noise = true}).triangles);
  }
}

TEST(SampleSurface, LeavesOutPrimitivesWithoutArea) {
  TriangleMesh mesh = make_box({});
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{5, 5, 5}, {6, 6, 6}});
  mesh.triangles.push_back({base, base + 1, base});
  mesh.segments.push_back({base, base + 1});
  for (const TriangleId t : sample_surface(mesh, 1000).triangles) EXPECT_LT(t.value, 12U);
  EXPECT_TRUE(sample_surface(mesh, 0).points.empty());
  EXPECT_TRUE(sample_surface(mesh, 0, {.blue_noise = true}).points.empty());
  EXPECT_EQ(sample_surface(mesh, 1, {.blue_noise = true}).points.size(), 1U);
  TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  EXPECT_THROW((void)sample_surface(flat, 10), InvalidMesh);
  EXPECT_THROW((void)sample_surface(TriangleMesh{}, 10), InvalidMesh);
  EXPECT_THROW((void)sample_surface(mesh, std::size_t{1} << 40), OutOfMemory);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)sample_surface(mesh, 10000, {}, {.cancel = stop.get_token()}), Cancelled);
}

TEST(SampleNear, ReportsExactDistances) {
  const TriangleMesh mesh = make_organic({.frequency = 10});
  const NearSamples found = sample_near(mesh, 20000, {.sigma = 0.02, .in_box = 0.25, .seed = 9});
  ASSERT_EQ(found.points.size(), 20000U);
  ASSERT_EQ(found.closest.size(), 20000U);
  const ClosestPointQuery query(mesh);
  double squares = 0;
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    const ClosestPoint expected = query.nearest(found.points[k]);
    EXPECT_EQ(found.closest[k].distance, expected.distance);
    EXPECT_EQ(found.closest[k].site, expected.site);
    if (k < 15000) squares += expected.distance * expected.distance;
  }
  // Only the part of an offset across the surface counts. It is a little less where the surface bends.
  EXPECT_NEAR(std::sqrt(squares / 15000), 0.02, 0.001);
  const Box3 box = bounds(mesh);
  for (std::size_t k = 15000; k < 20000; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LE(std::abs(found.points[k][axis] - box.center()[axis]), 0.55 * box.size()[axis] * (1 + 1e-12));
    }
  }
  const NearSamples again = sample_near(mesh, 20000, {.sigma = 0.02, .in_box = 0.25, .seed = 9}, {.threads = 5});
  EXPECT_EQ(again.points, found.points);
  EXPECT_THROW((void)sample_near(mesh, 10, {.sigma = 0.0}), InvalidOption);
  EXPECT_THROW((void)sample_near(mesh, 10, {.in_box = 1.5}), InvalidOption);
  EXPECT_THROW((void)sample_near(mesh, 10, {.sigma = NAN}), InvalidOption);
}

}  // namespace
}  // namespace blum
