// Penetration is right if surfaces coincide, nearly coincide or lie inside each other, also with rounded coordinates.
// Counts of voxels and known volumes are the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/proximity/penetration.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;
using test::moved;

TriangleMesh turned_about_z(TriangleMesh mesh, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  for (Vec3d& p : mesh.vertices) {
    p = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y, p.z};
  }
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  append(a, b);
  return a;
}

TriangleMesh cube(double half, const Vec3d& at = {}) {
  return moved(make_box({.size = {2 * half, 2 * half, 2 * half}}), 1, at);
}

struct Answer {
  double separation = 0;
  double volume = 0;
  std::size_t parts = 0;
  double depth = 0;
};

Answer answer(const TriangleMesh& a, const TriangleMesh& b) {
  ProximityScene scene;
  const ObjectId first = scene.add(a);
  const ObjectId second = scene.add(b);
  const Penetrations found = scene.penetration(first, second);
  Answer out{scene.signed_separation(first, second), 0, found.parts.size(), 0};
  for (const Penetration& part : found.parts) {
    out.volume += part.volume;
    out.depth = std::max(out.depth, part.depth);
    EXPECT_GT(part.depth, 0);
    EXPECT_GE(part.depth_bound, part.depth);
  }
  if (out.parts > 0) {
    EXPECT_EQ(out.separation, -out.depth);
  }
  return out;
}

/// Cells of a grid of 3 x 3 x 3 cells.
using Cells = std::bitset<27>;
bool holds(const Cells& cells, int x, int y, int z) {
  const int cell = x + 3 * y + 9 * z;
  return std::min({x, y, z}) >= 0 && std::max({x, y, z}) < 3 && cells[static_cast<std::size_t>(cell)];
}

/// The boundary of cells of the given size, from the given corner of the grid. Equal corners round to equal values.
TriangleMesh surface_of(const Cells& cells, double size, const Vec3d& from) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back({from.x + size * at[0], from.y + size * at[1], from.z + size * at[2]});
    return place->second;
  };
  for (int cell = 0; cell < 27; ++cell) {
    const std::array<int, 3> at{cell % 3, cell / 3 % 3, cell / 9};
    if (!cells[static_cast<std::size_t>(cell)]) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> next = at;
        next[axis] += side == 1 ? 1 : -1;
        if (holds(cells, next[0], next[1], next[2])) continue;
        std::array<std::uint32_t, 4> corner{};
        for (std::size_t k = 0; k < 4; ++k) {
          std::array<int, 3> p = at;
          p[axis] += side;
          p[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
          p[(axis + 2) % 3] += k >= 2 ? 1 : 0;
          corner[k] = vertex(p);
        }
        if (side == 0) std::swap(corner[1], corner[3]);
        mesh.triangles.push_back({corner[0], corner[1], corner[2]});
        mesh.triangles.push_back({corner[0], corner[2], corner[3]});
      }
    }
  }
  return mesh;
}

TEST(HostilePenetration, MatchesTheCommonVoxels) {
  Random random(5);
  const auto cells = [&] {
    Cells out;
    for (std::size_t k = 0; k < 27; ++k) out[k] = random.uniform() < 0.3;
    if (out.none()) out.set(13);
    return out;
  };
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    const double size = trial % 3 == 0 ? 1 : random.uniform() + 0.01;
    const Vec3d from = trial % 3 == 0 ? Vec3d{} : Vec3d{random.uniform(), random.uniform(), random.uniform()};
    const Cells a = cells();
    const Cells b = trial % 10 == 1 ? a : trial % 10 == 2 ? a | cells() : cells();
    const auto common = static_cast<double>((a & b).count());
    const Answer found = answer(surface_of(a, size, from), surface_of(b, size, from));
    EXPECT_NEAR(found.volume, common * size * size * size, 1e-9 * size * size * size);
    EXPECT_EQ(found.separation < 0, common > 0);
  }
}

