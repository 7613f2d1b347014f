// Proximity of objects matches a test of all pairs of primitives, for any meshes, transforms, updates and threads.
#include "blum/proximity/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/shapes/generators.hpp"
#include "support/nasty_soup.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

using Corners = std::array<Vec3d, 3>;
/// First object and primitive, second object and primitive, distance.
using Row = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, double>;

Row row(const PrimitivePair& pair) {
  return {pair.first_object.value, pair.first, pair.second_object.value, pair.second, pair.between.distance};
}
std::vector<Row> rows(const std::vector<PrimitivePair>& pairs) {
  std::vector<Row> out;
  for (const PrimitivePair& pair : pairs) out.push_back(row(pair));
  return out;
}

/// A reference for scenes: it tests all pairs.
struct SlowScene {
  struct Object {
    TriangleMesh mesh;
    ObjectOptions options;
    RigidTransform place;
  };
  std::vector<Object> objects;
  std::set<std::pair<std::uint32_t, std::uint32_t>> excluded;

  [[nodiscard]] std::vector<std::array<std::uint32_t, 3>> primitives(std::uint32_t object) const {
    const TriangleMesh& mesh = objects[object].mesh;
    std::vector<std::array<std::uint32_t, 3>> out(mesh.triangles.begin(), mesh.triangles.end());
    for (const auto& [a, b] : mesh.segments) out.push_back({a, b, b});
    for (const std::uint32_t v : mesh.points) out.push_back({v, v, v});
    return out;
  }
  [[nodiscard]] Corners corners(std::uint32_t object, const std::array<std::uint32_t, 3>& primitive) const {
    Corners out;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = objects[object].mesh.vertices[primitive[k]];
      out[k] = objects[object].place == RigidTransform{} ? p : objects[object].place(p);
    }
    return out;
  }
  [[nodiscard]] bool are_compared(std::uint32_t a, std::uint32_t b) const {
    if (excluded.contains({a, b})) return false;
    if (a == b) return objects[a].options.self;
    return (objects[a].options.layers & objects[b].options.meets) != 0 &&
           (objects[b].options.layers & objects[a].options.meets) != 0;
  }
  /// All compared pairs, each once, without pairs of one object that share a corner.
  [[nodiscard]] std::vector<Row> all_pairs() const {
    std::vector<Row> out;
    for (std::uint32_t a = 0; a < objects.size(); ++a) {
      for (std::uint32_t b = a; b < objects.size(); ++b) {
        if (are_compared(a, b)) add_pairs(a, b, out);
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  }
  void add_pairs(std::uint32_t a, std::uint32_t b, std::vector<Row>& out) const {
    const auto of_a = primitives(a);
    const auto of_b = primitives(b);
    for (std::uint32_t i = 0; i < of_a.size(); ++i) {
      for (std::uint32_t j = a == b ? i + 1 : 0; j < of_b.size(); ++j) {
        const Corners p = corners(a, of_a[i]);
        const Corners q = corners(b, of_b[j]);
        const bool is_shared = std::any_of(p.begin(), p.end(),
                                           [&](const Vec3d& x) { return std::find(q.begin(), q.end(), x) != q.end(); });
        if (a == b && is_shared) continue;
        out.emplace_back(a, i, b, j, triangle_distance(p, q).distance);
      }
    }
  }
  void add_to(ProximityScene& scene) const {
    for (const Object& object : objects) {
      const ObjectId id = scene.add(object.mesh, object.options);
      scene.update(id, object.place);
    }
    for (const auto& [a, b] : excluded) scene.exclude(ObjectId(a), ObjectId(b));
  }
};

bool is_closer(const Row& a, const Row& b) {
  if (std::get<4>(a) != std::get<4>(b)) return std::get<4>(a) < std::get<4>(b);
  return a < b;
}

/// The closest primitive of each primitive, in ascending order of (object, primitive).
std::vector<Row> closest_of_each(const std::vector<Row>& all, double max_distance) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Row> best;
  const auto offer = [&](const Row& r) {
    const auto [at, is_new] = best.try_emplace({std::get<0>(r), std::get<1>(r)}, r);
    if (!is_new && is_closer(r, at->second)) at->second = r;
  };
  for (const Row& r : all) {
    if (std::get<4>(r) > max_distance) continue;
    offer(r);
    offer({std::get<2>(r), std::get<3>(r), std::get<0>(r), std::get<1>(r), std::get<4>(r)});
  }
  std::vector<Row> out;
  for (const auto& [key, r] : best) out.push_back(r);
  return out;
}

