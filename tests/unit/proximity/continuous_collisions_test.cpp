// Collisions of moving meshes match a test of all pairs one by one, for any mesh and number of threads.
#include "blum/proximity/continuous_collisions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stop_token>
#include <thread>
#include <tuple>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

using VertexFace = std::tuple<std::uint32_t, std::uint32_t, double>;
using EdgeEdge = std::tuple<Segment, Segment, double>;

struct Collisions {
  std::vector<VertexFace> vertex_face;
  std::vector<EdgeEdge> edge_edge;
  friend bool operator==(const Collisions&, const Collisions&) = default;
};

Collisions as_rows(const ContinuousCollisions& found) {
  Collisions out;
  for (const auto& [vertex, face, time] : found.vertex_face) out.vertex_face.emplace_back(vertex, face.value, time);
  for (const auto& [first, second, time] : found.edge_edge) out.edge_edge.emplace_back(first, second, time);
  return out;
}

/// Tests all pairs one by one.
Collisions slow_collisions(const MeshView& mesh, std::span<const Vec3d> end, const ImpactOptions& options) {
  // Vertices that coincide at the start and at the end count as one.
  std::map<std::array<double, 6>, std::uint32_t> first_at;
  std::vector<std::uint32_t> place;
  for (std::uint32_t v = 0; v < end.size(); ++v) {
    const Vec3d& a = mesh.vertices[v];
    const Vec3d& b = end[v];
    place.push_back(
        first_at.try_emplace({a.x + 0.0, a.y + 0.0, a.z + 0.0, b.x + 0.0, b.y + 0.0, b.z + 0.0}, v).first->second);
  }
  std::set<std::uint32_t> vertices;
  for_each_named_vertex(mesh, [&](std::uint32_t v) { vertices.insert(place[v]); });
  std::set<Segment> edges;
  const auto add = [&](std::uint32_t a, std::uint32_t b) {
    if (place[a] != place[b]) edges.insert({std::min(place[a], place[b]), std::max(place[a], place[b])});
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) add(t[k], t[(k + 1) % 3]);
  }
  for (const Segment& s : mesh.segments) add(s[0], s[1]);
  const auto moving = [&](const std::array<std::uint32_t, 4>& four) {
    FourMovingPoints points;
    for (std::size_t k = 0; k < 4; ++k) {
      points.start[k] = mesh.vertices[four[k]];
      points.end[k] = end[four[k]];
    }
    return points;
  };
  Collisions out;
  for (const std::uint32_t v : vertices) {
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const auto& [a, b, c] = mesh.triangles[f];
      if (place[a] == v || place[b] == v || place[c] == v) continue;
      if (const auto time = vertex_face_impact(moving({v, a, b, c}), options))
        out.vertex_face.emplace_back(v, f, *time);
    }
  }
  for (auto first = edges.begin(); first != edges.end(); ++first) {
    for (auto second = std::next(first); second != edges.end(); ++second) {
      const auto& [a, b] = *first;
      const auto& [c, d] = *second;
      if (a == c || a == d || b == c || b == d) continue;
      if (const auto time = edge_edge_impact(moving({a, b, c, d}), options))
        out.edge_edge.emplace_back(*first, *second, *time);
    }
  }
  return out;
}

/// @return  the number of colliding pairs.
std::size_t expect_right(const TriangleMesh& mesh, const std::vector<Vec3d>& end, const ImpactOptions& options = {}) {
  const Collisions right = slow_collisions(mesh, end, options);
  for (const int threads : {1, 2, 7}) {
    const ContinuousCollisions found = continuous_collisions(mesh, end, options, {.threads = threads});
    EXPECT_TRUE(as_rows(found) == right) << threads << " threads: " << found.vertex_face.size() << " and "
                                         << found.edge_edge.size() << ", not " << right.vertex_face.size() << " and "
                                         << right.edge_edge.size();
    EXPECT_GE(found.box_pairs, found.exact_tests);
    EXPECT_GE(found.exact_tests, right.vertex_face.size() + right.edge_edge.size());
  }
  return right.vertex_face.size() + right.edge_edge.size();
}

