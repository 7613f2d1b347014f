// Proves that meshes, points and complexes from debug_dump() read back unchanged, and that debug_dump() accepts broken
// shapes.
#include "blum/core/debug_dump.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/complex_io.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

const std::vector<Vec3d> places{{0.1, 1.0 / 3.0, -1e-7}, {1, 0, 0}, {0, 1, 0}, {1e300, 1, 5e-324}};

Complex dumped(const test::TemporaryFolder& folder) {
  return read_complex(folder / "x.vtp").complex;
}

TEST(DebugDump, OfAMeshReadsBack) {
  const test::TemporaryFolder folder;
  const TriangleMesh mesh{.vertices = places, .triangles = {{0, 1, 2}, {2, 1, 3}}, .segments = {{3, 0}}};
  debug_dump(folder / "x.vtp", mesh);
  const Complex of_mesh = dumped(folder);
  EXPECT_EQ(of_mesh.positions, mesh.vertices);
  EXPECT_EQ(of_mesh.triangles, mesh.triangles);
  EXPECT_EQ(of_mesh.edges, mesh.segments);

  debug_dump(folder / "x.vtp", mesh.view());
  EXPECT_EQ(dumped(folder).triangles, mesh.triangles);
}

TEST(DebugDump, OfPointsReadsBack) {
  const test::TemporaryFolder folder;
  debug_dump(folder / "x.vtp", places);
  EXPECT_EQ(dumped(folder).positions, places);
  debug_dump(folder / "x.vtp", std::span<const Vec3d>());
  EXPECT_TRUE(dumped(folder).positions.empty());
}

TEST(DebugDump, OfAComplexReadsBack) {
  const test::TemporaryFolder folder;
  Complex complex;
  complex.positions = places;
  complex.edges = {{1, 0}, {2, 3}};
  complex.triangles = {{0, 1, 2}};
  complex.vertex_columns = Columns(4);
  complex.vertex_columns.add<double>("radius");
  debug_dump(folder / "x.vtp", complex);
  const Complex read = dumped(folder);
  EXPECT_EQ(read.positions, complex.positions);
  EXPECT_EQ(read.edges, complex.edges);
  EXPECT_EQ(read.triangles, complex.triangles);
}

TEST(DebugDump, OmitsInvalidPartsOfBrokenShapes) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh{.vertices = places, .triangles = {{0, 1, 2}, {0, 1, 7}, {1, 2, 3}}, .segments = {{0, 4}, {0, 1}}};
  mesh.vertices[3].y = std::nan("");
  debug_dump(folder / "x.vtp", mesh);
  const Complex read = dumped(folder);
  EXPECT_EQ(read.positions[3], Vec3d());
  EXPECT_EQ(read.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(read.edges, (std::vector<Segment>{{0, 1}}));
}

TEST(DebugDump, ThrowsIfItCannotWrite) {
  EXPECT_THROW(debug_dump("/nowhere/x.vtp", places), FileError);
}

}  // namespace
}  // namespace blum
