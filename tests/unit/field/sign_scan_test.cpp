// Proves that winding numbers counted along the rows of a grid equal the full sum at every node. The tests cover
// balanced meshes that cross, fold, are flat or are aligned with the nodes. Unbalanced meshes are recognised.
#include "field/sign/scan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "field/sign/policy.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

sign::Method method_of(const MeshView& mesh) {
  return sign::Planner().plan(SignMode::winding, mesh, SiteTable(mesh), {}).method;
}

/// Compares all nodes. Signs may differ within 1e-12 of the diagonal from the surface.
void expect_true_signs(const MeshView& mesh, const GridSpec& grid) {
  ASSERT_EQ(method_of(mesh), sign::Method::crossings);
  const reference::BruteForce exact(mesh);
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  Field field;
  field.grid = grid;
  field.distance = Buffer<float>(grid.node_count(), 1.0F);
  const std::optional<SignScan> scan = SignScan::make(mesh, grid, {.threads = 3});
  ASSERT_TRUE(scan.has_value());
  scan->apply(field, 0, {.threads = 2});
  std::size_t wrong = 0;
  std::size_t checked = 0;
  for (std::int64_t z = 0; z < grid.size[2]; ++z) {
    for (std::int64_t y = 0; y < grid.size[1]; ++y) {
      for (std::int64_t x = 0; x < grid.size[0]; ++x) {
        const Vec3d query = grid.position(x, y, z);
        const bool is_inside = field.distance[grid.index(x, y, z)] < 0;
        const bool is_right = is_inside == (reference::winding_number(mesh, query) > 0.5);
        if (!is_right && exact.nearest(query).distance < 1e-12 * box.diagonal()) continue;
        ++checked;
        wrong += is_right ? 0 : 1;
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(checked, grid.node_count() / 8);
}

/// Returns tetrahedra, some inside out, some flat, with corners anywhere or on a lattice.
TriangleMesh tetrahedra(std::size_t count, bool on_lattice, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k < count; ++k) {
    for (int corner = 0; corner < 4; ++corner) {
      Vec3d p = random.in_cube() * 8;
      if (on_lattice) p = {std::floor(p.x), std::floor(p.y), std::floor(p.z)};
      mesh.vertices.push_back(p);
    }
    const std::uint32_t v = 4 * k;
    mesh.triangles.insert(mesh.triangles.end(),
                          {{v, v + 2, v + 1}, {v, v + 1, v + 3}, {v + 1, v + 2, v + 3}, {v, v + 3, v + 2}});
  }
  return mesh;
}

TEST(SignScan, IsRightOnClosedShapes) {
  for (const TriangleMesh& mesh :
       {make_sphere({.frequency = 5}), make_star({}), make_void_cube({}), make_gear({}), make_bodies({}),
        make_torus_knot({.curve_segments = 80, .tube_segments = 8}), make_box({})}) {
    expect_true_signs(mesh, grid_around(bounds(mesh), 24));
  }
}

TEST(SignScan, IsRightWhereShapesCrossFoldAndLieOnTheNodes) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    for (const bool on_lattice : {false, true}) {
      const TriangleMesh mesh = tetrahedra(1 + 2 * seed, on_lattice, seed);
      GridSpec grid;
      grid.size = {17, 19, 18};
      grid.spacing = {0.5, 0.5, 0.5};
      expect_true_signs(mesh, grid);
    }
  }
}

TEST(SignScan, IsRightOnThinTurnedAndMirroredGrids) {
  const TriangleMesh mesh = tetrahedra(9, true, 3);
  for (const double mirror : {1.0, -1.0}) {
    for (const std::array<std::int64_t, 3> size :
         {std::array<std::int64_t, 3>{40, 37, 1}, {1, 40, 9}, {33, 1, 8}, {1, 1, 60}, {1, 1, 1}, {17, 9, 16}}) {
      GridSpec grid;
      grid.size = size;
      grid.spacing = {0.26, 0.28, 0.21};
      grid.origin = {1.1, -0.9, 0.4};
      grid.direction.columns[0] = {0.8, 0.6, 0};
      grid.direction.columns[1] = {-0.6 * mirror, 0.8 * mirror, 0};
      expect_true_signs(mesh, grid);
    }
  }
}

TEST(SignScan, IsRightFarFromTheOriginAndAtAnyScale) {
  const TriangleMesh star = make_star({});
  for (const double scale : {1e-9, 1e9}) {
    const TriangleMesh mesh = test::moved(star, scale);
    expect_true_signs(mesh, grid_around(bounds(mesh), 16));
  }
  const TriangleMesh far = test::moved(star, 1, {1e6, 1e6, -1e6});
  expect_true_signs(far, grid_around(bounds(far), 16));
  expect_true_signs(star, grid_in({{-1e7, -1e7, -1e7}, {1e7, 1e7, 1e7}}, 9));
}

TEST(SignScan, LeavesZerosAlone) {
  Field field;
  const TriangleMesh mesh = make_box({});
  field.grid = grid_around(bounds(mesh), 9);
  field.distance = Buffer<float>(field.grid.node_count(), 0.0F);
  SignScan::make(mesh, field.grid, {})->apply(field, 0, {});
  for (const float d : field.distance.span()) EXPECT_FALSE(std::signbit(d));  // a zero has no side
}

TEST(SignScan, GivesUpOnHeapsOfOverlappingShapes) {
  TriangleMesh heap;
  for (int k = 0; k < 4000; ++k) append(heap, make_box({}));
  const GridSpec grid = grid_around(bounds(heap), 40);
  EXPECT_FALSE(SignScan::make(heap, grid, {}).has_value());
}

TEST(SignScan, BalanceIsCheckedAtEveryEdge) {
  TriangleMesh mesh = make_sphere({.frequency = 3});
  EXPECT_EQ(method_of(mesh), sign::Method::crossings);
  mesh.triangles.push_back({2, 2, 5});  // its edges have no length, or run back on themselves
  EXPECT_EQ(method_of(mesh), sign::Method::crossings);
  mesh.triangles.pop_back();
  std::swap(mesh.triangles[4][0], mesh.triangles[4][1]);
  EXPECT_EQ(method_of(mesh), sign::Method::sums);
  mesh.triangles.erase(mesh.triangles.begin() + 4);
  EXPECT_EQ(method_of(mesh), sign::Method::sums);
  // Four triangles meet at an edge, two in each direction.
  TriangleMesh touching = make_box({});
  append(touching, make_box({}));
  for (Triangle& t : touching.triangles) {
    for (std::uint32_t& v : t) v %= 8;
  }
  EXPECT_EQ(method_of(touching), sign::Method::crossings);
}

}  // namespace
}  // namespace blum
