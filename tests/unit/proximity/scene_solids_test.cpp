// A query of all pairs of solids of a scene returns the same bytes as queries pair by pair.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

void expect_same(const Penetration& one, const Penetration& other) {
  EXPECT_EQ(one.first_object, other.first_object);
  EXPECT_EQ(one.second_object, other.second_object);
  EXPECT_EQ(one.depth, other.depth);
  EXPECT_EQ(one.depth_bound, other.depth_bound);
  EXPECT_EQ(one.direction, other.direction);
  EXPECT_EQ(one.deep_point, other.deep_point);
  EXPECT_EQ(one.surface_point, other.surface_point);
  EXPECT_EQ(one.is_first_deep, other.is_first_deep);
  EXPECT_EQ(one.deep_triangle, other.deep_triangle);
  EXPECT_EQ(one.surface_triangle, other.surface_triangle);
  EXPECT_EQ(one.area, other.area);
  EXPECT_EQ(one.volume, other.volume);
  EXPECT_EQ(one.curves, other.curves);
}

void expect_same(const PrimitivePair& one, const PrimitivePair& other) {
  EXPECT_EQ(one.first_object, other.first_object);
  EXPECT_EQ(one.second_object, other.second_object);
  EXPECT_EQ(one.first, other.first);
  EXPECT_EQ(one.second, other.second);
  EXPECT_EQ(one.between.distance, other.between.distance);
  EXPECT_EQ(one.between.first_point, other.between.first_point);
  EXPECT_EQ(one.between.second_point, other.between.second_point);
}

using ObjectPairs = std::vector<std::pair<ObjectId, ObjectId>>;

/// @param pairs  the compared pairs, in order. @return the number of pairs that overlap.
std::size_t expect_pair_by_pair(const ProximityScene& scene, const ObjectPairs& pairs,
                                const PenetrationOptions& options, const Context& context = {}) {
  std::vector<Penetration> parts;
  std::vector<PrimitivePair> closest;
  std::size_t overlapping = 0;
  for (const auto& [a, b] : pairs) {
    const Penetrations found = scene.penetration(a, b, options);
    EXPECT_EQ(found.object_pairs, 1U);
    parts.insert(parts.end(), found.parts.begin(), found.parts.end());
    const auto apart = scene.separation(a, b);
    if (!apart) continue;
    closest.push_back(found.parts.empty() ? *apart : deepest_pair(found.parts.front()));
    EXPECT_EQ(closest.back().between.distance, scene.signed_separation(a, b, options));
    if (!found.parts.empty()) ++overlapping;
  }
  const Penetrations all = scene.penetrations(options, context);
  EXPECT_EQ(all.object_pairs, pairs.size());
  EXPECT_EQ(all.parts.size(), parts.size());
  for (std::size_t k = 0; k < std::min(parts.size(), all.parts.size()); ++k) expect_same(all.parts[k], parts[k]);
  const ProximityPairs separations = scene.signed_separations(options, context);
  EXPECT_EQ(separations.pairs.size(), closest.size());
  for (std::size_t k = 0; k < std::min(closest.size(), separations.pairs.size()); ++k) {
    expect_same(separations.pairs[k], closest[k]);
  }
  return overlapping;
}

std::vector<TriangleMesh> solids() {
  TriangleMesh twice = make_box({});
  TriangleMesh beside = make_box({});
  for (Vec3d& p : beside.vertices) p += Vec3d{0.4, 0.2, 0.3};
  append(twice, beside);
  return {make_sphere({.frequency = 2}), make_box({.size = {2, 0.5, 0.25}}), make_box({.segments = {2, 3, 1}}), twice,
          make_cylinder({.sides = 5})};
}

TEST(SceneOfSolids, AllPairsMatchSinglePairs) {
  Random random(11);
  const std::vector<TriangleMesh> meshes = solids();
  std::size_t overlapping = 0;
  std::size_t apart = 0;
  for (const double far : {0.3, 1.0, 3.0}) {
    for (const int trial : {0, 1}) {
      ProximityScene scene({.culling = trial == 0 ? Culling::bvh : Culling::voronoi});
      ObjectPairs pairs;
      for (std::uint32_t k = 0; k < meshes.size(); ++k) {
        scene.update(scene.add(meshes[k], {.self = k == 3}), test::random_transform(random, far));
        for (std::uint32_t other = 0; other < k; ++other) pairs.emplace_back(other, k);
        if (k == 3) pairs.emplace_back(k, k);
      }
      std::sort(pairs.begin(), pairs.end());
      const std::size_t now = expect_pair_by_pair(scene, pairs, {.depth_tolerance = 0.5}, {.threads = 1 + 6 * trial});
      overlapping += now;
      apart += pairs.size() - now;
    }
  }
  EXPECT_GT(overlapping, 12U);
  EXPECT_GT(apart, 12U);
}

