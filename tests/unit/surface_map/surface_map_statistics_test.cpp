// Proves that statistics of maps are weighted by area. The tests use known means and percentiles, texels of different
// sizes and maps without values. Maps of other meshes are rejected.
#include "blum/surface_map/surface_map_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/surface_map/thickness.hpp"

namespace blum {
namespace {

const TriangleMesh slope{{{0, 0, 0}, {2, 0, 1}, {2, 3, 1}, {0, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
const TriangleMesh plane{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};

/// On this slope, the distance from the plane is evenly distributed from 0 to 1.
TEST(SurfaceMapStatistics, OfASlope) {
  const SurfaceMapStatistics found = surface_map_statistics(slope, surface_distance_map(slope, plane, {.texel = 0.01}));
  EXPECT_NEAR(found.area, 3 * std::sqrt(5.0), 1e-12);
  EXPECT_NEAR(found.measured_area, found.area, 1e-12);
  EXPECT_NEAR(found.mean, 0.5, 0.002);
  EXPECT_NEAR(found.rms, std::sqrt(1.0 / 3), 0.002);
  EXPECT_LT(found.smallest, 0.01);
  EXPECT_GT(found.largest, 0.99);
  for (std::size_t k = 0; k < found.percentiles.size(); ++k) {
    EXPECT_NEAR(found.percentiles[k], SurfaceMapStatistics::percents[k] / 100, 0.005);
  }
}

/// Linear values are spread exactly, however large texels are. Percentiles are never beyond the values of texels, so 1
/// % and 99 % are not compared.
TEST(SurfaceMapStatistics, OfASlopeDoNotDependOnTheTexel) {
  TriangleMesh above = slope;
  for (Vec3d& v : above.vertices) v.z += 1;
  for (const double texel : {0.3, 0.11, 0.03}) {
    const SurfaceMapStatistics found =
        surface_map_statistics(above, surface_distance_map(above, plane, {.texel = texel}));
    EXPECT_NEAR(found.mean, 1.5, 1e-6);
    for (std::size_t k = 1; k + 1 < found.percentiles.size(); ++k) {
      EXPECT_NEAR(found.percentiles[k], 1 + SurfaceMapStatistics::percents[k] / 100, 0.03 * texel) << texel;
    }
  }
}

/// Exact distances of a coarse sphere's points from a fine sphere, at the centroids of equal parts of each triangle.
std::vector<std::pair<double, double>> distances_by_area(const TriangleMesh& mesh, const TriangleMesh& other) {
  constexpr int parts = 40;
  std::vector<Vec3d> points;
  std::vector<double> areas;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    const double area = length(cross(b - a, c - a)) / 2 / (parts * parts);
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < 2 * (parts - i) - 1; ++j) {
        const double third = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
        const double u = (i + third) / parts;
        const double v = (j / 2 + third) / parts;
        points.push_back(a + (b - a) * u + (c - a) * v);
        areas.push_back(area);
      }
    }
  }
  const std::vector<ClosestPoint> found = closest_points(other, points);
  std::vector<std::pair<double, double>> out;
  for (std::size_t k = 0; k < points.size(); ++k) out.emplace_back(found[k].distance, areas[k]);
  std::sort(out.begin(), out.end());
  return out;
}

/// All triangles of the coarse sphere are nearly alike, so an error at their borders would not average out.
TEST(SurfaceMapStatistics, PercentilesOfDistancesAreThoseOfTheWholeArea) {
  const TriangleMesh coarse = make_sphere({.frequency = 5});
  const TriangleMesh fine = make_sphere({.frequency = 40});
  const auto exact = distances_by_area(coarse, fine);
  double all = 0;
  for (const auto& [distance, area] : exact) all += area;
  const SurfaceMapStatistics found =
      surface_map_statistics(coarse, surface_distance_map(coarse, fine, {.sign = SignMode::automatic}));
  EXPECT_NEAR(found.area, all, 1e-9);
  std::size_t k = 0;
  double below = 0;
  for (const auto& [distance, area] : exact) {
    below += area;
    while (k < found.percentiles.size() && below >= all * SurfaceMapStatistics::percents[k] / 100) {
      EXPECT_NEAR(found.percentiles[k], distance, 0.008 * std::abs(exact.front().first))
          << SurfaceMapStatistics::percents[k] << " %";
      ++k;
    }
  }
  EXPECT_EQ(k, found.percentiles.size());
}

/// A box of 1 x 1 x 1/4 has thickness 1/4 on two thirds of its area and 1 on the rest, for any triangulation.
TEST(SurfaceMapStatistics, AreWeightedByAreaForAnySizeOfTriangles) {
  const TriangleMesh box = make_box({.size = {1, 1, 0.25}});
  const SurfaceMapStatistics coarse = surface_map_statistics(box, thickness_map(box, {.texel = 0.02}));
  EXPECT_NEAR(coarse.area, 3, 1e-12);
  EXPECT_NEAR(coarse.mean, (2 * 0.25 + 1) / 3, 1e-6);
  EXPECT_NEAR(coarse.percentiles[3], 0.25, 1e-6);
  EXPECT_NEAR(coarse.percentiles[4], 1, 1e-6);
  // Here one triangle is split into three, and texels have another size.
  TriangleMesh split = box;
  const Triangle t = split.triangles[0];
  const auto middle = static_cast<std::uint32_t>(split.vertices.size());
  split.vertices.push_back((box.vertices[t[0]] + box.vertices[t[1]] + box.vertices[t[2]]) / 3.0);
  split.triangles[0] = {t[0], t[1], middle};
  split.triangles.push_back({t[1], t[2], middle});
  split.triangles.push_back({t[2], t[0], middle});
  const SurfaceMapStatistics other = surface_map_statistics(split, thickness_map(split, {.texel = 0.01}));
  EXPECT_NEAR(other.area, coarse.area, 1e-12);
  EXPECT_NEAR(other.mean, coarse.mean, 1e-6);
  EXPECT_NEAR(other.rms, coarse.rms, 1e-6);
}

/// Border texels of a triangle lie mostly outside it and count by their inner part. The triangle rises from a side to a
/// corner, so the area above height h is proportional to (1 - h)^2.
TEST(SurfaceMapStatistics, OfOneTriangleAreNotBiasedByItsBorder) {
  const TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 1}}, {{0, 1, 2}}, {}, {}};
  for (const double texel : {0.01, 0.05, 0.1}) {
    const SurfaceMapStatistics found =
        surface_map_statistics(triangle, surface_distance_map(triangle, plane, {.texel = texel}));
    EXPECT_NEAR(found.mean, 1.0 / 3, texel * texel) << texel;
    EXPECT_NEAR(found.rms, std::sqrt(1.0 / 6), texel * texel) << texel;
    for (std::size_t k = 0; k < found.percentiles.size(); ++k) {
      EXPECT_NEAR(found.percentiles[k], 1 - std::sqrt(1 - SurfaceMapStatistics::percents[k] / 100), texel) << texel;
    }
  }
}

