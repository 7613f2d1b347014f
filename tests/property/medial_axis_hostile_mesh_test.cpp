// Proves the results of medial_axis() for meshes that are not clean solids. The tests use reversed and nested shells,
// open and crossing surfaces, parts thinner than a voxel, and touching bodies. Meshes without an interior are rejected.
#include <gtest/gtest.h>

#include <algorithm>

#include "blum/geometry/topology.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/data.hpp"
#include "support/medial_check.hpp"
#include "support/medial_rows.hpp"
#include "support/mesh_places.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::VertexRow;

constexpr MedialAxisOptions coarse{.resolution = 48};

TEST(MedialHostileMesh, ShapesThatFaceInwardsAreReversed) {
  for (const char* const name : {"box", "torus", "plate", "void_cube", "linked_tori"}) {
    SCOPED_TRACE(name);
    TriangleMesh mesh = make_shape(name);
    const Topology right = topology(mesh);
    reverse_triangles(mesh);
    const MedialAxis axis = medial_axis(mesh, coarse);
    EXPECT_EQ(axis.report().reversed_shells, right.shells.size());
    test::expect_certified(axis, mesh, right.betti.value());
  }
}

TEST(MedialHostileMesh, NestedShellsMayFaceEitherWay) {
  for (const bool is_outer_turned : {false, true}) {
    for (const bool is_void_turned : {false, true}) {
      TriangleMesh mesh = test::box_between({-1, -1, -1}, {1, 1, 1}, is_outer_turned);
      append(mesh, test::box_between({-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7}, is_void_turned));
      append(mesh, test::box_between({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3}, is_outer_turned));
      const MedialAxis axis = medial_axis(mesh, coarse);
      EXPECT_EQ(axis.report().reversed_shells, (is_outer_turned ? 2U : 0U) + (is_void_turned ? 0U : 1U));
      EXPECT_EQ(axis.report().bodies.size(), 2U);
      test::expect_certified(axis, mesh, {2, 0, 1});
    }
  }
}

TEST(MedialHostileMesh, ReversingShellsMovesNothing) {
  TriangleMesh mesh = make_shape("bracket");
  const AxisRows straight = medial_axis(mesh, coarse).simplify(60);
  reverse_triangles(mesh);
  const AxisRows turned = medial_axis(mesh, coarse).simplify(60);
  EXPECT_EQ(test::positions(turned), test::positions(straight));
}

/// At 1e10, coordinates have steps of 2e-6, a millionth of the box. Search and placement then end on the surface, which
/// once caused a read beyond the end of a list. A bracket at 1e9 took minutes and got no certificate.
TEST(MedialHostileMesh, FarFromTheOriginItIsRightOrRefused) {
  for (const double place : {1e5, 3e6}) {
    const TriangleMesh mesh = test::box_between({place, place, 0}, {place + 2, place + 1, 0.5}, false);
    const MedialAxis axis = medial_axis(mesh, coarse);
    test::expect_certified(axis, mesh, {1, 0, 0});
  }
  for (const double place : {1e7, 1e10, 1e14}) {
    const TriangleMesh mesh = test::box_between({place, place, 0}, {place + 2, place + 1, 0.5}, false);
    EXPECT_THROW((void)medial_axis(mesh, coarse), InvalidMesh);
  }
}

/// Returns the voxels whose centres lie inside, by winding number, a mesh that does not bound a polyhedron.
VoxelSet wound_voxels(const MeshView& mesh, const GridSpec& grid) {
  const Field field = distance_field(mesh, grid, {.sign = SignMode::winding});
  VoxelSet voxels(grid.size);
  test::for_each_voxel(grid.size, 1, [&](auto i, auto j, auto k) {
    if (field.distance[grid.index(i, j, k)] < 0) voxels.insert(i, j, k);
  });
  return voxels;
}