TEST(SceneOfSolids, ComparesOnlyRequestedPairs) {
  ProximityScene scene;
  EXPECT_EQ(expect_pair_by_pair(scene, {}, {}), 0U);
  const TriangleMesh box = make_box({});
  const auto add = [&](double x, const ObjectOptions& options) {
    const ObjectId added = scene.add(box, options);
    scene.update(added, RigidTransform{{}, {x, 0.1 * x, 0.2 * x}});
    return added;
  };
  const ObjectId a = add(0, {.layers = 1, .meets = 2});
  const ObjectId b = add(0.1, {.layers = 1, .meets = 2});  // b does not meet a, nor a b
  const ObjectId c = add(0.2, {.layers = 2, .meets = 3});
  const ObjectId d = add(0.3, {.layers = 3, .meets = 3});
  EXPECT_EQ(expect_pair_by_pair(scene, {{a, c}, {a, d}, {b, c}, {b, d}, {c, d}}, {}), 5U);
  scene.exclude(d, a);
  scene.remove(c);
  EXPECT_EQ(expect_pair_by_pair(scene, {{b, d}}, {}), 1U);
}

TEST(SceneOfSolids, TreatsOpenMeshesAsQueriesOfOnePairDo) {
  const TriangleMesh box = make_box({});
  TriangleMesh open = box;
  open.triangles.pop_back();
  ProximityScene scene;
  const ObjectId first = scene.add(box);
  const ObjectId second = scene.add(open, {.name = "cup"});
  scene.update(second, RigidTransform{{}, {3, 0, 0}});
  EXPECT_THROW(static_cast<void>(scene.penetration(first, second)), InvalidMesh);
  EXPECT_THROW(static_cast<void>(scene.penetrations()), InvalidMesh);
  const ProximityPairs apart = scene.signed_separations();
  ASSERT_EQ(apart.pairs.size(), 1U);
  EXPECT_EQ(apart.pairs[0].between.distance, 2);
  EXPECT_EQ(scene.signed_separation(first, second), 2);
  scene.update(second, RigidTransform{{}, {0.5, 0, 0}});
  EXPECT_THROW(static_cast<void>(scene.signed_separations()), InvalidMesh);
  for (const double tolerance : {0.0, 2.0}) {
    EXPECT_THROW(static_cast<void>(scene.penetrations({.depth_tolerance = tolerance})), InvalidOption);
    EXPECT_THROW(static_cast<void>(scene.signed_separations({.depth_tolerance = tolerance})), InvalidOption);
  }
  EXPECT_THROW(static_cast<void>(scene.penetrations({}, {.threads = -1})), InvalidOption);
}

TEST(SceneOfSolids, ShowsProgressAndStops) {
  ProximityScene scene;
  for (const TriangleMesh& mesh : solids()) scene.add(mesh);
  std::vector<double> told;
  Context context;
  context.progress = [&](double fraction, std::string_view phase) {
    if (phase == "penetration") told.push_back(fraction);
  };
  static_cast<void>(scene.penetrations({}, context));
  ASSERT_EQ(told.size(), 10U);
  for (std::size_t k = 0; k < told.size(); ++k) EXPECT_DOUBLE_EQ(told[k], static_cast<double>(k + 1) / 10);
  std::stop_source stop;
  context.cancel = stop.get_token();
  std::size_t pairs = 0;
  context.progress = [&](double /*fraction*/, std::string_view phase) {
    if (phase == "penetration" && ++pairs == 3) stop.request_stop();
  };
  EXPECT_THROW(static_cast<void>(scene.penetrations({}, context)), Cancelled);
  EXPECT_EQ(pairs, 3U);
  EXPECT_THROW(static_cast<void>(scene.signed_separations({}, context)), Cancelled);
}

}  // namespace
}  // namespace blum
