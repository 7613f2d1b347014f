// Proves the precision promise on every back end: distance, site and sign at every node. Results are compared with
// double-precision brute force and the exact hierarchy. The tests use every generated shape and soups made to break
// float32. Grids have 64^3 nodes, on the host 32^3, because kernels are slow there.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"
#include "support/nasty_soup.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

GridSpec grid_for(const MeshView& mesh, int nodes) {
  return grid_around(bounds(mesh), nodes, 0.1);
}

TriangleMesh soup(std::size_t triangles) {
  SoupOptions options;
  options.triangles = triangles;
  return make_soup(options);
}

/// Compares every node with the hierarchy, and some with brute force and winding numbers.
void expect_exact(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options, const Context& context,
                  std::size_t brute_nodes) {
  const Field field = distance_field(mesh, grid, options, context);
  EXPECT_EQ(field.device, context.device);
  expect_promise(test::compare_with_bvh(field, mesh, test::all_nodes(grid)));
  expect_promise(test::compare_with_brute_force(field, mesh, test::random_nodes(grid, brute_nodes)));
}

class CatalogFields : public test::NamedBackEndTest {};

TEST_P(CatalogFields, AreExactAtEveryNode) {
  const TriangleMesh mesh = make_shape(name());
  const ShapeInfo& shape = find_shape(name());
  const bool is_solid = shape.betti(complete_parameters(shape, {})).has_value();
  const std::size_t brute_nodes = 2'000'000 / (mesh.triangles.size() + mesh.segments.size() + mesh.points.size()) + 20;
  expect_exact(mesh, grid_for(mesh, usually(64, 32)), {.sign = is_solid ? SignMode::automatic : SignMode::none},
               context({.threads = 2}), std::min<std::size_t>(brute_nodes, usually<std::size_t>(5000, 500)));
}

INSTANTIATE_TEST_SUITE_P(SlowShapes, CatalogFields,
                         testing::Combine(testing::ValuesIn(test::catalog_names()),
                                          testing::Values(test::BackEnd::cpu, test::BackEnd::device)),
                         test::name_and_back_end);
// These grids are small enough for the sanitizers.
INSTANTIATE_TEST_SUITE_P(Shapes, CatalogFields,
                         testing::Combine(testing::ValuesIn(test::catalog_names()),
                                          testing::Values(test::BackEnd::host)),
                         test::name_and_back_end);

constexpr FieldOptions is_unsigned{.sign = SignMode::none};

class FieldExactness : public test::BackEndTest {
 protected:
  void expect_exact(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options,
                    std::size_t brute_nodes) const {
    blum::expect_exact(mesh, grid, options, context({.threads = 2}), brute_nodes);
  }
  [[nodiscard]] GridSpec usual_grid(const MeshView& mesh) const { return grid_for(mesh, usually(64, 32)); }
};
class SlowFieldExactness : public FieldExactness {};

INSTANTIATE_TEST_SUITE_P(On, FieldExactness, test::every_back_end(), test::back_end_name);
INSTANTIATE_TEST_SUITE_P(On, SlowFieldExactness, test::every_back_end(), test::back_end_name);

TEST_P(SlowFieldExactness, BruteForceAtEveryNodeOfSmallShapes) {
  for (const TriangleMesh& mesh : {make_box({}), make_wedge({}), make_menger({.level = 1, .size = 1}), soup(100)}) {
    const GridSpec grid = grid_for(mesh, usually(64, 24));
    const Field field = distance_field(mesh, grid, {}, context({.threads = 2}));
    expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
  }
}

TEST_P(FieldExactness, NastySoups) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = test::nasty_soup(seed, 40 * seed);
    expect_exact(mesh, usual_grid(mesh), is_unsigned, 1000);
  }
}

TEST_P(FieldExactness, TriangulatedStripsOfSliversThatShareVertices) {
  // In a fan of slivers around one vertex and a strip of caps, neighbouring domains meet at angles that float32 cannot
  // resolve.
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, 0});
  for (int k = 0; k <= 400; ++k) {
    const double angle = 1e-3 * k;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 1e-4 * std::sin(40 * angle)});
    if (k > 0) mesh.triangles.push_back({0, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(k + 1)});
  }
  expect_exact(mesh, usual_grid(mesh), is_unsigned, 500);
}

TEST_P(FieldExactness, FarOriginsAndExtremeScales) {
  const TriangleMesh base = soup(60);
  for (const double scale : {1e-12, 1e-3, 1e6, 1e15}) {
    for (const double offset : {0.0, 1e6}) {
      TriangleMesh mesh = base;
      for (Vec3d& v : mesh.vertices) v = (v + Vec3d{offset, -2 * offset, 0.5 * offset}) * scale;
      const GridSpec grid = grid_for(mesh, 32);
      SCOPED_TRACE(testing::Message() << "scale " << scale << " offset " << offset);
      expect_exact(mesh, grid, is_unsigned, 300);
    }
  }
}

