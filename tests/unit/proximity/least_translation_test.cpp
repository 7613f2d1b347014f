// Bounds on the least translation that separates two solids contain the true length. For convex solids they are equal,
// except for rounding. A slow reference tries the normals of all faces of the Minkowski difference.
#include "blum/proximity/least_translation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;
using test::moved;

TriangleMesh cube(double side, const Vec3d& at = {}) {
  return moved(make_box({.size = {side, side, side}}), 1, at);
}

/// Turns a mesh by the same angle about z and then about x.
TriangleMesh turned(TriangleMesh mesh, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (Vec3d& p : mesh.vertices) {
    p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    p = {p.x, c * p.y - s * p.z, s * p.y + c * p.z};
  }
  return mesh;
}

/// Returns the least height of the Minkowski difference over the normals of all faces that it may have. These are the
/// normals of both solids, and products of one edge of each.
double slow_depth(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<Vec3d> normals;
  std::vector<std::vector<Vec3d>> edges(2);
  for (std::size_t k = 0; k < 2; ++k) {
    const TriangleMesh& mesh = k == 0 ? a : b;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto [p, q, r] = triangle_corners(mesh, t);
      normals.push_back(cross(q - p, r - p));
      edges[k].insert(edges[k].end(), {q - p, r - q, p - r});
    }
  }
  for (const Vec3d& e : edges[0]) {
    for (const Vec3d& f : edges[1]) normals.push_back(cross(e, f));
  }
  double least = HUGE_VAL;
  for (const Vec3d& normal : normals) {
    if (!(length(normal) > 1e-9)) continue;
    for (const double way : {1.0, -1.0}) {
      const Vec3d n = normal * (way / length(normal));
      double most = -HUGE_VAL;
      double fewest = HUGE_VAL;
      for (const Vec3d& v : b.vertices) most = std::max(most, dot(v, n));
      for (const Vec3d& v : a.vertices) fewest = std::min(fewest, dot(v, n));
      least = std::min(least, most - fewest);
    }
  }
  return std::max(least, 0.0);
}

void expect_exact(const LeastTranslation& found, double depth, double size) {
  EXPECT_TRUE(found.are_convex);
  EXPECT_LE(found.lower, depth + 1e-14 * size);
  EXPECT_GE(found.upper, depth - 1e-14 * size);
  EXPECT_LE(found.upper - found.lower, 3e-14 * size);
  EXPECT_NEAR(length(found.translation), found.upper, 1e-14 * size);
}

