// Proves that angle-weighted pseudonormals follow their definition and give the sign of closed meshes.
#include "blum/geometry/pseudonormals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "blum/field/reference.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

/// The diagonals of a cube's sides differ from corner to corner. Only weights by angle make the normals symmetric.
TEST(Pseudonormals, WeighFacesByTheirAngles) {
  const TriangleMesh cube = make_box({});
  const SiteTable sites(cube);
  const Pseudonormals normals(cube, sites);
  for (std::uint32_t v = 0; v < cube.vertices.size(); ++v) {
    const Vec3d normal = normals.normal(SiteId(v));
    EXPECT_NEAR(length(normal), std::numbers::pi / 2 * std::sqrt(3.0), 1e-12);
    const Vec3d& p = cube.vertices[v];
    EXPECT_NEAR(dot(normal, p), length(normal) * length(p), 1e-12) << "of vertex " << v;
  }
}

TEST(Pseudonormals, LeaveOutTrianglesWithoutArea) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, 0}, {3, 3, 3}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 0, 1}, {4, 4, 4}};
  const SiteTable sites(mesh);
  const Pseudonormals normals(mesh, sites);
  const Vec3d right = normals.normal(SiteId(0));
  EXPECT_NEAR(right.z, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(normals.normal(SiteId(1)).z, std::numbers::pi / 4, 1e-12);
  EXPECT_EQ(normals.normal(SiteId(3)), Vec3d{});
  EXPECT_EQ(normals.normal(SiteId(4)), Vec3d{});
  EXPECT_EQ(normals.normal(sites.id({SiteKind::face, 1})), Vec3d{});
  EXPECT_NEAR(normals.normal(sites.id({SiteKind::face, 0})).z, 1, 1e-15);
  for (const Vec3d& n : normals.normals()) EXPECT_TRUE(is_finite(n));
}

void expect_signs_of_winding_numbers(const TriangleMesh& mesh, std::uint64_t seed) {
  const SiteTable sites(mesh);
  const Pseudonormals normals(mesh, sites);
  const Bvh bvh(mesh, sites);
  std::size_t inside = 0;
  for (const Vec3d& q : test::places_around(mesh, 600, seed)) {
    const std::optional<NearestSite> nearest = bvh.nearest(q);
    if (nearest->distance < 1e-9 * bounds(mesh).diagonal()) continue;
    const bool is_inside = reference::winding_number(mesh, q) > 0.5;
    inside += is_inside ? 1 : 0;
    EXPECT_EQ(normals.is_inside(q, nearest->point, nearest->site), is_inside);
  }
  EXPECT_GT(inside, 3U);
}

TEST(Pseudonormals, GiveTheSignOfClosedMeshes) {
  expect_signs_of_winding_numbers(make_sphere({.frequency = 6}), 1);
  expect_signs_of_winding_numbers(make_star({}), 2);
  expect_signs_of_winding_numbers(make_wedge({}), 3);
  expect_signs_of_winding_numbers(make_void_cube({}), 4);
  expect_signs_of_winding_numbers(test::moved(make_star({}), 1e-100), 5);
  expect_signs_of_winding_numbers(test::moved(make_star({}), 1e100), 6);
  expect_signs_of_winding_numbers(test::moved(make_gear({}), 1, {1e6, 1e6, 1e6}), 7);
}

}  // namespace
}  // namespace blum