/// The closest pair of primitives of each pair of objects.
std::vector<Row> closest_of_objects(const std::vector<Row>& all) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Row> best;
  for (const Row& r : all) {
    const auto [at, is_new] = best.try_emplace({std::get<0>(r), std::get<2>(r)}, r);
    if (!is_new && is_closer(r, at->second)) at->second = r;
  }
  std::vector<Row> out;
  for (const auto& [key, r] : best) out.push_back(r);
  return out;
}

std::vector<Row> no_further(const std::vector<Row>& all, double distance) {
  std::vector<Row> out;
  std::copy_if(all.begin(), all.end(), std::back_inserter(out),
               [&](const Row& r) { return std::get<4>(r) <= distance; });
  return out;
}

/// All results of a scene match a test of all pairs.
void expect_scene_answers(const ProximityScene& scene, const SlowScene& slow, const Context& context) {
  const std::vector<Row> all = slow.all_pairs();
  ASSERT_EQ(rows(scene.separation(infinite, context).pairs), closest_of_objects(all));
  ASSERT_EQ(rows(scene.closest_primitives(infinite, context).pairs), closest_of_each(all, infinite));
  for (const double distance : {0.0, 0.02, 0.3}) {
    ASSERT_EQ(rows(scene.closer_than(distance, context).pairs), no_further(all, distance));
    ASSERT_EQ(rows(scene.closest_primitives(distance, context).pairs), closest_of_each(all, distance));
  }
  for (const Row& r : closest_of_objects(all)) {
    const auto [a, i, b, j, distance] = r;
    const auto found = scene.separation(ObjectId(a), ObjectId(b), infinite, context);
    ASSERT_TRUE(found);
    ASSERT_EQ(row(*found), r);
    if (a == b) continue;
    const auto back = scene.separation(ObjectId(b), ObjectId(a), infinite, context);
    ASSERT_TRUE(back);
    ASSERT_EQ(row(*back), Row(b, j, a, i, distance));
    ASSERT_EQ(back->between.first_point, found->between.second_point);
  }
}

/// Also checks scenes that cull by Voronoi diagrams, on coarse and fine grids.
void expect_answers(const ProximityScene& scene, const SlowScene& slow, const Context& context = {}) {
  expect_scene_answers(scene, slow, context);
  for (const double cell_size : {0.2, 1.0, 2.0, 20.0}) {
    SCOPED_TRACE(cell_size);
    ProximityScene by_cells({.culling = Culling::voronoi, .cell_size = cell_size});
    slow.add_to(by_cells);
    expect_scene_answers(by_cells, slow, context);
    EXPECT_EQ(rows(by_cells.collisions(context).pairs), rows(scene.collisions(context).pairs));
  }
}

TriangleMesh soup(std::uint64_t seed, std::size_t count) {
  TriangleMesh mesh = test::nasty_soup(seed, count);
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.segments = {{0, vertices - 1}, {1, 1}};
  mesh.points = {2, vertices - 2};
  return mesh;
}

TEST(ProximityScene, MatchesAllPairsForNastySoups) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Random random(seed);
    SlowScene slow;
    for (std::uint32_t k = 0; k < 4; ++k) {
      slow.objects.push_back({soup(10 * seed + k, 5 + 30 * k), {.self = k % 2 == 0}, {}});
      if (k >= 2) slow.objects.back().place = test::random_transform(random, 1.5);
    }
    ProximityScene scene;
    slow.add_to(scene);
    expect_answers(scene, slow);
  }
}

/// Every primitive is at distance zero from many others: their order decides.
TEST(ProximityScene, MatchesAllPairsForMeshesOnAGrid) {
  Random random(7);
  SlowScene slow;
  for (int k = 0; k < 3; ++k) {
    TriangleMesh mesh;
    for (std::uint32_t t = 0; t < 60; ++t) {
      for (int corner = 0; corner < 3; ++corner) {
        const auto one = [&] { return static_cast<double>(random.below(4)); };
        const double x = one();
        const double y = one();
        mesh.vertices.push_back({x, y, one()});
      }
      mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    }
    slow.objects.push_back({std::move(mesh), {.self = true}, {}});
  }
  ProximityScene scene;
  slow.add_to(scene);
  expect_answers(scene, slow);
}