TEST(SurfaceMapStatistics, CountOnlyTexelsWithAValue) {
  const SurfaceMap map = surface_distance_map(slope, plane, {.texel = 0.02, .max_distance = 0.5});
  const SurfaceMapStatistics found = surface_map_statistics(slope, map);
  EXPECT_NEAR(found.measured_area / found.area, 0.5, 0.02);
  EXPECT_NEAR(found.mean, 0.25, 0.01);
  EXPECT_LE(found.largest, 0.5F);
  const TriangleMesh far{{{0, 0, 100}}, {}, {}, {0}};
  const SurfaceMapStatistics none =
      surface_map_statistics(slope, surface_distance_map(slope, far, {.texel = 0.1, .max_distance = 1}));
  EXPECT_EQ(none.measured_area, 0);
  EXPECT_EQ(none.mean, 0);
  EXPECT_NEAR(none.area, 3 * std::sqrt(5.0), 1e-12);
}

/// Areas and squares neither overflow nor underflow if the values are in range.
TEST(SurfaceMapStatistics, OfHugeAndTinyMeshes) {
  for (const double size : {1e-30, 1e30}) {
    TriangleMesh mesh = slope;
    TriangleMesh other = plane;
    for (Vec3d& v : mesh.vertices) v *= size;
    for (Vec3d& v : other.vertices) v *= size;
    const SurfaceMapStatistics found =
        surface_map_statistics(mesh, surface_distance_map(mesh, other, {.texel = 0.05 * size}));
    EXPECT_NEAR(found.mean / size, 0.5, 0.01);
    EXPECT_NEAR(found.rms / size, std::sqrt(1.0 / 3), 0.01);
    EXPECT_NEAR(found.area / size / size, 3 * std::sqrt(5.0), 1e-9);
  }
}

TEST(SurfaceMapStatistics, RefuseMapsOfOtherMeshes) {
  SurfaceMap map = surface_distance_map(slope, plane, {.texel = 0.5});
  EXPECT_THROW(static_cast<void>(surface_map_statistics(make_box(), map)), InvalidMesh);
  auto atlas = std::make_shared<SurfaceAtlas>(surface_atlas(slope, 0.5));
  for (TriangleId& triangle : atlas->triangle) {
    if (triangle.has_value()) triangle = TriangleId(7);
  }
  map.atlas = atlas;
  EXPECT_THROW(static_cast<void>(surface_map_statistics(slope, map)), InvalidMesh);
  map.atlas = nullptr;
  EXPECT_THROW(static_cast<void>(surface_map_statistics(slope, map)), InvalidMesh);
}

}  // namespace
}  // namespace blum
