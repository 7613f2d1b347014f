// Proves that thickness by rays and by balls equals known values of plates, hollow spheres, spheres and wedges, and
// brute force.
#include "blum/surface_map/thickness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/points/sample_surface.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

TriangleMesh turned_box(const Vec3d& size) {
  return test::turned(test::box_between({0, 0, 0}, size));
}

TEST(RayThickness, OfPlatesIsTheirSize) {
  const Vec3d size{5, 3, 0.25};
  for (const TriangleMesh& plate : {test::box_between({0, 0, 0}, size), turned_box(size)}) {
    const SurfaceSamples samples = sample_surface(plate, 4000);
    const std::vector<Thickness> found = thickness(plate, samples.points);
    for (std::size_t k = 0; k < found.size(); ++k) {
      // The thickness is the size along the normal, which is one of three.
      const double nearest = std::min({std::abs(found[k].thickness - size.x), std::abs(found[k].thickness - size.y),
                                       std::abs(found[k].thickness - size.z)});
      ASSERT_LT(nearest, 1e-12);
      const Vec3d way = samples.points[k] - found[k].opposite;
      ASSERT_NEAR(dot(way, samples.normals[k]), found[k].thickness, 1e-12);
    }
  }
}

/// On edges and at vertices, rays run along neighbouring triangles.
TEST(RayThickness, OnBorders) {
  const TriangleMesh plate = turned_box({5, 3, 0.25});
  std::vector<Vec3d> points = plate.vertices;
  for (const Triangle& t : plate.triangles) points.push_back((plate.vertices[t[0]] + plate.vertices[t[1]]) * 0.5);
  for (const Thickness& one : thickness(plate, points)) {
    const double nearest =
        std::min({std::abs(one.thickness - 5), std::abs(one.thickness - 3), std::abs(one.thickness - 0.25)});
    EXPECT_LT(nearest, 1e-6) << one.thickness;
  }
}

/// Points inside triangles are evaluated exactly where they are. The prism lies between y = 0 and y = 1 - x / 3.
TEST(RayThickness, InsideOfFacesIsExact) {
  const TriangleMesh prism{{{0, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 0, 2}, {3, 0, 2}, {0, 1, 2}},
                           {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}},
                           {},
                           {}};
  for (const Vec3d& p : {Vec3d{2.5, 0, 0.7}, Vec3d{2.5, 0, 0.3}, Vec3d{1.5, 0, 0.2}, Vec3d{2.9, 0, 1.9}}) {
    EXPECT_NEAR(thickness(prism, std::vector<Vec3d>{p})[0].thickness, 1 - p.x / 3, 4e-16);
  }
}

TEST(BallThickness, OfPlatesIsTheirSizeOrTwiceTheDistanceToAnEdge) {
  const Vec3d size{5, 3, 0.25};
  const TriangleMesh plate = test::box_between({0, 0, 0}, size);
  const SurfaceSamples samples = sample_surface(plate, 4000);
  const std::vector<Thickness> found = thickness(plate, samples.points, {.kind = ThicknessKind::ball});
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Vec3d& p = samples.points[k];
    double known = HUGE_VAL;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_normal = std::abs(samples.normals[k][axis]) > 0.5;
      known = std::min(known, is_normal ? size[axis] : 2 * std::min(p[axis], size[axis] - p[axis]));
    }
    ASSERT_NEAR(found[k].thickness, known, 2e-6) << "the point moves by 1e-7 of the triangle";
  }
}

/// At distance s from the edge of a wedge, the ray's length is s tan(angle). The ball's diameter is 2 s tan(angle / 2).
TEST(Thickness, OfWedges) {
  for (const double angle : {10.0, 45.0, 80.0}) {
    const double a = angle * std::numbers::pi / 180;
    TriangleMesh wedge;
    for (const double z : {-50.0, 50.0}) {
      wedge.vertices.insert(wedge.vertices.end(), {{0, 0, z}, {10, 0, z}, {10 * std::cos(a), 10 * std::sin(a), z}});
    }
    wedge.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    std::vector<Vec3d> points;
    for (double s = 0.125; s < 3; s += 0.25) points.push_back({s, 0, 0.1});
    const std::vector<Thickness> rays = thickness(wedge, points);
    const std::vector<Thickness> balls = thickness(wedge, points, {.kind = ThicknessKind::ball});
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double s = points[k].x;
      if (s / std::cos(a) < 10) {
        EXPECT_NEAR(rays[k].thickness, s * std::tan(a), 1e-4 * s * std::tan(a)) << angle;
      }
      EXPECT_NEAR(balls[k].thickness, 2 * s * std::tan(a / 2), 1e-4 * s) << angle;
    }
  }
}