TEST(LeastTranslation, OfBoxes) {
  const LeastTranslation found = least_translation(cube(1), cube(1, {0.75, 0.1, 0}));
  expect_exact(found, 0.25, 1);
  EXPECT_NEAR(found.translation.x, -0.25, 1e-14) << "the first solid moves away from the second";
  expect_exact(least_translation(cube(1), cube(0.5, {0.1, 0, 0})), 0.65, 1);
  expect_exact(least_translation(cube(0.5, {0.1, 0, 0}), cube(1)), 0.65, 1);
  expect_exact(least_translation(cube(1), cube(1)), 1, 1);
  const double angle = std::numbers::pi / 4;
  expect_exact(least_translation(turned(cube(1), 0), moved(turned(make_box(), 2 * std::numbers::pi), 1, {0.5, 0, 0})),
               0.5, 1);
  TriangleMesh roof = make_box();  // an edge along z points at the other box
  for (Vec3d& p : roof.vertices) {
    p = {std::cos(angle) * p.x - std::sin(angle) * p.y + 1, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
  }
  expect_exact(least_translation(cube(1), roof), std::sqrt(0.5) - 0.5, 2);
}

TEST(LeastTranslation, IsZeroForSolidsThatTouchOrAreApart) {
  for (const Vec3d& at : {Vec3d{1, 0, 0}, Vec3d{1, 1, 1}, Vec3d{1, 0.5, 0}, Vec3d{5, 0, 0}, Vec3d{0.9, 0.9, 1.5}}) {
    const LeastTranslation found = least_translation(cube(1), cube(1, at));
    EXPECT_EQ(found.lower, 0);
    EXPECT_EQ(found.upper, 0);
    EXPECT_EQ(found.translation, Vec3d{});
  }
}

TEST(LeastTranslation, OfSpheresIsNearTheSumOfRadiiMinusTheDistance) {
  const TriangleMesh ball = make_sphere();
  const double radius = length(ball.vertices[0]);
  const LeastTranslation found = least_translation(ball, moved(ball, 1, {radius, 0, 0}));
  EXPECT_TRUE(found.are_convex);
  EXPECT_LE(found.upper, radius + 1e-12);
  EXPECT_GT(found.lower, 0.95 * radius);
  EXPECT_LE(found.upper - found.lower, 1e-13);
}

/// The hulls of random points: random tetrahedra and octahedra-like shapes, also thin ones.
TEST(LeastTranslation, OfRandomConvexSolidsIsThatOfTheSlowReference) {
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    const auto part = [&] {
      TriangleMesh out{{}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}, {}};
      if (round % 3 == 1) out = make_box();
      if (round % 3 == 2) out = make_sphere({.frequency = 1});
      if (out.vertices.empty()) {
        out.vertices = {{-1, -0.7, -0.6}, {1, -0.8, -0.5}, {0, 1, -0.6}, {0.1, 0, 1}};
      }
      const double angle = random.uniform(0, 7);
      const Vec3d stretch{random.uniform(0.05, 1), random.uniform(0.05, 1), random.uniform(0.05, 1)};
      for (Vec3d& p : out.vertices) p = {p.x * stretch.x, p.y * stretch.y, p.z * stretch.z};
      return moved(turned(out, angle), 1,
                   {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)});
    };
    const TriangleMesh a = part();
    const TriangleMesh b = part();
    const LeastTranslation found = least_translation(a, b);
    const double depth = slow_depth(a, b);
    EXPECT_TRUE(found.are_convex) << round;
    EXPECT_LE(found.lower, depth + 1e-13) << round;
    EXPECT_GE(found.upper, depth - 1e-13) << round;
    EXPECT_LE(found.upper - found.lower, 1e-12) << round;
  }
}

TEST(LeastTranslation, HoldsAtEveryScaleAndFarFromTheOrigin) {
  for (const double scale : {1e-60, 1e-9, 1.0, 1e9, 1e60}) {
    const LeastTranslation found = least_translation(moved(cube(1), scale), moved(cube(1, {0.75, 0.125, 0}), scale));
    expect_exact(found, 0.25 * scale, scale);
  }
  const Vec3d far{1048576, -2097152, 4194304};
  const LeastTranslation found = least_translation(cube(1, far), cube(1, far + Vec3d{0.75, 0.125, 0}));
  expect_exact(found, 0.25, 1);
}

/// A U of three boxes in one piece, open upwards. The slot is 1 wide, from z = 0 to z = 3.
TriangleMesh make_u() {
  const std::vector<std::array<double, 2>> outline{{-2, -1}, {2, -1},   {2, 3},    {0.5, 3},
                                                   {0.5, 0}, {-0.5, 0}, {-0.5, 3}, {-2, 3}};
  TriangleMesh out;
  const auto count = static_cast<std::uint32_t>(outline.size());
  for (const double y : {-1.0, 1.0}) {
    for (const auto& [x, z] : outline) out.vertices.push_back({x, y, z});
  }
  const std::vector<Triangle> front{{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}};
  for (const Triangle& t : front) {
    out.triangles.push_back(t);
    out.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t next = (k + 1) % count;
    out.triangles.push_back({k, k + count, next});
    out.triangles.push_back({next, k + count, next + count});
  }
  return out;
}

