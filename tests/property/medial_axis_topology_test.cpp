// Proves that medial axes of meshes have the topology of the solid at every angle. The meshes are real ones, and
// generated shapes whose Betti numbers are known from their construction and from topology().
#include <gtest/gtest.h>

#include "blum/geometry/topology.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/data.hpp"
#include "support/medial_check.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

struct Shape {
  std::string label;
  std::string name;
  ShapeParameters parameters = {};
};

/// Returns every closed shape of the catalogue, and variants whose topology depends on the parameters.
std::vector<Shape> shapes() {
  std::vector<Shape> all;
  for (const ShapeInfo& shape : shape_catalog()) {
    if (shape.betti(complete_parameters(shape, {}))) all.push_back({shape.name, shape.name});
  }
  all.push_back({"knot_3_5", "torus_knot", {{"p", 3}, {"q", 5}, {"tube_radius", 0.1}}});
  all.push_back({"chain", "linked_tori", {{"count", 4}}});
  all.push_back({"plate_1", "plate", {{"holes_x", 1}, {"holes_y", 1}}});
  all.push_back({"plate_20", "plate", {{"holes_x", 5}, {"holes_y", 4}}});
  all.push_back({"six_shells", "nested_shells", {{"shells", 6}}});
  all.push_back({"balls", "bodies", {{"count", 8}, {"frequency", 4}}});
  all.push_back({"sponge_1", "menger", {{"level", 1}}});
  all.push_back({"closed_gear", "gear", {{"bore_radius", 0}, {"openings", 0}}});
  all.push_back({"open_bracket", "bracket", {{"holes", 4}, {"ribs", 0}, {"hole_radius", 0.2}}});
  return all;
}

void expect_shape(const Shape& shape, const MedialAxisOptions& options) {
  const ShapeInfo& info = find_shape(shape.name);
  const auto betti = info.betti(complete_parameters(info, shape.parameters));
  const TriangleMesh mesh = make_shape(shape.name, shape.parameters);
  ASSERT_TRUE(betti);
  ASSERT_EQ(topology(mesh).betti, betti);
  test::expect_certified(medial_axis(mesh, options), mesh, *betti);
}

class MedialTopologyOfShapes : public testing::TestWithParam<Shape> {};
class SlowMedialTopologyOfShapes : public testing::TestWithParam<Shape> {};

TEST_P(MedialTopologyOfShapes, IsTheSolidsAtEveryAngleOnCoarseVoxels) {
  expect_shape(GetParam(), {.resolution = 64});
}
TEST_P(SlowMedialTopologyOfShapes, IsTheSolidsAtEveryAngleByDefault) {
  expect_shape(GetParam(), {});
}

std::string label_of(const testing::TestParamInfo<Shape>& info) {
  return info.param.label;
}
INSTANTIATE_TEST_SUITE_P(Catalogue, MedialTopologyOfShapes, testing::ValuesIn(shapes()), label_of);
INSTANTIATE_TEST_SUITE_P(Catalogue, SlowMedialTopologyOfShapes, testing::ValuesIn(shapes()), label_of);

struct RealMesh {
  std::string file;
  BettiNumbers betti;
};

const std::vector<RealMesh>& real_meshes() {
  static const std::vector<RealMesh> all = {
      {"spot.obj", {1, 0, 0}},        {"fandisk.obj", {1, 0, 0}},     {"rocker-arm.obj", {1, 1, 0}},
      {"3holes.off", {1, 3, 0}},      {"screwdriver.off", {1, 0, 0}}, {"eight.off", {1, 2, 0}},
      {"ballcube.off", {1, 5, 0}},    {"plate_holes.STL", {1, 5, 0}}, {"torus.STL", {1, 1, 0}},
      {"round.stl", {1, 1, 0}},       {"abc5.stl", {10, 0, 0}},       {"abc7.stl", {1, 0, 0}},
      {"7_8ths_cube.stl", {1, 0, 0}}, {"abc9.stl", {1, 0, 0}}};
  return all;
}

class MedialTopologyOfRealMeshes : public testing::TestWithParam<RealMesh> {};
class SlowMedialTopologyOfRealMeshes : public testing::TestWithParam<RealMesh> {};

