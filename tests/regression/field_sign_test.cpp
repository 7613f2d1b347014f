// Proves on every back end that signs are right for input on which float32 pseudonormals alone fail. Such input is
// knife edges, thin plates, bands narrower than a grid step, grids far away and shapes that cross. Caps near the limit
// of float32 barycentrics keep the promise at their tips.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

class FieldSigns : public test::BackEndTest {
 protected:
  [[nodiscard]] Field compute(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {}) const {
    return distance_field(mesh, grid, options, context());
  }
  void expect_right_signs(const TriangleMesh& mesh, const GridSpec& grid, std::optional<double> band = {}) const {
    const auto nodes = grid.node_count() < 1000 ? test::all_nodes(grid) : test::random_nodes(grid, 1000);
    for (const SignMode mode : {SignMode::automatic, SignMode::normals, SignMode::winding}) {
      const Field field = compute(mesh, grid, {.sign = mode, .band = band});
      expect_promise(test::compare_with_brute_force(field, mesh, nodes));
    }
  }
};

INSTANTIATE_TEST_SUITE_P(On, FieldSigns, test::every_back_end(), test::back_end_name);

TEST_P(FieldSigns, OfAKnifeEdgeAreRight) {
  for (const double angle : {1e-6, 1e-4, 1e-3, 0.1}) {
    const TriangleMesh mesh = make_wedge({.angle = angle, .length = 1, .width = 1});
    const GridSpec grid = grid_around(bounds(mesh), 33);
    for (const std::optional<double> band : {std::optional<double>(), std::optional<double>(0.3 * grid.spacing.x)}) {
      expect_right_signs(mesh, grid, band);
    }
  }
}

/// float32 cannot determine which side of the plate is closer.
TEST_P(FieldSigns, OfAThinPlateAreRight) {
  for (const double thickness : {1e-4, 1e-6, 1e-7, 1e-8, 1e-10}) {
    TriangleMesh mesh = make_box({.segments = {4, 4, 4}});
    for (Vec3d& p : mesh.vertices) p = {p.x + 0.3 * p.y, p.y, thickness * p.z + 0.2 * p.x};
    expect_right_signs(mesh, grid_around(bounds(mesh), 33));
  }
}

/// All sides of the mesh are equally close from so far away.
TEST_P(FieldSigns, FarFromASmallMeshAreRight) {
  const TriangleMesh mesh = make_star({});
  expect_right_signs(mesh, grid_in({{-1e8, -1e8, -1e8}, {1e8, 1e8, 1e8}}, 21));
}

/// A closed shell that faces outwards, bent into a ring of more than a turn, so that its ends cross.
TriangleMesh overlapping_ring() {
  TriangleMesh mesh = make_sphere({.frequency = 10});
  for (Vec3d& p : mesh.vertices) {
    const double angle = 3.8 * p.z;
    const double radius = 1 + 0.4 * p.x;
    p = {radius * std::cos(angle), radius * std::sin(angle), 0.1 * p.z - 0.4 * p.y};
  }
  return mesh;
}

/// Only the surface separates nodes with wrong pseudonormals from right ones. Some nodes have no neighbours.
TEST_P(FieldSigns, OfAShellThatCrossesItselfAreRightOnCoarseAndFlatGrids) {
  const TriangleMesh mesh = overlapping_ring();
  bool were_normals_wrong = false;
  for (const std::int64_t n : {2, 3, 5, 9, 20}) {
    for (const std::int64_t layers : {std::int64_t{1}, n}) {
      GridSpec grid;
      grid.size = {n, n, layers};
      grid.origin = {-1.4, -0.6, 0};
      grid.spacing = Vec3d{1.2, 1.2, 0.1} * (1.0 / static_cast<double>(n));
      expect_right_signs(mesh, grid);
      were_normals_wrong = were_normals_wrong || compute(mesh, grid).sign_rule == SignRule::winding;
    }
  }
  EXPECT_TRUE(were_normals_wrong);
  expect_right_signs(mesh, grid_in({{-1.0, 0.0, 0.0}, {-0.9998, 0.0002, 0.0002}}, 20));
}

/// A closed mesh with random corners: it crosses itself nearly everywhere.
TriangleMesh crumpled(std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = seed % 2 == 0 ? make_box({}) : make_sphere({.frequency = 2});
  for (Vec3d& v : mesh.vertices) v += random.in_ball() * (seed % 3 == 0 ? 0.6 : 0.3);
  return mesh;
}

TEST_P(FieldSigns, OfCrumpledMeshesAreRightOnCoarseGrids) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = crumpled(seed);
    GridSpec grid = grid_around(bounds(mesh), 3 + static_cast<int>(seed % 6));
    if (seed % 5 == 0) grid.size[seed % 3] = 1;
    expect_promise(test::compare_with_brute_force(compute(mesh, grid), mesh, test::all_nodes(grid)));
  }
}

/// Explicitly requested normals of a mesh that is inside out make the outside negative.
TEST_P(FieldSigns, OfInsideOutThinPlatesFollowTheirNormals) {
  for (const double thickness : {1e-7, 1e-9}) {  // no node inside
    TriangleMesh mesh = make_box({.size = {1, 0.9, thickness}});
    reverse_triangles(mesh);
    const GridSpec grid = grid_in({{-0.7, -0.6, -0.5}, {0.7, 0.6, 0.5}}, 12);
    const Field field = compute(mesh, grid, {.sign = SignMode::normals});
    for (const float d : field.distance.span()) {
      EXPECT_LT(d, 2e-6F);
    }
  }
}

/// The CPU does not count so many crossings one by one (at 65^3 nodes, from 350 boxes on).
TEST_P(FieldSigns, OfHeapsOfCoincidentBoxesAreRightEitherWayRound) {
  TriangleMesh mesh;
  for (int k = 0; k < 400; ++k) append(mesh, make_box({}));
  const int nodes = usually(65, 33);
  const GridSpec grid = grid_in({{-0.8, -0.8, -0.8}, {0.8, 0.8, 0.8}}, nodes);
  const std::size_t inside = grid.index(nodes / 2, nodes / 2, nodes / 2);
  EXPECT_LT(compute(mesh, grid).distance[inside], 0);
  EXPECT_GT(compute(mesh, grid).distance[0], 0);
  reverse_triangles(mesh);
  EXPECT_GT(compute(mesh, grid, {.sign = SignMode::normals}).distance[inside], 0);
}

TEST_P(FieldSigns, AndDistancesAtTheTipsOfCapsKeepThePromise) {
  for (const double height : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
    TriangleMesh mesh;
    mesh.vertices = {{-0.3, 0.1, 0.2}, {0.35, -0.05, 0.12}, {}};
    mesh.vertices[2] = (mesh.vertices[0] + mesh.vertices[1]) * 0.5 + Vec3d{0.3, 0.9, 0.2} * height;
    mesh.triangles = {{0, 1, 2}};
    const GridSpec grid = grid_in({{-0.45, -0.2, 0.0}, {-0.25, 0.2, 0.4}}, 40);
    const Field field = compute(mesh, grid, {.sign = SignMode::none});
    expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
  }
}

}  // namespace
}  // namespace blum