TEST(Thickness, OfSpheresNearsTheDiameter) {
  // Errors are quadratic in the edge length, like those of the normals.
  struct Case {
    ThicknessKind kind;
    double at_least;
  };
  for (const auto& [kind, at_least] : {Case{ThicknessKind::ray, 3.0}, Case{ThicknessKind::ball, 2.8}}) {
    double last = 1;
    for (const int frequency : {5, 10, 20}) {
      const TriangleMesh sphere = make_sphere({.frequency = frequency});
      const double diameter = 2 * length(sphere.vertices[0]);
      double worst = 0;
      for (const Thickness& one : thickness(sphere, {.kind = kind})) {
        worst = std::max(worst, std::abs(one.thickness / diameter - 1));
      }
      EXPECT_LT(worst, last / at_least);
      last = worst;
    }
    EXPECT_LT(last, 0.006);
  }
}

/// In this hollow sphere, the thickness is that of its wall, by both definitions.
TEST(Thickness, OfHollowSpheresIsThatOfTheirWalls) {
  TriangleMesh tube = make_sphere({.frequency = 24});
  const double outer = length(tube.vertices[0]);
  TriangleMesh inner = test::moved(tube, 0.8);
  inner.triangles = reversed_triangles(inner.triangles);
  append(tube, inner);
  for (const ThicknessKind kind : {ThicknessKind::ray, ThicknessKind::ball}) {
    for (const Thickness& one : thickness(tube, {.kind = kind})) {
      EXPECT_NEAR(one.thickness, 0.2 * outer, 0.004 * outer);
    }
  }
}

Vec3d normal_of(const MeshView& mesh, std::size_t t) {
  const auto [a, b, c] = triangle_corners(mesh, t);
  const Vec3d n = cross(b - a, c - a);
  return n / length(n);
}

/// Computes the smooth normal by its definition, triangle by triangle.
Vec3d slow_smooth_normal(const MeshView& mesh, std::uint32_t triangle, const Vec3d& point, double cosine) {
  const std::array<Vec3d, 3> p = triangle_corners(mesh, triangle);
  const Vec3d own = normal_of(mesh, triangle);
  const double whole = length(cross(p[1] - p[0], p[2] - p[0]));
  Vec3d mean;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t vertex = mesh.triangles[triangle][k];
    Vec3d sum;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& other = mesh.triangles[t];
      const auto here = static_cast<std::size_t>(std::find(other.begin(), other.end(), vertex) - other.begin());
      if (here == 3 || (t != triangle && dot(normal_of(mesh, t), own) <= cosine)) continue;
      const Vec3d u = mesh.vertices[other[(here + 1) % 3]] - p[k];
      const Vec3d v = mesh.vertices[other[(here + 2) % 3]] - p[k];
      sum += normal_of(mesh, t) * std::acos(dot(u, v) / (length(u) * length(v)));
    }
    const double weight = length(cross(p[(k + 1) % 3] - point, p[(k + 2) % 3] - point)) / whole;
    mean += sum / length(sum) * weight;
  }
  return mean / length(mean);
}

/// Brute force goes through all triangles of the polyhedron and takes the smallest ball that touches one.
TEST(BallThickness, AgreesWithBruteForce) {
  const TriangleMesh mesh = make_organic({.frequency = 5});
  const SurfaceSamples samples = sample_surface(mesh, 150);
  for (const double separation : {20.0, 60.0}) {
    const std::vector<Thickness> found =
        thickness(mesh, samples.points, {.kind = ThicknessKind::ball, .separation = separation});
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Vec3d& p = samples.points[k];
      const double cosine = std::cos(separation * std::numbers::pi / 180);
      const Vec3d n = slow_smooth_normal(mesh, samples.triangles[k].value, p, cosine);
      double radius = 100;
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<Vec3d, 3> corners = triangle_corners(mesh, t);
        Vec3d m = cross(corners[1] - corners[0], corners[2] - corners[0]);
        m = m / length(m);
        if (dot(m, n) > cosine) continue;
        for (int step = 0; step < 100; ++step) {
          const Vec3d q = closest_point_on_triangle(p - n * radius, corners);
          if (length(q - (p - n * radius)) >= radius * (1 - 1e-13)) break;
          radius = std::min(radius, squared_length(p - q) / (2 * dot(p - q, n)));
        }
      }
      if (radius == 100) {
        EXPECT_TRUE(std::isinf(found[k].thickness));
      } else {
        EXPECT_NEAR(found[k].thickness, 2 * radius, 1e-8);
      }
    }
  }
}

/// Triangles without area close cracks in CAD meshes. They have no normal and limit no ball.
TEST(BallThickness, LooksPastTrianglesWithoutArea) {
  TriangleMesh plate = test::box_between({0, 0, 0}, {4, 3, 0.5});
  plate.vertices.insert(plate.vertices.end(), {{1.4, 1, 0.5}, {1.6, 1, 0.5}, {1.5, 1, 0.5}});
  const auto first = static_cast<std::uint32_t>(plate.vertices.size() - 3);
  plate.triangles.push_back({first, first + 1, first + 2});
  const std::vector<Vec3d> at{{1.5, 1.01, 0.5}};
  for (const double separation : {10.0, 30.0, 90.0}) {
    const std::vector<Thickness> found = thickness(plate, at, {.kind = ThicknessKind::ball, .separation = separation});
    EXPECT_NEAR(found[0].thickness, 0.5, 1e-9);
  }
}

