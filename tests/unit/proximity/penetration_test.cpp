// Penetration depths match the known depths of spheres, boxes, tori and plates, at any tessellation.
#include "blum/proximity/penetration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/winding_number.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

constexpr double pi = std::numbers::pi;

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.vertices) p += by;
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  append(a, b);
  return a;
}

/// A box between two corners; each face is divided into parts x parts rectangles.
TriangleMesh box(const Vec3d& lower, const Vec3d& upper, int parts = 1) {
  TriangleMesh mesh = make_box({.size = upper - lower, .segments = {parts, parts, parts}});
  const Vec3d middle = bounds(mesh).center();
  return moved(mesh, (lower + upper) * 0.5 - middle);
}

struct Answer {
  Penetrations found;
  double separation;
};

Answer answer(const TriangleMesh& a, const TriangleMesh& b, double tolerance = 0.01) {
  ProximityScene scene;
  const ObjectId first = scene.add(a);
  const ObjectId second = scene.add(b);
  const PenetrationOptions options{.depth_tolerance = tolerance};
  return {scene.penetration(first, second, options), scene.signed_separation(first, second, options)};
}

/// Checks the properties of every part.
void expect_sound(const Penetration& part, const TriangleMesh& a, const TriangleMesh& b, double tolerance) {
  EXPECT_GT(part.depth, 0);
  EXPECT_GE(part.depth_bound, part.depth);
  EXPECT_LE(part.depth_bound, part.depth * (1 + tolerance) * (1 + 1e-9) + 1e-12);
  EXPECT_NEAR(length(part.deep_point - part.surface_point), part.depth, 1e-12);
  EXPECT_NEAR(length(part.direction), 1, 1e-12);
  const Vec3d way = part.is_first_deep ? part.surface_point - part.deep_point : part.deep_point - part.surface_point;
  EXPECT_NEAR(dot(part.direction, way), part.depth, 1e-12);
  const TriangleMesh& deep = part.is_first_deep ? a : b;
  const TriangleMesh& other = part.is_first_deep ? b : a;
  const auto on_triangle = [](const Vec3d& p, const TriangleMesh& mesh, std::uint32_t t) {
    const auto& [i, j, k] = mesh.triangles[t];
    return triangle_distance({p, p, p}, {mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]}).distance < 1e-12;
  };
  EXPECT_TRUE(on_triangle(part.deep_point, deep, part.deep_triangle));
  EXPECT_TRUE(on_triangle(part.surface_point, other, part.surface_triangle));
  EXPECT_TRUE(WindingNumber(other).is_inside(part.deep_point));
  for (const auto& curve : part.curves) EXPECT_EQ(curve.front(), curve.back());
}

TEST(Penetration, OfSpheresConverges) {
  for (const double apart : {1.9, 1.2, 0.4}) {
    double last_error = std::numeric_limits<double>::infinity();
    for (const int frequency : {4, 12, 36}) {
      const TriangleMesh a = make_sphere({.frequency = frequency});
      const TriangleMesh b = moved(a, Vec3d{1, 0.3, 0.2} * (apart / length(Vec3d{1, 0.3, 0.2})));
      const Answer found = answer(a, b, 1e-4);
      ASSERT_EQ(found.found.parts.size(), 1U);
      const Penetration& part = found.found.parts[0];
      expect_sound(part, a, b, 1e-4);
      EXPECT_EQ(found.separation, -part.depth);
      ASSERT_EQ(part.curves.size(), 1U);
      // The depth reaches from pole to pole or, if the spheres nearly coincide, from a pole to the curve of crossing.
      const double error = std::abs(part.depth - std::min(2 - apart, std::sqrt(2 - apart)));
      EXPECT_LT(error, 1.5 / (frequency * frequency) + 1e-3) << apart << " " << frequency;
      EXPECT_LT(error, last_error + 1e-3);
      last_error = error;
      if (frequency < 36) continue;
      const double cap = 2 * pi * (1 - apart / 2);
      EXPECT_NEAR(part.area[0], cap, 0.01 * cap + 1e-3);
      EXPECT_NEAR(part.area[1], cap, 0.01 * cap + 1e-3);
      const double lens = pi * (4 + apart) * (2 - apart) * (2 - apart) / 12;
      EXPECT_NEAR(part.volume, lens, 0.01 * lens + 1e-3);
    }
  }
}

