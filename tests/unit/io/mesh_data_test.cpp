// Proves that real files of every format have their known counts of vertices and triangles after exact welding.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blum/geometry/weld.hpp"
#include "blum/io/mesh_io.hpp"
#include "support/data.hpp"

namespace blum {
namespace {

struct Fact {
  const char* file;
  std::size_t vertices;  ///< those that a triangle names
  std::size_t triangles;
  std::size_t unreferenced = 0;
};

const std::vector<Fact> facts = {{"stanford-bunny.obj", 34834, 69451, 1113},
                                 {"spot.obj", 2930, 5856},
                                 {"fandisk.obj", 6475, 12946},
                                 {"rocker-arm.obj", 10044, 20088},
                                 {"3holes.off", 3596, 7200},
                                 {"screwdriver.off", 3395, 6786},
                                 {"eight.off", 315, 634},
                                 {"ballcube.off", 5434, 10884},
                                 {"plate_holes.STL", 618, 1252},
                                 {"torus.STL", 4350, 8700},
                                 {"round.stl", 560, 1120},
                                 {"7_8ths_cube.stl", 14, 24},
                                 {"abc5.stl", 2560, 5080},
                                 {"abc7.stl", 254, 504},
                                 {"abc9.stl", 632, 1260},
                                 {"featuretype.STL", 2010, 3476},
                                 {"soup.stl", 300, 100},
                                 {"not_convex.obj", 44, 96},
                                 {"multibody.stl", 20, 32}};

std::size_t named_vertices(const TriangleMesh& mesh) {
  std::vector<bool> named(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t index : t) named[index] = true;
  }
  return static_cast<std::size_t>(std::count(named.begin(), named.end(), true));
}

TEST(MeshData, CountsAfterExactWelding) {
  for (const Fact& fact : facts) {
    const std::string name = std::string("meshes/") + fact.file;
    const auto path = test::data_file(name);
    if (!path) GTEST_SKIP() << test::no_data(name);
    const TriangleMesh mesh = read_mesh(*path, {.weld = 0.0});
    EXPECT_EQ(named_vertices(mesh), fact.vertices) << fact.file;
    EXPECT_EQ(mesh.vertices.size(), fact.vertices + fact.unreferenced) << fact.file;
    EXPECT_EQ(mesh.triangles.size(), fact.triangles) << fact.file;
    EXPECT_TRUE(mesh.segments.empty() && mesh.points.empty()) << fact.file;
  }
}

TEST(MeshData, BigEndianPly) {
  for (const std::string name : {"ccd/cloth-ball/cloth_ball92.ply", "ccd/cloth-ball/cloth_ball93.ply"}) {
    const auto path = test::data_file(name);
    if (!path) GTEST_SKIP() << test::no_data(name);
    const TriangleMesh mesh = read_mesh(*path);
    EXPECT_EQ(mesh.vertices.size(), 46598U);
    EXPECT_EQ(mesh.triangles.size(), 92230U);
    const Box3 box = bounds(mesh);
    EXPECT_LT(box.diagonal(), 100.0);  // the wrong byte order gives coordinates of any size
    EXPECT_GT(box.diagonal(), 0.01);
  }
}

}  // namespace
}  // namespace blum
