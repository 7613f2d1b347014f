// Proves that certificates compute the known Betti numbers of solids, equal to those of topology(). Meshes that do not
// bound a solid are rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "certificate/solid_oracle.hpp"
#include "support/data.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::box_between;

/// The Betti numbers that the verifier computes for an unchanged mesh.
BettiNumbers solid_of(const MeshView& mesh) {
  BettiNumbers sum{};
  for (const BettiNumbers& body : verifier::solid_of_mesh(mesh, mesh, {}).bodies) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += body[k];
  }
  return sum;
}

/// Reverses some of the shells of a mesh.
TriangleMesh some_shells_turned(TriangleMesh mesh, std::uint64_t seed) {
  Random random(seed);
  // Parts that share no vertex are reversed as a whole, so the mesh stays consistently oriented.
  std::vector<std::uint32_t> part(mesh.vertices.size());
  for (std::uint32_t v = 0; v < part.size(); ++v) part[v] = v;
  const auto root = [&](std::uint32_t v) {
    while (part[v] != v) v = part[v] = part[part[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles) {
    part[root(t[1])] = root(t[0]);
    part[root(t[2])] = root(t[0]);
  }
  std::vector<bool> is_reversed(mesh.vertices.size());
  for (std::size_t v = 0; v < is_reversed.size(); ++v) is_reversed[v] = random.uniform() < 0.5;
  for (Triangle& t : mesh.triangles) {
    if (is_reversed[root(t[0])]) std::swap(t[1], t[2]);
  }
  return mesh;
}

TEST(SolidBetti, CatalogueShapesHaveTheirNumbersInAnyOrientation) {
  int shapes = 0;
  for (const ShapeInfo& shape : shape_catalog()) {
    const ShapeParameters parameters = complete_parameters(shape, {});
    const auto known = shape.betti(parameters);
    if (!known) continue;
    const TriangleMesh mesh = shape.make(parameters);
    EXPECT_EQ(topology(mesh).betti, known) << shape.name;
    EXPECT_EQ(solid_of(mesh), *known) << shape.name;
    EXPECT_EQ(solid_of(some_shells_turned(mesh, 5)), *known) << shape.name << ", turned";
    ++shapes;
  }
  EXPECT_GT(shapes, 15);
}

TEST(SolidBetti, NestedShells) {
  EXPECT_EQ(solid_of(make_nested_shells({.shells = 60, .frequency = 2})), (BettiNumbers{30, 0, 30}));
  EXPECT_EQ(solid_of(some_shells_turned(make_bodies({.count = 1000}), 1)), (BettiNumbers{1000, 0, 0}));
  TriangleMesh mesh = make_torus({});
  append(mesh, make_torus({.tube_radius = 0.2}));
  append(mesh, make_torus({.tube_radius = 0.1}));
  append(mesh, make_box({{0.2, 0.2, 0.2}, {1, 1, 1}}));  // in the hole of the ring and therefore in none of its shells
  EXPECT_EQ(solid_of(mesh), (BettiNumbers{3, 3, 1}));
}

TEST(SolidBetti, ShellsThatTouch) {
  // Boxes lie on each other, side by side and corner to corner. Bodies stay separate.
  TriangleMesh stacked = box_between({0, 0, 0}, {1, 1, 1});
  append(stacked, box_between({0, 0, 1}, {1, 1, 2}));
  append(stacked, box_between({1, 0, 0}, {2, 1, 1}));
  append(stacked, box_between({2, 1, 1}, {3, 2, 2}));
  EXPECT_EQ(solid_of(stacked), (BettiNumbers{4, 0, 0}));
  // One void reaches the walls from within. Another touches them in a face and an edge.
  TriangleMesh hollow = box_between({0, 0, 0}, {2, 2, 2});
  append(hollow, box_between({0, 0.5, 0.5}, {1, 1, 1}, true));
  append(hollow, box_between({1, 0, 1}, {1.5, 0.5, 2}, true));
  EXPECT_EQ(solid_of(hollow), (BettiNumbers{1, 0, 2}));
  // A body in the void touches it from within.
  append(hollow, box_between({0, 0.5, 0.5}, {0.5, 0.75, 1}));
  EXPECT_EQ(solid_of(hollow), (BettiNumbers{2, 0, 2}));
  EXPECT_EQ(solid_of(some_shells_turned(hollow, 2)), (BettiNumbers{2, 0, 2}));
}

/// Cuts a box into parts along random planes. Some parts get a shell that fills them or nearly so, and are cut again.
/// Shells touch their neighbours and the shells around them in whole faces. Counts shells by depth.
void add_nested_boxes(const Vec3d& lower, const Vec3d& upper, int depth, Random& random, TriangleMesh& mesh,
                      BettiNumbers& betti) {
  append(mesh, box_between(lower, upper, random.uniform() < 0.5));
  ++betti[depth % 2 == 0 ? 0 : 2];
  if (depth == 4) return;
  const Vec3d cut = lower + (upper - lower) * random.uniform(0.3, 0.7);
  for (std::size_t part = 0; part < 8; ++part) {
    if (random.uniform() < 0.6) continue;
    Vec3d from = lower;
    Vec3d to = upper;
    for (std::size_t a = 0; a < 3; ++a) ((part >> a & 1U) == 0 ? to : from)[a] = cut[a];
    if (random.uniform() < 0.5) from += (to - from) * 0.125;
    add_nested_boxes(from, to, depth + 1, random, mesh, betti);
  }
}

TEST(SolidBetti, RandomBoxesInBoxes) {
  Random random(21);
  std::size_t most = 0;
  for (int trial = 0; trial < 40; ++trial) {
    TriangleMesh mesh;
    BettiNumbers expected{0, 0, 0};
    add_nested_boxes({0, 0, 0}, {4, 4, 4}, 0, random, mesh, expected);
    most = std::max(most, mesh.triangles.size() / 12);
    ASSERT_EQ(solid_of(mesh), expected) << "trial " << trial;
    ASSERT_EQ(solid_of(test::moved(mesh, 1e-3, {-7000, 3, 1})), expected) << "trial " << trial << ", far away";
  }
  EXPECT_GT(most, 50U) << "shells";
}

TEST(SolidBetti, RealMeshes) {
  for (const char* name : {"spot.obj", "fandisk.obj", "rocker-arm.obj", "3holes.off", "eight.off", "ballcube.off",
                           "plate_holes.STL", "torus.STL", "round.stl", "abc5.stl"}) {
    const auto file = test::data_file(std::string("meshes/") + name);
    if (!file) GTEST_SKIP() << test::no_data(std::string("meshes/") + name);
    const TriangleMesh mesh = read_mesh(*file, {.weld = 0});
    EXPECT_EQ(topology(mesh).betti, solid_of(mesh)) << name;
  }
}

/// The message with which a mesh is rejected.
std::string refusal(const MeshView& mesh) {
  try {
    (void)solid_of(mesh);
  } catch (const InvalidMesh& error) {
    return error.what();
  }
  return {};
}

TEST(SolidBetti, DoesNotDependOnTheOrientationOfTriangles) {
  TriangleMesh torus = make_torus({});
  Random random(31);
  for (Triangle& t : torus.triangles) {
    if (random.uniform() < 0.5) std::swap(t[1], t[2]);
  }
  EXPECT_EQ(certify({}, torus, {.positions = false}).solid, (BettiNumbers{1, 1, 0}));
}

TEST(SolidBetti, RejectsMeshesThatBoundNoSolid) {
  const auto says = [](const MeshView& mesh, const std::string& words) {
    const std::string message = refusal(mesh);
    EXPECT_NE(message.find(words), std::string::npos) << words << " in: " << message;
  };
  TriangleMesh open = make_box({});
  open.triangles.pop_back();
  says(open, "not closed and manifold");
  // The smallest projective plane: six vertices in general position. It is closed and manifold, and has one side only.
  TriangleMesh one_sided;
  one_sided.vertices = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0.3}, {0.4, 0.3, 1}, {1, 1.1, 0.9}, {0.1, 0.7, 1.2}};
  one_sided.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 1},
                         {1, 2, 4}, {2, 3, 5}, {3, 4, 1}, {4, 5, 2}, {5, 1, 3}};
  says(one_sided, "only one side");
  TriangleMesh doubled = make_box({});
  doubled.triangles.insert(doubled.triangles.end(), doubled.triangles.begin(), doubled.triangles.end());
  says(doubled, "4 triangles instead of two");
  TriangleMesh pair = box_between({0, 0, 0}, {1, 1, 1});
  append(pair, box_between({1, 1, 1}, {2, 2, 2}));
  const auto first = std::find(pair.vertices.begin(), pair.vertices.end(), Vec3d{1, 1, 1}) - pair.vertices.begin();
  for (Triangle& t : pair.triangles) {
    for (std::uint32_t& v : t) {
      if (pair.vertices[v] == Vec3d{1, 1, 1}) v = static_cast<std::uint32_t>(first);
    }
  }
  says(pair, "meet only in vertex " + std::to_string(first));
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  says(flat, "the shell that contains triangle 0 encloses no volume");
  TriangleMesh twice = make_box({});
  append(twice, make_box({}));
  says(twice, "same volume at the same place");
  TriangleMesh points = make_points({});
  says(points, "bounds nothing");
  TriangleMesh degenerate = make_box({});
  degenerate.triangles.push_back({0, 0, 1});
  EXPECT_EQ(refusal(degenerate), "");
}

}  // namespace
}  // namespace blum