void expect_real_mesh(const RealMesh& real, const MedialAxisOptions& options) {
  const std::string name = "meshes/" + real.file;
  const auto file = test::data_file(name);
  if (!file) GTEST_SKIP() << test::no_data(name);
  const TriangleMesh mesh = read_mesh(*file);
  ASSERT_EQ(topology(mesh).betti, real.betti);
  test::expect_certified(medial_axis(mesh, options), mesh, real.betti);
}

TEST_P(MedialTopologyOfRealMeshes, IsTheSolidsAtEveryAngleOnCoarseVoxels) {
  expect_real_mesh(GetParam(), {.resolution = 96});
}
TEST_P(SlowMedialTopologyOfRealMeshes, IsTheSolidsAtEveryAngleByDefault) {
  expect_real_mesh(GetParam(), {});
}

std::string file_of(const testing::TestParamInfo<RealMesh>& info) {
  return test::test_name(info.param.file);
}
INSTANTIATE_TEST_SUITE_P(Data, MedialTopologyOfRealMeshes, testing::ValuesIn(real_meshes()), file_of);
INSTANTIATE_TEST_SUITE_P(Data, SlowMedialTopologyOfRealMeshes, testing::ValuesIn(real_meshes()), file_of);

/// No rotation maps the lattice to itself.
std::vector<Mat3> rotations() {
  return {test::rotation({1, 0, 0}, 17), test::rotation({1, 2, 3}, 40), test::rotation({-2, 1, 5}, 101),
          test::rotation({1, -1, 0.3}, 163)};
}

/// Tests a wedge of 10 degrees, whose sharp edge is thinner than a voxel of any size.
void expect_wedge(int resolution) {
  const TriangleMesh wedge = make_shape("wedge", {{"angle", 10}});
  const MedialAxisOptions options{.resolution = resolution};
  test::expect_certified(medial_axis(wedge, options), wedge, {1, 0, 0});
  for (const Mat3& turn : rotations()) {
    test::expect_certified(medial_axis(test::turned(wedge, turn), options), test::turned(wedge, turn), {1, 0, 0});
  }
}

TEST(MedialTopologyOfAWedge, IsThatOfAPointHoweverItIsTurned) {
  for (const int resolution : {64, 128}) expect_wedge(resolution);
}
TEST(SlowMedialTopologyOfAWedge, IsThatOfAPointHoweverItIsTurnedByDefault) {
  expect_wedge(MedialAxisOptions{}.resolution);
}

class MedialTopologyOfMovedShapes : public testing::TestWithParam<Shape> {};

TEST_P(MedialTopologyOfMovedShapes, DoesNotDependOnHowTheShapeLies) {
  const TriangleMesh mesh = make_shape(GetParam().name, GetParam().parameters);
  const auto betti = topology(mesh).betti;
  ASSERT_TRUE(betti);
  for (const Mat3& turn : rotations()) {
    test::expect_certified(medial_axis(test::turned(mesh, turn), {.resolution = 48}), test::turned(mesh, turn), *betti);
  }
}

TEST_P(MedialTopologyOfMovedShapes, DoesNotDependOnWhereTheVoxelsLie) {
  // The grid follows the box of a body, so half a voxel more at one end moves all voxels by a quarter.
  const TriangleMesh mesh = make_shape(GetParam().name, GetParam().parameters);
  const Vec3d size = bounds(mesh).size();
  const double voxel = std::max({size.x, size.y, size.z}) / 48;
  const auto betti = topology(mesh).betti;
  ASSERT_TRUE(betti);
  for (const double part : {0.0, 0.5}) {
    const Vec3d offset = Vec3d{part, -part, 3 + part} * voxel;
    for (const double more : {0.99, 1.01, 1.02}) {
      SCOPED_TRACE(testing::Message() << "offset " << part << ", spacing " << more);
      test::expect_certified(medial_axis(test::moved(mesh, 1, offset), {.spacing = more * voxel}),
                             test::moved(mesh, 1, offset), *betti);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, MedialTopologyOfMovedShapes,
                         testing::Values(Shape{"plate", "plate", {{"holes_x", 2}, {"holes_y", 1}}},
                                         Shape{"star", "star"}, Shape{"torus", "torus"},
                                         Shape{"void_cube", "void_cube"}, Shape{"bracket", "bracket"}),
                         label_of);

}  // namespace
}  // namespace blum