TEST(Penetration, OfBoxesIsExactAtAnyTessellation) {
  for (const int parts : {1, 2, 7}) {
    const TriangleMesh a = box({0, 0, 0}, {2, 2, 2}, parts);
    const TriangleMesh b = box({0.5, 0.6, 1.875}, {1.25, 1.5, 3}, parts);
    const Answer found = answer(a, b, 1e-3);
    ASSERT_EQ(found.found.parts.size(), 1U);
    const Penetration& part = found.found.parts[0];
    expect_sound(part, a, b, 1e-3);
    EXPECT_NEAR(part.depth, 0.125, 1e-12);
    EXPECT_NEAR(part.direction.z, -1, 1e-9);
    EXPECT_NEAR(part.volume, 0.75 * 0.9 * 0.125, 1e-12);
    EXPECT_NEAR(part.area[0], 0.75 * 0.9, 1e-12);
    EXPECT_NEAR(part.area[1], 0.75 * 0.9 + 2 * (0.75 + 0.9) * 0.125, 1e-12);
    ASSERT_EQ(part.curves.size(), 1U);
    double around = 0;
    for (std::size_t k = 1; k < part.curves[0].size(); ++k) {
      around += length(part.curves[0][k] - part.curves[0][k - 1]);
    }
    EXPECT_NEAR(around, 2 * (0.75 + 0.9), 1e-12);
  }
}

/// The tubes overlap all along a ring.
TEST(Penetration, OfToriConverges) {
  double last_error = std::numeric_limits<double>::infinity();
  for (const int segments : {12, 30, 75}) {
    const TriangleMesh a = make_torus({.ring_segments = 3 * segments, .tube_segments = segments});
    const TriangleMesh b = moved(a, {0, 0, 0.4});
    const Answer found = answer(a, b, 1e-3);
    ASSERT_EQ(found.found.parts.size(), 1U);
    expect_sound(found.found.parts[0], a, b, 1e-3);
    EXPECT_EQ(found.found.parts[0].curves.size(), 2U);
    const double error = std::abs(found.found.parts[0].depth - 0.2);
    EXPECT_LT(error, 0.6 / segments);
    EXPECT_LT(error, last_error);
    last_error = error;
  }
}

/// A plate passes through a box. None of its vertices is inside, and the border of its part inside has depth zero.
TEST(Penetration, OfAPlateThroughABoxIsHalfTheWayThrough) {
  for (const double thickness : {0.1, 1e-3, 1e-6}) {
    for (const int parts : {1, 3}) {
      const TriangleMesh a = box({0, 0, 0}, {1, 1, 1}, parts);
      const TriangleMesh b = box({-1, -1, 0.4}, {2, 2, 0.4 + thickness}, parts);
      const Answer found = answer(a, b);
      ASSERT_EQ(found.found.parts.size(), 1U);
      expect_sound(found.found.parts[0], a, b, 0.01);
      // The centre of the plate is half a side away from the surface of the box.
      EXPECT_NEAR(found.found.parts[0].depth, 0.5, 0.01);
      EXPECT_TRUE(!found.found.parts[0].is_first_deep);
      EXPECT_NEAR(found.found.parts[0].volume, thickness, 1e-9 * thickness + 1e-15);
    }
  }
}

