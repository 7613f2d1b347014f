// Proves that each void gets a point deep inside, and that motion over such points is detected.
#include "medial_axis/surface/void_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "medial_axis/surface/mesh_surface.hpp"

namespace blum {
namespace {

using detail::holds_any;
using detail::MeshSurface;
using detail::moves_over_any;

/// Adds a moved and scaled mesh, turned inside out.
void add_void(TriangleMesh& mesh, const TriangleMesh& solid, double scale, const Vec3d& at) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : solid.vertices) mesh.vertices.push_back(v * scale + at);
  for (const Triangle& t : solid.triangles) mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
}

std::vector<Vec3d> points_in(const TriangleMesh& mesh) {
  const SiteTable sites(mesh);
  const MeshSurface surface(mesh, sites, true, {});
  return {surface.voids().begin(), surface.voids().end()};
}

TEST(VoidPoints, EachVoidHasOneInItsMiddle) {
  TriangleMesh mesh = make_box({.size = {8, 8, 8}});
  EXPECT_TRUE(points_in(mesh).empty());
  const TriangleMesh ball = make_sphere({});
  add_void(mesh, ball, 0.5, {2, 1, 0});
  add_void(mesh, ball, 1e-6, {-2, 0, 1});
  add_void(mesh, make_box({.size = {1, 1, 1e-3}}), 1, {0, -2, -2});
  const std::vector<Vec3d> points = points_in(mesh);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_LT(length(points[0] - Vec3d{-2, 0, 1}), 1e-7);
  EXPECT_NEAR(points[1].z, -2, 1e-6);
  EXPECT_LT(length(points[2] - Vec3d{2, 1, 0}), 0.1);
}

TEST(VoidPoints, TetrahedraContainPointsAsBarycentricCoordinatesDo) {
  Random random(5);
  int held = 0;
  for (int n = 0; n < 2000; ++n) {
    std::array<Vec3d, 4> corners;
    for (Vec3d& corner : corners) corner = random.in_cube();
    const Vec3d p = random.in_cube();
    const auto volume = [](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
      return dot(b - a, cross(c - a, d - a));
    };
    const auto& [a, b, c, d] = corners;
    const double all = volume(a, b, c, d);
    const bool is_in = volume(p, b, c, d) / all > 0 && volume(a, p, c, d) / all > 0 && volume(a, b, p, d) / all > 0 &&
                       volume(a, b, c, p) / all > 0;
    held += is_in ? 1 : 0;
    const std::vector<Vec3d> points{{-1, 0, 0}, p, {2, 0, 0}};
    EXPECT_EQ(holds_any(points, corners), is_in);
  }
  EXPECT_GT(held, 10);
}

TEST(VoidPoints, AMovingTriangleSweepsThePointsBetweenItsPlaces) {
  const std::array<Vec3d, 3> below{Vec3d{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::array<Vec3d, 3> above{Vec3d{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const auto moves_over = [&](const Vec3d& p) { return moves_over_any(std::vector<Vec3d>{p}, below, above); };
  for (const double height : {0.1, 0.4, 0.6, 0.9}) {
    EXPECT_TRUE(moves_over({0.3, 0.3, height}));
    EXPECT_FALSE(moves_over({0.6, 0.6, height}));
  }
  EXPECT_FALSE(moves_over({0.3, 0.3, 1.1}));
  EXPECT_FALSE(moves_over({0.3, 0.3, -0.1}));
  EXPECT_FALSE(moves_over_any({}, below, above));
}

}  // namespace
}  // namespace blum