/// Expects that a mesh that does not bound a polyhedron gives an axis with the topology of its voxels.
void expect_axis_of_voxels(const MeshView& mesh, const MedialAxisOptions& options) {
  const MedialAxis axis = medial_axis(mesh, options);
  EXPECT_EQ(axis.report().rule, SolidRule::winding);
  EXPECT_FALSE(axis.report().reason.empty());
  EXPECT_GE(axis.report().betti[0], 1);
  test::expect_betti(axis, axis.report().betti);
  const AxisRows complex = axis.simplify(60);
  test::expect_exact_balls(complex, mesh);
  const GridSpec& grid = axis.report().grid;
  const Certificate certificate = certify(complex, wound_voxels(mesh, grid), grid, &mesh, {.balls = false});
  for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << mismatch;
}

TEST(MedialHostileMesh, OpenSurfacesAreSolidWhereTheWindingNumberExceedsOneHalf) {
  for (const int holes : {1, 6, 12}) {
    SCOPED_TRACE(holes);
    expect_axis_of_voxels(make_organic({.frequency = 24, .holes = holes}), coarse);
  }
}

TEST(MedialHostileMesh, ABoxWithoutALidIsABox) {
  TriangleMesh mesh = make_box({.size = {1, 1, 1}, .segments = {8, 8, 8}});
  const auto is_in_lid = [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      const Vec3d& p = mesh.vertices[v];
      return p.z > 0.49 && std::abs(p.x) < 0.3 && std::abs(p.y) < 0.3;
    });
  };
  EXPECT_GT(std::erase_if(mesh.triangles, is_in_lid), 4U);
  expect_axis_of_voxels(mesh, coarse);
  EXPECT_EQ(medial_axis(mesh, coarse).report().betti, (BettiNumbers{1, 0, 0}));
}

/// The certificate looks for missing parts with balls between the walls of the mesh. The voxel faces that close the
/// hole are not walls.
TEST(MedialHostileMesh, ABoxWithoutALidIsJudgedByItsWalls) {
  TriangleMesh mesh = make_box({});
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.vertices[v].z > 0; });
  });
  ASSERT_EQ(mesh.triangles.size(), 10U);
  const MedialAxis axis = medial_axis(mesh, {.resolution = 32});
  const MeshView view(mesh);
  const GridSpec& grid = axis.report().grid;
  const VoxelSet voxels = wound_voxels(mesh, grid);
  for (const double theta : {20.0, 60.0}) {
    const Certificate certificate = certify(axis.fitted(theta), voxels, grid, &view, {.theta = theta, .lambda = 0});
    for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << theta << ": " << mismatch;
    EXPECT_GT(certificate.medial.medial_share, 0.99) << theta;
    EXPECT_GT(certificate.medial.balls, 500U) << theta;
  }
}

TEST(MedialHostileMesh, SelfCrossingSurfacesBoundTheUnionOfTheirParts) {
  TriangleMesh boxes = test::box_between({0, 0, 0}, {2, 1, 1});
  append(boxes, test::box_between({1.3, 0.2, 0.2}, {3, 0.8, 1.7}));
  test::expect_certified(medial_axis(boxes, coarse), boxes, {1, 0, 0});
  TriangleMesh tori = make_torus();
  append(tori, make_torus(), {1.3, 0, 0});
  test::expect_certified(medial_axis(tori, coarse), tori, {1, 3, 0});
}

TEST(MedialHostileMesh, InconsistentTrianglesAreReversed) {
  TriangleMesh mesh = make_sphere({.frequency = 10});
  TriangleMesh agreeing = mesh;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    // A triangle that is reversed back starts at its second corner. That matters, because rounding decides which of a
    // sphere's triangles is closer.
    std::rotate(agreeing.triangles[t].begin(), agreeing.triangles[t].begin() + 1, agreeing.triangles[t].end());
  }
  const AxisRows right = medial_axis(agreeing, coarse).simplify(60);
  const MedialAxis axis = medial_axis(mesh, coarse);
  test::expect_certified(axis, mesh, {1, 0, 0});
  EXPECT_EQ(test::positions(axis.simplify(60)), test::positions(right));
}

