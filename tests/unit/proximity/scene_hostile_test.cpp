// Smallest cases of hostile scenes give right results.
#include <gtest/gtest.h>

#include <vector>

#include "blum/core/error.hpp"
#include "blum/proximity/scene.hpp"

namespace blum {
namespace {

/// Layers of triangles drift slightly to one side. The direction from one half to the other differs from the normal by
/// a millionth.
TEST(HostileScene, SeesContactsOfStacks) {
  Vec3d n{1, 1, 1};
  n = n / length(n);
  Vec3d u = cross(n, Vec3d{0, 0, 1});
  u = u / length(u);
  const Vec3d v = cross(n, u);
  TriangleMesh stack;
  for (std::uint32_t k = 0; k < 8; ++k) {
    const Vec3d c = n * (1000.0 + 2 * k) + u * (2.5e-6 * k);
    stack.vertices.insert(stack.vertices.end(), {c + u, c - u * 0.5 + v * 0.8, c - u * 0.5 - v * 0.8});
    stack.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const Vec3d corner = stack.vertices[21];
  const TriangleMesh other{{corner, corner + u + v * 0.5, corner + u - v * 0.5}, {{0, 1, 2}}};
  for (const Culling culling : {Culling::bvh, Culling::voronoi}) {
    ProximityScene scene({.culling = culling});
    scene.add(stack);
    scene.add(other);
    EXPECT_EQ(scene.collisions().pairs.size(), 1U);
    EXPECT_EQ(scene.closer_than(1e-7).pairs.size(), 1U);
    EXPECT_EQ(scene.closest_primitives(1e-7).pairs.size(), 2U);
    EXPECT_EQ(scene.separation(1e-7).pairs.size(), 1U);
  }
}

/// A heap of equal triangles would require a test of every two of them. Queries fail at once if these are too many.
/// Queries that do not compare them return a result.
TEST(HostileScene, RejectsAMillionEqualTrianglesAtOnce) {
  TriangleMesh heap;
  for (std::uint32_t k = 0; k < 1000000; ++k) {
    heap.vertices.insert(heap.vertices.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    heap.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  const TriangleMesh other{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}};
  for (const Culling culling : {Culling::bvh, Culling::voronoi}) {
    ProximityScene scene({.culling = culling});
    const ObjectId first = scene.add(heap, {.self = true});
    const ObjectId second = scene.add(other);
    EXPECT_EQ(scene.separation(first, second)->between.distance, 1);
    EXPECT_THROW(static_cast<void>(scene.separation(first, first)), InvalidMesh);
    EXPECT_THROW(static_cast<void>(scene.separation()), InvalidMesh);
    EXPECT_THROW(static_cast<void>(scene.closest_primitives()), InvalidMesh);
    EXPECT_THROW(static_cast<void>(scene.closer_than(0.5)), InvalidMesh);
    EXPECT_THROW(static_cast<void>(scene.collisions()), OutOfMemory);
    EXPECT_TRUE(scene.meets(first, first));
    EXPECT_FALSE(scene.meets(first, second));
  }
}

/// The rotation of one object is off by the allowed error. The other object therefore seems further away.
TEST(HostileScene, AllowsForTransformsThatAreNotQuiteRigid) {
  ProximityScene scene;
  const ObjectId a = scene.add(TriangleMesh{{{0, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}}});
  const ObjectId b = scene.add(TriangleMesh{{{1000, 0, 0}, {1001, 1, 0}, {1001, -1, 0}}, {{0, 1, 2}}});
  RigidTransform place;
  for (std::size_t k = 0; k < 3; ++k) place.rotation.columns[k][k] = 1 + 4.9e-10;
  scene.update(a, place);
  EXPECT_TRUE(scene.separation(a, b, 1000));
  EXPECT_EQ(scene.closer_than(1000).pairs.size(), 1U);
}

TEST(HostileScene, FindsDistancesOfTinyTriangles) {
  const TriangleMesh first{{{9.1004506896295872e-80, -8.1070665165859975e-80, -7.3285331680394144e-80},
                            {3.716264567174343e-80, -2.0780840308544357e-80, -7.8735754081426897e-80},
                            {-4.1002664756115471e-81, -5.3864596565443778e-80, -5.8439334345407713e-81}},
                           {{0, 1, 2}}};
  const TriangleMesh second{{{-3.4041434931523439e-80, -7.8996155181356668e-80, 3.5173789491727598e-79},
                             {9.785488293245043e-80, -5.5163234861373355e-80, 3.3942791809412498e-79},
                             {2.3847578437123039e-81, 9.795915027381899e-80, 3.2527333231294493e-79}},
                            {{0, 1, 2}}};
  ProximityScene scene;
  const ObjectId a = scene.add(first);
  const ObjectId b = scene.add(second);
  EXPECT_TRUE(scene.separation(a, b, 3.4812478997099003e-79));
  TriangleMesh smaller = first;
  for (Vec3d& p : smaller.vertices) p = p * 1e-65;
  EXPECT_THROW(scene.add(smaller), InvalidMesh);
  EXPECT_THROW(scene.update(a, smaller.vertices), InvalidMesh);
}

}  // namespace
}  // namespace blum