TEST(ProximityScene, MatchesAllPairsForEqualObjects) {
  SlowScene slow;
  for (int k = 0; k < 3; ++k) slow.objects.push_back({make_sphere({.frequency = 3}), {.self = true}, {}});
  slow.objects[2].place.translation = {2, 0, 0};
  ProximityScene scene;
  slow.add_to(scene);
  expect_answers(scene, slow);
}

TEST(ProximityScene, MatchesAllPairsFarFromTheOrigin) {
  for (const double far : {1e5, 1e12}) {
    Random random(8);
    SlowScene slow;
    for (int k = 0; k < 3; ++k) {
      slow.objects.push_back(
          {soup(80 + static_cast<std::uint64_t>(k), 25), {.self = true}, test::random_transform(random, 1)});
      slow.objects.back().place.translation += Vec3d{far, -far, far};
    }
    ProximityScene scene;
    slow.add_to(scene);
    expect_answers(scene, slow);
  }
}

TEST(ProximityScene, MatchesAllPairsForAnySize) {
  for (const double scale : {1e-100, 1e-30, 1e30, 1e69}) {
    SlowScene slow;
    for (std::uint64_t k = 0; k < 3; ++k) {
      slow.objects.push_back({soup(90 + k, 25), {.self = true}, {}});
      for (Vec3d& p : slow.objects.back().mesh.vertices) p = p * scale;
    }
    const std::vector<Row> all = slow.all_pairs();
    for (const Culling culling : {Culling::bvh, Culling::voronoi}) {
      ProximityScene scene({.culling = culling});
      slow.add_to(scene);
      ASSERT_EQ(rows(scene.separation().pairs), closest_of_objects(all));
      ASSERT_EQ(rows(scene.closest_primitives().pairs), closest_of_each(all, infinite));
      ASSERT_EQ(rows(scene.closer_than(0.1 * scale).pairs), no_further(all, 0.1 * scale));
    }
  }
}

TEST(ProximityScene, ComparesOnlyRequestedPairs) {
  SlowScene slow;
  for (std::uint32_t k = 0; k < 5; ++k) slow.objects.push_back({soup(20 + k, 12), {.self = k == 3}, {}});
  slow.objects[0].options = {.layers = 2, .meets = 1};
  slow.objects[1].options = {.layers = 1, .meets = 1};  // does not meet the first object, which would meet it
  slow.objects[2].options = {.layers = 3, .meets = 3};
  slow.excluded = {{2, 3}, {3, 3}};
  ProximityScene scene;
  slow.add_to(scene);
  expect_answers(scene, slow);
  scene.exclude(ObjectId(3), ObjectId(2), false);
  scene.exclude(ObjectId(3), ObjectId(3), false);
  slow.excluded.clear();
  expect_answers(scene, slow);
}

class ProximitySceneOfThreads : public testing::TestWithParam<Culling> {};

TEST_P(ProximitySceneOfThreads, IsTheSameForAnyNumber) {
  ProximityScene scene({.culling = GetParam()});
  scene.add(make_organic({.frequency = 12}), {.self = true});
  const ObjectId other = scene.add(make_torus({}), {.self = true});
  Random random(30);
  scene.update(other, test::random_transform(random, 0.4));
  std::optional<std::vector<std::vector<Row>>> first;
  for (const int threads : {1, 2, 7}) {
    Context context;
    context.threads = threads;
    const std::vector<std::vector<Row>> answers{
        rows(scene.separation(infinite, context).pairs), rows(scene.closest_primitives(infinite, context).pairs),
        rows(scene.closer_than(0.05, context).pairs), rows(scene.collisions(context).pairs)};
    for (const auto& answer : answers) EXPECT_FALSE(answer.empty());
    if (!first) first = answers;
    EXPECT_EQ(answers, *first);
  }
}

INSTANTIATE_TEST_SUITE_P(Cullings, ProximitySceneOfThreads, testing::Values(Culling::bvh, Culling::voronoi),
                         [](const auto& info) { return std::string(to_string(info.param)); });

/// A plate of n x n squares at a height. Two plates have the same distance everywhere.
TriangleMesh plate(std::uint32_t n, double height) {
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) mesh.vertices.emplace_back(x, y, height);
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t v = y * (n + 1) + x;
      mesh.triangles.push_back({v, v + 1, v + n + 1});
      mesh.triangles.push_back({v + 1, v + n + 2, v + n + 1});
    }
  }
  return mesh;
}