/// The teeth of two combs overlap by different amounts.
TEST(Penetration, ReportsEachContactOfInterlockedParts) {
  for (const int parts : {1, 2, 5}) {
    TriangleMesh a = box({-1, 0, -1}, {9, 1, 0}, parts);
    TriangleMesh b = box({-1, 0, 3}, {9, 1, 4}, parts);
    for (int tooth = 0; tooth < 4; ++tooth) {
      const double x = 2.0 * tooth;
      a = both(a, box({x, 0.25, 0.5}, {x + 1, 0.75, 2}, parts));
      const double overlap = 0.05 * (tooth + 1);
      b = both(b, box({x + 1 - overlap, 0, 1}, {x + 1.5, 1, 2.75}, parts));
    }
    const Answer found = answer(a, b, 1e-3);
    ASSERT_EQ(found.found.parts.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      const Penetration& part = found.found.parts[k];
      expect_sound(part, a, b, 1e-3);
      const double overlap = 0.05 * (4 - static_cast<double>(k));
      EXPECT_NEAR(part.volume, overlap * 0.5 * 1, 1e-9);
      // Each side is at most as far from the other side as the teeth overlap.
      EXPECT_NEAR(part.depth, overlap, 1e-9);
      EXPECT_NEAR(std::abs(part.direction.x), 1, 1e-9);
    }
    EXPECT_NEAR(found.separation, -0.2, 1e-9);
  }
}

TEST(Penetration, OfAnEnclosedSolidIsItsLargestDistance) {
  const TriangleMesh a = box({0, 0, 0}, {4, 4, 4});
  const TriangleMesh b = moved(make_sphere({.radius = 0.5, .frequency = 8}), {1, 2, 2});
  for (const bool is_turned : {false, true}) {
    const Answer found = is_turned ? answer(b, a, 1e-3) : answer(a, b, 1e-3);
    ASSERT_EQ(found.found.parts.size(), 1U);
    const Penetration& part = found.found.parts[0];
    expect_sound(part, is_turned ? b : a, is_turned ? a : b, 1e-3);
    EXPECT_NEAR(part.depth, 1.5, 0.02);
    EXPECT_EQ(part.is_first_deep, is_turned);
    EXPECT_NEAR(part.direction.x, is_turned ? -1 : 1, 1e-9);
    EXPECT_TRUE(part.curves.empty());
    EXPECT_NEAR(found.separation, -part.depth, 1e-15);
  }
}

/// The sign changes with the last bit of a coordinate.
TEST(Penetration, SignFlipsExactlyAtContact) {
  const TriangleMesh a = box({0, 0, 0}, {1, 1, 1});
  const auto at = [&](double z) {
    TriangleMesh b = box({0.25, 0.25, 1}, {0.75, 0.75, 2});
    for (Vec3d& p : b.vertices) {
      if (p.z == 1) p.z = z;
    }
    return answer(a, b);
  };
  const Answer touching = at(1);
  EXPECT_EQ(touching.separation, 0);
  EXPECT_TRUE(touching.found.parts.empty());
  const Answer apart = at(std::nextafter(1.0, 2.0));
  EXPECT_EQ(apart.separation, 0x1p-52);
  EXPECT_TRUE(apart.found.parts.empty());
  const Answer inside = at(std::nextafter(1.0, 0.0));
  EXPECT_LT(inside.separation, 0);
  EXPECT_GT(inside.separation, -1e-15);
  EXPECT_EQ(inside.found.parts.size(), 1U);
}

TEST(Penetration, OfAnObjectWithItselfMatchesItsParts) {
  const TriangleMesh a = make_sphere({.frequency = 10});
  const TriangleMesh b = moved(a, {1.5, 0.1, 0.2});
  const Answer expected = answer(a, b);
  ProximityScene scene;
  const ObjectId one = scene.add(both(a, b));
  const Penetrations found = scene.penetration(one, one);
  ASSERT_EQ(found.parts.size(), 1U);
  EXPECT_EQ(found.parts[0].depth, expected.found.parts[0].depth);
  EXPECT_NEAR(found.parts[0].volume, expected.found.parts[0].volume, 1e-12);
  EXPECT_EQ(found.parts[0].curves.size(), 1U);
  const ObjectId other = scene.add(a);
  EXPECT_TRUE(scene.penetration(other, other).parts.empty());
}

