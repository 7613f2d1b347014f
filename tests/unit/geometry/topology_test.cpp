// Proves that topology() describes surfaces correctly: tiny meshes with facts counted by hand, and nested shells
// compared with brute-force winding numbers. The time does not depend on the number of shells.
#include "blum/geometry/topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stop_token>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/field/reference.hpp"
#include "blum/shapes/generators.hpp"
#include "geometry/topology/shells.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using Betti = std::array<std::int64_t, 3>;

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TriangleMesh cube(double size, bool inverted = false, const Vec3d& center = {}) {
  TriangleMesh box = make_box({{size, size, size}, {1, 1, 1}});
  for (Vec3d& p : box.vertices) p += center;
  if (inverted) reverse_triangles(box);
  return box;
}

TEST(Topology, Tetrahedron) {
  const Topology t = topology(tetrahedron());
  EXPECT_EQ(t.vertices, 4U);
  EXPECT_EQ(t.edges, 6U);
  EXPECT_EQ(t.triangles, 4U);
  EXPECT_EQ(t.pieces, 1U);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.closed_components, 1U);
  EXPECT_EQ(t.euler_characteristic, 2);
  EXPECT_TRUE(t.closed && t.oriented && t.manifold && t.faces_outwards);
  ASSERT_EQ(t.shells.size(), 1U);
  EXPECT_EQ(t.shells[0].genus, 0);
  EXPECT_DOUBLE_EQ(t.shells[0].signed_volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(t.area, 1.5 + std::sqrt(3.0) / 2);
  EXPECT_DOUBLE_EQ(t.shells[0].area, t.area);
  EXPECT_EQ(t.betti, (Betti{1, 0, 0}));
}

TEST(Topology, TwoTetrahedraThatShareAVertex) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  for (const Triangle& t : std::vector<Triangle>{{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {0, 5, 6}})
    mesh.triangles.push_back(t);
  const Topology t = topology(mesh);
  EXPECT_TRUE(t.closed && t.oriented);
  EXPECT_FALSE(t.manifold);
  EXPECT_EQ(t.nonmanifold_vertices, 1U);
  EXPECT_EQ(t.nonmanifold_edges, 0U);
  EXPECT_EQ(t.pieces, 1U);
  EXPECT_EQ(t.components, 2U);
  EXPECT_EQ(t.euler_characteristic, 3);
  for (const Shell& shell : t.shells) EXPECT_EQ(shell.euler_characteristic, 2);
  EXPECT_FALSE(t.betti.has_value());
}

TEST(Topology, TwoTetrahedraThatShareAnEdge) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.end(), {{0, -1, 0}, {0, 0, -1}});
  for (const Triangle& t : std::vector<Triangle>{{0, 1, 4}, {0, 4, 5}, {1, 5, 4}, {0, 5, 1}})
    mesh.triangles.push_back(t);
  const Topology t = topology(mesh);
  EXPECT_EQ(t.nonmanifold_edges, 1U);
  EXPECT_EQ(t.nonmanifold_vertices, 2U);
  EXPECT_EQ(t.components, 1U);
  EXPECT_EQ(t.closed_components, 0U);
  EXPECT_FALSE(t.closed);
  EXPECT_TRUE(t.shells.empty());
  EXPECT_FALSE(t.betti.has_value());
}

TEST(Topology, OpenSquare) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Topology t = topology(mesh);
  EXPECT_EQ(t.boundary_edges, 4U);
  EXPECT_EQ(t.boundary_loops, 1U);
  EXPECT_EQ(t.euler_characteristic, 1);
  EXPECT_TRUE(t.manifold && t.oriented && !t.closed && !t.faces_outwards);
  EXPECT_EQ(t.inconsistent_edges, 0U);
  EXPECT_DOUBLE_EQ(t.area, 1);
  EXPECT_EQ(t.signed_volume, 0);
  mesh.triangles[1] = {0, 3, 2};
  const Topology turned = topology(mesh);
  EXPECT_EQ(turned.inconsistent_edges, 1U);
  EXPECT_EQ(turned.boundary_loops, 1U);
  EXPECT_FALSE(turned.oriented);
}

