// Proves that many queries together get the results that each gets alone, bit for bit: points, distances, signs, sites
// and triangles. The queries have any layout. The tests use every generated shape, soups made to break float32, and
// real meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "support/data.hpp"
#include "support/mesh_places.hpp"
#include "support/nasty_soup.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

/// Returns the corners of a mesh's primitives, which excludes unused vertices.
std::vector<std::array<Vec3d, 3>> primitives(const MeshView& mesh) {
  std::vector<std::array<Vec3d, 3>> out;
  const auto& v = mesh.vertices;
  for (const Triangle& t : mesh.triangles) out.push_back({v[t[0]], v[t[1]], v[t[2]]});
  for (const Segment& s : mesh.segments) out.push_back({v[s[0]], v[s[1]], v[s[1]]});
  for (const std::uint32_t p : mesh.points) out.push_back({v[p], v[p], v[p]});
  return out;
}

/// Returns queries in every layout: all over the box, near and on the surface (corners, edges, faces), and far away.
/// Others lie in a tiny ball, on a line, or all in one place.
std::vector<Vec3d> queries_about(const MeshView& mesh, std::size_t of_each, std::uint64_t seed) {
  Random random(seed);
  const auto all = primitives(mesh);
  Box3 box;
  for (const auto& corners : all) {
    for (const Vec3d& p : corners) box.extend(p);
  }
  const double size = box.diagonal() > 0 ? box.diagonal() : 1.0;
  const auto on_surface = [&] {
    const auto& [a, b, c] = all[random.below(all.size())];
    const double s = random.uniform();
    const double t = random.uniform() * (1 - s);
    return a + (b - a) * s + (c - a) * t;
  };
  std::vector<Vec3d> out;
  const Vec3d somewhere = on_surface();
  for (std::size_t k = 0; k < of_each; ++k) {
    const auto& [a, b, c] = all[random.below(all.size())];
    const Vec3d from_lower{random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1)};
    Vec3d in_box;
    for (std::size_t axis = 0; axis < 3; ++axis) in_box[axis] = box.lower[axis] + box.size()[axis] * from_lower[axis];
    const double exponent = random.uniform(-12.0, -1.0);
    out.insert(out.end(), {in_box, in_box, on_surface() + random.in_ball() * (0.01 * size),
                           on_surface() + random.in_ball() * (std::pow(10.0, exponent) * size), on_surface(), a,
                           (a + b) * 0.5, (a + b + c) * (1.0 / 3), somewhere + random.in_ball() * (1e-6 * size),
                           box.lower + box.size() * random.uniform(-0.3, 1.3), box.center(),
                           box.center() + random.in_ball() * (10 * size), random.in_ball() * (1e6 * size)});
  }
  return out;
}

bool is_same(const ClosestPoint& a, const ClosestPoint& b) {
  const bool is_far = std::isinf(a.distance) && std::isinf(b.distance);
  return (is_far || a.distance == b.distance) && a.site == b.site && a.triangle == b.triangle && a.point == b.point;
}

/// Returns a number of queries that is large enough to process them together.
std::size_t count_for(const MeshView& mesh) {
  return std::max<std::size_t>(mesh.triangles.size(), 4096) / 13 + 50;
}

void expect_as_alone(const MeshView& mesh, const ClosestPointOptions& options, std::uint64_t seed) {
  const std::vector<Vec3d> queries = queries_about(mesh, count_for(mesh), seed);
  const ClosestPointQuery query(mesh, options);
  const std::vector<ClosestPoint> found = query.nearest(queries);
  std::size_t differ = 0;
  for (std::size_t k = 0; k < queries.size(); ++k) {
    const ClosestPoint alone = query.nearest(queries[k]);
    if (is_same(found[k], alone)) continue;
    if (++differ > 3) continue;
    ADD_FAILURE() << "query " << k << ": site " << found[k].site.value << " at " << found[k].distance << ", alone "
                  << alone.site.value << " at " << alone.distance << ", off by " << found[k].distance - alone.distance;
  }
  EXPECT_EQ(differ, 0U) << "of " << queries.size();
}

constexpr ClosestPointOptions is_unsigned{.sign = SignMode::none};

class PointSearchOfShapes : public testing::TestWithParam<std::string> {};

TEST_P(PointSearchOfShapes, MatchesSingleQueries) {
  const TriangleMesh mesh = make_shape(GetParam());
  expect_as_alone(mesh, is_unsigned, 1);
  expect_as_alone(mesh, {.sign = SignMode::none, .max_distance = 0.05 * bounds(mesh).diagonal()}, 2);
}

INSTANTIATE_TEST_SUITE_P(Shapes, PointSearchOfShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& info) { return test::test_name(info.param); });

