// Collisions between moving objects of a scene match a test of all pairs of features.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

/// Kind; object and vertices of the first feature, and of the second; time.
using ImpactRow =
    std::tuple<int, std::uint32_t, std::vector<std::uint32_t>, std::uint32_t, std::vector<std::uint32_t>, double>;

std::vector<ImpactRow> impact_rows(const SceneCollisions& found) {
  std::vector<ImpactRow> out;
  for (const ObjectCollisions& pair : found.objects) {
    for (const auto& [v, f, time] : pair.vertex_face) {
      out.emplace_back(0, pair.first.value, std::vector{v}, pair.second.value, std::vector{f.value}, time);
    }
    for (const auto& [v, f, time] : pair.face_vertex) {
      out.emplace_back(0, pair.second.value, std::vector{v}, pair.first.value, std::vector{f.value}, time);
    }
    for (const auto& [a, b, time] : pair.edge_edge) {
      out.emplace_back(1, pair.first.value, std::vector{a[0], a[1]}, pair.second.value, std::vector{b[0], b[1]}, time);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// The edges of a mesh, each with the smaller vertex first.
std::set<Segment> edges_of(const TriangleMesh& mesh) {
  std::set<Segment> out;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) out.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  }
  return out;
}

/// A body at the start and at the end of a motion.
struct Frames {
  const TriangleMesh* mesh;
  std::vector<Vec3d> start, end;
};

std::vector<ImpactRow> slow_impacts(const std::vector<Frames>& bodies, const ImpactOptions& options) {
  std::vector<ImpactRow> out;
  for (std::uint32_t a = 0; a < bodies.size(); ++a) {
    for (std::uint32_t b = 0; b < bodies.size(); ++b) {
      if (a == b) continue;
      const auto& [mesh_a, start_a, end_a] = bodies[a];
      const auto& [mesh_b, start_b, end_b] = bodies[b];
      for (std::uint32_t v = 0; v < start_a.size(); ++v) {
        for (std::uint32_t f = 0; f < mesh_b->triangles.size(); ++f) {
          const auto& [i, j, k] = mesh_b->triangles[f];
          const auto time = vertex_face_impact(
              {{start_a[v], start_b[i], start_b[j], start_b[k]}, {end_a[v], end_b[i], end_b[j], end_b[k]}}, options);
          if (time) out.emplace_back(0, a, std::vector{v}, b, std::vector{f}, *time);
        }
      }
      if (b < a) continue;
      for (const auto& [i, j] : edges_of(*mesh_a)) {
        for (const auto& [k, l] : edges_of(*mesh_b)) {
          const auto time = edge_edge_impact(
              {{start_a[i], start_a[j], start_b[k], start_b[l]}, {end_a[i], end_a[j], end_b[k], end_b[l]}}, options);
          if (time) out.emplace_back(1, a, std::vector{i, j}, b, std::vector{k, l}, *time);
        }
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// One body deforms, one rotates and one rests. The resting body touches another one from the start.
TEST(SceneInMotion, MatchesAllPairsOfFeatures) {
  for (const double min_separation : {0.0, 0.05}) {
    const ImpactOptions options{.min_separation = min_separation};
    const TriangleMesh ball = make_sphere({.frequency = 2});
    const TriangleMesh block = make_box({.segments = {2, 2, 2}});
    Random random(60);
    ProximityScene scene;
    const ObjectId a = scene.add(ball);
    const ObjectId b = scene.add(block);
    const ObjectId c = scene.add(block);
    const RigidTransform from = test::random_transform(random, 1.5);
    const RigidTransform to = test::random_transform(random, 1.5);
    RigidTransform rest;
    rest.translation = {2, 0, 0};
    scene.update(b, from);
    scene.update(c, rest);
    std::vector<Vec3d> squeezed = ball.vertices;
    for (Vec3d& p : squeezed) p = {2.5 * p.x, 0.5 * p.y, p.z};
    const auto placed = [&](const RigidTransform& place) {
      std::vector<Vec3d> out = block.vertices;
      for (Vec3d& p : out) p = place(p);
      return out;
    };
    const std::vector<ObjectMotion> motions{{a, squeezed, {}}, {b, {}, to}};
    const SceneCollisions found = scene.continuous(motions, options);
    const std::vector<ImpactRow> expected = slow_impacts(
        {{&ball, ball.vertices, squeezed}, {&block, placed(from), placed(to)}, {&block, placed(rest), placed(rest)}},
        options);
    EXPECT_EQ(impact_rows(found), expected);
    ASSERT_FALSE(expected.empty());
    double earliest = 1;
    for (const ImpactRow& one : expected) earliest = std::min(earliest, std::get<5>(one));
    EXPECT_EQ(found.earliest(), earliest);
    // The query moved no object.
    EXPECT_EQ(impact_rows(scene.continuous(motions, options)), expected);
  }
}

TEST(SceneInMotion, MatchesASingleMeshForSelfCollisions) {
  const TriangleMesh mesh = make_organic({.frequency = 6});
  std::vector<Vec3d> end = mesh.vertices;
  for (Vec3d& p : end) p.z *= -0.5;
  const ContinuousCollisions alone = continuous_collisions(mesh, end);
  ProximityScene scene;
  const ObjectId self = scene.add(mesh, {.self = true});
  const SceneCollisions found = scene.continuous(std::vector<ObjectMotion>{{self, end, {}}});
  ASSERT_EQ(found.objects.size(), 1U);
  ASSERT_EQ(found.objects[0].vertex_face.size(), alone.vertex_face.size());
  ASSERT_EQ(found.objects[0].edge_edge.size(), alone.edge_edge.size());
  EXPECT_FALSE(alone.vertex_face.empty());
  EXPECT_TRUE(found.objects[0].face_vertex.empty());
  EXPECT_EQ(found.earliest(), alone.earliest());
  EXPECT_EQ(found.exact_tests, alone.exact_tests);
}

TEST(StartWarnings, CountThePairsWithTheTimeZero) {
  EXPECT_TRUE(start_warnings(0).empty());
  EXPECT_TRUE(start_warnings(ContinuousCollisions{}).empty());
  EXPECT_EQ(start_warnings(1).front().text, "1 pair meets already at the start of the motion, so its time is 0");
  ContinuousCollisions found;
  found.vertex_face = {{0, TriangleId(1), 0}, {0, TriangleId(2), 0.25}};
  found.edge_edge = {{{0, 1}, {2, 3}, 0}};
  ASSERT_EQ(start_warnings(found).size(), 1U);
  EXPECT_EQ(start_warnings(found).front().code, WarningCode::meet_at_start);
  EXPECT_TRUE(start_warnings(found).front().text.starts_with("2 pairs meet already"));
  SceneCollisions scene;
  scene.objects.push_back({ObjectId(0), ObjectId(1), found.vertex_face, found.vertex_face, found.edge_edge});
  EXPECT_TRUE(start_warnings(scene).front().text.starts_with("3 pairs meet already"));
}

}  // namespace
}  // namespace blum