TEST(MedialHostileMesh, DuplicateTrianglesAreNotAPolyhedron) {
  TriangleMesh mesh = make_box({.size = {1, 2, 1}, .segments = {4, 4, 4}});
  mesh.triangles.push_back(mesh.triangles.front());
  expect_axis_of_voxels(mesh, coarse);
}

class MedialHostileRealMesh : public testing::TestWithParam<std::string> {};

TEST_P(MedialHostileRealMesh, HasTheAxisOfItsVoxels) {
  const std::string name = "meshes/" + GetParam();
  const auto file = test::data_file(name);
  if (!file) GTEST_SKIP() << test::no_data(name);
  expect_axis_of_voxels(read_mesh(*file), {.resolution = 64});
}
INSTANTIATE_TEST_SUITE_P(Data, MedialHostileRealMesh,
                         testing::Values("stanford-bunny.obj", "featuretype.STL", "not_convex.obj"),
                         [](const auto& info) { return test::test_name(info.param); });

/// Returns the message of the error that a call throws; empty if it throws none.
template <class Thrown, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Thrown& error) {
    return error.what();
  }
  return "";
}

void expect_no_interior(const MeshView& mesh, const char* why) {
  SCOPED_TRACE(why);
  const std::string message = message_of<InvalidMesh>([&] { (void)medial_axis(mesh, coarse); });
  EXPECT_NE(message.find("interior"), std::string::npos) << "message: " << message;
}

TEST(MedialHostileMesh, MeshesWithoutInteriorAreRejected) {
  expect_no_interior(make_points({.points = 50}), "points");
  expect_no_interior(make_segments({.segments = 50}), "segments");
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}}, {}, {}};
  expect_no_interior(mesh, "one triangle");
  mesh.triangles.push_back({1, 3, 2});
  expect_no_interior(mesh, "a square");
  mesh.triangles.push_back({0, 2, 1});
  mesh.triangles.push_back({1, 2, 3});
  expect_no_interior(mesh, "a square from both sides");
  expect_no_interior({mesh.vertices, std::span(mesh.triangles).first(0), {}, std::array<std::uint32_t, 1>{0}},
                     "a point");
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  expect_no_interior(mesh, "a triangle from both sides");
  mesh.vertices = {{2, 2, 2}, {2, 2, 2}, {2, 2, 2}, {2, 2, 2}};
  expect_no_interior(mesh, "triangles without size");
}

TEST(MedialHostileMesh, ARealMeshWithInconsistentTrianglesIsTwoBodies) {
  const auto file = test::data_file("meshes/multibody.stl");
  if (!file) GTEST_SKIP() << test::no_data("meshes/multibody.stl");
  test::expect_certified(medial_axis(read_mesh(*file), coarse), read_mesh(*file), {2, 0, 0});
}

TEST(MedialHostileMesh, OpenMeshesThatFaceInwardsAreRejected) {
  TriangleMesh mesh = make_box({.size = {1, 2, 1}, .segments = {4, 4, 4}});
  mesh.triangles.pop_back();
  reverse_triangles(mesh);
  expect_no_interior(mesh, "an open box that faces inwards");
}

TEST(MedialHostileMesh, InvalidMeshesAreRejected) {
  EXPECT_THROW((void)medial_axis(MeshView{}), InvalidMesh);
  TriangleMesh mesh = make_box({});
  mesh.vertices[3].y = std::nan("");
  EXPECT_THROW((void)medial_axis(mesh), InvalidMesh);
  mesh = make_box({});
  mesh.triangles[5][1] = 8;
  EXPECT_THROW((void)medial_axis(mesh), InvalidMesh);
}

