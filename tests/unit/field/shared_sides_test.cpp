// Proves that points that share answers get the sides that their own winding numbers decide. The tests cover points
// near rims of holes, near and on the surface, between crossing sheets, in soups, and at any scale.
#include "field/sign/shared_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

/// Removes every `every`-th triangle from a mesh.
TriangleMesh with_holes(TriangleMesh mesh, std::size_t every) {
  std::vector<Triangle> kept;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t % every != 0) kept.push_back(mesh.triangles[t]);
  }
  mesh.triangles = kept;
  return mesh;
}

/// Returns small and large clouds of points around places on the surface. Each cloud is one group of queries.
std::vector<std::vector<sign::SidedPoint>> clouds(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  Random random(seed);
  const double extent = bounds(mesh).diagonal();
  std::vector<std::vector<sign::SidedPoint>> out;
  for (std::size_t c = 0; c < count; ++c) {
    const Triangle& t = mesh.triangles[random.below(mesh.triangles.size())];
    const Vec3d on_surface = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) * (1.0 / 3);
    Vec3d middle = bvh.bounds().center();
    for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += random.uniform(-0.5, 0.5) * bvh.bounds().size()[axis];
    if (c % 2 == 0) middle = on_surface;
    const double radius = extent * std::pow(10.0, random.uniform(-4.0, 0.0));
    std::vector<sign::SidedPoint>& cloud = out.emplace_back();
    const std::size_t size = 1 + random.below(sign::most_shared);
    for (std::size_t k = 0; k < size; ++k) {
      // A third of the points is close to the surface relative to its cloud, some within rounding.
      Vec3d at = middle + random.in_ball() * radius;
      if (k % 3 == 0) {
        const auto near = bvh.nearest(at);
        at = near->point + (at - near->point) * std::pow(10.0, random.uniform(-14.0, 0.0));
      }
      const auto found = bvh.nearest(at);
      if (found && found->distance > 0) cloud.push_back({at, found->distance, false});
    }
  }
  return out;
}

void expect_sides_of_each(const TriangleMesh& mesh, std::uint64_t seed) {
  const WindingNumber winding(mesh);
  const double extent = bounds(mesh).diagonal();
  std::size_t inside = 0;
  std::size_t differ = 0;
  for (std::vector<sign::SidedPoint>& cloud : clouds(mesh, 60, seed)) {
    sign::decide_sides(winding, cloud, 1e-12 * 4 * extent);
    for (const sign::SidedPoint& point : cloud) {
      inside += point.is_inside ? 1 : 0;
      differ += point.is_inside != winding.is_inside(point.at) ? 1 : 0;
    }
  }
  EXPECT_EQ(differ, 0U);
  EXPECT_GT(inside, 0U);
}

TEST(SharedSides, AreThoseOfEachPoint) {
  expect_sides_of_each(with_holes(make_sphere({.frequency = 12}), 50), 1);
  expect_sides_of_each(with_holes(make_sphere({.frequency = 12}), 3), 2);
  expect_sides_of_each(make_organic({.frequency = 12, .holes = 3}), 3);
  TriangleMesh crossing = make_sphere({.frequency = 8});
  append(crossing, test::moved(with_holes(make_sphere({.frequency = 8}), 40), 0.8, {0.4, 0.1, 0.2}));
  expect_sides_of_each(crossing, 4);
  expect_sides_of_each(test::unwelded(with_holes(make_sphere({.frequency = 8}), 30)), 5);
}

/// In openings there is no triangle, but the winding number crosses 1/2.
TEST(SharedSides, AreThoseOfEachPointInOpenings) {
  TriangleMesh bowl = make_sphere({.frequency = 16});
  std::erase_if(bowl.triangles, [&](const Triangle& t) { return bowl.vertices[t[0]].z > 0; });
  const SiteTable sites(bowl);
  const Bvh bvh(bowl, sites);
  const WindingNumber winding(bowl);
  Random random(11);
  // Positive radii give balls. Negative radii give rows across the opening, where each point could copy the answer of
  // the one before.
  for (const double radius : {0.1, 0.2, 0.4, -0.1, -0.2, -0.4}) {
    std::vector<sign::SidedPoint> points;
    std::size_t inside = 0;
    for (std::size_t k = 0; k < sign::most_shared; ++k) {
      const double height = radius * (2.0 * static_cast<double>(k) / (sign::most_shared - 1) - 1);
      const Vec3d at = radius > 0 ? random.in_ball() * radius : random.in_ball() * 0.01 + Vec3d{0, 0, height};
      points.push_back({at, bvh.nearest(at)->distance, false});
    }
    sign::decide_sides(winding, points, 1e-12);
    for (const sign::SidedPoint& point : points) {
      EXPECT_EQ(point.is_inside, winding.is_inside(point.at));
      inside += point.is_inside ? 1 : 0;
    }
    EXPECT_GT(inside, 50U);
    EXPECT_LT(inside, 200U);
  }
}

TEST(SharedSides, AreThoseOfEachPointInSoups) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) expect_sides_of_each(test::nasty_soup(seed, 400), 6 + seed);
}

TEST(SharedSides, AreThoseOfEachPointAtAnyScale) {
  const TriangleMesh mesh = with_holes(make_sphere({.frequency = 8}), 40);
  for (const double scale : {1e-60, 1e-20, 1e30, 1e100}) expect_sides_of_each(test::moved(mesh, scale), 10);
}

TEST(SharedSides, OfNoPoints) {
  sign::decide_sides(WindingNumber(make_sphere({.frequency = 8})), {}, 0);
}

}  // namespace
}  // namespace blum
