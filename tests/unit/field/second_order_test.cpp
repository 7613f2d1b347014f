// Proves the promises of fields of order 2 against brute force over all sites. The tests cover soups, shared vertices,
// degenerate, doubled and touching shapes, strips, fans, several objects, bands and layers. The first order keeps its
// bytes. The promises hold for any number of threads and any instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/device_field.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "support/nasty_soup.hpp"
#include "support/second_check.hpp"

namespace blum {
namespace {

using test::all_nodes;
using test::compare_second;
using test::expect_promise;
using test::same_bytes;
using test::same_second_bytes;

constexpr SecondRule by_vertex = SecondRule::no_common_vertex;
constexpr SecondRule by_object = SecondRule::other_object;

Field second_field(const MeshView& mesh, const GridSpec& grid, SecondRule rule, int threads = 2,
                   std::optional<double> band = {}) {
  return distance_field(mesh, grid, {.sign = SignMode::none, .band = band, .order = 2, .second = rule},
                        {.threads = threads});
}

std::vector<std::size_t> some_nodes(const GridSpec& grid, std::size_t sites) {
  const std::size_t count = 6'000'000 / (sites + 1) + 200;
  return count < grid.node_count() ? test::random_nodes(grid, count) : all_nodes(grid);
}

/// Checks both rules on a grid around a mesh.
void expect_exact(const MeshView& mesh, int nodes = 24, double padding = 0.3) {
  const GridSpec grid = grid_around(bounds(mesh), nodes, padding);
  const std::vector<std::size_t> looked_at = some_nodes(grid, SiteTable(mesh).size());
  const Field first = distance_field(mesh, grid, {.sign = SignMode::none});
  const std::vector<std::uint32_t> parts = test::slow_parts(mesh);
  for (const SecondRule rule : {by_vertex, by_object}) {
    const Field field = second_field(mesh, grid, rule);
    SCOPED_TRACE(to_string(rule));
    EXPECT_TRUE(same_bytes(field, first));
    EXPECT_EQ(field.order(), 2);
    EXPECT_EQ(field.second, rule);
    expect_promise(compare_second(
        field, mesh, rule == by_object ? std::span<const std::uint32_t>(parts) : std::span<const std::uint32_t>(),
        looked_at));
  }
}

TriangleMesh soup(std::size_t triangles, std::uint64_t seed = 1) {
  SoupOptions options;
  options.triangles = triangles;
  options.seed = seed;
  return make_soup(options);
}

/// Returns triangles, segments and points between few vertices. Many triangles share an edge, and many primitives of
/// all kinds share a vertex.
TriangleMesh tangle(std::uint64_t seed, std::uint32_t vertices, std::size_t triangles, std::size_t segments) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    mesh.vertices.push_back({random.uniform(), random.uniform(), random.uniform()});
  }
  const auto any = [&] { return static_cast<std::uint32_t>(random.below(vertices)); };
  for (std::size_t t = 0; t < triangles; ++t) mesh.triangles.push_back({any(), any(), any()});
  for (std::size_t s = 0; s < segments; ++s) mesh.segments.push_back({any(), any()});
  mesh.points.push_back(any());
  return mesh;
}

/// Returns a strip of triangles over a row of points, bent to a hill or a valley. The edge that two triangles share is
/// the second site of nodes whose closest site lies beyond one of them.
TriangleMesh strip(double bend) {
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k < 12; ++k) {
    const double x = k * 0.1;
    mesh.vertices.push_back({x, k % 2 == 0 ? 0.0 : 0.15, bend * x * (1.1 - x)});
  }
  for (std::uint32_t k = 0; k + 2 < 12; ++k) mesh.triangles.push_back({k, k + 1, k + 2});
  return mesh;
}