TEST(MedialHostileMesh, LooseTrianglesAreRefusedOrHaveTheAxisOfTheirVoxels) {
  const auto file = test::data_file("meshes/soup.stl");
  if (!file) GTEST_SKIP() << test::no_data("meshes/soup.stl");
  for (const TriangleMesh& mesh : {read_mesh(*file), make_soup({.awkward = 0.5})}) {
    const std::string refusal = message_of<InvalidMesh>([&] { expect_axis_of_voxels(mesh, coarse); });
    if (!refusal.empty()) {
      EXPECT_NE(refusal.find("interior"), std::string::npos) << refusal;
    }
  }
}

/// Returns a grid of points in the mid-surface of a box whose sides are 1 or `thin`. The points keep a distance of
/// `thin` from its borders.
std::vector<Vec3d> middle_of(const Vec3d& size, double thin) {
  std::vector<Vec3d> points;
  const auto steps = [&](double side) { return side > thin ? 40 : 0; };
  for (int i = 0; i <= steps(size.x); ++i) {
    for (int j = 0; j <= steps(size.y); ++j) {
      const double y = steps(size.y) > 0 ? (j / 40.0 - 0.5) * (size.y - 2 * thin) : 0;
      points.push_back({(i / 40.0 - 0.5) * (size.x - 2 * thin), y, 0});
    }
  }
  return points;
}

TEST(MedialHostileMesh, PartsThinnerThanAVoxelAreKeptWhole) {
  for (const double thickness : {0.02, 0.01, 0.002, 1e-4}) {
    for (const Mat3& turn : {Mat3{}, test::rotation({1, 2, 3}, 40)}) {
      for (const Vec3d& size : {Vec3d{1, 1, thickness}, Vec3d{1, thickness, thickness}}) {
        SCOPED_TRACE(testing::Message() << size.x << " x " << size.y << " x " << size.z);
        const TriangleMesh mesh = test::turned(make_box({.size = size}), turn);
        const MedialAxis axis = medial_axis(mesh, coarse);
        test::expect_certified(axis, mesh, {1, 0, 0});
        const AxisRows complex = axis.simplify(60);
        test::expect_exact_balls(complex, mesh);
        std::vector<double> radii;
        for (const VertexRow& vertex : complex.vertices) radii.push_back(vertex.radius);
        std::sort(radii.begin(), radii.end());
        // The axis of a wire also has sheets towards the wire's edges.
        const bool is_wire = size.y < 1;
        EXPECT_GT(radii[radii.size() / (is_wire ? 10 : 20)], (is_wire ? 0.02 : 0.1) * thickness)
            << "inside, and not on the surface";
        EXPECT_NEAR(radii[radii.size() / 2], 0.5 * thickness, is_wire ? 0.3 * thickness : 1e-9);
        std::vector<Vec3d> middle = middle_of(size, thickness);
        for (Vec3d& point : middle) point = turn * point;
        const double bound = test::voxel_diagonal(axis);
        EXPECT_LE(test::furthest_from(test::shape_of(complex), middle), bound) << "the middle is all there";
      }
    }
  }
}

TEST(MedialHostileMesh, AThinFinOnABlockIsKeptWhole) {
  TriangleMesh mesh = make_box({.size = {1, 1, 1}, .segments = {1, 1, 3}});
  // The fin is the middle third of a side, drawn out. The vertices at z = +-1/6 move together where the fin begins.
  constexpr double half = 5e-4;
  for (Vec3d& p : mesh.vertices) {
    if (std::abs(p.z) < 0.4) p.z = std::copysign(half, p.z);
  }
  std::uint32_t corner[2][2] = {};  // on the side x = 1/2: y, z
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3d& p = mesh.vertices[v];
    if (p.x > 0.4 && std::abs(p.z) < 0.1) corner[p.y > 0][p.z > 0] = v;
  }
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return v == corner[0][0] || v == corner[0][1] || v == corner[1][0] || v == corner[1][1];
    });
  });
  std::uint32_t tip[2][2] = {};
  for (const int y : {0, 1}) {
    for (const int z : {0, 1}) {
      tip[y][z] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(mesh.vertices[corner[y][z]] + Vec3d{2, 0, 0});
    }
  }
  const auto add_side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  add_side(tip[0][0], tip[1][0], tip[1][1], tip[0][1]);
  add_side(corner[0][1], tip[0][1], tip[1][1], corner[1][1]);
  add_side(corner[1][0], tip[1][0], tip[0][0], corner[0][0]);
  add_side(corner[0][0], tip[0][0], tip[0][1], corner[0][1]);
  add_side(corner[1][1], tip[1][1], tip[1][0], corner[1][0]);
  const MedialAxis axis = medial_axis(mesh, coarse);
  test::expect_certified(axis, mesh, {1, 0, 0});
  const AxisRows complex = axis.simplify(60);
  test::expect_exact_balls(complex, mesh);
  std::vector<Vec3d> middle;
  for (int n = 0; n <= 40; ++n) middle.push_back({0.5 + 1.95 * n / 40, 0.45 * std::sin(n), 0});
  EXPECT_LE(test::furthest_from(test::shape_of(complex), middle), test::voxel_diagonal(axis));
}

