// Proves the precision promise on real meshes: every node of a 64^3 grid against the exact hierarchy, random nodes of
// it against brute force, and random nodes of a 200^3 grid against both.
#include <gtest/gtest.h>

#include <cctype>

#include "blum/field/field.hpp"
#include "blum/io/mesh_io.hpp"
#include "support/data.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

class SlowRealMeshes : public testing::TestWithParam<std::string> {};

TEST_P(SlowRealMeshes, KeepThePromise) {
  const std::string name = "meshes/" + GetParam();
  const auto file = test::data_file(name);
  if (!file) GTEST_SKIP() << test::no_data(name);
  const TriangleMesh mesh = read_mesh(*file);
  const std::size_t brute_nodes = 10 + 1'000'000 / mesh.triangles.size();
  for (const int resolution : {64, 200}) {
    const GridSpec grid = grid_around(bounds(mesh), resolution);
    const Field field = distance_field(mesh, grid, {.sign = SignMode::automatic}, {.threads = 2});
    const auto nodes = resolution == 64 ? test::all_nodes(grid) : test::random_nodes(grid, 2000);
    expect_promise(test::compare_with_bvh(field, mesh, nodes));
    expect_promise(
        test::compare_with_brute_force(field, mesh, test::random_nodes(grid, std::min<std::size_t>(brute_nodes, 500))));
  }
}

INSTANTIATE_TEST_SUITE_P(Data, SlowRealMeshes,
                         testing::Values("stanford-bunny.obj", "spot.obj", "fandisk.obj", "rocker-arm.obj",
                                         "3holes.off", "screwdriver.off", "eight.off", "ballcube.off",
                                         "plate_holes.STL", "torus.STL", "round.stl", "7_8ths_cube.stl", "abc5.stl",
                                         "abc7.stl", "abc9.stl", "featuretype.STL", "soup.stl", "not_convex.obj",
                                         "multibody.stl"),
                         [](const auto& info) {
                           std::string name = info.param;
                           for (char& c : name) {
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace blum