TriangleMesh fan(std::uint32_t count, double height) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, height});
  for (std::uint32_t k = 0; k < count; ++k) {
    const double angle = 2 * M_PI * k / count;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % count});
  }
  return mesh;
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b, const Vec3d& move) {
  TriangleMesh mesh = a;
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  for (const Vec3d& v : b.vertices) mesh.vertices.push_back(v + move);
  for (const Triangle& t : b.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return mesh;
}

TriangleMesh sphere(int frequency = 6) {
  SphereOptions options;
  options.frequency = frequency;
  return make_sphere(options);
}

TEST(SecondOrder, IsExactOnSoups) {
  for (const std::size_t count : {1U, 2U, 5U, 40U, 400U}) expect_exact(soup(count, count));
  expect_exact(test::nasty_soup(1, 200));
}

TEST(SecondOrder, IsExactWhereVerticesAreShared) {
  expect_exact(sphere());
  expect_exact(sphere(14), 40);
  expect_exact(make_torus());
  expect_exact(make_box());
  for (std::uint64_t seed = 1; seed < 12; ++seed) {
    expect_exact(tangle(seed, static_cast<std::uint32_t>(4 + 2 * seed), 3 * seed, seed), 16);
  }
}

TEST(SecondOrder, FindsSharedEdgesOfAStripAsSecondSites) {
  for (const double bend : {-2.0, -0.3, 0.0, 0.3, 2.0}) expect_exact(strip(bend), 40);
}

TEST(SecondOrder, OfFansAndSolidsWithFewVertices) {
  for (const double height : {-0.5, 0.0, 0.2, 2.0}) {
    expect_exact(fan(3, height));
    expect_exact(fan(5, height));
    expect_exact(fan(200, height), 16);
  }
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  expect_exact(tetrahedron);
}

TEST(SecondOrder, OfDegenerateAndDoubledShapes) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, 0}, {0.5, 0.5, 1e-9}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 3}, {4, 4, 4}, {3, 4, 5}, {0, 3, 1}, {1, 3, 0}, {6, 6, 1}, {5, 1, 3}};
  mesh.segments = {{2, 4}, {4, 5}, {6, 6}};
  mesh.points = {2, 6};
  expect_exact(mesh);
  const TriangleMesh one = soup(30);
  expect_exact(joined(one, one, {}));                          // the same soup twice
  expect_exact(joined(make_box(), make_box(), {2, 0, 0}));     // coincident faces
  expect_exact(joined(make_box(), make_box(), {1e-7, 0, 0}));  // nearly coincident faces
  TriangleMesh flat = soup(60);
  for (Vec3d& v : flat.vertices) v.z = 0.25;
  expect_exact(flat);
}

TEST(SecondOrder, OfSegmentsAndPoints) {
  expect_exact(make_segments());
  expect_exact(make_points());
  TriangleMesh path;
  for (std::uint32_t k = 0; k < 9; ++k) path.vertices.push_back({0.1 * k, 0.02 * k * k, 0});
  for (std::uint32_t k = 0; k < 8; ++k) path.segments.push_back({k, k + 1});
  expect_exact(path);
  TriangleMesh point;
  point.vertices = {{1, 2, 3}, {9, 9, 9}};
  point.points = {0};
  const GridSpec grid = grid_in({{0, 1, 2}, {2, 3, 4}}, 9);
  expect_promise(compare_second(second_field(point, grid, by_vertex), point, {}, all_nodes(grid)));
}

TEST(SecondOrder, OfSeveralObjects) {
  const TriangleMesh two = joined(sphere(), sphere(4), {2.5, 0.3, 0});
  expect_exact(two, 40);
  expect_exact(joined(two, make_box(), {1, 2, 1}), 32);
  expect_exact(joined(sphere(), make_noisy(sphere(4), 0.02), {0.1, 0, 0}), 32);  // they cross
  // A single object has no second site.
  const GridSpec grid = grid_around(bounds(sphere()), 16, 0.2);
  const Field alone = second_field(sphere(), grid, by_object);
  for (std::size_t node = 0; node < grid.node_count(); ++node) {
    EXPECT_EQ(alone.distance2[node], HUGE_VALF);
    EXPECT_FALSE(alone.site2[node].has_value());
  }
}

TEST(SecondOrder, OfObjectsOfTheCallers) {
  const TriangleMesh mesh = sphere(10);
  const GridSpec grid = grid_around(bounds(mesh), 28, 0.3);
  for (const std::uint32_t count : {2U, 3U, 7U, 40U}) {
    std::vector<std::uint32_t> objects;
    for (const Vec3d& v : mesh.vertices) {
      const double turn = std::atan2(v.y, v.x) / (2 * M_PI) + 0.5;
      objects.push_back(static_cast<std::uint32_t>(turn * count) % count);
    }
    const Field field = distance_field(mesh, grid, objects, {.sign = SignMode::none, .order = 2, .second = by_object});
    expect_promise(compare_second(field, mesh, objects, some_nodes(grid, 4000)));
  }
}

TEST(SecondOrder, StopsAtTheBand) {
  const TriangleMesh mesh = joined(sphere(), make_box(), {1.2, 0.3, 0});
  const GridSpec grid = grid_around(bounds(mesh), 36, 0.3);
  const std::vector<std::uint32_t> parts = test::slow_parts(mesh);
  for (const double band : {0.02, 0.2, 0.9, 5.0}) {
    for (const SecondRule rule : {by_vertex, by_object}) {
      const Field field = second_field(mesh, grid, rule, 2, band);
      const Field first = distance_field(mesh, grid, {.sign = SignMode::none, .band = band});
      EXPECT_TRUE(same_bytes(field, first));
      std::span<const std::uint32_t> labels;
      if (rule == by_object) labels = parts;
      expect_promise(compare_second(field, mesh, labels, some_nodes(grid, 2000)));
    }
  }
}

