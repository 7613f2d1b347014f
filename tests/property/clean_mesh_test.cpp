// Proves that cleaned meshes keep the reported bound: the independent hausdorff_distance() finds no larger distance.
// The tests use real meshes, thin solids, and generated shapes as they are, subdivided, jittered and rounded. Cleaned
// meshes are valid and keep their topology.
#include "blum/solid/clean_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/weld.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/surface_map/hausdorff_distance.hpp"
#include "support/data.hpp"
#include "support/mesh_places.hpp"
#include "support/model_solids.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

/// True if cleaning accepts the mesh.
bool bounds_a_solid(const MeshView& mesh) {
  return topology(mesh, SiteTable(mesh)).betti.has_value() && find_self_intersections(mesh, 1).pairs.empty();
}

/// @return  the share of triangles that remain.
double check_cleaning(const MeshView& mesh, double part, const std::string& name) {
  const double tolerance = part * bounds(mesh).diagonal();
  const CleanedMesh out = clean_mesh(mesh, tolerance);
  EXPECT_TRUE(bounds_a_solid(out.mesh)) << name;
  EXPECT_EQ(topology(out.mesh, SiteTable(out.mesh)).betti, topology(mesh, SiteTable(mesh)).betti) << name;
  EXPECT_LE(out.report.deviation, tolerance) << name;
  HausdorffOptions options;
  options.tolerance = 0.1 * tolerance;
  options.max_points = 300'000;  // the lower bound is right for any number
  const HausdorffDistance found = hausdorff_distance(mesh, out.mesh, options);
  // The tolerance covers the rounding of the distances themselves.
  EXPECT_LE(found.lower, out.report.deviation * (1 + 1e-9) + 1e-14 * bounds(mesh).largest_coordinate()) << name;
  return static_cast<double>(out.report.triangles) / static_cast<double>(out.report.triangles_before);
}

TriangleMesh fine(const MeshView& mesh, std::size_t most) {
  TriangleMesh out = copy_of(mesh);
  while (out.triangles.size() * 4 <= most) out = make_subdivided(out);
  return out;
}

class CleanedShapes : public testing::TestWithParam<std::string> {};

TEST_P(CleanedShapes, KeepTheirBounds) {
  const TriangleMesh shape = make_shape(GetParam());
  constexpr std::size_t most = 5000;
  if (shape.triangles.size() > 2 * most || !bounds_a_solid(shape)) return;
  const TriangleMesh mesh = fine(shape, most);
  const double size = bounds(mesh).diagonal();
  check_cleaning(shape, 1e-5, "as it is, 1e-5");
  check_cleaning(shape, 1e-2, "as it is, 1e-2");
  EXPECT_LE(check_cleaning(mesh, 1e-6, "subdivided"), mesh.triangles.size() > shape.triangles.size() ? 0.5 : 1);
  for (const double noise : {1e-9, 1e-7, 1e-6}) {
    const TriangleMesh noisy = make_noisy(mesh, noise * size);
    if (!bounds_a_solid(noisy)) continue;
    check_cleaning(noisy, 1e-5, "noise " + std::to_string(noise));
    check_cleaning(noisy, 2 * noise, "about the noise " + std::to_string(noise));
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, CleanedShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& of) { return test::test_name(of.param); });

TEST(CleanedSolids, InSinglePrecisionTurned) {
  const std::vector<TriangleMesh> shapes{make_gear(), make_bracket(), make_plate(), make_star()};
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const TriangleMesh turned = test::in_single_precision(test::turned(fine(shapes[k], 12'000), k + 1));
    if (!bounds_a_solid(turned)) continue;
    EXPECT_LT(check_cleaning(turned, 1e-6, std::to_string(k)), 0.4) << k;
    EXPECT_LT(check_cleaning(turned, 1e-4, std::to_string(k)), 0.4) << k;
  }
}

TEST(CleanedSolids, ThinOnes) {
  for (const test::NamedMesh& solid : test::thin_solids()) {
    if (!bounds_a_solid(solid.mesh)) continue;
    const TriangleMesh mesh = make_subdivided(solid.mesh, 1);
    for (const double part : {1e-6, 1e-3, 0.05, 0.5}) {
      check_cleaning(solid.mesh, part, solid.name);
      if (bounds_a_solid(mesh)) check_cleaning(mesh, part, solid.name + ", subdivided");
    }
  }
}

class CleanedData : public testing::TestWithParam<const char*> {};

TEST_P(CleanedData, KeepsItsBounds) {
  const std::string name = std::string("meshes/") + GetParam();
  const auto path = test::data_file(name);
  if (!path) GTEST_SKIP() << test::no_data(name);
  const TriangleMesh mesh = weld(read_mesh(*path));
  ASSERT_TRUE(bounds_a_solid(mesh));
  for (const double part : {1e-5, 1e-4, 1e-3}) check_cleaning(mesh, part, name);
}

INSTANTIATE_TEST_SUITE_P(Data, CleanedData,
                         testing::Values("7_8ths_cube.stl", "plate_holes.STL", "abc9.stl", "abc5.stl", "3holes.off",
                                         "screwdriver.off", "torus.STL", "fandisk.obj", "round.stl"));

}  // namespace
}  // namespace blum