TEST(Topology, MoebiusStripAndKleinBottle) {
  // Quads form a ring. The last quad is attached with a twist.
  TriangleMesh strip;
  for (std::uint32_t k = 0; k < 6; ++k) {
    const double angle = 2 * 3.14159265358979 * k / 6;
    const Vec3d out{std::cos(angle), std::sin(angle), 0};
    const Vec3d side = out * (0.3 * std::cos(angle / 2)) + Vec3d{0, 0, 0.3 * std::sin(angle / 2)};
    strip.vertices.push_back(out - side);
    strip.vertices.push_back(out + side);
    std::uint32_t a = 2 * k + 2;
    std::uint32_t b = 2 * k + 3;
    if (k == 5) {
      a = 1;
      b = 0;
    }
    strip.triangles.push_back({2 * k, a, 2 * k + 1});
    strip.triangles.push_back({2 * k + 1, a, b});
  }
  const Topology t = topology(strip);
  EXPECT_EQ(t.boundary_loops, 1U);
  EXPECT_EQ(t.boundary_edges, 12U);
  EXPECT_EQ(t.euler_characteristic, 0);
  EXPECT_TRUE(t.manifold);
  EXPECT_EQ(t.inconsistent_edges, 1U);
  // A lattice with one pair of sides glued straight and the other with a flip is closed, but has no outside.
  TriangleMesh bottle;
  const std::uint32_t n = 5;
  for (std::uint32_t v = 0; v < n * n; ++v) bottle.vertices.push_back({v % n * 1.0, v / n * 1.0, v * v % 7 * 1.0});
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return (j % n) * n + (j < n ? i % n : (2 * n - i) % n); };
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      bottle.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      bottle.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const Topology klein = topology(bottle);
  EXPECT_TRUE(klein.closed);
  EXPECT_FALSE(klein.oriented);
  EXPECT_EQ(klein.euler_characteristic, 0);
  EXPECT_EQ(klein.closed_components, 1U);
  EXPECT_TRUE(klein.shells.empty());
  EXPECT_FALSE(klein.betti.has_value());
}

TEST(Topology, InvertedBoxFacesInwards) {
  const Topology t = topology(cube(2, true));
  EXPECT_TRUE(t.closed && t.oriented && t.manifold);
  EXPECT_FALSE(t.faces_outwards);
  EXPECT_DOUBLE_EQ(t.signed_volume, -8);
  EXPECT_FALSE(t.betti.has_value());
  EXPECT_FALSE(orientation(cube(2, true), SiteTable(cube(2, true))).outward);
}

TEST(Topology, CubeInVoidInCube) {
  TriangleMesh mesh = cube(1);
  append(mesh, cube(3));
  append(mesh, cube(2, true));
  const Topology t = topology(mesh);
  ASSERT_EQ(t.shells.size(), 3U);
  EXPECT_EQ(t.shells[0].depth, 2U);
  EXPECT_EQ(t.shells[0].parent, 2);
  EXPECT_EQ(t.shells[1].depth, 0U);
  EXPECT_EQ(t.shells[1].parent, -1);
  EXPECT_EQ(t.shells[2].depth, 1U);
  EXPECT_EQ(t.shells[2].parent, 1);
  EXPECT_EQ(t.betti, (Betti{2, 0, 1}));
  EXPECT_DOUBLE_EQ(t.signed_volume, 27 - 8 + 1);
}

