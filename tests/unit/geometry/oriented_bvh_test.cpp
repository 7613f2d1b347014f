// Proves that the hierarchy of oriented boxes reports every pair of primitives within a limit. The tests compare it
// with exact distances of all pairs. The hierarchy may report further pairs.
#include "blum/geometry/oriented_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/shapes/generators.hpp"
#include "support/nasty_soup.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;
using Corners = std::array<Vec3d, 3>;

std::vector<Corners> primitives(const TriangleMesh& mesh, const RigidTransform& place = {}) {
  std::vector<Corners> out;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out.push_back({place(mesh.vertices[a]), place(mesh.vertices[b]), place(mesh.vertices[c])});
  };
  for (const auto& [a, b, c] : mesh.triangles) add(a, b, c);
  for (const auto& [a, b] : mesh.segments) add(a, b, b);
  for (const std::uint32_t v : mesh.points) add(v, v, v);
  return out;
}

TriangleMesh soup(std::uint64_t seed, std::size_t count) {
  TriangleMesh mesh = test::nasty_soup(seed, count);
  mesh.segments = {{0, 1}, {2, 2}};
  mesh.points = {1};
  return mesh;
}

/// Checks that each pair within the limit was reported, and that no lower bound exceeds the distance.
void expect_seen(const std::map<Pair, double>& seen, const std::vector<Corners>& here,
                 const std::vector<Corners>& there, double limit, bool is_self) {
  for (std::uint32_t i = 0; i < here.size(); ++i) {
    for (std::uint32_t j = is_self ? i + 1 : 0; j < there.size(); ++j) {
      const double distance = triangle_distance(here[i], there[j]).distance;
      auto found = seen.find({i, j});
      if (is_self && found == seen.end()) found = seen.find({j, i});
      if (distance <= limit) {
        ASSERT_NE(found, seen.end()) << i << " " << j << " " << distance;
      }
      if (found != seen.end()) {
        ASSERT_LE(found->second, distance + 1e-12);
      }
    }
  }
}

TEST(OrientedBvh, ReportsAllClosePairs) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const TriangleMesh a = soup(seed, 20 * seed);
    const TriangleMesh b = seed % 2 == 0 ? make_organic({.frequency = 4}) : soup(seed + 100, 70);
    const RigidTransform place = seed == 1 ? RigidTransform{} : test::random_transform(random, 1.5);
    const OrientedBvh here(a);
    const OrientedBvh there(b);
    for (const double limit : {0.0, 0.05, 0.4}) {
      std::map<Pair, double> at_once;
      std::map<Pair, double> by_block;
      const auto see = [&](std::map<Pair, double>& into) {
        return [&into, limit](std::uint32_t i, std::uint32_t j, double at_least) {
          EXPECT_TRUE(into.emplace(Pair(i, j), at_least).second);
          return limit;
        };
      };
      here.for_each_near_pair(there, place, limit, see(at_once));
      for (std::size_t block = 0; block < here.block_count(); ++block) {
        here.for_each_near_pair(block, there, place, limit, see(by_block));
      }
      expect_seen(at_once, primitives(a), primitives(b, place), limit, false);
      expect_seen(by_block, primitives(a), primitives(b, place), limit, false);
    }
  }
}

TEST(OrientedBvh, ReportsEachSelfPairOnce) {
  for (const std::size_t count : {1U, 7U, 8U, 9U, 64U, 65U, 150U}) {
    const TriangleMesh mesh = soup(count, count);
    const OrientedBvh bvh(mesh);
    EXPECT_EQ(bvh.size(), mesh.triangles.size() + 3);
    std::map<Pair, double> seen;
    for (std::size_t block = 0; block < bvh.block_count(); ++block) {
      bvh.for_each_near_self_pair(block, 0.1, [&](std::uint32_t i, std::uint32_t j, double at_least) {
        EXPECT_NE(i, j);
        EXPECT_TRUE(seen.emplace(Pair(std::min(i, j), std::max(i, j)), at_least).second);
        return 0.1;
      });
    }
    expect_seen(seen, primitives(mesh), primitives(mesh), 0.1, true);
  }
}

TEST(OrientedBvh, StopsWhenTheLimitIsLowered) {
  const TriangleMesh mesh = make_organic({.frequency = 8});
  const OrientedBvh bvh(mesh);
  std::size_t seen = 0;
  bvh.for_each_near_pair(bvh, {}, std::numeric_limits<double>::infinity(), [&](std::uint32_t, std::uint32_t, double) {
    ++seen;
    return -1.0;
  });
  EXPECT_EQ(seen, 1U);
}

/// Boxes lie along a rotated flat surface. No pair of two plates that face each other is reported.
TEST(OrientedBvh, SeparatesSurfacesThatFaceEachOther) {
  TriangleMesh plate = make_plate({});
  Random random(3);
  const RigidTransform turn = test::random_transform(random, 0);
  TriangleMesh other = plate;
  for (Vec3d& p : plate.vertices) p = turn(p);
  for (Vec3d& p : other.vertices) p = turn(p + Vec3d{0, 0, 3});
  const OrientedBvh a(plate);
  const OrientedBvh b(other);
  const double gap = bounds(plate).size().x * 1e-3;
  std::size_t seen = 0;
  a.for_each_near_pair(b, {}, gap, [&](std::uint32_t, std::uint32_t, double) {
    ++seen;
    return gap;
  });
  EXPECT_EQ(seen, 0U);
}

TEST(OrientedBvh, ReportsAllClosePairsAfterARefit) {
  TriangleMesh mesh = soup(9, 120);
  OrientedBvh bvh(mesh);
  Random random(10);
  for (Vec3d& p : mesh.vertices) p = p * 2.0 + random.in_ball() * 0.3;
  bvh.refit(mesh.vertices);
  std::map<Pair, double> seen;
  bvh.for_each_near_pair(bvh, {}, 0.2, [&](std::uint32_t i, std::uint32_t j, double at_least) {
    seen.emplace(Pair(i, j), at_least);
    return 0.2;
  });
  expect_seen(seen, primitives(mesh), primitives(mesh), 0.2, false);
  EXPECT_THROW(bvh.refit(std::vector<Vec3d>(3)), InvalidMesh);
  const Box3 box = bounds(mesh);
  EXPECT_EQ(bvh.bounds().lower, box.lower);
  EXPECT_EQ(bvh.bounds().upper, box.upper);
}

}  // namespace
}  // namespace blum