TEST(Thickness, WarnsOfMeshesWithoutAnInside) {
  const TriangleMesh box = test::box_between({0, 0, 0}, {4, 4, 4});
  EXPECT_TRUE(thickness_warnings(box).empty());
  EXPECT_TRUE(thickness_map(box, {.texel = 1}).warnings.empty());
  const auto expect = [](const TriangleMesh& mesh, WarningCode code, const std::string& words) {
    const std::vector<Warning> found = thickness_warnings(mesh);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].code, code);
    EXPECT_TRUE(found[0].text.starts_with(words)) << found[0].text;
    EXPECT_EQ(thickness_map(mesh, {.texel = 1}).warnings.front(), found[0]);
  };
  TriangleMesh mesh = box;
  mesh.triangles.pop_back();
  expect(mesh, WarningCode::open_mesh, "the mesh is open (3 edges with one triangle)");
  mesh = box;
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  expect(mesh, WarningCode::facing, "triangles face different ways (3 edges)");
  mesh.triangles = reversed_triangles(box.triangles);
  expect(mesh, WarningCode::facing, "triangles face into the solid");
  mesh = box;
  append(mesh, test::box_between({1, 1, 1}, {3, 3, 3}));
  expect(mesh, WarningCode::facing, "shells lie in or cross each other");
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::vector<Warning> found = thickness_map(mesh, {.texel = 1}).warnings;
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1], (Warning{WarningCode::nothing_found, "no texel has a thickness"}));
}

TEST(ThicknessMap, HoldsThicknesses) {
  const TriangleMesh plate = test::box_between({0, 0, 0}, {4, 3, 0.5});
  const SurfaceMap map = thickness_map(plate, {.texel = 0.1});
  EXPECT_EQ(map.quantity, SurfaceQuantity::ray_thickness);
  EXPECT_TRUE(map.error.empty());
  for (std::size_t k = 0; k < map.distance.size(); ++k) {
    if (!map.atlas->triangle[k].has_value()) continue;
    const float value = map.distance[k];
    EXPECT_TRUE(std::abs(value - 4) < 1e-5 || std::abs(value - 3) < 1e-5 || std::abs(value - 0.5) < 1e-5) << value;
    EXPECT_NEAR(length(map.vector[k]), value, 1e-5);
  }
}

/// A map reuses results of the previous texel, which must not change a value.
TEST(ThicknessMap, EqualsTheThicknessOfEachPointAlone) {
  const TriangleMesh mesh = make_organic({.frequency = 6, .seed = 2});
  for (const ThicknessKind kind : {ThicknessKind::ray, ThicknessKind::ball}) {
    const SurfaceMap map = thickness_map(mesh, {.texel = 0.03}, {.kind = kind, .separation = 50});
    const SurfaceTexels all = surface_texels(mesh, *map.atlas);
    const std::vector<Thickness> alone = thickness(mesh, all.points, {.kind = kind, .separation = 50});
    std::size_t compared = 0;
    for (std::size_t k = 0; k < all.texels.size(); ++k) {
      // Near borders, a single point may be assigned to a neighbouring triangle.
      const std::uint32_t t = map.atlas->triangle[all.texels[k]].value;
      const auto [a, b, c] = triangle_corners(mesh, t);
      const Vec3d inwards = cross(b - a, c - a);
      double inside = HUGE_VAL;
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        inside = std::min(inside, dot(cross(to - from, all.points[k] - from), inwards) / squared_length(inwards));
      }
      if (inside < 1e-6) continue;
      ++compared;
      const float value = map.distance[all.texels[k]];
      if (std::isinf(alone[k].thickness)) {
        ASSERT_TRUE(std::isinf(value));
      } else {
        ASSERT_NEAR(value, alone[k].thickness, 1e-6 * alone[k].thickness);
      }
    }
    EXPECT_GT(compared, all.texels.size() / 4);
  }
}

TEST(Thickness, WithoutAFarSideIsInfinite) {
  const TriangleMesh open{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  for (const ThicknessKind kind : {ThicknessKind::ray, ThicknessKind::ball}) {
    const std::vector<Thickness> found = thickness(open, {.kind = kind});
    EXPECT_TRUE(std::isinf(found[0].thickness));
    EXPECT_FALSE(found[0].triangle.has_value());
  }
  TriangleMesh inwards = make_sphere();
  inwards.triangles = reversed_triangles(inwards.triangles);
  EXPECT_TRUE(std::isinf(thickness(inwards, ThicknessOptions{})[0].thickness));
}

TEST(Thickness, RejectsInvalidInput) {
  const TriangleMesh box = make_box();
  EXPECT_THROW((void)thickness(box, {.separation = 190}), InvalidOption);
  EXPECT_THROW((void)thickness(make_points({.points = 3}), ThicknessOptions{}), InvalidMesh);
  const std::vector<Vec3d> points{{0, 0, 0}, {NAN, 0, 0}};
  EXPECT_THROW((void)thickness(box, points), InvalidOption);
}

}  // namespace
}  // namespace blum