TriangleMesh random_soup(Random& random, std::size_t triangles, double size) {
  TriangleMesh mesh;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const Vec3d at = random.in_cube();
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(at + random.in_ball() * size);
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

std::vector<Vec3d> moved(const TriangleMesh& mesh, const std::function<Vec3d(const Vec3d&)>& where) {
  std::vector<Vec3d> out;
  for (const Vec3d& p : mesh.vertices) out.push_back(where(p));
  return out;
}

TEST(ContinuousCollisions, MatchAllPairsForSoups) {
  Random random(1);
  for (const double speed : {0.0, 0.02, 0.5}) {
    const TriangleMesh soup = random_soup(random, 60, 0.2);
    const std::size_t found =
        expect_right(soup, moved(soup, [&](const Vec3d& p) { return p + random.in_ball() * speed; }));
    EXPECT_GE(found, speed == 0.5 ? 100U : 0U);
  }
}

/// Coordinates are whole numbers: features touch at corners and along edges, triangles coincide or have no area.
TEST(ContinuousCollisions, MatchAllPairsForDegenerateSoups) {
  Random random(2);
  const auto corner = [&] {
    const double x = static_cast<double>(random.below(4));
    const double y = static_cast<double>(random.below(4));
    return Vec3d{x, y, static_cast<double>(random.below(4))};
  };
  for (int n = 0; n < 4; ++n) {
    TriangleMesh soup = random_soup(random, 30, 1);
    for (Vec3d& p : soup.vertices) p = corner();
    EXPECT_GT(expect_right(soup, moved(soup, [&](const Vec3d& p) { return n % 2 == 0 ? corner() : p; })), 50U);
  }
}

TEST(ContinuousCollisions, MatchAllPairsWithASeparation) {
  Random random(3);
  const TriangleMesh soup = random_soup(random, 40, 0.15);
  const std::vector<Vec3d> end = moved(soup, [&](const Vec3d& p) { return p + random.in_ball() * 0.1; });
  std::size_t before = 0;
  for (const double distance : {0.0, 1e-3, 0.02, 0.1}) {
    const std::size_t found = expect_right(soup, end, {.min_separation = distance});
    EXPECT_GE(found, before);
    before = found;
  }
  EXPECT_GT(before, 200U);
}

TEST(ContinuousCollisions, MatchAllPairsForConnectedMeshes) {
  const TriangleMesh sphere = make_sphere({.frequency = 3});
  // The sphere turns inside out through its middle.
  EXPECT_GT(expect_right(sphere, moved(sphere, [](const Vec3d& p) { return Vec3d{p.x, p.y, -0.3 * p.z}; })), 100U);
  // The sphere grows: nothing meets.
  EXPECT_EQ(expect_right(sphere, moved(sphere, [](const Vec3d& p) { return p * 3.0; })), 0U);
  // The motion is rigid: only the boxes around motions meet.
  EXPECT_EQ(expect_right(sphere, moved(sphere, [](const Vec3d& p) { return p + Vec3d{5, 3, 1}; })), 0U);
}

TEST(ContinuousCollisions, AMeshNeedNotBeWelded) {
  const TriangleMesh box = make_box({.segments = {3, 3, 3}});
  TriangleMesh soup;
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(box.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const auto squashed = [](const Vec3d& p) { return Vec3d{p.x, p.y * 1.1, -p.z}; };
  EXPECT_EQ(expect_right(soup, moved(soup, [](const Vec3d& p) { return p * 2.0; })), 0U);
  EXPECT_EQ(expect_right(soup, moved(soup, squashed)), expect_right(box, moved(box, squashed)));
}

TEST(ContinuousCollisions, SegmentsAndPointsTakePart) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.25, 0.25, 1}, {-1, 0.5, 1}, {2, 0.5, 1}, {0.2, 0.2, 5}};
  mesh.triangles = {{0, 1, 2}};
  mesh.segments = {{4, 5}};
  mesh.points = {3};
  std::vector<Vec3d> end = mesh.vertices;
  for (std::size_t v = 3; v < 7; ++v) end[v].z = -1;  // no primitive contains the last vertex
  EXPECT_EQ(expect_right(mesh, end), 3U);
  const ContinuousCollisions found = continuous_collisions(mesh, end);
  ASSERT_EQ(found.vertex_face.size(), 1U);
  EXPECT_EQ(found.vertex_face[0].vertex, 3U);
  EXPECT_NEAR(*found.earliest(), 0.5, 1e-6);
}

