// Proves that components, and the cubes that pass, equal those of cutting the solid by the sides of every cube.
#include "support/slow_clipping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"
#include "solid/model/cut_grid.hpp"
#include "support/model_solids.hpp"

namespace blum::detail {
namespace {

TEST(SlowClipping, CutsABoxIntoBoxes) {
  const TriangleMesh box = make_box({.size = {2, 2, 2}});
  const GridPlanes planes({-1.53, -1.51, -1.57}, {1.03, 1.01, 1.02}, {0, 0, 0}, {3, 3, 3});
  int cubes = 0;
  test::for_each_cube(box, planes, [&](const Place& /*at*/, const test::PartShape& shape) {
    EXPECT_TRUE(shape.is_sure && shape.passes());
    EXPECT_EQ(shape.components, 1U);
    ++cubes;
  });
  EXPECT_EQ(cubes, 27);
}

TEST(SlowClipping, DetectsAHandleAVoidAndAHoleInASquare) {
  const auto shape_in = [](const TriangleMesh& mesh, const Vec3d& low, const Vec3d& high) {
    const GridPlanes planes(low, high - low, {0, 0, 0}, {1, 1, 1});
    test::PartShape found;
    test::for_each_cube(mesh, planes, [&](const Place& /*at*/, const test::PartShape& shape) { found = shape; });
    EXPECT_TRUE(found.is_sure);
    return found;
  };
  const TriangleMesh torus = test::turned(make_torus({.ring_segments = 9, .tube_segments = 5}), 3);
  const test::PartShape ring = shape_in(torus, {-2, -2, -2}, {2, 2, 2});
  EXPECT_EQ(ring.shells, std::vector<int>{0});
  EXPECT_FALSE(ring.passes());
  const TriangleMesh hollow = make_void_cube({.void_radius = 0.2, .segments = 1, .frequency = 2});
  const test::PartShape with_void = shape_in(hollow, {-0.45, -0.43, -0.41}, {0.42, 0.41, 0.44});
  EXPECT_EQ(with_void.components, 1U);
  EXPECT_EQ(with_void.voids, 1U);
  EXPECT_FALSE(with_void.passes());
  const test::PartShape half = shape_in(hollow, {0.05, -0.43, -0.41}, {0.42, 0.41, 0.44});
  EXPECT_EQ(half.shells, std::vector<int>{2});
  EXPECT_EQ(half.sides[0], std::vector<int>{0});
  EXPECT_FALSE(half.passes());
}

struct Found {
  std::size_t cubes = 0;
  std::size_t unsure = 0;
  std::size_t cut = 0;
  std::size_t failing = 0;
  std::size_t several = 0;
  std::size_t handles = 0;  ///< cubes that fail by themselves
};

void compare_body(const TriangleMesh& mesh, const GridPlanes& planes, const std::string& name, Found& found) {
  const SurfaceMesh surface(mesh, {});
  const CutGrid grid(surface, planes, {});
  test::for_each_cube(mesh, planes, [&](const Place& at, const test::PartShape& shape) {
    const Cell cube = cell_at(grid.lattice().node(at[0], at[1], at[2]), 7);
    ++found.cubes;
    if (!shape.is_sure) {
      ++found.unsure;
      return;
    }
    const bool passes = !std::binary_search(grid.failing_cubes().begin(), grid.failing_cubes().end(), cube);
    EXPECT_EQ(passes, shape.passes()) << name << " cube " << cube;
    // The surroundings of a hole are not joined to it, and the walls of a void are not joined to others. Components are
    // then unknown.
    bool is_known = shape.voids == 0;
    const auto faces = grid.faces_of(cube);
    for (std::size_t f = 0; f < 6; ++f) {
      if (std::any_of(shape.sides[f].begin(), shape.sides[f].end(), [](int euler) { return euler != 1; })) {
        is_known = false;
        continue;
      }
      EXPECT_EQ(grid.components(faces[f]), shape.sides[f].size()) << name << " cube " << cube << " side " << f;
    }
    if (is_known) {
      EXPECT_EQ(grid.components(cube), shape.components) << name << " cube " << cube;
    }
    if (!passes && is_known) ++found.handles;
    if (grid.is_cut(cube)) ++found.cut;
    if (!passes) ++found.failing;
    if (shape.components > 1) ++found.several;
  });
}

void compare(const test::NamedMesh& named, const std::vector<int>& resolutions, Found& found) {
  const Solid solid = Solid::of(named.mesh);
  if (solid.rule() != SolidRule::polyhedron) return;
  const Vec3d size = solid.box().size();
  constexpr std::array<double, 3> shifts{0.381966, 0.123, 0.777};
  for (const int resolution : resolutions) {
    const double spacing = std::max({size.x, size.y, size.z}) / resolution;
    for (const double shift : shifts) {
      // The offset differs along each axis, so that no plane passes through a symmetric place.
      const Vec3d origin = solid.box().lower - Vec3d{shift, shift + 0.0347, shift + 0.0591} * spacing;
      for (const SolidBody& body : solid.bodies()) {
        const std::string name = named.name + " at " + std::to_string(resolution) + " by " + std::to_string(shift);
        compare_body(body.mesh, test::planes_around(body.mesh, origin, spacing), name, found);
      }
    }
  }
}

TEST(SlowClipping, EqualsTheGridInThinSolids) {
  Found found;
  for (const test::NamedMesh& named : test::thin_solids()) compare(named, {2, 5, 12}, found);
  EXPECT_EQ(found.unsure, 0U);
  EXPECT_GT(found.cut, 30000U);
  EXPECT_GT(found.failing, 100U);
  EXPECT_GT(found.several, 1000U);
}

TEST(SlowClipping, EqualsTheGridInTheCatalogue) {
  Found found;
  for (const ShapeInfo& shape : shape_catalog()) {
    const TriangleMesh mesh = shape.make(complete_parameters(shape, {}));
    if (mesh.triangles.empty() || mesh.triangles.size() > 4000) continue;
    compare({shape.name, mesh}, {2, 3, 7}, found);
    compare({shape.name + " turned", test::turned(mesh, 7)}, {2, 3, 7}, found);
  }
  EXPECT_EQ(found.unsure, 0U);
  EXPECT_GT(found.cut, 15000U);
  EXPECT_GT(found.several, 200U);
  EXPECT_GT(found.handles, 150U);
}

}  // namespace
}  // namespace blum::detail
