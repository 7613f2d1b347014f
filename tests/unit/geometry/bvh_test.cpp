// Proves that the bounding-volume hierarchy finds the closest site that a look at every site finds.
#include "blum/geometry/bvh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "blum/field/reference.hpp"
#include "blum/geometry/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// Compares distance, site and point with brute force; the extent that rounding refers to reaches to the query.
void expect_same_as_brute_force(const MeshView& mesh, const std::vector<Vec3d>& places) {
  const reference::BruteForce expected(mesh);
  const Bvh bvh(mesh, expected.sites());
  const Box3 box = bounds(mesh);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3d& q = places[i];
    const std::optional<NearestSite> found = bvh.nearest(q);
    ASSERT_TRUE(found) << i;
    const reference::Nearest truth = expected.nearest(q);
    Box3 both = box;
    both.extend(q);
    const double corner = std::max(length(both.lower), length(both.upper));
    const double tolerance = 1e-12 * both.diagonal() + 4e-16 * corner;
    EXPECT_NEAR(found->distance, truth.distance, tolerance) << i;
    EXPECT_NEAR(expected.site_distance(found->site, q), truth.distance, tolerance) << i;
    EXPECT_NEAR(length(q - found->point), found->distance, tolerance) << i;
  }
}

TEST(Bvh, AgreesWithBruteForceOnAwkwardSoups) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TriangleMesh mesh = test::awkward_soup(seed * 25, seed);
    expect_same_as_brute_force(mesh, test::places_around(mesh, 120, seed));
  }
}

TEST(Bvh, AgreesAtEveryScaleAndOffset) {
  const TriangleMesh mesh = test::awkward_soup(100, 5);
  for (const double scale : {1e-60, 1e-9, 1e9, 1e60}) {
    const TriangleMesh scaled = test::moved(mesh, scale);
    expect_same_as_brute_force(scaled, test::places_around(scaled, 80, 3));
  }
  const TriangleMesh far = test::moved(mesh, 1, {1e6, -1e6, 2e6});
  expect_same_as_brute_force(far, test::places_around(far, 80, 4));
}

TEST(Bvh, FindsTheSmallestSiteOfExactTies) {
  // The middle of a cube is as far from all six sides; a corner's neighbourhood belongs to the vertex.
  const TriangleMesh cube = make_box({});
  const reference::BruteForce expected(cube);
  const Bvh bvh(cube, expected.sites());
  const Vec3d middle = bounds(cube).center();
  EXPECT_EQ(bvh.nearest(middle)->site, expected.nearest(middle).site);
  for (std::uint32_t v = 0; v < cube.vertices.size(); ++v) {
    EXPECT_EQ(bvh.nearest(middle + (cube.vertices[v] - middle) * 1.5)->site, SiteId(v));
    EXPECT_EQ(bvh.nearest(cube.vertices[v])->distance, 0);
  }
}

TEST(Bvh, FindsTheFirstOfCopies) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 0, 1}, {1, 0, 2}};
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  EXPECT_EQ(bvh.nearest({0.2, 0.3, 0.7})->site, sites.id({SiteKind::face, 0}));
  EXPECT_EQ(bvh.nearest({0.4, -0.3, 0.7})->site, sites.id({SiteKind::edge, 0}));
}

TEST(Bvh, SeesNothingBeyondTheLargestDistance) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}};
  mesh.points = {0};
  const Bvh bvh(mesh, SiteTable(mesh));
  EXPECT_FALSE(bvh.nearest({1, 2, 5}, 1.999));
  EXPECT_TRUE(bvh.nearest({1, 2, 5}, 2));
  EXPECT_TRUE(bvh.nearest({1, 2, 3}, 0));
  EXPECT_FALSE(bvh.nearest({NAN, 2, 3}));
  EXPECT_FALSE(bvh.nearest({HUGE_VAL, 2, 3}));
}

TEST(Bvh, TellsEmptyBoxes) {
  const TriangleMesh sphere = make_sphere({.frequency = 8});
  const Bvh bvh(sphere, SiteTable(sphere));
  EXPECT_FALSE(bvh.may_touch({{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}));
  EXPECT_FALSE(bvh.may_touch({{2, 2, 2}, {3, 3, 3}}));
  EXPECT_TRUE(bvh.may_touch({{-0.1, -0.1, 0.5}, {0.1, 0.1, 1.5}}));
  EXPECT_FALSE(bvh.may_touch(Box3{}));
}

TEST(Bvh, IsTheSameOnAnyNumberOfThreads) {
  const TriangleMesh mesh = make_organic({.frequency = 20});
  const SiteTable sites(mesh);
  const Bvh one(mesh, sites, {.threads = 1});
  const Bvh four(mesh, sites, {.threads = 4});
  for (const Vec3d& q : test::places_around(mesh, 500, 1)) {
    EXPECT_EQ(one.nearest(q)->distance, four.nearest(q)->distance);
    EXPECT_EQ(one.nearest(q)->site, four.nearest(q)->site);
  }
}

}  // namespace
}  // namespace blum