TEST(MedialHostileMesh, AThinPlateKeepsItsHoles) {
  for (const double thickness : {0.02, 0.005}) {
    SCOPED_TRACE(thickness);
    test::expect_certified(medial_axis(make_plate({.thickness = thickness}), coarse),
                           make_plate({.thickness = thickness}), {1, 6, 0});
  }
}

/// Vertices on opposite sides of a narrow hole may see each other. Edges and triangles must still follow the solid
/// around the hole.
TEST(MedialHostileMesh, NoTriangleSpansAHoleNarrowerThanAVoxel) {
  for (const double radius : {0.02, 0.005}) {
    for (const int holes : {1, 2}) {
      SCOPED_TRACE(::testing::Message() << "radius " << radius << ", holes " << holes * holes);
      const TriangleMesh plate = test::turned(make_plate({.holes_x = holes, .holes_y = holes, .hole_radius = radius}));
      const MedialAxis axis = medial_axis(plate, {.resolution = 24});
      for (const Complex& complex : {axis.simplify(20), axis.fitted(20), axis.fitted(60)}) {
        const Certificate found = certify(complex, plate);
        EXPECT_TRUE(found.holds());
        EXPECT_EQ(found.homology.across, 0U);
        EXPECT_EQ(found.homology.proven, Proven::homology) << found.homology.shown;
      }
    }
  }
}

TEST(MedialHostileMesh, BodiesThatTouchStayApart) {
  const TriangleMesh box = test::box_between({0, 0, 0}, {1, 1, 1});
  for (const Vec3d& offset : {Vec3d{1, 0, 0}, Vec3d{1, 0.3, 0.2}, Vec3d{1, 1, 0}, Vec3d{1, 1, 1}, Vec3d{1.001, 0, 0}}) {
    SCOPED_TRACE(testing::Message() << offset.x << " " << offset.y << " " << offset.z);
    TriangleMesh mesh = box;
    append(mesh, box, offset);
    test::expect_certified(medial_axis(mesh, coarse), mesh, {2, 0, 0});
  }
}

TEST(MedialHostileMesh, AVoidMayReachTheSurfaceUpToAThinWall) {
  TriangleMesh mesh = test::box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, test::box_between({0.3, 0.3, 0.3}, {0.7, 0.7, 0.995}, true));
  test::expect_certified(medial_axis(mesh, coarse), mesh, {1, 0, 1});
}

TEST(MedialHostileMesh, SizeAndPlaceDoNotMatter) {
  const TriangleMesh mesh = make_shape("plate", {{"holes_x", 2}, {"holes_y", 1}});
  for (const double scale : {1e-9, 1e6, 1e12}) {
    SCOPED_TRACE(scale);
    test::expect_certified(medial_axis(test::moved(mesh, scale, Vec3d{40, -70, 10} * scale), coarse),
                           test::moved(mesh, scale, Vec3d{40, -70, 10} * scale), {1, 2, 0});
  }
}

}  // namespace
}  // namespace blum