TEST(Topology, WrongOrientationOfNestedShellsIsSeen) {
  for (int wrong = 0; wrong < 8; ++wrong) {
    TriangleMesh mesh = cube(3, (wrong & 1) != 0);
    append(mesh, cube(2, (wrong & 2) == 0));
    append(mesh, cube(1, (wrong & 4) != 0));
    const Topology t = topology(mesh);
    EXPECT_EQ(t.faces_outwards, wrong == 0) << wrong;
    EXPECT_EQ(t.betti.has_value(), wrong == 0) << wrong;
    EXPECT_EQ(orientation(mesh, SiteTable(mesh)).outward, wrong == 0) << wrong;
    for (std::size_t s = 0; s < 3; ++s) {
      EXPECT_EQ(t.shells[s].depth, s);
      EXPECT_EQ(t.shells[s].faces_outwards, (wrong >> s & 1) == 0);
    }
  }
}

TEST(Topology, BoxesThatOverlapWithoutNesting) {
  // A small cube in the hole of a torus lies in its bounds, but not in it. Another one lies in a corner of a sphere's
  // bounds.
  TriangleMesh mesh = make_torus({});
  append(mesh, cube(0.5));
  append(mesh, make_sphere({}), {10, 0, 0});
  append(mesh, cube(0.1), {10.9, 0.9, 0.9});
  const Topology t = topology(mesh);
  for (const Shell& shell : t.shells) EXPECT_EQ(shell.depth, 0U);
  EXPECT_EQ(t.betti, (Betti{4, 1, 0}));
}

TEST(Topology, DuplicateAndDegenerateTriangles) {
  TriangleMesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 0, 2});
  mesh.triangles.push_back({2, 1, 0});
  const Topology t = topology(mesh);
  EXPECT_EQ(t.duplicate_triangles, 2U);
  EXPECT_EQ(t.nonmanifold_edges, 3U);
  EXPECT_FALSE(t.closed);

  TriangleMesh degenerate = tetrahedron();
  degenerate.triangles.push_back({0, 0, 1});
  degenerate.triangles.push_back({2, 2, 2});
  const Topology d = topology(degenerate);
  EXPECT_EQ(d.degenerate_triangles, 2U);
  EXPECT_EQ(d.duplicate_triangles, 0U);
  EXPECT_TRUE(d.closed && d.manifold);  // these triangles bound nothing
  EXPECT_EQ(d.betti, (Betti{1, 0, 0}));
}