/// A peg in the slot that reaches 0.25 into the bottom leaves by moving up; its hull would have to move further.
TEST(LeastTranslation, OfAPegInASlot) {
  const TriangleMesh u = make_u();
  const TriangleMesh peg = box_between({-0.4, -0.5, -0.25}, {0.4, 0.5, 2});
  const LeastTranslation found = least_translation(peg, u);
  EXPECT_FALSE(found.are_convex);
  EXPECT_LE(found.lower, 0.25);
  EXPECT_GE(found.upper, 0.25);
  EXPECT_NEAR(found.lower, 0.25, 1e-9);
  EXPECT_NEAR(found.upper, 0.25, 1e-9);
  EXPECT_GT(found.translation.z, 0.24);
  const TriangleMesh free = moved(peg, 1, {0, 0, 0.5});
  EXPECT_EQ(least_translation(free, u).upper, 0) << "hulls overlap, solids do not";
  const LeastTranslation aside = least_translation(box_between({-0.3, -0.5, 0.5}, {0.6, 0.5, 2}), u);
  EXPECT_NEAR(aside.lower, 0.1, 1e-9);
  EXPECT_NEAR(aside.upper, 0.1, 1e-9);
  const LeastTranslation touching = least_translation(box_between({-0.5, -0.5, 0}, {0.5, 0.5, 2}), u);
  EXPECT_EQ(touching.upper, 0);
}

/// For all solids: bounds are in order, the translation separates, and half the lower bound along any direction does
/// not.
TEST(LeastTranslation, SeparatesSolidsThatAreNotConvex) {
  const TriangleMesh ring = make_torus({.ring_segments = 24, .tube_segments = 12});
  Random random(3);
  for (int round = 0; round < 6; ++round) {
    const Vec3d at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3)};
    const TriangleMesh other = moved(turned(ring, random.uniform(0, 3)), 1, at);
    const LeastTranslation found = least_translation(ring, other);
    EXPECT_LE(found.lower, found.upper);
    ProximityScene scene;
    const ObjectId a = scene.add(ring);
    const ObjectId b = scene.add(other);
    RigidTransform place;
    place.translation = found.translation * (1 + 1e-9);
    scene.update(a, place);
    EXPECT_TRUE(scene.penetration(a, b).parts.empty()) << round;
    for (int k = 0; k < 20 && found.lower > 0; ++k) {
      const Vec3d way{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
      place.translation = way * (0.999 * found.lower / length(way));
      scene.update(a, place);
      EXPECT_FALSE(scene.penetration(a, b).parts.empty()) << round;
    }
  }
}

TEST(LeastTranslation, RefusesWhatPenetrationRefuses) {
  TriangleMesh open = make_box();
  open.triangles.pop_back();
  EXPECT_THROW((void)least_translation(open, make_box()), InvalidMesh);
  TriangleMesh inward = make_box();
  for (Triangle& t : inward.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW((void)least_translation(make_box(), inward), InvalidMesh);
  EXPECT_THROW((void)least_translation(make_box(), make_box(), {.translation_tolerance = -1}), InvalidOption);
  EXPECT_THROW((void)least_translation(make_box(), make_box(), {.max_planes = 0}), InvalidOption);
  ProximityScene scene;
  const ObjectId a = scene.add(make_box());
  EXPECT_THROW((void)scene.least_translation(a, a), InvalidOption);
}

/// Also if an option ends the search early, the bounds contain the length.
TEST(LeastTranslation, KeepsItsPromiseWithFewPlanes) {
  const TriangleMesh ball = make_sphere();
  const TriangleMesh other = moved(turned(ball, 1), 1, {0.3, 0.1, 0});
  const LeastTranslation exact = least_translation(ball, other);
  for (const std::size_t planes : {1U, 10U, 100U}) {
    const LeastTranslation found = least_translation(ball, other, {.max_planes = planes});
    EXPECT_LE(found.lower, exact.upper);
    EXPECT_GE(found.upper, exact.lower);
  }
  const LeastTranslation rough = least_translation(ball, other, {.translation_tolerance = 0.1});
  EXPECT_LE(rough.upper - rough.lower, 0.1 * rough.upper + 1e-14);
}

TEST(LeastTranslation, IsTheSameForAnyThreads) {
  const TriangleMesh u = make_u();
  const TriangleMesh ball = moved(make_sphere(), 1, {0.2, 0.1, 0.4});
  const LeastTranslation one = least_translation(ball, u, {}, {.threads = 1});
  const LeastTranslation many = least_translation(ball, u, {}, {.threads = 4});
  EXPECT_EQ(one.lower, many.lower);
  EXPECT_EQ(one.translation, many.translation);
}

}  // namespace
}  // namespace blum