/// An object that crosses itself counts as the solid that its surface bounds.
TEST(Penetration, CountsOverlapsWithinOneObjectOnce) {
  const TriangleMesh crossed = both(box({0, 0, 0}, {1, 1, 1}), box({0.5, 0.2, 0.3}, {1.5, 0.8, 0.7}));
  const TriangleMesh far = box({1.25, 0, 0}, {3, 1, 1});
  const Answer found = answer(crossed, far, 1e-3);
  ASSERT_EQ(found.found.parts.size(), 1U);
  EXPECT_NEAR(found.found.parts[0].volume, 0.25 * 0.6 * 0.4, 1e-12);
  // A shell inside another shell of the same object is not an overlap with another object.
  const TriangleMesh nested = both(box({0, 0, 0}, {1, 1, 1}), box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
  EXPECT_TRUE(answer(nested, moved(far, {1, 0, 0})).found.parts.empty());
}

/// No tested point of either side is deeper than the bound.
TEST(Penetration, BoundHoldsForSampledPoints) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const TriangleMesh a = make_organic({.frequency = 7, .seed = seed});
    const TriangleMesh b = moved(make_organic({.frequency = 9, .seed = seed + 10}), random.in_ball() * 0.9);
    const Answer found = answer(a, b);
    ASSERT_FALSE(found.found.parts.empty());
    double deepest = 0;
    for (const Penetration& part : found.found.parts) expect_sound(part, a, b, 0.01);
    const WindingNumber in_a(a);
    const WindingNumber in_b(b);
    const SiteTable sites_a(a), sites_b(b);
    const Bvh of_a(a, sites_a);
    const Bvh of_b(b, sites_b);
    for (const Vec3d& p : a.vertices) {
      if (in_b.is_inside(p)) deepest = std::max(deepest, of_b.nearest(p)->distance);
    }
    for (const Vec3d& p : b.vertices) {
      if (in_a.is_inside(p)) deepest = std::max(deepest, of_a.nearest(p)->distance);
    }
    EXPECT_LE(deepest, found.found.parts.front().depth_bound * (1 + 1e-9));
    EXPECT_GT(deepest, 0.2 * found.found.parts.front().depth);
  }
}

TEST(Penetration, RejectsMeshesThatAreNotSolids) {
  TriangleMesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  const TriangleMesh solid = box({0.5, 0.5, 0.5}, {2, 2, 2});
  EXPECT_THROW(answer(open, solid), InvalidMesh);
  TriangleMesh points;
  points.vertices = {{0, 0, 0}};
  points.points = {0};
  EXPECT_THROW(answer(points, solid), InvalidMesh);
  TriangleMesh inverted = box({0, 0, 0}, {1, 1, 1});
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  EXPECT_THROW(answer(inverted, solid), InvalidMesh);
  EXPECT_THROW(answer(solid, inverted), InvalidMesh);
  EXPECT_THROW(answer(solid, solid, 0), InvalidOption);
  EXPECT_THROW(answer(solid, solid, std::numeric_limits<double>::quiet_NaN()), InvalidOption);
}

