// ProximityScene::meets() answers as a test of all pairs of primitives, for any meshes, transforms, places and threads.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/nasty_soup.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

using Corners = std::array<Vec3d, 3>;

std::vector<Corners> primitives(const TriangleMesh& mesh, const RigidTransform& place) {
  const auto at = [&](std::uint32_t v) {
    return place == RigidTransform{} ? mesh.vertices[v] : place(mesh.vertices[v]);
  };
  std::vector<Corners> out;
  for (const auto& [a, b, c] : mesh.triangles) out.push_back({at(a), at(b), at(c)});
  for (const auto& [a, b] : mesh.segments) out.push_back({at(a), at(b), at(b)});
  for (const std::uint32_t v : mesh.points) out.push_back({at(v), at(v), at(v)});
  return out;
}

/// The reference: tests all pairs of primitives.
bool any_pair_meets(const TriangleMesh& a, const RigidTransform& place_of_a, const TriangleMesh& b,
                    const RigidTransform& place_of_b) {
  const std::vector<Corners> of_b = primitives(b, place_of_b);
  for (const Corners& p : primitives(a, place_of_a)) {
    for (const Corners& q : of_b) {
      if (triangles_meet(p, q)) return true;
    }
  }
  return false;
}

TriangleMesh soup(std::uint64_t seed, std::size_t count) {
  TriangleMesh mesh = test::nasty_soup(seed, count);
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.segments = {{0, vertices - 1}, {1, 1}};
  mesh.points = {2, vertices - 2};
  return mesh;
}

/// Checks the queries of two objects at many places against the reference, and against other queries.
/// @return  the number of places at which they meet.
std::size_t expect_answers(const TriangleMesh& a, const RigidTransform& place_of_a, const TriangleMesh& b,
                           const std::vector<RigidTransform>& places) {
  ProximityScene scene;
  const ObjectId first = scene.add(a);
  const ObjectId second = scene.add(b);
  scene.update(first, place_of_a);
  std::vector<std::uint8_t> expected;
  for (const RigidTransform& place : places) {
    expected.push_back(any_pair_meets(a, place_of_a, b, place) ? 1 : 0);
    scene.update(second, place);
    const bool meets = expected.back() == 1;
    EXPECT_EQ(scene.meets(first, second), meets);
    EXPECT_EQ(scene.meets(second, first), meets);
    EXPECT_EQ(scene.meets(), meets);
    EXPECT_EQ(scene.separation(first, second)->between.distance == 0, meets);
    EXPECT_EQ(!scene.collisions().pairs.empty(), meets);
  }
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    EXPECT_EQ(scene.meets(first, second, places, context), expected);
  }
  std::size_t count = 0;
  for (const std::uint8_t one : expected) count += one;
  return count;
}

TEST(Meets, MatchesAllPairsForNastySoups) {
  Random random(1);
  std::size_t count = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    std::vector<RigidTransform> places{{}};
    for (int k = 0; k < 30; ++k) {
      places.push_back(test::random_transform(random, 0.5));
      // The second soup stays in the planes of the first one.
      if (k % 3 == 0) places.back() = {{}, {random.uniform(-1, 1), random.uniform(-1, 1), 0}};
    }
    const RigidTransform of_a = seed % 2 == 0 ? RigidTransform{} : test::random_transform(random, 0.5);
    count += expect_answers(soup(seed, 8 + 6 * seed), of_a, soup(seed + 50, 40), places);
  }
  EXPECT_GT(count, 30U);
  EXPECT_LT(count, 156U);
}

TEST(Meets, MatchesAllPairsForMeshes) {
  Random random(2);
  const TriangleMesh body = make_organic({.frequency = 5});
  const TriangleMesh ring = make_torus({.ring_segments = 24, .tube_segments = 12});
  std::vector<RigidTransform> places;
  for (int k = 0; k < 40; ++k) places.push_back(test::random_transform(random, 4));
  const std::size_t count = expect_answers(body, test::random_transform(random, 1), ring, places);
  EXPECT_GT(count, 5U);
  EXPECT_LT(count, 35U);
}