/// The closest pair of two objects, by a test of all pairs.
Row closest_of_all(const SlowScene& slow) {
  const auto of_a = slow.primitives(0);
  const auto of_b = slow.primitives(1);
  Row best{0, 0, 1, 0, infinite};
  for (std::uint32_t i = 0; i < of_a.size(); ++i) {
    const Corners p = slow.corners(0, of_a[i]);
    for (std::uint32_t j = 0; j < of_b.size(); ++j) {
      const double distance = triangle_distance(p, slow.corners(1, of_b[j])).distance;
      if (distance < std::get<4>(best)) best = {0, i, 1, j, distance};
    }
  }
  return best;
}

/// The objects are so large that several threads share the work. Pairs may be equally close everywhere.
TEST(ProximityScene, SharesTheWorkOfLargeObjects) {
  const TriangleMesh body = make_organic({.frequency = 12});
  const TriangleMesh flat = plate(34, 0);
  SlowScene apart{{{body, {}, {}}, {body, {}, {}}}, {}};
  apart.objects[1].place.translation = {2.5, 0.3, -0.2};
  SlowScene touching = apart;
  touching.objects[1].place.translation = {0.4, 0.3, 0.2};
  SlowScene parallel{{{flat, {}, {}}, {plate(34, 0.75), {}, {}}}, {}};
  SlowScene equal{{{flat, {}, {}}, {flat, {}, {}}}, {}};
  for (const SlowScene& slow : {apart, touching, parallel, equal}) {
    ASSERT_GT(slow.objects[0].mesh.triangles.size(), 8 * 256U);
    ProximityScene scene;
    slow.add_to(scene);
    const Row expected = closest_of_all(slow);
    std::optional<ProximityReport> first;
    for (const int threads : {1, 2, 7}) {
      Context context;
      context.threads = threads;
      const ProximityPairs found = scene.separation(infinite, context);
      ASSERT_EQ(rows(found.pairs), std::vector<Row>{expected});
      if (!first) first = found.report;
      EXPECT_EQ(found.report.candidates, first->candidates);
      EXPECT_EQ(found.report.exact_tests, first->exact_tests);
    }
  }
}

/// Voronoi culling of N-body distances reduces the exact tests, and reports its counts.
TEST(ProximityScene, ReportsItsCulling) {
  const TriangleMesh mesh = make_organic({.frequency = 10});
  ProximityScene scene({.culling = Culling::voronoi});
  scene.add(mesh, {.self = true});
  const ProximityReport cells = scene.closest_primitives().report;
  EXPECT_EQ(cells.culling, Culling::voronoi);
  EXPECT_GT(cells.cells, 100U);
  EXPECT_LT(cells.left_over, mesh.triangles.size() / 10);
  EXPECT_GE(cells.exact_tests, mesh.triangles.size());
  EXPECT_LT(cells.exact_tests, 60 * mesh.triangles.size());
  const ProximityReport closest = scene.separation().report;
  EXPECT_EQ(closest.culling, Culling::voronoi);
  EXPECT_GT(closest.cells, 100U);
  EXPECT_LT(closest.exact_tests, mesh.triangles.size());
  ProximityScene automatic;
  automatic.add(mesh, {.self = true});
  EXPECT_EQ(automatic.closest_primitives().report.culling, Culling::bvh);
  EXPECT_THROW(ProximityScene({.cell_size = 0}), InvalidOption);
  EXPECT_THROW(ProximityScene({.cell_size = std::numeric_limits<double>::quiet_NaN()}), InvalidOption);
}

/// A coarse plate lies under a fine body, and a heap of triangles lies in one place. The hierarchy handles primitives
/// that do not fit the cells. Results stay the same.
TEST(ProximityScene, LeavesPrimitivesOffTheCellsToTheHierarchy) {
  SlowScene slow;
  slow.objects.push_back({make_box({.size = {100, 100, 0.1}}), {.self = true}, {}});
  slow.objects.push_back({make_sphere({.radius = 0.5, .frequency = 4}), {.self = true}, {}});
  TriangleMesh heap;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const double shift = 1e-9 * k;
    heap.vertices.insert(heap.vertices.end(), {{shift, 2, 0.2}, {0.1, 2 + shift, 0.2}, {0, 2, 0.3 + shift}});
    heap.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  slow.objects.push_back({heap, {.self = true}, {}});
  ProximityScene scene({.culling = Culling::voronoi, .cell_size = 0.05});
  slow.add_to(scene);
  expect_scene_answers(scene, slow, {});
  EXPECT_GT(scene.closest_primitives().report.left_over, 300U);
}