TEST_P(FieldExactness, PointsSegmentsAndMixtures) {
  const TriangleMesh points = make_points();
  const TriangleMesh segments = make_segments();
  expect_exact(points, usual_grid(points), is_unsigned, 500);
  expect_exact(segments, usual_grid(segments), is_unsigned, 500);
  TriangleMesh mixed = soup(50);
  const auto first = static_cast<std::uint32_t>(mixed.vertices.size());
  mixed.vertices.insert(mixed.vertices.end(), segments.vertices.begin(), segments.vertices.end());
  for (const Segment& s : segments.segments) mixed.segments.push_back({s[0] + first, s[1] + first});
  mixed.vertices.push_back({2, 2, 2});
  mixed.points.push_back(static_cast<std::uint32_t>(mixed.vertices.size() - 1));
  expect_exact(mixed, usual_grid(mixed), is_unsigned, 500);
}

TEST_P(FieldExactness, NodesOnSitesAndOnBordersOfDomains) {
  // The box is aligned with the grid: nodes lie exactly on vertices, edges, faces, and on the planes between domains.
  const TriangleMesh mesh = make_box({.size = {1, 1, 1}, .segments = {4, 4, 4}});
  const Box3 box = bounds(mesh);
  const Vec3d margin{0.5, 0.5, 0.5};
  const GridSpec grid = grid_in({box.lower - margin, box.upper + margin}, 33);
  expect_exact(mesh, grid, {}, 500);
}

TEST_P(FieldExactness, AnisotropicSpacingDirectionAndOddSizes) {
  const TriangleMesh mesh = make_torus({});
  GridSpec grid = grid_for(mesh, 40);
  grid.spacing = {grid.spacing.x, grid.spacing.y * 0.7, grid.spacing.z * 2.3};
  grid.size = {37, 53, 19};
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  grid.direction.columns[0] = {c, s, 0};
  grid.direction.columns[1] = {-s, c, 0};
  expect_exact(mesh, grid, {}, 500);
}

TEST_P(FieldExactness, GridsOfAnyShapeAndDirection) {
  const TriangleMesh mesh = make_torus({});
  GridSpec grid = grid_for(mesh, 24);
  grid.spacing = {0.07, 0.11, 0.05};
  using Size = std::array<std::int64_t, 3>;
  for (const Size& size : {Size{1, 1, 1}, {40, 1, 1}, {1, 33, 7}, {8, 8, 8}, {9, 17, 5}, {3, 2, 65}}) {
    grid.size = size;
    for (const Mat3& direction : {Mat3{}, Mat3{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}}}) {
      grid.direction = direction;
      expect_exact(mesh, grid, {}, 50);
    }
  }
}

TEST_P(FieldExactness, OneLayerIsA2DField) {
  const TriangleMesh mesh = soup(80);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Box3 box = bounds(mesh);
    box.lower[axis] = box.upper[axis] = box.center()[axis];
    const GridSpec grid = grid_in(box, 150);
    EXPECT_EQ(grid.size[axis], 1);
    expect_exact(mesh, grid, is_unsigned, 500);
  }
}

TEST_P(FieldExactness, FarGridsAndSingleNodes) {
  const TriangleMesh mesh = make_sphere({});
  for (const double distance : {3.0, 100.0, 1e4}) {
    GridSpec grid;
    grid.origin = {distance, 0.1, 0.2};
    grid.spacing = {0.01, 0.01, 0.01};
    grid.size = {9, 5, 7};
    expect_exact(mesh, grid, {}, 100);
    grid.size = {1, 1, 1};
    expect_exact(mesh, grid, {}, 1);
  }
}

TEST_P(FieldExactness, Bands) {
  const TriangleMesh mesh = make_torus_knot({.curve_segments = 100, .tube_segments = 8});
  for (const double band : {0.01, 0.2, 100.0}) expect_exact(mesh, grid_for(mesh, 40), {.band = band}, 50);
}

TEST_P(FieldExactness, UnusedVerticesAreNotSites) {
  TriangleMesh mesh = make_sphere({.frequency = 4});
  mesh.vertices.insert(mesh.vertices.begin(), {0, 0, 0});
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) ++v;
  }
  expect_exact(mesh, grid_for(mesh, 24), {}, 50);
}

TEST_P(FieldExactness, OnePointIsEnough) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}};
  mesh.points = {0};
  expect_exact(mesh, {.origin = {0, 0, 0}, .spacing = {1, 1, 1}, .size = {5, 9, 17}}, is_unsigned, 50);
}

TEST_P(FieldExactness, TiesGoToTheSmallerId) {
  // Two points coincide, and a node lies half way between two others.
  TriangleMesh mesh;
  mesh.vertices = {{1, 1, 1}, {0, 0, 0}, {0, 0, 0}};
  mesh.points = {2, 1, 0};
  GridSpec grid;
  grid.origin = {0.5, 0.5, 0.5};
  grid.size = {1, 1, 1};
  EXPECT_EQ(distance_field(mesh, grid, {}, context()).site[0], SiteId(0));
  grid.origin = {0.25, 0.25, 0.25};
  EXPECT_EQ(distance_field(mesh, grid, {}, context()).site[0], SiteId(1));
}

}  // namespace
}  // namespace blum
