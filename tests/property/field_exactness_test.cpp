// Proves the precision promise: distance, site and sign at every node of 64^3 grids, against double-precision brute
// force and the exact hierarchy, on every generated shape and on soups made to break float32.
#include <gtest/gtest.h>

#include <cmath>

#include "blum/core/random.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/generators.hpp"
#include "blum/geometry/shape_catalog.hpp"
#include "support/field_check.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

constexpr int resolution = 64;

GridSpec grid_for(const MeshView& mesh, int nodes = resolution) {
  return grid_around(bounds(mesh), nodes, 0.1);
}

TriangleMesh soup(std::size_t triangles) {
  SoupOptions options;
  options.triangles = triangles;
  return make_soup(options);
}

/// Every node by the hierarchy, some by brute force with winding numbers.
void expect_exact(const MeshView& mesh, const GridSpec& grid, SignMode sign, std::size_t brute_nodes = 300) {
  const Field field = distance_field(mesh, grid, {.sign = sign}, {.threads = 2});
  expect_promise(test::compare_with_bvh(field, mesh, test::all_nodes(grid)));
  expect_promise(test::compare_with_brute_force(field, mesh, test::random_nodes(grid, brute_nodes)));
}

class SlowCatalogFields : public testing::TestWithParam<std::string> {};

TEST_P(SlowCatalogFields, AreExactAtEveryNode) {
  const TriangleMesh mesh = make_shape(GetParam());
  const ShapeInfo& shape = find_shape(GetParam());
  const bool is_solid = shape.betti(complete_parameters(shape, {})).has_value();
  const std::size_t brute_nodes = 2'000'000 / (mesh.triangles.size() + mesh.segments.size() + mesh.points.size()) + 20;
  expect_exact(mesh, grid_for(mesh), is_solid ? SignMode::automatic : SignMode::none,
               std::min<std::size_t>(brute_nodes, 5000));
}

std::vector<std::string> catalog_names() {
  std::vector<std::string> names;
  for (const ShapeInfo& shape : shape_catalog()) names.push_back(shape.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Shapes, SlowCatalogFields, testing::ValuesIn(catalog_names()), [](const auto& info) {
  std::string name = info.param;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
});

TEST(SlowFieldExactness, BruteForceAtEveryNodeOfSmallShapes) {
  for (const TriangleMesh& mesh : {make_box({}), make_wedge({}), make_menger({.level = 1, .size = 1}), soup(100)}) {
    const GridSpec grid = grid_for(mesh);
    const Field field = distance_field(mesh, grid, {.sign = SignMode::automatic}, {.threads = 2});
    expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
  }
}

TEST(FieldExactness, NastySoups) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const TriangleMesh mesh = test::nasty_soup(seed, 40 * seed);
    expect_exact(mesh, grid_for(mesh), SignMode::none, 1000);
  }
}

TEST(FieldExactness, TriangulatedStripsOfSliversThatShareVertices) {
  // A fan of slivers around one vertex and a strip of caps: neighbouring domains meet at angles that float32 cannot
  // tell.
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (int k = 0; k <= 400; ++k) {
    const double angle = 1e-3 * k;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 1e-4 * std::sin(40 * angle)});
    if (k > 0) mesh.triangles.push_back({0, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k + 1)});
  }
  expect_exact(mesh, grid_for(mesh), SignMode::none, 500);
}

TEST(FieldExactness, FarOriginsAndExtremeScales) {
  const TriangleMesh base = soup(60);
  for (const double scale : {1e-12, 1e-3, 1e6, 1e15}) {
    for (const double offset : {0.0, 1e6}) {
      TriangleMesh mesh = base;
      for (Vec3d& v : mesh.vertices) v = (v + Vec3d{offset, -2 * offset, 0.5 * offset}) * scale;
      const GridSpec grid = grid_for(mesh, 32);
      SCOPED_TRACE(testing::Message() << "scale " << scale << " offset " << offset);
      expect_exact(mesh, grid, SignMode::none, 300);
    }
  }
}

TEST(FieldExactness, PointsSegmentsAndMixtures) {
  const TriangleMesh points = make_points();
  const TriangleMesh segments = make_segments();
  expect_exact(points, grid_for(points), SignMode::none, 500);
  expect_exact(segments, grid_for(segments), SignMode::none, 500);
  TriangleMesh mixed = soup(50);
  const auto first = static_cast<std::uint32_t>(mixed.vertices.size());
  mixed.vertices.insert(mixed.vertices.end(), segments.vertices.begin(), segments.vertices.end());
  for (const Segment& s : segments.segments) mixed.segments.push_back({s[0] + first, s[1] + first});
  mixed.vertices.push_back({2, 2, 2});
  mixed.points.push_back(static_cast<std::uint32_t>(mixed.vertices.size() - 1));
  expect_exact(mixed, grid_for(mixed), SignMode::none, 500);
}

TEST(FieldExactness, NodesOnSitesAndOnBordersOfDomains) {
  // A box aligned with the grid: nodes lie exactly on vertices, edges, faces, and on the planes between domains.
  const TriangleMesh mesh = make_box({.size = {1, 1, 1}, .segments = {4, 4, 4}});
  const Box3 box = bounds(mesh);
  const Vec3d margin{0.5, 0.5, 0.5};
  const GridSpec grid = grid_in({box.lower - margin, box.upper + margin}, 33);
  expect_exact(mesh, grid, SignMode::automatic, 500);
}

TEST(FieldExactness, AnisotropicSpacingDirectionAndOddSizes) {
  const TriangleMesh mesh = make_torus({});
  GridSpec grid = grid_for(mesh, 40);
  grid.spacing = {grid.spacing.x, grid.spacing.y * 0.7, grid.spacing.z * 2.3};
  grid.size = {37, 53, 19};
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  grid.direction.columns[0] = {c, s, 0};
  grid.direction.columns[1] = {-s, c, 0};
  expect_exact(mesh, grid, SignMode::automatic, 500);
}

TEST(FieldExactness, OneLayerIsA2DField) {
  const TriangleMesh mesh = soup(80);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Box3 box = bounds(mesh);
    box.lower[axis] = box.upper[axis] = box.center()[axis];
    const GridSpec grid = grid_in(box, 150);
    EXPECT_EQ(grid.size[axis], 1);
    expect_exact(mesh, grid, SignMode::none, 500);
  }
}

TEST(FieldExactness, FarGridsAndSingleNodes) {
  const TriangleMesh mesh = make_sphere({});
  for (const double distance : {3.0, 100.0, 1e4}) {
    GridSpec grid;
    grid.origin = {distance, 0.1, 0.2};
    grid.spacing = {0.01, 0.01, 0.01};
    grid.size = {9, 5, 7};
    expect_exact(mesh, grid, SignMode::automatic, 100);
    grid.size = {1, 1, 1};
    expect_exact(mesh, grid, SignMode::automatic, 1);
  }
}

TEST(FieldExactness, TiesGoToTheSmallerId) {
  // Two coincident points, and two parallel triangles with nodes half way between them.
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
  mesh.points = {2, 1, 0};
  GridSpec grid;
  grid.origin = {0.5, 0.5, 0.5};
  grid.size = {1, 1, 1};
  EXPECT_EQ(distance_field(mesh, grid).site[0], SiteId(0));
  grid.origin = {0.25, 0.25, 0.25};
  EXPECT_EQ(distance_field(mesh, grid).site[0], SiteId(1));
}

}  // namespace
}  // namespace blum