/// One body deforms and one moves for a hundred frames. Results match a new scene in each frame.
TEST(ProximityScene, OfADeformingBodyMatchesANewScene) {
  const TriangleMesh rest = make_organic({.frequency = 6});
  TriangleMesh moved = rest;
  const TriangleMesh body = make_torus({.ring_segments = 24, .tube_segments = 12});
  Random random(31);
  ProximityScene scene;
  const ObjectId soft = scene.add(rest, {.self = true});
  const ObjectId rigid = scene.add(body);
  for (int frame = 0; frame < 100; ++frame) {
    for (std::size_t v = 0; v < rest.vertices.size(); ++v) {
      const Vec3d& p = rest.vertices[v];
      const double angle = 0.05 * frame * p.z;
      moved.vertices[v] = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y,
                           p.z * (1 - 0.009 * frame)};
    }
    const RigidTransform place = test::random_transform(random, 1.2);
    scene.update(soft, moved.vertices);
    scene.update(rigid, place);
    ProximityScene anew;
    anew.add(moved, {.self = true});
    anew.update(anew.add(body), place);
    ASSERT_EQ(rows(scene.separation().pairs), rows(anew.separation().pairs));
    ASSERT_EQ(rows(scene.closest_primitives().pairs), rows(anew.closest_primitives().pairs));
    ASSERT_EQ(rows(scene.closer_than(0.05).pairs), rows(anew.closer_than(0.05).pairs));
    ASSERT_EQ(rows(scene.collisions().pairs), rows(anew.collisions().pairs));
  }
}

TEST(ProximityScene, TakesAnotherMeshForAnObject) {
  SlowScene slow;
  for (std::uint64_t k = 0; k < 3; ++k) slow.objects.push_back({soup(40 + k, 15), {.self = true}, {}});
  Random random(41);
  slow.objects[1].place = test::random_transform(random, 0.5);
  ProximityScene scene;
  slow.add_to(scene);
  slow.objects[1].mesh = soup(45, 40);
  scene.update(ObjectId(1), slow.objects[1].mesh);
  expect_answers(scene, slow);
}

TEST(ProximityScene, LeavesOutRemovedObjects) {
  ProximityScene scene;
  const TriangleMesh ball = make_sphere({.frequency = 3});
  const ObjectId a = scene.add(ball);
  const ObjectId b = scene.add(ball);
  const ObjectId c = scene.add(ball);
  scene.remove(b);
  const ProximityPairs found = scene.separation();
  ASSERT_EQ(found.pairs.size(), 1U);
  EXPECT_EQ(found.pairs[0].first_object, a);
  EXPECT_EQ(found.pairs[0].second_object, c);
  EXPECT_EQ(scene.size(), 3U);
  EXPECT_THROW(static_cast<void>(scene.separation(a, b)), InvalidOption);
  EXPECT_THROW(scene.remove(b), InvalidOption);
}