/// Coordinates exceed the range of single precision.
TEST(ContinuousCollisions, PointsMayBeFarAway) {
  TriangleMesh mesh;
  mesh.triangles = {{0, 1, 2}};
  mesh.points = {3};
  for (const double size : {1e-50, 1.0}) {
    for (const double far : {1.0, 1e39, 1e150}) {
      mesh.vertices = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {far, far, far}};
      EXPECT_EQ(expect_right(mesh, mesh.vertices), 0U);
      std::vector<Vec3d> end = mesh.vertices;
      end[3] = {0, 0, 0};
      EXPECT_EQ(expect_right(mesh, end), 1U);
    }
  }
}

TEST(ContinuousCollisions, ReportOnlyVerticesOfPrimitives) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {1, 1, 1}};
  mesh.triangles = {{1, 2, 3}};
  mesh.points = {4, 5};
  std::vector<Vec3d> end = mesh.vertices;
  for (const std::size_t v : {0U, 4U, 5U}) end[v].z = -1;
  const ContinuousCollisions found = continuous_collisions(mesh, end);
  ASSERT_EQ(found.vertex_face.size(), 1U);
  EXPECT_EQ(found.vertex_face[0].vertex, 4U);
}

/// All of many pairs collide: the work is long, and little of it passes between two checks for cancellation.
TEST(ContinuousCollisions, CanBeCancelledWhereAllCollides) {
  constexpr std::uint32_t count = 3000;
  TriangleMesh mesh;
  std::vector<Vec3d> end;
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}) {
      mesh.vertices.push_back(p);
      end.push_back(p + Vec3d{0, 0, static_cast<double>(t + 1)});
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  std::stop_source stop;
  const Context context{.threads = 2, .cancel = stop.get_token()};
  const auto begin = std::chrono::steady_clock::now();
  std::thread asking([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request_stop();
  });
  EXPECT_THROW(static_cast<void>(continuous_collisions(mesh, end, {}, context)), Cancelled);
  asking.join();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5);
}

TEST(ContinuousCollisions, FindNothingForAMeshAtRest) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const ContinuousCollisions found = continuous_collisions(mesh, mesh.vertices);
  EXPECT_TRUE(found.vertex_face.empty() && found.edge_edge.empty());
  EXPECT_FALSE(found.earliest());
}

TEST(ContinuousCollisions, RejectInvalidMotions) {
  const TriangleMesh box = make_box();
  std::vector<Vec3d> end = box.vertices;
  EXPECT_THROW(static_cast<void>(continuous_collisions(box, std::span(end).first(3))), InvalidMesh);
  EXPECT_THROW(static_cast<void>(continuous_collisions(box, end, {.tolerance = -1})), InvalidOption);
  EXPECT_THROW(static_cast<void>(continuous_collisions(TriangleMesh{}, {})), InvalidMesh);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    end[2].y = bad;
    try {
      static_cast<void>(continuous_collisions(box, end));
      FAIL() << bad;
    } catch (const InvalidMesh& error) {
      EXPECT_EQ(std::string(error.what()).find("at the end: "), 0U) << error.what();
    }
  }
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(static_cast<void>(continuous_collisions(box, box.vertices, {}, {.cancel = stop.get_token()})),
               Cancelled);
}

}  // namespace
}  // namespace blum
