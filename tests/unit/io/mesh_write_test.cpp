// Proves that written meshes read back the same, bit for bit if the format has the precision. Content that a format
// cannot hold is refused, and nothing is written.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "mesh_text.hpp"
#include "temporary_folder.hpp"

namespace blum {
namespace {

using test::file_content;
using test::TemporaryFolder;

/// Random triangles over vertices at all scales, including extremes.
TriangleMesh random_mesh(std::uint64_t seed, bool single_precision) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  TriangleMesh mesh;
  for (int i = 0; i < 200; ++i) {
    Vec3d v;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      v[axis] = unit(random) * std::pow(10.0, (single_precision ? 30 : 100) * unit(random));
      if (single_precision) v[axis] = static_cast<float>(v[axis]);
    }
    mesh.vertices.push_back(v);
  }
  mesh.vertices[7] = {0.1, -0.0, single_precision ? 1e38 : std::numeric_limits<double>::denorm_min()};
  if (single_precision) mesh.vertices[7] = {0.5, 0.0, 2.0};
  for (int i = 0; i < 300; ++i) {
    const auto corner = [&] { return static_cast<std::uint32_t>(random() % 199); };  // no triangle names 199
    mesh.triangles.push_back({corner(), corner(), corner()});
  }
  return mesh;
}

void expect_same(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t i = 0; i < a.vertices.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(a.vertices[i][axis], b.vertices[i][axis]);
      ASSERT_EQ(std::signbit(a.vertices[i][axis]), std::signbit(b.vertices[i][axis]));
    }
  }
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.points, b.points);
}

TEST(MeshWrite, EveryDoubleComesBack) {
  const TemporaryFolder folder;
  for (const char* name : {"a.obj", "a.off", "a.ply"}) {
    const TriangleMesh mesh = random_mesh(1, false);
    write_mesh(folder / name, mesh);
    expect_same(read_mesh(folder / name), mesh);
  }
  EXPECT_EQ(folder.entries(), 3);
}

TEST(MeshWrite, StlKeepsTrianglesInSinglePrecision) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = random_mesh(2, true);
  write_mesh(folder / "a.stl", mesh);
  EXPECT_EQ(file_content(folder / "a.stl").size(), 84 + 50 * mesh.triangles.size());
  // Reading welds, so corners are compared by position.
  const TriangleMesh read = read_mesh(folder / "a.stl");
  std::vector<Vec3d> expected;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // welding removes these
    for (const std::uint32_t index : t) expected.push_back(mesh.vertices[index]);
  }
  std::vector<Vec3d> found;
  for (const Triangle& t : read.triangles) {
    for (const std::uint32_t index : t) found.push_back(read.vertices[index]);
  }
  EXPECT_EQ(found, expected);
}

TEST(MeshWrite, StlNormalsAreUnitOrZero) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = {.vertices = {{0, 0, 0}, {1e-30, 0, 0}, {0, 1e30, 0}, {0, 2e30, 0}},
                             .triangles = {{0, 1, 2}, {0, 2, 3}}};
  write_mesh(folder / "a.stl", mesh);
  const std::string bytes = file_content(folder / "a.stl");
  float normal[3];
  std::memcpy(normal, bytes.data() + 84, sizeof(normal));
  EXPECT_EQ(normal[2], 1.0F);
  std::memcpy(normal, bytes.data() + 134, sizeof(normal));
  EXPECT_EQ(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 0.0F);
}

TEST(MeshWrite, SegmentsAndPoints) {
  const TemporaryFolder folder;
  TriangleMesh mesh = {
      .vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 3, 3}}, .triangles = {{0, 1, 2}}, .segments = {{2, 3}}};
  write_mesh(folder / "a.ply", mesh);
  expect_same(read_mesh(folder / "a.ply"), mesh);
  mesh.points = {3, 1};
  write_mesh(folder / "a.obj", mesh);
  expect_same(read_mesh(folder / "a.obj"), mesh);

  const TriangleMesh cloud = {.vertices = mesh.vertices, .points = {0, 1, 2, 3}};
  for (const char* name : {"c.obj", "c.off", "c.ply"}) {
    write_mesh(folder / name, cloud);
    expect_same(read_mesh(folder / name), cloud);
  }
}

TEST(MeshWrite, UnwritableContentIsRefusedAndTheOldFileStays) {
  const TemporaryFolder folder;
  const std::vector<Vec3d> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  const TriangleMesh with_segment = {.vertices = vertices, .triangles = triangles, .segments = {{0, 1}}};
  const TriangleMesh with_point = {.vertices = vertices, .triangles = triangles, .points = {0}};
  const TriangleMesh part_of_cloud = {.vertices = vertices, .points = {0, 2}};
  const TriangleMesh far = {.vertices = {{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, .triangles = triangles};
  const TriangleMesh nan_vertex = {.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, std::nan(""), 0}},
                                   .triangles = triangles};
  for (const char* name : {"a.off", "a.stl", "a.ply", "a.obj"}) test::put_file(folder / name, "old");
  for (const char* name : {"a.off", "a.stl"}) EXPECT_THROW(write_mesh(folder / name, with_segment), FileError);
  for (const char* name : {"a.off", "a.stl", "a.ply"}) {
    EXPECT_THROW(write_mesh(folder / name, with_point), FileError);
    EXPECT_THROW(write_mesh(folder / name, part_of_cloud), FileError);
  }
  EXPECT_THROW(write_mesh(folder / "a.stl", far), FileError);
  EXPECT_THROW(write_mesh(folder / "a.obj", nan_vertex), InvalidMesh);
  EXPECT_THROW(write_mesh(folder / "a.obj", TriangleMesh{}), InvalidMesh);
  EXPECT_THROW(write_mesh(folder / "a.gltf", with_point), FileError);
  for (const char* name : {"a.off", "a.stl", "a.ply", "a.obj"}) EXPECT_EQ(file_content(folder / name), "old");
  EXPECT_EQ(folder.entries(), 4);
}

TEST(MeshWrite, TextIsTheShortestThatReadsBack) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.off",
             TriangleMesh{.vertices = {{0.1, 1, -2.5}, {1e300 * 1e-160, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}});
  EXPECT_EQ(file_content(folder / "a.off"), "OFF\n3 1 0\n 0.1 1 -2.5\n 1e+140 0 0\n 0 1 0\n3 0 1 2\n");
}

}  // namespace
}  // namespace blum