TEST(PointSearch, SignsMatchSingleQueries) {
  expect_as_alone(make_sphere({.frequency = 12}), {}, 3);
  expect_as_alone(make_organic({.frequency = 12, .holes = 2}), {}, 4);
  TriangleMesh open = make_sphere({.frequency = 12});
  for (std::size_t k = 0; k < 5; ++k) std::swap(open.triangles[37 * k], open.triangles[open.triangles.size() - 1 - k]);
  open.triangles.resize(open.triangles.size() - 5);
  expect_as_alone(open, {}, 20);
  expect_as_alone(test::moved(open, 1e-30), {.max_distance = 1e-31}, 21);
  append(open, test::moved(make_sphere({.frequency = 9}), 0.7, {0.5, 0.2, 0.1}));
  expect_as_alone(open, {}, 22);
  expect_as_alone(test::nasty_soup(1, 600), {.sign = SignMode::winding}, 23);
}

TEST(PointSearch, MatchesSingleQueriesInSoups) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const std::size_t triangles = std::size_t{40} << seed;
    expect_as_alone(test::nasty_soup(seed, triangles), is_unsigned, seed);
    expect_as_alone(test::awkward_soup(triangles, seed), is_unsigned, seed);
  }
  expect_as_alone(test::unwelded(make_sphere({.frequency = 10})), is_unsigned, 7);
}

/// Fans of many triangles around a vertex are flat, concave or almost flat. Their domains are empty, or thinner than
/// rounding.
TEST(PointSearch, MatchesSingleQueriesAroundFans) {
  for (const double height : {0.0, 1e-9, -1e-9, 1e-6, -1e-5, 1e-3, -1e-2, 0.5, -2.0}) {
    SCOPED_TRACE(height);
    TriangleMesh fan;
    constexpr std::uint32_t blades = 60;
    fan.vertices.emplace_back(0, 0, height);
    for (std::uint32_t k = 0; k < blades; ++k) {
      const double angle = 6.283185307179586 * k / blades;
      fan.vertices.emplace_back(std::cos(angle), std::sin(angle), k % 3 == 0 ? 0.5 * height : 0.0);
      fan.triangles.push_back({0, k + 1, (k + 1) % blades + 1});
    }
    expect_as_alone(fan, is_unsigned, 8);
    // More than two triangles share an edge.
    for (std::uint32_t k = 0; k < 8; ++k) {
      fan.vertices.emplace_back(0.1 * k, 0.3, 1 + height * k);
      fan.triangles.push_back({0, k + 1, static_cast<std::uint32_t>(fan.vertices.size() - 1)});
    }
    expect_as_alone(fan, is_unsigned, 9);
  }
}

/// In two plates of coplanar squares, in doubled plates and in a box, almost all sites tie with others somewhere.
TEST(PointSearch, MatchesSingleQueriesWhereSitesTie) {
  TriangleMesh plates;
  for (const double z : {0.0, 0.25}) {
    const auto first = static_cast<std::uint32_t>(plates.vertices.size());
    for (std::uint32_t y = 0; y <= 20; ++y) {
      for (std::uint32_t x = 0; x <= 20; ++x) plates.vertices.emplace_back(0.125 * x, 0.125 * y, z);
    }
    for (std::uint32_t y = 0; y < 20; ++y) {
      for (std::uint32_t x = 0; x < 20; ++x) {
        const std::uint32_t v = first + y * 21 + x;
        plates.triangles.push_back({v, v + 1, v + 21});
        plates.triangles.push_back({v + 1, v + 22, v + 21});
      }
    }
  }
  expect_as_alone(plates, is_unsigned, 10);
  TriangleMesh twice = plates;
  append(twice, plates);
  expect_as_alone(twice, is_unsigned, 11);
  const TriangleMesh box = make_box({});
  expect_as_alone(box, is_unsigned, 12);
}

TEST(PointSearch, MatchesSingleQueriesAtAnySizeAndPlace) {
  const TriangleMesh mesh = make_organic({.frequency = 8});
  for (const double scale : {1e-35, 1e-30, 1e-10, 1e-3, 1e10, 1e30, 3e36, 1e60}) {
    SCOPED_TRACE(scale);
    expect_as_alone(test::moved(mesh, scale), is_unsigned, 13);
  }
  expect_as_alone(test::moved(mesh, 1, {1e6, -1e7, 1e5}), is_unsigned, 14);
  expect_as_alone(test::moved(mesh, 1e-3, {1e3, 0, -1e6}), is_unsigned, 15);
  TriangleMesh point;
  point.vertices = {{1, 2, 3}};
  point.points = {0};
  expect_as_alone(point, is_unsigned, 16);
}

