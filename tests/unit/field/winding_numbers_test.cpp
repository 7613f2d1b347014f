// Proves that the winding numbers of many points equal the sum over all triangles. They are exact whole numbers for
// closed meshes and within the bound for others. The tests use many and few points, and any number of threads.
#include "blum/field/winding_numbers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

/// Returns clusters of points so close that they share answers, and a few scattered points.
std::vector<Vec3d> many_places(const MeshView& mesh, std::size_t count, std::uint64_t seed) {
  const std::vector<Vec3d> some = test::places_around(mesh, count / 64 + 1, seed);
  Random random(seed);
  const double size = bounds(mesh).diagonal();
  std::vector<Vec3d> out;
  for (std::size_t k = 0; k < count; ++k) {
    out.push_back(some[k % some.size()] + random.in_ball() * size * std::pow(10.0, random.uniform(-6.0, -1.0)));
  }
  return out;
}

void expect_like_full_sum(const TriangleMesh& mesh, double max_error, std::uint64_t seed) {
  const std::vector<Vec3d> points = many_places(mesh, std::max<std::size_t>(4200, mesh.triangles.size()), seed);
  const std::vector<double> found = winding_numbers(mesh, points, max_error);
  const std::vector<double> few = winding_numbers(mesh, std::span(points).first(200), max_error);
  const std::vector<ClosestPoint> near = closest_points(mesh, points, {.sign = SignMode::none});
  ASSERT_EQ(found.size(), points.size());
  const double extent = bounds(mesh).diagonal();
  std::size_t differ = 0;
  for (std::size_t k = 0; k < points.size(); k += k < 200 ? 1 : 7) {
    if (near[k].distance < 1e-10 * extent) continue;
    const double truth = reference::winding_number(mesh, points[k]);
    differ += std::abs(found[k] - truth) <= max_error + 1e-11 ? 0 : 1;
    if (k < few.size()) {
      EXPECT_NEAR(few[k], truth, max_error + 1e-11);
    }
  }
  EXPECT_EQ(differ, 0U);
  EXPECT_EQ(found, winding_numbers(mesh, points, max_error, {.threads = 1}));
}

TriangleMesh without_some(TriangleMesh mesh, std::size_t every) {
  std::size_t t = 0;
  std::erase_if(mesh.triangles, [&](const Triangle&) { return t++ % every == 0; });
  return mesh;
}

TEST(WindingNumbers, OfOpenMeshesAndSoups) {
  expect_like_full_sum(without_some(make_sphere({.frequency = 12}), 100), 1e-6, 1);
  expect_like_full_sum(without_some(make_sphere({.frequency = 12}), 100), 1e-9, 2);
  expect_like_full_sum(without_some(make_sphere({.frequency = 12}), 100), 1e-11, 3);
  expect_like_full_sum(without_some(make_sphere({.frequency = 20}), 3), 1e-4, 4);  // boundary too long to close
  expect_like_full_sum(without_some(make_box({}), 3), 1e-6, 5);
  expect_like_full_sum(test::nasty_soup(1, 300), 1e-6, 6);
  expect_like_full_sum(test::moved(without_some(make_sphere({.frequency = 8}), 30), 1e30), 1e-6, 7);
  TriangleMesh twice = without_some(make_sphere({.frequency = 8}), 60);
  append(twice, twice);
  expect_like_full_sum(twice, 1e-6, 8);
}

TEST(WindingNumbers, OfClosedMeshesAreWhole) {
  TriangleMesh crossing = make_sphere({.frequency = 8});
  append(crossing, test::moved(make_sphere({.frequency = 8}), 0.8, {0.5, 0.1, 0.2}));
  append(crossing, test::moved(test::unwelded(make_sphere({.frequency = 6})), 0.5));
  std::vector<double> seen;
  const std::vector<Vec3d> points = many_places(crossing, 6000, 9);
  const std::vector<ClosestPoint> near = closest_points(crossing, points, {.sign = SignMode::none});
  const std::vector<double> found = winding_numbers(crossing, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_EQ(found[k], std::round(found[k]));
    seen.push_back(found[k]);
    if (near[k].distance <= 1e-10) continue;
    EXPECT_EQ(found[k], std::round(reference::winding_number(crossing, points[k])));
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  EXPECT_EQ(seen, (std::vector<double>{0, 1, 2, 3}));
}

TEST(WindingNumbers, OfPointsOnTheConeOfTheBoundary) {
  // The lattice has points on the cone over the box's opening, which is not aligned with the box, and on lines between
  // its corners.
  const TriangleMesh box = without_some(make_box({}), 6);
  std::vector<Vec3d> points;
  for (int x = -4; x <= 4; ++x) {
    for (int y = -4; y <= 4; ++y) {
      for (int z = -4; z <= 4; ++z) points.push_back({x * 0.12, y * 0.12, z * 0.12});
    }
  }
  const std::vector<double> found = winding_numbers(box, points, 1e-8);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(found[k], reference::winding_number(box, points[k]), 1e-8);
  }
}

TEST(WindingNumbers, RejectInvalidInput) {
  const TriangleMesh box = make_box({});
  EXPECT_EQ(winding_numbers(box, {}), std::vector<double>{});
  EXPECT_THROW((void)winding_numbers(box, std::vector<Vec3d>{{0, 0, 0}}, 0), InvalidOption);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)winding_numbers(box, std::vector<Vec3d>{{0, nan, 0}}), InvalidOption);
  EXPECT_THROW((void)winding_numbers({}, std::vector<Vec3d>{{0, 0, 0}}), InvalidMesh);
  EXPECT_EQ(winding_numbers(make_segments({.segments = 3}), std::vector<Vec3d>{{0, 0, 0}}), std::vector<double>{0});
  EXPECT_EQ(winding_numbers(box, std::vector<Vec3d>{{1e200, 0, 0}, {0, 0, 0}}), (std::vector<double>{0, 1}));
}

}  // namespace
}  // namespace blum