/// Collisions of a mesh with itself match find_self_intersections(), except for primitives without area.
TEST(ProximityScene, SelfCollisionsMatchSelfIntersections) {
  std::vector<TriangleMesh> meshes{make_organic({.frequency = 8}), test::nasty_soup(50, 300)};
  for (Vec3d& p : meshes[0].vertices) p.z = std::abs(p.z - 0.2);  // folded, so that it passes through itself
  for (const TriangleMesh& mesh : meshes) {
    ProximityScene scene;
    scene.add(mesh, {.self = true});
    std::set<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (const TrianglePair& pair : find_self_intersections(mesh).pairs) {
      expected.emplace(pair.first.value, pair.second.value);
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    const auto has_no_area = [&](std::uint32_t t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3d n = cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
      return length(n) < 1e-14;
    };
    for (const PrimitivePair& pair : scene.collisions().pairs) {
      EXPECT_EQ(pair.between.distance, 0);
      if (expected.contains({pair.first, pair.second})) {
        found.emplace(pair.first, pair.second);
      } else {
        EXPECT_TRUE(has_no_area(pair.first) || has_no_area(pair.second)) << pair.first << " " << pair.second;
      }
    }
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(found, expected);
  }
}

TEST(ProximityScene, RefusesBadInput) {
  ProximityScene scene;
  const TriangleMesh ball = make_sphere({.frequency = 3});
  EXPECT_THROW(scene.add(TriangleMesh{}), InvalidMesh);
  TriangleMesh far = ball;
  far.vertices[0].x = 1e71;
  EXPECT_THROW(scene.add(far), InvalidMesh);
  EXPECT_EQ(scene.size(), 0U);
  const ObjectId id = scene.add(ball);
  EXPECT_THROW(scene.update(id, far.vertices), InvalidMesh);
  EXPECT_THROW(scene.update(id, std::vector<Vec3d>(3)), InvalidMesh);
  EXPECT_THROW(scene.update(ObjectId(1), ball), InvalidOption);
  EXPECT_THROW(scene.exclude(id, ObjectId(1)), InvalidOption);
  RigidTransform bent;
  bent.rotation.columns[1].y = 1.1;
  EXPECT_THROW(scene.update(id, bent), InvalidOption);
  bent.rotation.columns[1].y = -1;  // a reflection
  EXPECT_THROW(scene.update(id, bent), InvalidOption);
  bent.rotation.columns[1].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(scene.update(id, bent), InvalidOption);
  EXPECT_THROW(static_cast<void>(scene.closer_than(-1)), InvalidOption);
  EXPECT_THROW(static_cast<void>(scene.separation(std::numeric_limits<double>::quiet_NaN())), InvalidOption);
  const std::vector<Vec3d> few(3);
  EXPECT_THROW(static_cast<void>(scene.continuous(std::vector<ObjectMotion>{{id, few, {}}})), InvalidMesh);
  EXPECT_THROW(static_cast<void>(scene.continuous(std::vector<ObjectMotion>{{id, far.vertices, {}}})), InvalidMesh);
  EXPECT_THROW(static_cast<void>(scene.continuous(std::vector<ObjectMotion>{{id, {}, bent}})), InvalidOption);
  EXPECT_THROW(static_cast<void>(scene.continuous(std::vector<ObjectMotion>{{id, {}, {}}, {id, {}, {}}})),
               InvalidOption);
  EXPECT_THROW(static_cast<void>(scene.continuous(std::vector<ObjectMotion>{{ObjectId(7), {}, {}}})), InvalidOption);
  // Rejected calls changed nothing.
  EXPECT_EQ(scene.separation(id, scene.add(ball))->between.distance, 0);
}

TEST(ProximityScene, StopsWhenAsked) {
  ProximityScene scene;
  scene.add(make_organic({.frequency = 20}), {.self = true});
  std::stop_source source;
  source.request_stop();
  Context context;
  context.cancel = source.get_token();
  EXPECT_THROW(static_cast<void>(scene.separation(infinite, context)), Cancelled);
  EXPECT_THROW(static_cast<void>(scene.closest_primitives(infinite, context)), Cancelled);
  EXPECT_THROW(static_cast<void>(scene.closer_than(1, context)), Cancelled);
  EXPECT_THROW(static_cast<void>(scene.collisions(context)), Cancelled);
  EXPECT_THROW(scene.add(make_torus({}), {}, context), Cancelled);
  EXPECT_EQ(scene.size(), 1U);
}

TEST(PairQueries, CallTheMethodsOfTheirNames) {
  ProximityScene scene;
  TriangleMesh box = make_box({});
  for (const double x : {0.0, 0.75, 4.0}) {
    TriangleMesh moved = box;
    for (Vec3d& p : moved.vertices) p.x += x;
    scene.add(moved);
  }
  const PairQueryOptions options{.max_distance = 0.5, .penetration = {.depth_tolerance = 1e-3}};
  const std::map<std::string_view, ProximityPairs> expected{
      {"separation", scene.separation(0.5)},
      {"signed_separations", scene.signed_separations(options.penetration)},
      {"closest_primitives", scene.closest_primitives(0.5)},
      {"closer_than", scene.closer_than(0.5)},
      {"collisions", scene.collisions()}};
  for (const auto& [name, wanted] : expected) {
    SCOPED_TRACE(name);
    EXPECT_FALSE(wanted.pairs.empty());
    EXPECT_EQ(rows(ask_pairs(scene, name, options).pairs), rows(wanted.pairs));
  }
  EXPECT_THROW((void)ask_pairs(scene, "penetrations"), InvalidOption);
}

}  // namespace
}  // namespace blum