/// The bound covers parts that the search skips. With a tolerance of 1, the reported depth may be half the true one.
TEST(Penetration, BoundCoversSkippedParts) {
  const TriangleMesh a{{{0, 3, 3}, {0, 1, 1}, {3, 1, 0}, {2, 3, 2}}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  const TriangleMesh b{{{1, 0, 3}, {0, 3, 0}, {0, 0, 1}, {0, 0, 2}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const double depth = answer(a, b, 1e-4).found.parts.at(0).depth;
  EXPECT_NEAR(depth, 0.1873, 1e-4);
  for (const double tolerance : {1.0, 0.3, 0.01}) {
    const Penetration part = answer(a, b, tolerance).found.parts.at(0);
    EXPECT_GE(part.depth_bound, depth);
    EXPECT_LE(part.depth, depth * (1 + 1e-4));
  }
}

/// A block lies slightly in a floor, and solids of many long triangles overlap slightly at their faces. These parts are
/// wide compared with their depth. The tolerance holds at any depth.
TEST(Penetration, OfShallowContactsKeepsTheTolerance) {
  const TriangleMesh floor = box({-5, -5, -1}, {5, 5, 0});
  for (const double deep : {1e-2, 1e-4, 1e-6, 1e-9}) {
    SCOPED_TRACE(deep);
    const Penetration part = answer(floor, box({0.1, 0.2, -deep}, {1.1, 1.2, 1})).found.parts.at(0);
    EXPECT_NEAR(part.depth, deep, 1e-12);
    expect_sound(part, floor, box({0.1, 0.2, -deep}, {1.1, 1.2, 1}), 0.01);
    for (const TriangleMesh& solid : {make_cylinder({.sides = 50}), make_gear({}), make_sphere({.frequency = 4})}) {
      const Vec3d size = bounds(solid).size();
      const TriangleMesh above = moved(solid, {0.1 * size.x, 0.05 * size.y, size.z - deep});
      const Penetrations found = answer(solid, above).found;
      for (const Penetration& one : found.parts) expect_sound(one, solid, above, 0.01);
    }
  }
}

/// Faces have too many sides for a complete search. The bound must still hold.
TEST(Penetration, OfManySidedFacesIsBounded) {
  const TriangleMesh solid = make_cylinder({.sides = 3000});
  const TriangleMesh above = moved(solid, {0.2, 0.1, bounds(solid).size().z - 1e-3});
  const Penetration part = answer(solid, above).found.parts.at(0);
  EXPECT_NEAR(part.depth, 1e-3, 1e-9);
  EXPECT_GE(part.depth_bound, part.depth);
}

/// Equal solids have the depth of an infinitesimal displacement.
TEST(Penetration, OfEqualSolidsMatchesASmallDisplacement) {
  for (const TriangleMesh& solid : {box({0, 0, 0}, {1, 1, 1}, 2), make_cylinder({.sides = 40}), make_gear({}),
                                    make_torus({}), make_sphere({.frequency = 6})}) {
    const Answer same = answer(solid, solid, 1e-3);
    ASSERT_EQ(same.found.parts.size(), 1U);
    const Answer beside = answer(solid, moved(solid, {-1e-7, -1e-9, -1e-11}), 1e-3);
    EXPECT_NEAR(same.found.parts[0].volume, beside.found.parts[0].volume, 1e-5);
    EXPECT_NEAR(same.separation, beside.separation, 2e-3 * std::abs(same.separation));
    EXPECT_LT(same.separation, -0.1);
    EXPECT_NEAR(same.found.parts[0].area[0], beside.found.parts[0].area[0], 1e-5);
  }
  // Two solids share some of their faces.
  const Answer half = answer(box({0, 0, 0}, {1, 1, 1}), box({0, 0, 0.5}, {1, 1, 1.5}));
  EXPECT_NEAR(half.separation, -0.5, 1e-12);
}

/// Errors name the object that is not a solid, and a remedy.
TEST(Penetration, SaysWhichObjectIsOpen) {
  const TriangleMesh solid = box({0, 0, 0}, {1, 1, 1});
  const auto message = [&](const TriangleMesh& other) -> std::string {
    try {
      static_cast<void>(answer(solid, other));
    } catch (const InvalidMesh& error) {
      return error.what();
    }
    return {};
  };
  TriangleMesh open = moved(solid, {0.5, 0.25, 0.25});
  TriangleMesh loose;
  for (const Triangle& t : open.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.vertices.size());
    for (const std::uint32_t v : t) loose.vertices.push_back(open.vertices[v]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  open.triangles.pop_back();
  EXPECT_TRUE(message(open).starts_with("object 1 is not closed, or its triangles do not all face the same way: at 3"));
  EXPECT_TRUE(
      message(loose).starts_with("object 1 is not closed: at 36 edges its triangles touch but share no vertices"));
  EXPECT_NE(message(loose).find("weld"), std::string::npos);
}

}  // namespace
}  // namespace blum