TEST(Topology, DegenerateMeansExactlyOnALine) {
  const auto flat = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    TriangleMesh mesh;
    mesh.vertices = {a, b, c};
    mesh.triangles = {{0, 1, 2}};
    return topology(mesh).degenerate_triangles == 1;
  };
  EXPECT_TRUE(flat({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  EXPECT_TRUE(flat({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.7, 0.7, 0.7}));
  EXPECT_TRUE(flat({1e6, 1e6 + 1, 0}, {1e6 + 3, 1e6 + 4, 0}, {1e6 + 8, 1e6 + 9, 0}));
  EXPECT_TRUE(flat({1, 2, 3}, {1, 2, 3}, {4, 5, 6}));
  EXPECT_FALSE(flat({0, 0, 0}, {1, 2, 3}, {2, 4, std::nextafter(6, 7)}));
  EXPECT_FALSE(flat({0, 0, 0}, {1, 1, 0}, {0.5, std::nextafter(0.5, 1), 0}));
  EXPECT_FALSE(flat({0, 0, 0}, {1e-100, 0, 0}, {0, 1e-100, 0}));
  EXPECT_FALSE(flat({0, 0, 0}, {1e150, 0, 0}, {0, 1e150, 0}));
}

TEST(Topology, ThinShellsKeepTheirSide) {
  for (const double height : {1e-3, 1e-12, 1e-15, 1e-30, 1e-70}) {
    const TriangleMesh plate = make_box({.size = {1, 2, height}});
    const Topology t = topology(plate);
    EXPECT_TRUE(t.faces_outwards) << height;
    EXPECT_NEAR(t.signed_volume / (2 * height), 1, 1e-9) << height;
    EXPECT_EQ(t.betti, (Betti{1, 0, 0}));
    TriangleMesh reversed = plate;
    reversed.triangles = reversed_triangles(plate.triangles);
    EXPECT_FALSE(topology(reversed).faces_outwards) << height;
    EXPECT_LT(topology(reversed).signed_volume, 0) << height;
  }
  // Shells that enclose nothing have no side.
  for (const Vec3d& to : {Vec3d{1, 1, 0}, Vec3d{0.1, 0.7, 0.3}}) {
    TriangleMesh collapsed = make_box({.segments = {3, 3, 3}});
    for (Vec3d& v : collapsed.vertices) v = v.x > 0 ? to : v.y > 0 ? to * 0.25 : -to;
    EXPECT_FALSE(topology(collapsed).faces_outwards);
    EXPECT_EQ(topology(collapsed).signed_volume, 0);
  }
}

TEST(Topology, SegmentsPointsAndUnnamedVertices) {
  TriangleMesh mesh;
  mesh.vertices.assign(9, {});
  for (std::size_t v = 0; v < 9; ++v) mesh.vertices[v].x = static_cast<double>(v);
  mesh.segments = {{0, 1}, {1, 2}, {4, 5}};
  mesh.points = {7, 7, 2};
  const Topology t = topology(mesh);
  EXPECT_EQ(t.vertices, 9U);
  EXPECT_EQ(t.named_vertices, 6U);
  EXPECT_EQ(t.pieces, 3U);
  EXPECT_EQ(t.edges, 3U);
  EXPECT_EQ(t.segments, 3U);
  EXPECT_EQ(t.points, 3U);
  EXPECT_EQ(t.components, 0U);
  EXPECT_FALSE(t.closed);
  EXPECT_EQ(t.bounds.upper.x, 7);
}

TEST(Topology, AnySizeAndPlace) {
  for (const double scale : {1e-90, 1e-9, 1.0, 1e9, 1e90}) {
    for (const double shift : {0.0, 1e6}) {
      TriangleMesh mesh = make_void_cube({});
      for (Vec3d& p : mesh.vertices) p = (p + Vec3d{shift, -shift, shift}) * scale;
      const Topology t = topology(mesh);
      EXPECT_EQ(t.betti, (Betti{1, 0, 1})) << scale << " " << shift;
      EXPECT_NEAR(t.signed_volume / (scale * scale * scale), 1 - 0.112, 0.002);
    }
  }
}

TEST(Topology, FlatShellFacesNowhere) {
  TriangleMesh mesh;  // a triangle with two sides
  mesh.vertices = {{0, 0, 0.3}, {1, 0, 0.7}, {0, 1, 0.1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  const Topology t = topology(mesh);
  EXPECT_TRUE(t.closed && t.oriented);
  EXPECT_FALSE(t.faces_outwards);
  EXPECT_EQ(t.duplicate_triangles, 1U);
}

/// Walls that two shells share must not count as outside, whichever vertices are tested first.
TEST(Topology, VoidsThatTouchTheWallFromWithinAreVoids) {
  const Vec3d lower{0, 0, 0};
  const Vec3d upper{4, 4, 4};
  int tried = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool is_at_upper : {false, true}) {
      for (const bool is_full : {false, true}) {  // over the whole wall: each of the void's vertices touches
        for (int first = 0; first < 12; ++first) {
          Vec3d from = is_full ? lower : Vec3d{1, 1, 1};
          Vec3d to = is_full ? upper : Vec3d{3, 3, 3};
          from[axis] = is_at_upper ? 2 : 0;
          to[axis] = is_at_upper ? 4 : 2;
          TriangleMesh mesh = test::box_between(from, to, true, first);
          append(mesh, test::box_between(lower, upper));
          const Topology t = topology(mesh);
          ASSERT_EQ(t.shells.size(), 2U);
          EXPECT_EQ(t.shells[0].depth, 1U) << "axis " << axis << ", first triangle " << first;
          EXPECT_EQ(t.shells[1].depth, 0U);
          EXPECT_TRUE(t.faces_outwards);
          // Shells that touch from outside are two bodies.
          Vec3d shift;
          shift[axis] = is_at_upper ? 2 : -2;
          TriangleMesh parts = test::box_between(from + shift, to + shift, false, first);
          append(parts, test::box_between(lower, upper));
          const Topology apart = topology(parts);
          EXPECT_EQ(apart.shells[0].depth, 0U);
          EXPECT_EQ(apart.shells[1].depth, 0U);
          ++tried;
        }
      }
    }
  }
  EXPECT_EQ(tried, 144);
}

/// The depth of each shell, from the winding numbers of all others around one of its vertices.
std::vector<std::uint32_t> brute_force_depths(const std::vector<TriangleMesh>& shells) {
  std::vector<std::uint32_t> depths;
  for (std::size_t i = 0; i < shells.size(); ++i) {
    std::uint32_t depth = 0;
    for (std::size_t j = 0; j < shells.size(); ++j) {
      const double winding = reference::winding_number(shells[j], shells[i].vertices[0]);
      if (j != i && std::abs(winding) > 0.5) ++depth;
    }
    depths.push_back(depth);
  }
  return depths;
}

TEST(Topology, NestingAgreesWithWindingNumbers) {
  // Shapes on a lattice, scaled and nested at random. Their coordinates make rays hit edges and vertices.
  Random random(11);
  std::uint32_t deepest = 0;
  for (int run = 0; run < 30; ++run) {
    std::vector<TriangleMesh> shells;
    TriangleMesh all;
    for (int place = 0; place < 12; ++place) {
      const Vec3d center{4.0 * (place % 3), 4.0 * (place / 3 % 2), 4.0 * (place / 6)};
      const std::uint64_t count = 1 + random.below(4);
      const std::uint64_t kind = random.below(3);
      for (std::uint64_t k = 0; k < count; ++k) {
        const double size = 1.5 - 0.25 * static_cast<double>(k);
        TriangleMesh shell = kind == 0   ? make_box({{2 * size, 2 * size, 2 * size}, {2, 2, 2}})
                             : kind == 1 ? make_uv_sphere({size, 8, 4})
                                         : make_torus({1.2, 0.5 * size, 24, 12});
        for (Vec3d& p : shell.vertices) p += center;
        if (random.below(2) == 1) reverse_triangles(shell);
        append(all, shell);
        shells.push_back(std::move(shell));
      }
    }
    const auto expected = brute_force_depths(shells);
    const Topology t = topology(all);
    ASSERT_EQ(t.shells.size(), shells.size());
    for (std::size_t s = 0; s < shells.size(); ++s) {
      EXPECT_EQ(t.shells[s].depth, expected[s]) << run << " " << s;
      deepest = std::max(deepest, expected[s]);
      if (expected[s] == 0) {
        EXPECT_EQ(t.shells[s].parent, -1);
      } else {
        EXPECT_EQ(t.shells[static_cast<std::size_t>(t.shells[s].parent)].depth + 1, expected[s]);
      }
    }
  }
  EXPECT_EQ(deepest, 3U);
}

TEST(Topology, ManyShellsInOne) {
  // 3,000 bodies in the void of one large fine box would take minutes if the time were not near-linear.
  TriangleMesh mesh = make_box({{30, 30, 30}, {40, 40, 40}});
  TriangleMesh hollow = make_box({{29, 29, 29}, {40, 40, 40}});
  reverse_triangles(hollow);
  append(mesh, hollow);
  append(mesh, make_bodies({3000, 0.5, 1, 2}));
  const Topology t = topology(mesh);
  EXPECT_EQ(t.betti, (Betti{3001, 0, 1}));
}

struct NestedShells {
  std::size_t meetings;
  detail::ShellSet set;

  explicit NestedShells(const TriangleMesh& mesh) {
    const SiteTable sites(mesh);
    set = detail::find_shells(mesh, detail::find_components(mesh, sites, detail::tally_edges(mesh, sites)), {});
    meetings = detail::nest_shells(mesh, set, {});
  }
};

/// Boxes that share their planes along y and z. @param growth  of the third side, from box to box.
struct NestedBoxes : NestedShells {
  NestedBoxes(int boxes, double growth) : NestedShells(mesh_of(boxes, growth)) {}

 private:
  static TriangleMesh mesh_of(int boxes, double growth) {
    TriangleMesh mesh;
    for (int k = 0; k < boxes; ++k) {
      BoxOptions box;
      box.size.x += growth * k;
      append(mesh, make_box(box));
    }
    return mesh;
  }
};

TEST(Topology, CoincidentShellsTakeBoundedWork) {
  EXPECT_LT(NestedBoxes(1200, 0).meetings, 12 * NestedBoxes(100, 0).meetings + 1000);  // equal points are tested once
  EXPECT_GT(NestedBoxes(100, 1e-3).meetings, 100U * 100U * 12U);                       // from many points of each
  EXPECT_LT(NestedBoxes(1200, 1e-3).meetings, 24'000'000U);  // 1,200^2 times 110 without a limit
}

TEST(Topology, EqualShellsLieInAllOthers) {
  const NestedBoxes boxes(5, 0);
  for (std::size_t s = 0; s < 5; ++s) {
    EXPECT_EQ(boxes.set.shells[s].depth, 4U);
    EXPECT_EQ(boxes.set.shells[s].parent, s == 0 ? 1 : 0);
  }
}

/// The rounded middles of triangles may lie beside the walls that hold them. Only free points decide.
TEST(Topology, AVoidOnFiveOfItsWallsIsAVoid) {
  TriangleMesh mesh;
  mesh.vertices = {{8, 8, 8}, {10, 10, 6}, {6, 8, 6}, {8, 10, 4}, {10, 6, 10}, {12, 8, 8}, {8, 6, 8}, {10, 8, 6},
                   {8, 8, 8}, {9, 9, 7},   {6, 8, 6}, {7, 9, 5},  {10, 6, 10}, {11, 7, 9}, {8, 6, 8}, {9, 7, 7}};
  mesh.triangles = {{1, 3, 2},    {5, 7, 3},    {4, 6, 5},   {0, 2, 4},   {0, 5, 1},    {3, 7, 6},
                    {2, 3, 6},    {0, 4, 5},    {1, 5, 3},   {0, 1, 2},   {2, 6, 4},    {6, 7, 5},
                    {9, 12, 8},   {15, 11, 10}, {9, 13, 12}, {11, 13, 9}, {11, 15, 13}, {13, 15, 12},
                    {14, 15, 10}, {10, 9, 8},   {12, 14, 8}, {14, 10, 8}, {15, 14, 12}, {10, 11, 9}};
  const Topology found = topology(mesh);
  ASSERT_EQ(found.shells.size(), 2U);
  EXPECT_EQ(found.shells[0].depth, 0U);
  EXPECT_EQ(found.shells[1].depth, 1U);
  EXPECT_EQ(found.betti, (std::array<std::int64_t, 3>{1, 0, 1}));
}

TEST(Topology, APinFlushInAHoleLiesBesideThePlate) {
  for (int sides = 3; sides < 40; ++sides) {
    std::vector<Point2> hole;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      hole.push_back({std::cos(angle), std::sin(angle)});
    }
    const std::vector<Point2> outline{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    TriangleMesh mesh = make_extrusion(hole, {});
    append(mesh, make_extrusion(outline, std::vector<std::vector<Point2>>{hole}));
    const Topology found = topology(mesh);
    ASSERT_EQ(found.shells.size(), 2U);
    EXPECT_EQ(found.betti, (std::array<std::int64_t, 3>{2, 1, 0})) << sides << " sides";
  }
}

/// A box whose sides are cut along random diagonals.
TriangleMesh box_of(const Vec3d& lower, const Vec3d& upper, bool is_reversed, Random& random) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.vertices.push_back(
        {(k & 4) != 0 ? upper.x : lower.x, (k & 2) != 0 ? upper.y : lower.y, (k & 1) != 0 ? upper.z : lower.z});
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  for (const auto& side : sides) {
    const std::size_t k = random.below(2);
    mesh.triangles.push_back({side[k], side[k + 1], side[(k + 2) % 4]});
    mesh.triangles.push_back({side[k], side[(k + 2) % 4], side[(k + 3) % 4]});
  }
  if (is_reversed) reverse_triangles(mesh);
  return mesh;
}

/// Cubes of a block: most of their points lie on other cubes.
TEST(Topology, BlocksThatTouchOnAllSidesAreBesideEachOther) {
  Random random(5);
  for (int run = 0; run < 10; ++run) {
    TriangleMesh mesh;
    for (int k = 0; k < 27; ++k) {
      const Vec3d lower{static_cast<double>(k % 3), static_cast<double>(k / 3 % 3), static_cast<double>(k / 9)};
      append(mesh, box_of(lower, lower + Vec3d{1, 1, 1}, false, random));
    }
    EXPECT_EQ(topology(mesh).betti, (std::array<std::int64_t, 3>{27, 0, 0}));
  }
}

TEST(Topology, AVoidFilledByItsInsertsContainsThem) {
  Random random(6);
  for (int run = 0; run < 20; ++run) {
    TriangleMesh mesh = box_of({0, 0, 0}, {4, 4, 4}, false, random);
    append(mesh, box_of({0, 0, 0}, {4, 4, 2}, true, random));   // a void on five of its walls
    append(mesh, box_of({0, 0, 0}, {4, 4, 1}, false, random));  // two bodies that fill it
    append(mesh, box_of({0, 0, 1}, {4, 4, 2}, false, random));
    const Topology found = topology(mesh);
    ASSERT_EQ(found.shells.size(), 4U);
    for (std::size_t s = 0; s < 4; ++s) {
      EXPECT_EQ(found.shells[s].depth, std::min<std::size_t>(s, 2));
      EXPECT_EQ(found.shells[s].parent, s == 0 ? -1 : s == 1 ? 0 : 1);
    }
  }
}

TEST(Topology, TinyAndHugeShellsNestAsOthersDo) {
  for (const double size : {1e-120, 1e-20, 1.0, 1e20, 1e90}) {
    TriangleMesh mesh;
    for (const double side : {2.0, 1.0}) {
      BoxOptions box;
      box.size = Vec3d{side, side, side} * size;
      TriangleMesh part = make_box(box);
      if (side == 1.0) reverse_triangles(part);
      append(mesh, part);
    }
    EXPECT_EQ(NestedShells(mesh).set.shells[1].depth, 1U) << size;
  }
}

TEST(Topology, RefusesInvalidMeshesAndCanBeCancelled) {
  EXPECT_THROW(static_cast<void>(topology(TriangleMesh{})), InvalidMesh);
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW(static_cast<void>(topology(tetrahedron(), Context{.cancel = source.get_token()})), Cancelled);
}

TEST(Orientation, CountsWrongEdges) {
  TriangleMesh mesh = cube(1);
  mesh.triangles.pop_back();
  const Orientation open = orientation(mesh, SiteTable(mesh));
  EXPECT_FALSE(open.closed);
  EXPECT_TRUE(open.oriented);
  EXPECT_FALSE(open.outward);
  EXPECT_EQ(open.boundary_edges, 3U);
  TriangleMesh turned = cube(1);
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  const Orientation twisted = orientation(turned, SiteTable(turned));
  EXPECT_TRUE(twisted.closed);
  EXPECT_FALSE(twisted.oriented);
  EXPECT_EQ(twisted.inconsistent_edges, 3U);
  TriangleMesh points;
  points.vertices = {{0, 0, 0}};
  points.points = {0};
  EXPECT_FALSE(orientation(points, SiteTable(points)).closed);
}

}  // namespace
}  // namespace blum