TEST(HostilePenetration, FindsTheOverlapOfEqualSolids) {
  for (const Vec3d& at : {Vec3d{}, Vec3d{0.1, 0.2, 0.3}, Vec3d{-3.7, 1e3 / 7, 0.01}}) {
    const TriangleMesh box = cube(0.5, at);
    EXPECT_NEAR(answer(box, box).separation, -1, 1e-12);
    EXPECT_NEAR(answer(box, box).volume, 1, 1e-9);
    const TriangleMesh torus = moved(make_torus(), 1, at);
    EXPECT_NEAR(answer(torus, torus).separation, answer(make_torus(), make_torus()).separation, 1e-9);
  }
  Random random(6);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3d at{random.uniform(), random.uniform(), random.uniform()};
    const double half = 0.1 + random.uniform();
    const TriangleMesh part = cube(half, at);
    TriangleMesh bar = part;
    for (Vec3d& p : bar.vertices) p.x += p.x > at.x ? 0.3 : 0;
    // The cube is flush with five faces of the bar.
    EXPECT_LT(answer(part, bar).separation, 0) << trial;
    EXPECT_LT(answer(bar, part).separation, 0) << trial;
    EXPECT_NEAR(answer(part, bar).volume, 8 * half * half * half, 1e-9);
  }
}

/// Nested shells that all face outwards form one solid. The inner shells lie in its interior.
TEST(HostilePenetration, TreatsNestedShellsAsTheOuterOne) {
  const TriangleMesh nested = both(cube(2), cube(1));
  EXPECT_NEAR(answer(nested, cube(0.25)).volume, 0.125, 1e-12);
  EXPECT_NEAR(answer(nested, cube(0.25)).separation, -1.75, 1e-12);
  EXPECT_NEAR(answer(nested, cube(0.25, {1, 0, 0})).volume, 0.125, 1e-12);
  EXPECT_NEAR(answer(cube(0.25, {1, 0, 0}), nested).volume, 0.125, 1e-12);
  EXPECT_NEAR(answer(nested, cube(0.5, {2, 0, 0})).volume, 0.5, 1e-12);
  EXPECT_NEAR(answer(nested, cube(0.5, {3, 0, 0})).separation, 0.5, 1e-12);
  // An inner shell that faces inwards bounds a void. Objects in the void do not overlap the solid.
  TriangleMesh hollow = cube(1);
  for (Triangle& t : hollow.triangles) std::swap(t[1], t[2]);
  hollow = both(cube(2), hollow);
  EXPECT_NEAR(answer(hollow, cube(0.25)).separation, 0.75, 1e-12);
  EXPECT_NEAR(answer(hollow, cube(0.25, {1, 0, 0})).volume, 0.0625, 1e-12);
}

TEST(HostilePenetration, FindsTheOverlapOfEqualShellsOfOneObject) {
  const TriangleMesh twice = both(cube(1, {0.1, 0.2, 0.3}), cube(1, {0.1, 0.2, 0.3}));
  ProximityScene scene;
  ObjectOptions options;
  options.self = true;
  const ObjectId object = scene.add(twice, options);
  const Penetrations found = scene.penetration(object, object);
  ASSERT_EQ(found.parts.size(), 1U);
  EXPECT_NEAR(found.parts[0].volume, 8, 1e-9);
  EXPECT_NEAR(found.parts[0].depth, 2, 1e-9);
  EXPECT_EQ(scene.signed_separation(object, object), -found.parts[0].depth);
}

/// The overlap of two solids equals the overlap of one object of both with itself, in any order. This also holds if
/// only parts of their faces coincide.
TEST(HostilePenetration, OfOneObjectMatchesItsTwoSolids) {
  const std::vector<Point2> outline{{-1, -20}, {1, -20}, {1, 0}, {10, 0}, {10, 20}, {-1, 20}};
  const TriangleMesh bent = make_extrusion(outline, {}, {.thickness = 20});
  for (const TriangleMesh& other : {box_between({-1, -1, -1}, {1, 8, 1}), box_between({-1, -9, -1}, {1, 8, 1}),
                                    box_between({-2, -9, -1}, {1, 8, 1}), box_between({0.1, -9, -1}, {1, 8, 11})}) {
    for (const bool is_first : {true, false}) {
      const TriangleMesh& a = is_first ? bent : other;
      const TriangleMesh& b = is_first ? other : bent;
      const Answer wanted = answer(a, b);
      ProximityScene scene;
      ObjectOptions options;
      options.self = true;
      const ObjectId object = scene.add(both(a, b), options);
      const Penetrations found = scene.penetration(object, object);
      ASSERT_EQ(found.parts.size(), wanted.parts);
      EXPECT_NEAR(found.parts[0].depth, wanted.depth, 0.01 * wanted.depth);
      EXPECT_NEAR(found.parts[0].volume, wanted.volume, 1e-9 * wanted.volume);
    }
  }
}

