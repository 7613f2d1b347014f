// Proves that topology() finds the known facts of real meshes, read from files.
#include <gtest/gtest.h>

#include <cctype>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/geometry/topology.hpp"
#include "blum/io/mesh_io.hpp"
#include "support/data.hpp"

namespace blum {
namespace {

Topology read_topology(const std::filesystem::path& file) {
  MeshReadOptions options;
  options.weld = 0;
  return topology(read_mesh(file, options));
}

struct ClosedMesh {
  std::string name;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::int64_t genus = 0;
  std::size_t shells = 1;
};

class DataTopology : public testing::TestWithParam<ClosedMesh> {};

TEST_P(DataTopology, ClosedMeshHasItsGenus) {
  const ClosedMesh& known = GetParam();
  const auto file = test::data_file("meshes/" + known.name);
  if (!file) GTEST_SKIP() << test::no_data("meshes/" + known.name);
  const Topology t = read_topology(*file);
  EXPECT_EQ(t.named_vertices, known.vertices);
  EXPECT_EQ(t.triangles, known.triangles);
  EXPECT_TRUE(t.closed);
  EXPECT_TRUE(t.oriented);
  EXPECT_TRUE(t.manifold);
  EXPECT_TRUE(t.faces_outwards);
  EXPECT_EQ(t.shells.size(), known.shells);
  std::int64_t genus = 0;
  for (const Shell& shell : t.shells) genus += shell.genus;
  EXPECT_EQ(genus, known.genus);
  ASSERT_TRUE(t.betti.has_value());
  EXPECT_EQ((*t.betti)[1], known.genus);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, DataTopology,
    testing::Values(ClosedMesh{"spot.obj", 2930, 5856, 0}, ClosedMesh{"fandisk.obj", 6475, 12946, 0},
                    ClosedMesh{"rocker-arm.obj", 10044, 20088, 1}, ClosedMesh{"3holes.off", 3596, 7200, 3},
                    ClosedMesh{"screwdriver.off", 3395, 6786, 0}, ClosedMesh{"eight.off", 315, 634, 2},
                    ClosedMesh{"ballcube.off", 5434, 10884, 5}, ClosedMesh{"plate_holes.STL", 618, 1252, 5},
                    ClosedMesh{"torus.STL", 4350, 8700, 1}, ClosedMesh{"round.stl", 560, 1120, 1},
                    ClosedMesh{"7_8ths_cube.stl", 14, 24, 0}, ClosedMesh{"abc5.stl", 2560, 5080, 0, 10},
                    ClosedMesh{"abc7.stl", 254, 504, 0}, ClosedMesh{"abc9.stl", 632, 1260, 0}),
    [](const auto& param_info) {
      std::string name = "_" + param_info.param.name;
      for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      }
      return name;
    });

std::optional<Topology> topology_of(const std::string& name) {
  const auto file = test::data_file("meshes/" + name);
  if (!file) return std::nullopt;
  return read_topology(*file);
}

TEST(DataTopologyFacts, BunnyIsOpen) {
  const auto t = topology_of("stanford-bunny.obj");
  if (!t) GTEST_SKIP() << test::no_data("meshes/stanford-bunny.obj");
  EXPECT_EQ(t->vertices, 34834U + 1113U);
  EXPECT_EQ(t->named_vertices, 34834U);
  EXPECT_EQ(t->triangles, 69451U);
  EXPECT_EQ(t->boundary_edges, 223U);
  EXPECT_EQ(t->boundary_loops, 5U);
  EXPECT_FALSE(t->closed);
}

TEST(DataTopologyFacts, BrokenMeshesAreDescribed) {
  const auto feature_type = topology_of("featuretype.STL");
  if (!feature_type) GTEST_SKIP() << test::no_data("meshes/featuretype.STL");
  EXPECT_EQ(feature_type->boundary_edges, 576U);
  const auto soup = topology_of("soup.stl");
  ASSERT_TRUE(soup.has_value());
  EXPECT_EQ(soup->components, 100U);
  EXPECT_EQ(soup->boundary_edges, 300U);
  const auto not_convex = topology_of("not_convex.obj");
  ASSERT_TRUE(not_convex.has_value());
  EXPECT_EQ(not_convex->nonmanifold_edges, 12U);
  const auto multibody = topology_of("multibody.stl");
  ASSERT_TRUE(multibody.has_value());
  EXPECT_EQ(multibody->components, 2U);
  EXPECT_EQ(multibody->inconsistent_edges, 12U);
  EXPECT_FALSE(multibody->betti.has_value());
}

}  // namespace
}  // namespace blum
