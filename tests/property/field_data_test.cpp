// Proves the precision promise on real meshes, on every back end. Every node of a 64^3 grid is compared with the exact
// hierarchy, random nodes also with brute force. Random nodes of a 200^3 grid are compared with both. On the host,
// where kernels are slow, the grids have 32^3 and 64^3 nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "blum/field/field.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/solid/oriented_mesh.hpp"
#include "support/back_ends.hpp"
#include "support/data.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

class SlowRealMeshes : public test::NamedBackEndTest {};

TEST_P(SlowRealMeshes, KeepThePromise) {
  const std::string path = "meshes/" + name();
  const auto file = test::data_file(path);
  if (!file) GTEST_SKIP() << test::no_data(path);
  const TriangleMesh mesh = read_mesh(*file);
  // Half of the triangles of multibody.stl face the wrong way.
  const bool is_mixed = name() == "multibody.stl";
  const TriangleMesh facing_outwards = is_mixed ? oriented_mesh(mesh).mesh : mesh;
  const std::size_t brute_nodes = 10 + 1'000'000 / mesh.triangles.size();
  const int every_node = usually(64, 32);
  for (const int resolution : {every_node, usually(200, 64)}) {
    const GridSpec grid = grid_around(bounds(mesh), resolution);
    const Field field = distance_field(mesh, grid, {.sign = SignMode::automatic}, context({.threads = 2}));
    EXPECT_EQ(field.warnings.empty(), !is_mixed);
    const auto nodes = resolution == every_node ? test::all_nodes(grid) : test::random_nodes(grid, 2000);
    expect_promise(test::compare_with_bvh(field, facing_outwards, nodes));
    expect_promise(test::compare_with_brute_force(field, facing_outwards,
                                                  test::random_nodes(grid, std::min<std::size_t>(brute_nodes, 500))));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Data, SlowRealMeshes,
    testing::Combine(testing::Values("stanford-bunny.obj", "spot.obj", "fandisk.obj", "rocker-arm.obj", "3holes.off",
                                     "screwdriver.off", "eight.off", "ballcube.off", "plate_holes.STL", "torus.STL",
                                     "round.stl", "7_8ths_cube.stl", "abc5.stl", "abc7.stl", "abc9.stl",
                                     "featuretype.STL", "soup.stl", "not_convex.obj", "multibody.stl"),
                     test::every_back_end()),
    test::name_and_back_end);

}  // namespace
}  // namespace blum