TEST(SecondOrder, OfLayersAndGridsFarAway) {
  const TriangleMesh mesh = sphere(8);
  for (const Box3& box : {Box3{{-1, -1, 0.1}, {1, 1, 0.1}}, Box3{{-1.5, 0.2, 0.1}, {1.5, 0.2, 0.1}},
                          Box3{{10, -1, -1}, {12, 1, 1}}, Box3{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}}}) {
    const GridSpec grid = grid_in(box, 37);
    expect_promise(compare_second(second_field(mesh, grid, by_vertex), mesh, {}, some_nodes(grid, 3000)));
  }
}

TEST(SecondOrder, HasTheSameBytesForAnyNumberOfThreads) {
  const TriangleMesh mesh = joined(sphere(12), soup(300), {0.5, 0, 0});
  const GridSpec grid = grid_around(bounds(mesh), 70, 0.1);
  for (const SecondRule rule : {by_vertex, by_object}) {
    const Field one = second_field(mesh, grid, rule, 1);
    for (const int threads : {2, 7}) EXPECT_TRUE(same_second_bytes(one, second_field(mesh, grid, rule, threads)));
  }
}

TEST(SecondOrder, KeepsItsPromiseWithEveryInstructionSet) {
  const TriangleMesh mesh = joined(sphere(7), strip(0.4), {0.5, 0, 1});
  const GridSpec grid = grid_around(bounds(mesh), 24, 0.2);
  for (const std::string& target : cpu::simd_targets()) {
    SCOPED_TRACE(target);
    cpu::use_simd_target(target);
    expect_promise(compare_second(second_field(mesh, grid, by_vertex), mesh, {}, some_nodes(grid, 3000)));
    expect_promise(
        compare_second(second_field(mesh, grid, by_object), mesh, test::slow_parts(mesh), some_nodes(grid, 3000)));
  }
  cpu::use_simd_target("");
}

TEST(SecondOrder, WorksWithSignsTriangleIdsAndFieldsWithoutSites) {
  const TriangleMesh mesh = sphere(8);
  const GridSpec grid = grid_around(bounds(mesh), 24, 0.2);
  const Field field = distance_field(mesh, grid, {.order = 2});
  EXPECT_EQ(field.sign_rule, SignRule::normals);
  EXPECT_TRUE(same_bytes(field, distance_field(mesh, grid)));
  expect_promise(compare_second(field, mesh, {}, all_nodes(grid)));
  const Field bare = distance_field(mesh, grid, {.sites = false, .order = 2});
  EXPECT_TRUE(bare.site.empty() && bare.site2.empty());
  EXPECT_EQ(std::memcmp(bare.distance2.data(), field.distance2.data(), field.distance2.span().size_bytes()), 0);
  const Field triangles = distance_field(mesh, grid, {.site_ids = SiteIds::triangles, .order = 2});
  const SiteTable sites(mesh);
  for (std::size_t node = 0; node < grid.node_count(); ++node) {
    EXPECT_EQ(triangles.site2[node].value, sites.triangle(field.site2[node]).value);
  }
}

TEST(SecondOrder, FollowsTheFramesOfASolver) {
  TriangleMesh mesh = sphere(5);
  const GridSpec grid = grid_around(bounds(mesh), 20, 0.4);
  FieldSolver solver(grid, {.order = 2, .second = by_object});
  std::vector<std::uint32_t> objects(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < objects.size(); ++v) objects[v] = mesh.vertices[v].z > 0 ? 1 : 0;
  solver.set_objects(objects);
  for (int frame = 0; frame < 2; ++frame) {
    for (Vec3d& v : mesh.vertices) v = v * 0.9;
    expect_promise(compare_second(solver.compute(mesh), mesh, objects, all_nodes(grid)));
  }
  solver.set_objects({});
  EXPECT_EQ(solver.compute(mesh).distance2[0], HUGE_VALF);
}

TEST(SecondOrder, RejectsInvalidOptions) {
  const TriangleMesh mesh = sphere(3);
  const GridSpec grid = grid_around(bounds(mesh), 8, 0.2);
  EXPECT_THROW((void)distance_field(mesh, grid, {.order = 3}), InvalidOption);
  EXPECT_THROW((void)distance_field(mesh, grid, {.order = 0}), InvalidOption);
  EXPECT_THROW((void)distance_field(mesh, grid, {.order = 2}, {.device = Device::cuda()}), InvalidOption);
  const Field field = distance_field(mesh, grid, {.order = 2}, {.device = Device::automatic()});
  EXPECT_EQ(field.device, Device::cpu());
  EXPECT_FALSE(field.device_reason.empty());
  const std::vector<std::uint32_t> objects(mesh.vertices.size() - 1, 0);
  const FieldOptions of_objects{.order = 2, .second = by_object};
  EXPECT_THROW((void)distance_field(mesh, grid, objects, of_objects), InvalidOption);
  EXPECT_THROW((void)distance_field(mesh, grid, std::vector<std::uint32_t>(mesh.vertices.size(), 0), {.order = 2}),
               InvalidOption);
}

}  // namespace
}  // namespace blum