/// Small steps along a path, on which consecutive places often have the same first pair.
TEST(Meets, MatchesAllPairsAlongAPath) {
  const TriangleMesh ball = make_sphere({.frequency = 6});
  std::vector<RigidTransform> places;
  for (int k = -60; k <= 60; ++k) places.push_back({{}, {0.04 * k, 0.3, 0.01 * k}});
  const std::size_t count = expect_answers(ball, {}, make_box({}), places);
  EXPECT_GT(count, 20U);
  EXPECT_LT(count, 100U);
}

/// Boxes that touch in a face, an edge or a corner meet. The smallest possible gap separates them.
TEST(Meets, IsExactForContacts) {
  ProximityScene scene;
  const TriangleMesh box = make_box({});  // from -0.5 to 0.5
  const ObjectId first = scene.add(box);
  const ObjectId second = scene.add(box);
  const double less = std::nextafter(1.0, 0.0);
  const double more = std::nextafter(1.0, 2.0);
  for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{1, 1, 0}, Vec3d{1, 1, 1}, Vec3d{1, 0.5, -0.25}}) {
    const auto at = [&](double x) { return RigidTransform{{}, {x, way.y, way.z}}; };
    const std::vector<RigidTransform> places{at(less), at(1), at(more), at(-1), at(-more)};
    EXPECT_EQ(scene.meets(first, second, places), (std::vector<std::uint8_t>{1, 1, 0, 1, 0}));
  }
}

/// Positions are those of the transformed meshes, rounded to doubles. Far from the origin they decide.
TEST(Meets, MatchesAllPairsFarFromTheOrigin) {
  for (const double far : {1e5, 1e12, 1e15}) {
    Random random(3);
    std::vector<RigidTransform> places;
    for (int k = 0; k < 30; ++k) {
      places.push_back(test::random_transform(random, 3));
      places.back().translation += Vec3d{far, -far, far};
    }
    RigidTransform of_a = test::random_transform(random, 1);
    of_a.translation += Vec3d{far, -far, far};
    EXPECT_GT(expect_answers(soup(4, 25), of_a, soup(5, 25), places), 0U);
  }
}

TEST(Meets, CountsSurfacesOnly) {
  ProximityScene scene;
  const ObjectId inner = scene.add(make_sphere({.radius = 0.2}));
  const ObjectId outer = scene.add(make_sphere({.radius = 1}));
  EXPECT_FALSE(scene.meets(inner, outer));
  scene.update(inner, RigidTransform{{}, {0.9, 0, 0}});
  EXPECT_TRUE(scene.meets(inner, outer));
}

TEST(Meets, ComparesAsCollisionsDoes) {
  ProximityScene scene;
  const ObjectId a = scene.add(make_box({}), {.layers = 2, .meets = 1});
  const ObjectId b = scene.add(make_box({}), {.layers = 1, .meets = 1});
  EXPECT_FALSE(scene.meets());     // the second object does not meet the first one's layer
  EXPECT_TRUE(scene.meets(a, b));  // whatever the layers
  const ObjectId c = scene.add(make_box({}));
  EXPECT_TRUE(scene.meets());
  scene.exclude(b, c);
  EXPECT_TRUE(scene.meets());  // the first and the third object
  scene.exclude(a, c);
  EXPECT_FALSE(scene.meets());
  scene.remove(c);
  EXPECT_THROW(static_cast<void>(scene.meets(a, c)), InvalidOption);
}