/// Solids too far away or too small to be distinguished cause an error, never a wrong result.
TEST(HostilePenetration, IsRightOrAnErrorForFarOrSmallSolids) {
  for (const double far : {1e8, 1e10, 1e11, 1e13}) {
    const Vec3d at{far, 0, 0};
    const double half = 0.5;
    try {
      EXPECT_NEAR(answer(cube(half, at), cube(half, at + Vec3d{0.5, 0, 0})).separation, -0.5, 0.01) << far;
    } catch (const InvalidMesh&) {
      EXPECT_GT(far, 1e9);
    }
  }
  for (const double half : {1e-8, 3e-11, 1e-11, 1e-13}) {
    try {
      EXPECT_NEAR(answer(cube(half), cube(0.5)).separation, -0.5, 1e-6) << half;
    } catch (const InvalidMesh&) {
      EXPECT_LT(half, 1e-9);
    }
  }
}

/// A rotation by a multiple of the angle between its sides maps a cylinder to itself, except for rounding. Sides lie
/// 1e-16 apart and cross.
TEST(HostilePenetration, IsRightForSolidsEqualExceptForRounding) {
  const TriangleMesh cylinder = make_cylinder();
  const double volume = answer(cylinder, cylinder).volume;
  for (const double degrees : {1.0, 5.0, 7.5, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 120.0, 165.0, 180.0}) {
    const Answer found = answer(cylinder, turned_about_z(cylinder, degrees));
    const bool is_same = std::fmod(degrees, 7.5) == 0;
    EXPECT_NEAR(found.volume, volume, (is_same ? 1e-12 : 0.01) * volume) << degrees;
    EXPECT_LT(found.separation, -0.49) << degrees;
  }
  Random random(7);
  for (int trial = 0; trial < 60; ++trial) {
    const TriangleMesh box = cube(0.5, {random.uniform(), random.uniform(), random.uniform()});
    const double back = 360 * random.uniform();
    const Answer found = answer(box, turned_about_z(turned_about_z(box, back), -back));
    EXPECT_NEAR(found.volume, 1, 1e-9) << trial;
    EXPECT_LT(found.separation, -0.3) << trial;
  }
}

/// A torus that crosses itself along a line has hundreds of sides there. Memory must not grow with their square.
TEST(HostilePenetration, IsRightForASelfIntersectingTorus) {
  constexpr std::uint32_t around = 24;
  constexpr std::uint32_t tube = 16;
  TriangleMesh torus;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      const double u = i * 2 * std::numbers::pi / around;
      const double w = j * 2 * std::numbers::pi / tube;
      const double r = 0.5 + 0.8 * std::cos(w);
      torus.vertices.push_back({r * std::cos(u), r * std::sin(u), 0.8 * std::sin(w)});
      const std::uint32_t a = i * tube + j;
      const std::uint32_t b = (i + 1) % around * tube + j;
      const std::uint32_t c = i * tube + (j + 1) % tube;
      const std::uint32_t d = (i + 1) % around * tube + (j + 1) % tube;
      torus.triangles.push_back({a, b, d});
      torus.triangles.push_back({a, d, c});
    }
  }
  ProximityScene scene;
  ObjectOptions options;
  options.self = true;
  const ObjectId object = scene.add(torus, options);
  const Penetrations found = scene.penetration(object, object);
  ASSERT_FALSE(found.parts.empty());
  EXPECT_NEAR(found.parts[0].depth, 0.2331, 0.0024) << "as all sides together told";
  for (const Penetration& part : found.parts) {
    EXPECT_GE(part.volume, 0);
    EXPECT_GE(part.depth_bound, part.depth);
  }
}

}  // namespace
}  // namespace blum
