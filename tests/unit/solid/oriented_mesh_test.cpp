// Proves that the triangles of closed meshes are made to face outwards, for any set of reversed triangles, and that the
// mesh stays otherwise unchanged. Meshes that cannot be oriented are rejected.
#include "blum/solid/oriented_mesh.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/mesh_places.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

class OrientedShapes : public testing::TestWithParam<std::string> {};

// A random share of the triangles is reversed. The topology, the vertices and the order of triangles stay.
TEST_P(OrientedShapes, AreRestored) {
  const TriangleMesh mesh = make_shape(GetParam());
  const Topology facts = topology(mesh, SiteTable(mesh));
  if (!facts.betti) GTEST_SKIP() << "bounds no solid";
  Random random(3);
  for (const double share : {0.0, 0.05, 0.2, 1.0}) {
    TriangleMesh given = mesh;
    std::size_t count = 0;
    for (Triangle& t : given.triangles) {
      if (!(random.uniform() < share)) continue;
      std::swap(t[1], t[2]);
      ++count;
    }
    const OrientedMesh out = oriented_mesh(given);
    EXPECT_EQ(out.mesh.vertices, mesh.vertices);
    EXPECT_EQ(topology(out.mesh, SiteTable(out.mesh)).betti, facts.betti);
    EXPECT_EQ(out.mesh.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& own = out.mesh.triangles[t];
      EXPECT_TRUE(own == mesh.triangles[t] || (own == Triangle{own[0], given.triangles[t][2], given.triangles[t][1]}));
      EXPECT_EQ(own[0], given.triangles[t][0]);
    }
    const bool is_same_way = share == 0 || share == 1;
    EXPECT_TRUE(!is_same_way || out.reversed_triangles == 0);
    EXPECT_TRUE(!is_same_way || out.reversed_shells == (share == 1 ? facts.shells.size() : 0));
    EXPECT_TRUE(share == 1 || out.reversed_shells > 0 || out.reversed_triangles == count);
  }
}

INSTANTIATE_TEST_SUITE_P(Catalog, OrientedShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& name) { return test::test_name(name.param); });

// A void faces the other way than its body: the same triangles, reversed, are correct.
TEST(OrientedMesh, VoidsFaceInwards) {
  TriangleMesh mesh = test::box_between({0, 0, 0}, {3, 3, 3});
  append(mesh, test::box_between({1, 1, 1}, {2, 2, 2}));
  EXPECT_FALSE(topology(mesh, SiteTable(mesh)).betti);
  const OrientedMesh out = oriented_mesh(mesh);
  EXPECT_EQ(out.reversed_shells, 1U);
  EXPECT_EQ(topology(out.mesh, SiteTable(out.mesh)).betti, (std::array<std::int64_t, 3>{1, 0, 1}));
}

std::string message_of(const TriangleMesh& mesh) {
  try {
    static_cast<void>(oriented_mesh(mesh));
  } catch (const InvalidMesh& error) {
    return error.what();
  }
  return "";
}

// Nested shells, four deep, in all combinations of orientations. Every second shell becomes a void.
TEST(OrientedMesh, NestedShells) {
  Random random(5);
  for (int turn = 0; turn < 16; ++turn) {
    TriangleMesh mesh;
    std::size_t wrong = 0;
    for (const double k : {0.0, 1.0, 2.0, 3.0}) {
      TriangleMesh shell = test::box_between({k, k, k}, {8 - k, 8 - k, 8 - k});
      const bool is_void = k == 1 || k == 3;
      const bool is_reversed = (turn >> static_cast<int>(k)) % 2 == 1;
      if (is_reversed) shell.triangles = reversed_triangles(shell.triangles);
      wrong += is_reversed != is_void ? 1U : 0U;
      append(mesh, shell);
    }
    mesh.segments = {{0, 1}};
    mesh.points = {3};
    const OrientedMesh out = oriented_mesh(mesh);
    EXPECT_EQ(out.reversed_shells, wrong);
    EXPECT_EQ(out.reversed_triangles, 0U);
    EXPECT_EQ(topology(out.mesh, SiteTable(out.mesh)).betti, (std::array<std::int64_t, 3>{2, 0, 2}));
    EXPECT_EQ(out.mesh.segments, mesh.segments);
    EXPECT_EQ(out.mesh.points, mesh.points);
  }
}

// Half of the triangles of a box are reversed. The half of the first triangle decides, so the other half is reversed.
// The shell is then reversed as a whole.
TEST(OrientedMesh, TiesAreDecidedByTheFirstTriangle) {
  const TriangleMesh box = make_box();
  TriangleMesh mesh = box;
  for (std::size_t t = 0; t < 6; ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const OrientedMesh out = oriented_mesh(mesh);
  EXPECT_EQ(out.mesh.triangles, box.triangles);
  EXPECT_EQ(out.reversed_triangles, 6U);
  EXPECT_EQ(out.reversed_shells, 1U);
}

TEST(OrientedMesh, RejectsMeshesThatCannotBeOriented) {
  TriangleMesh open = make_box();
  open.triangles.pop_back();
  EXPECT_NE(message_of(open).find("not closed"), std::string::npos);
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}};
  line.segments = {{0, 1}};
  EXPECT_NE(message_of(line).find("no triangles"), std::string::npos);
  // The projective plane with six vertices: each edge has two triangles.
  TriangleMesh projective;
  Random random(1);
  for (int k = 0; k < 6; ++k) projective.vertices.push_back(random.in_cube());
  projective.triangles = {{0, 1, 4}, {0, 1, 5}, {0, 2, 3}, {0, 2, 5}, {0, 3, 4},
                          {1, 2, 3}, {1, 2, 4}, {1, 3, 5}, {2, 4, 5}, {3, 4, 5}};
  EXPECT_NE(message_of(projective).find("only one side"), std::string::npos);
  TriangleMesh pillow;
  pillow.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  pillow.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_NE(message_of(pillow).find("encloses no volume"), std::string::npos);
  TriangleMesh twice = make_box();
  append(twice, make_box());
  EXPECT_NE(message_of(twice).find("coincide"), std::string::npos);
  TriangleMesh named = make_box();
  named.triangles[0][0] = 99;
  EXPECT_NE(message_of(named), "");
}

}  // namespace
}  // namespace blum