/// An object and itself: as collisions(), which also finds neighbours that are folded onto each other.
TEST(Meets, FindsCollisionsOfAnObjectWithItself) {
  const TriangleMesh folded{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  const TriangleMesh flat{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, -1, 0}}, {{0, 1, 2}, {0, 1, 3}}};
  TriangleMesh crossed = flat;
  crossed.vertices.insert(crossed.vertices.end(), {{1, 1, -1}, {1, 1, 1}});
  crossed.segments = {{4, 5}};
  std::vector<TriangleMesh> meshes{folded, flat, crossed, make_torus({}), make_linked_tori({}), make_box({})};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    TriangleMesh few;
    for (std::uint32_t t = 0; t < 6; ++t) {
      for (int k = 0; k < 3; ++k) few.vertices.push_back(random.in_cube());
      few.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    meshes.push_back(few);
    meshes.push_back(soup(seed, 4));
  }
  std::size_t count = 0;
  for (const TriangleMesh& mesh : meshes) {
    ProximityScene scene;
    const ObjectId only = scene.add(mesh, {.self = true});
    const bool meets = !scene.collisions().pairs.empty();
    EXPECT_EQ(scene.meets(only, only), meets);
    EXPECT_EQ(scene.meets(), meets);
    count += meets ? 1U : 0U;
  }
  EXPECT_GT(count, 10U);
  EXPECT_LT(count, meshes.size());
}

/// Two shells close to each other everywhere need many steps, which threads share.
TEST(Meets, SharesLongSearchesAmongThreads) {
  const TriangleMesh shell = make_sphere({.radius = 1, .frequency = 40});
  TriangleMesh outer = shell;
  for (Vec3d& p : outer.vertices) p *= 1.0005;
  TriangleMesh poked = outer;
  poked.vertices[poked.vertices.size() / 2] *= 0.99;
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    ProximityScene scene;
    const ObjectId a = scene.add(shell);
    const ObjectId b = scene.add(outer);
    EXPECT_FALSE(scene.meets(a, b, context));
    EXPECT_EQ(scene.meets(a, b, std::vector<RigidTransform>(20), context), std::vector<std::uint8_t>(20, 0));
    scene.update(b, poked.vertices);
    EXPECT_TRUE(scene.meets(a, b, context));
    EXPECT_EQ(scene.meets(a, b, std::vector<RigidTransform>(20), context), std::vector<std::uint8_t>(20, 1));
  }
}

TEST(Meets, LeavesTheSceneUnchanged) {
  ProximityScene scene;
  const ObjectId a = scene.add(make_box({}));
  const ObjectId b = scene.add(make_box({}));
  const RigidTransform own{{}, {3, 0, 0}};
  scene.update(b, own);
  EXPECT_EQ(scene.meets(a, b, std::vector<RigidTransform>{{}, own}), (std::vector<std::uint8_t>{1, 0}));
  EXPECT_EQ(scene.separation(a, b)->between.distance, 2);
  EXPECT_TRUE(scene.meets(a, b, std::span<const RigidTransform>{}).empty());
}

TEST(Meets, ChecksItsArguments) {
  ProximityScene scene;
  const ObjectId a = scene.add(make_box({}));
  const ObjectId b = scene.add(make_box({}));
  std::vector<RigidTransform> places(3);
  EXPECT_THROW(static_cast<void>(scene.meets(a, a, places)), InvalidOption);
  places[2].rotation.columns[0] *= 2;
  try {
    static_cast<void>(scene.meets(a, b, places));
    ADD_FAILURE() << "accepts a transform that scales";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("transforms[2]"), std::string::npos);
  }
  Context context;
  context.threads = -1;
  EXPECT_THROW(static_cast<void>(scene.meets(a, b, context)), InvalidOption);
  EXPECT_THROW(static_cast<void>(scene.meets(a, b, std::vector<RigidTransform>(1), context)), InvalidOption);
}

TEST(Meets, StopsAndReportsProgress) {
  ProximityScene scene;
  const ObjectId a = scene.add(make_box({}));
  const ObjectId b = scene.add(make_box({}));
  std::stop_source stop;
  Context context;
  context.cancel = stop.get_token();
  double last = -1;
  context.progress = [&](double fraction, std::string_view) { last = fraction; };
  EXPECT_EQ(scene.meets(a, b, std::vector<RigidTransform>(100), context).size(), 100U);
  EXPECT_EQ(last, 1);
  stop.request_stop();
  EXPECT_THROW(static_cast<void>(scene.meets(a, b, context)), Cancelled);
  EXPECT_THROW(static_cast<void>(scene.meets(a, b, std::vector<RigidTransform>(100), context)), Cancelled);
}

}  // namespace
}  // namespace blum
