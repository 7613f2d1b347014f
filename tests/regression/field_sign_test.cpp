// Proves that `auto` keeps the right sign where float32 pseudonormals would not: knife edges, and bands narrower than a
// grid step; and that caps near the limit of float32 barycentrics keep the promise at their tips.
#include <gtest/gtest.h>

#include <cmath>

#include "blum/field/field.hpp"
#include "blum/geometry/generators.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

TEST(FieldSigns, OfAKnifeEdgeAreRight) {
  for (const double angle : {1e-4, 1e-3, 0.1}) {
    const TriangleMesh mesh = make_wedge({.angle = angle, .length = 1, .width = 1});
    const GridSpec grid = grid_around(bounds(mesh), 33);
    for (const std::optional<double> band : {std::optional<double>(), std::optional<double>(0.3 * grid.spacing.x)}) {
      const Field field = distance_field(mesh, grid, {.band = band});
      EXPECT_EQ(field.sign_rule, SignRule::winding);
      expect_promise(test::compare_with_brute_force(field, mesh, test::random_nodes(grid, 3000)));
    }
  }
}

TEST(FieldDistances, AtTheTipsOfCapsKeepThePromise) {
  for (const double height : {1e-2, 3e-3, 1e-3, 3e-4, 1e-4}) {
    TriangleMesh mesh;
    mesh.vertices = {{-0.3, 0.1, 0.2}, {0.35, -0.05, 0.12}, {}};
    mesh.vertices[2] = (mesh.vertices[0] + mesh.vertices[1]) * 0.5 + Vec3d{0.3, 0.9, 0.2} * height;
    mesh.triangles = {{0, 1, 2}};
    const GridSpec grid = grid_in({{-0.45, -0.2, 0.0}, {-0.25, 0.2, 0.4}}, 40);
    const Field field = distance_field(mesh, grid, {.sign = SignMode::none});
    expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
  }
}

}  // namespace
}  // namespace blum