/// Two distant points concentrate the mesh in few of the smallest cells that points are sorted into. Each such cell has
/// more points than one cell of the kernel takes, and much of the mesh.
TEST(PointSearch, MatchesSingleQueriesInACrowd) {
  for (const double far : {300.0, 800.0, 3000.0}) {
    SCOPED_TRACE(far);
    TriangleMesh mesh = make_organic({.frequency = 8, .holes = 2});
    for (const Vec3d& p : {Vec3d{far, far, far}, Vec3d{-far, -far, -far}}) {
      mesh.points.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(p);
    }
    Random random(19);
    std::vector<Vec3d> queries = {{far, far, far}, {-far, -far, -far}};
    for (std::size_t k = 0; k < 40000; ++k) queries.push_back(random.in_ball());
    const ClosestPointQuery query(mesh, is_unsigned);
    const std::vector<ClosestPoint> found = query.nearest(queries);
    for (std::size_t k = 0; k < queries.size(); ++k) ASSERT_TRUE(is_same(found[k], query.nearest(queries[k]))) << k;
  }
}

/// Queries are first sorted into 64, 512 or 4,096 buckets, by their number. A bucket with many of them is sorted again.
/// Results must not depend on this, nor on the place of a query in the list.
TEST(PointSearch, MatchesSingleQueriesForAnyBuckets) {
  const TriangleMesh mesh = make_organic({.frequency = 8, .holes = 2});
  const ClosestPointQuery query(mesh, is_unsigned);
  for (const std::size_t count : {5000U, 20000U, 70000U}) {
    for (const std::size_t spread : {1U, 2U, 200U}) {
      SCOPED_TRACE(testing::Message() << count << " queries, one of " << spread << " anywhere");
      Random random(23);
      std::vector<Vec3d> queries;
      for (std::size_t k = 0; k < count; ++k) {
        const Vec3d near = mesh.vertices[0] + random.in_ball() * 0.01;
        queries.push_back(k % spread == 0 ? random.in_ball() * 1.5 : near);
      }
      const std::vector<ClosestPoint> found = query.nearest(queries, {.threads = 1});
      const std::vector<ClosestPoint> of_three = query.nearest(queries, {.threads = 3});
      for (std::size_t k = 0; k < count; ++k) {
        ASSERT_TRUE(is_same(found[k], of_three[k])) << k;
        const bool is_checked = k % 7 == 0;
        ASSERT_TRUE(!is_checked || is_same(found[k], query.nearest(queries[k]))) << k;
      }
    }
  }
}

/// These points are so close to an open sheet that rounding may decide the side. All queries must give the same answer.
TEST(PointSearch, SignsNextToASheetMatchSingleQueries) {
  const TriangleMesh sheet = test::flat_sheet(18);
  for (const double height : {1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3}) {
    SCOPED_TRACE(height);
    std::vector<Vec3d> queries;
    for (int i = 0; i < 80; ++i) {
      for (int k = 0; k < 257; ++k) queries.push_back({(i + 0.5) / 80, (i + 0.5) / 80, height * (k - 128) / 128});
    }
    const ClosestPointQuery query(sheet, {.sign = SignMode::winding});
    for (const int threads : {1, 2, 7}) {
      const std::vector<ClosestPoint> found = query.nearest(queries, {.threads = threads});
      std::size_t differ = 0;
      for (std::size_t k = 0; k < queries.size(); k += 3) {
        differ += found[k].distance == query.nearest(queries[k]).distance ? 0U : 1U;
      }
      EXPECT_EQ(differ, 0U);
    }
  }
}

TEST(PointSearch, IsTheSameForAnyThreadsAndInstructions) {
  const TriangleMesh mesh = make_organic({.frequency = 12, .holes = 2});
  const std::vector<Vec3d> queries = queries_about(mesh, 2000, 17);
  const ClosestPointQuery query(mesh, is_unsigned);
  const std::vector<ClosestPoint> expected = query.nearest(queries, {.threads = 1});
  const auto expect_same = [&](const std::vector<ClosestPoint>& found) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) ASSERT_TRUE(is_same(found[k], expected[k])) << k;
  };
  for (const int threads : {2, 7}) expect_same(query.nearest(queries, {.threads = threads}));
  for (const std::string& target : cpu::simd_targets()) {
    SCOPED_TRACE(target);
    cpu::use_simd_target(target);
    expect_same(query.nearest(queries));
  }
  cpu::use_simd_target("");
}

TEST(SlowPointSearch, MatchesSingleQueriesOnRealMeshes) {
  for (const char* name : {"stanford-bunny.obj", "fandisk.obj", "multibody.stl", "7_8ths_cube.stl", "soup.stl",
                           "screwdriver.off", "plate_holes.STL"}) {
    SCOPED_TRACE(name);
    const auto file = test::data_file(std::string("meshes/") + name);
    if (!file) GTEST_SKIP() << test::no_data(name);
    expect_as_alone(read_mesh(*file), {}, 18);
  }
}

}  // namespace
}  // namespace blum
