// Proves that a certificate holds for axes made by hand of known solids. Every falsified part of an axis is found and
// named.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <stop_token>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/shapes/generators.hpp"
#include "support/medial_rows.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::box_between;
using test::VertexRow;

constexpr CertificateOptions unlabelled{.labels = false};  ///< axes made by hand lack roles

/// A vertex with the radius and footprint that the library's own hierarchy returns.
VertexRow vertex_at(const Bvh& bvh, const Vec3d& p) {
  const NearestSite nearest = *bvh.nearest(p);
  return {p, nearest.distance, {nearest.point, nearest.point}, {nearest.site, nearest.site}};
}

/// An axis of one vertex.
AxisRows ball_axis(const MeshView& mesh, const Vec3d& p) {
  AxisRows axis;
  axis.vertices = {vertex_at(Bvh(mesh, SiteTable(mesh)), p)};
  return axis;
}

/// The closed centre line of a torus of the default size.
AxisRows torus_axis(const MeshView& mesh, std::uint32_t parts = 96) {
  const Bvh bvh(mesh, SiteTable(mesh));
  AxisRows axis;
  for (std::uint32_t k = 0; k < parts; ++k) {
    const double angle = 2 * std::numbers::pi * k / parts;
    axis.vertices.push_back(vertex_at(bvh, {std::cos(angle), std::sin(angle), 0}));
    axis.edges.push_back({{k, (k + 1) % parts}});
  }
  return axis;
}

/// The mismatches of a certificate as one text.
std::string complaints(const Certificate& certificate) {
  std::string all;
  for (const std::string& one : certificate.mismatches) all += one + "\n";
  return all;
}

TEST(Certificate, HoldsForTheCentresOfABallAndABox) {
  const TriangleMesh ball = make_sphere({.radius = 2});
  const Certificate c = certify(ball_axis(ball, {}), ball, unlabelled);
  EXPECT_TRUE(c.holds()) << complaints(c);
  EXPECT_TRUE(c.topology_holds && c.geometry.holds);
  EXPECT_EQ(c.against, SolidRule::polyhedron);
  EXPECT_EQ(c.solid, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(c.axis, c.solid);
  EXPECT_EQ(c.geometry.vertices, 1U);
  // Vertices lie on the sphere, and triangles slightly inside.
  const double radius = Bvh(ball, SiteTable(ball)).nearest(Vec3d{})->distance;
  EXPECT_NEAR(c.balls.solid_to_balls, 2 - radius, 1e-12);
  EXPECT_GT(c.balls.mean_solid_to_balls, 0);
  EXPECT_LT(c.balls.mean_solid_to_balls, 2 - radius);
  EXPECT_LE(c.balls.balls_to_surface, 2 - radius);
  EXPECT_NEAR(c.balls.balls_beyond_solid, 0, 1e-14);
  EXPECT_GT(c.balls.step, 0);

  const TriangleMesh box = make_box({});
  const Certificate b = certify(ball_axis(box, {}), box, unlabelled);
  EXPECT_TRUE(b.holds()) << complaints(b);
  EXPECT_NEAR(b.balls.solid_to_balls, std::sqrt(0.75) - 0.5, 1e-12) << "corners";
  EXPECT_NEAR(b.balls.mean_solid_to_balls, 0.1403, 2e-3)
      << "mean distance on a unit square from its middle, 1/2 above it";
  EXPECT_NEAR(b.balls.balls_to_surface, 0.5 - 0.5 / std::sqrt(3.0), 0.05) << "near the diagonals";
}

TEST(Certificate, HoldsForTheCentreLineOfATorus) {
  const TriangleMesh torus = make_torus({});
  for (const std::uint32_t parts : {96U, 500U}) {
    const AxisRows axis = torus_axis(torus, parts);
    const Certificate c = certify(axis, torus, unlabelled);
    EXPECT_TRUE(c.holds()) << complaints(c);
    EXPECT_EQ(c.solid, (BettiNumbers{1, 1, 0}));
    const double finest = std::min(2 * std::sin(std::numbers::pi / parts), length(bounds(torus).size()) / 256);
    EXPECT_GT(c.balls.step, finest * (1 - 1e-9));
    const double affordable = 3 * std::sqrt(4 * std::numbers::pi * std::numbers::pi * 0.3 / 50'000);
    EXPECT_LT(c.balls.step, std::max(finest, affordable)) << "pieces are at least a ninth of a square of the step";
    EXPECT_LT(c.balls.solid_to_balls, 0.01);
    EXPECT_LT(c.balls.balls_to_surface, 0.01);
  }
}

TEST(Certificate, SeveralBodiesAndVoids) {
  // Two boxes touch in a face. The second box has a void that contains a body.
  TriangleMesh mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({1, 0, 0}, {4, 3, 3}));
  append(mesh, box_between({1.05, 1, 1}, {2, 2, 2}, true));
  append(mesh, box_between({1.25, 1.25, 1.25}, {1.75, 1.75, 1.75}));
  const Bvh bvh(mesh, SiteTable(mesh));
  AxisRows axis;
  for (const Vec3d& p : {Vec3d{0.5, 0.5, 0.5}, Vec3d{2.75, 1.5, 1.5}, Vec3d{1.5, 1.5, 1.5}}) {
    axis.vertices.push_back(vertex_at(bvh, p));
  }
  Certificate c = certify(axis, mesh, unlabelled);
  EXPECT_EQ(c.solid, (BettiNumbers{3, 0, 1}));
  EXPECT_TRUE(c.geometry.holds);
  EXPECT_EQ(complaints(c), "body 2 of 3 (around 2.5 1.5 1.5) has 1 void, the axis in it has 0\n");
  // The total is the same, but not the number in each body.
  axis.vertices[2] = axis.vertices[0];
  EXPECT_TRUE(
      complaints(certify(axis, mesh, unlabelled))
          .starts_with(
              "body 1 of 3 (around 0.5 0.5 0.5) has 1 component, the axis in it has 2\nbody 2 of 3 (around 2.5"))
      << complaints(certify(axis, mesh, unlabelled));
  // A point in the void lies outside.
  axis.vertices[2] = vertex_at(bvh, {1.15, 1.5, 1.5});
  c = certify(axis, mesh, unlabelled);
  EXPECT_EQ(c.geometry.outside, 1U);
  EXPECT_NEAR(c.geometry.outside_by, 0.1, 1e-12);
  EXPECT_NE(complaints(c).find("of the 3 vertices of the axis 1 lie outside"), std::string::npos) << complaints(c);
  EXPECT_NEAR(c.balls.balls_beyond_solid, 0.2, 1e-12);
}

TEST(Certificate, EdgesMayCutCornersButCrossNoGap) {
  // A U, and an axis from one prong to the other: over the floor, past the corners between them, or across the gap.
  const auto axis_of = [](const MeshView& mesh, const std::vector<Vec3d>& way) {
    const Bvh bvh(mesh, SiteTable(mesh));
    AxisRows axis;
    for (const Vec3d& p : way) axis.vertices.push_back(vertex_at(bvh, p));
    for (std::uint32_t v = 1; v < way.size(); ++v) axis.edges.push_back({{v - 1, v}});
    return axis;
  };
  for (const double gap : {0.5, 1e-4}) {
    const std::vector<Point2> outline{{-1 - gap, 0}, {1 + gap, 0}, {1 + gap, 3}, {gap, 3},
                                      {gap, 1},      {-gap, 1},    {-gap, 3},    {-1 - gap, 3}};
    const TriangleMesh u = make_extrusion(outline, {});
    const Vec3d middle = bounds(u).center();
    const auto at = [&](double x, double y) { return Vec3d{x, y, middle.z}; };
    Certificate c = certify(axis_of(u, {at(-0.5, 2), at(-0.5, 0.5), at(0.5, 0.5), at(0.5, 2)}), u, unlabelled);
    EXPECT_TRUE(c.holds()) << complaints(c);
    EXPECT_EQ(c.edges.edges, 3U);
    EXPECT_EQ(c.edges.pushed, 0U);
    c = certify(axis_of(u, {at(-0.5, 2), at(0.5, 2)}), u, unlabelled);
    EXPECT_EQ(c.edges.outside, 1U) << gap;
    EXPECT_NEAR(c.edges.outside_by, gap, gap / 2);
    EXPECT_EQ(complaints(c).substr(0, 38), "of the 1 edges of the axis 1 leave the");
    // The edge passes the corner by 0.02.
    const double past = 0.02 * std::sqrt(2.0);
    c = certify(axis_of(u, {at(-gap - 0.1 + past, 1.1), at(-gap + 0.1 + past, 0.9)}), u, unlabelled);
    EXPECT_EQ(c.edges.pushed, gap > 0.1 ? 1U : 0U) << complaints(c);
    EXPECT_EQ(c.holds(), gap > 0.1) << complaints(c);
  }
}

TEST(Certificate, TolerancesFollowTheSizeOfTheBody) {
  // The bodies are far apart. A distance that is small for the scene is large for a body.
  TriangleMesh mesh = make_sphere({.radius = 1e-3});
  append(mesh, make_sphere({.radius = 1e-3}), {5000, 0, 0});
  const Bvh bvh(mesh, SiteTable(mesh));
  AxisRows axis;
  axis.vertices = {vertex_at(bvh, {}), vertex_at(bvh, {5000, 0, 0})};
  EXPECT_TRUE(certify(axis, mesh, unlabelled).holds());
  axis.vertices[1].radius *= 1.001;
  EXPECT_FALSE(certify(axis, mesh, unlabelled).holds());
  axis.vertices[1] = vertex_at(bvh, {5000.0011, 0, 0});
  EXPECT_EQ(certify(axis, mesh, unlabelled).geometry.outside, 1U);
}

TEST(Certificate, ResolvesMeshesThatCrossThemselves) {
  TriangleMesh mesh = make_sphere({});
  append(mesh, make_sphere({}), {1, 0.1, 0.05});
  EXPECT_EQ(solid_rule(mesh).rule, SolidRule::polyhedron);
  EXPECT_EQ(solid_rule(mesh).reason, "the mesh is closed, and manifold after its crossings are resolved");
  const Certificate united = certify(ball_axis(mesh, {}), mesh, {.radii = false, .labels = false});
  EXPECT_EQ(united.solid, (BettiNumbers{1, 0, 0}));
  EXPECT_TRUE(united.holds()) << complaints(united);
  EXPECT_FALSE(certify(ball_axis(mesh, {3, 0, 0}), mesh, {.radii = false, .labels = false}).holds());
  EXPECT_EQ(solid_rule(make_void_cube({})).rule, SolidRule::polyhedron);
  // Crossings stay if the mesh faces inwards.
  TriangleMesh inwards = mesh;
  inwards.triangles = reversed_triangles(mesh.triangles);
  EXPECT_EQ(solid_rule(inwards).rule, SolidRule::winding);
  EXPECT_THROW((void)certify(ball_axis(inwards, {}), inwards, unlabelled), InvalidMesh);
  TriangleMesh open = make_box({});
  open.triangles.pop_back();
  EXPECT_EQ(solid_rule(open).rule, SolidRule::winding);
  // Two bodies may touch. Crossings stay if coordinates are too many orders of magnitude apart.
  mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({1, 0, 0}, {2, 1, 1}));
  EXPECT_EQ(solid_rule(mesh).rule, SolidRule::polyhedron);
  mesh = box_between({0, 0, 0}, {1, 1, 1});
  append(mesh, box_between({0.5, 0.5, 0.5}, {2, 2, 2}));
  mesh.vertices[0].x = 1e-200;
  EXPECT_EQ(solid_rule(mesh).rule, SolidRule::winding);
  EXPECT_EQ(solid_rule(mesh).reason,
            "the mesh crosses itself, and the crossings cannot be resolved: coordinates are too many orders of "
            "magnitude apart");
}

TEST(Certificate, PositionsAreCheckedWithoutRadii) {
  const TriangleMesh torus = make_torus({});
  AxisRows axis = torus_axis(torus);
  for (VertexRow& vertex : axis.vertices) vertex = {.position = vertex.position, .footprints = {}, .sites = {}};
  EXPECT_TRUE(certify(axis, torus, {.radii = false, .labels = false}).holds());
  for (VertexRow& vertex : axis.vertices) vertex.position.x += 5;
  const Certificate c = certify(axis, torus, {.radii = false, .labels = false});
  EXPECT_EQ(c.geometry.outside, 96U);
  EXPECT_EQ(c.edges.outside, 96U);
  EXPECT_FALSE(c.checked.footprints || c.checked.balls);
}

TEST(Certificate, CoarseNumbersEndTheSampling) {
  // Sides have length 1 and adjacent numbers differ by 1/8, so no piece is as short as the step.
  const TriangleMesh box = test::moved(make_box({}), 1, {1e15, 1e15, 1e15});
  EXPECT_GT(certify(ball_axis(box, {1e15, 1e15, 1e15}), box, unlabelled).balls.step, 0);
}

/// The axis of a torus, to be falsified.
class FalsifiedAxis : public testing::Test {
 protected:
  TriangleMesh torus = make_torus({});
  AxisRows axis = torus_axis(torus);

  void expect(const std::vector<std::string>& words) {
    for (const int threads : {1, 2, 7}) {
      const Certificate c = certify(axis, torus, unlabelled, {.threads = threads});
      EXPECT_FALSE(c.holds());
      ASSERT_EQ(c.mismatches.size(), words.size()) << complaints(c);
      for (std::size_t k = 0; k < words.size(); ++k) {
        EXPECT_NE(c.mismatches[k].find(words[k]), std::string::npos) << words[k] << " in: " << c.mismatches[k];
      }
    }
  }
};

TEST_F(FalsifiedAxis, MissingEdge) {
  axis.edges.pop_back();
  expect({"the solid has 1 tunnel, the axis has 0"});
}

TEST_F(FalsifiedAxis, ExtraVertex) {
  axis.vertices.push_back(axis.vertices.front());
  expect({"the solid has 1 component, the axis has 2"});
}

TEST_F(FalsifiedAxis, ExtraLoop) {
  axis.edges.push_back({{0, 5}});
  axis.edges.push_back({{0, 7}});
  expect({"the solid has 1 tunnel, the axis has 3"});
}

TEST_F(FalsifiedAxis, ExtraSphere) {
  axis.triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{0, 2, 3}}, {{1, 2, 3}}};
  expect({"the solid has 0 voids, the axis has 1"});
}

TEST_F(FalsifiedAxis, WrongRadius) {
  axis.vertices[17].radius += 1e-5;
  expect({"a radius differs", "the distance to a footprint differs"});
  EXPECT_NEAR(certify(axis, torus, unlabelled).balls.balls_beyond_solid, 1e-5, 1e-10);
  EXPECT_NEAR(certify(axis, torus, unlabelled).geometry.radius_error, 1e-5, 1e-10);
  axis.vertices[17].radius -= 2e-5;
  expect({"a radius differs", "the distance to a footprint differs"});
}

TEST_F(FalsifiedAxis, RadiusWithinTolerance) {
  axis.vertices[17].radius += 1e-7;
  EXPECT_TRUE(certify(axis, torus, unlabelled).holds());
}

TEST_F(FalsifiedAxis, SmallerBall) {
  // The numbers are consistent, but the footprints lie off the surface.
  for (Vec3d& foot : axis.vertices[40].footprints) foot = (foot + axis.vertices[40].position) * 0.5;
  axis.vertices[40].radius *= 0.5;
  expect({"a radius differs", "a footprint lies off the surface by", "off its site"});
}

TEST_F(FalsifiedAxis, FootprintOffTheSurface) {
  VertexRow& vertex = axis.vertices[3];
  const Vec3d off = vertex.footprints[1] - vertex.position;
  // The footprint is one radius away, but in a direction in which the surface is farther.
  Vec3d other = cross(off, vertex.position);
  other = other * (vertex.radius / length(other)) + off * 0.2;
  vertex.footprints[1] = vertex.position + other * (vertex.radius / length(other));
  expect({"a footprint lies off the surface by", "off its site", "a separation angle differs"});
}

TEST_F(FalsifiedAxis, FootprintElsewhereOnTheSurface) {
  axis.vertices[3].footprints[0] = axis.vertices[50].footprints[0];
  expect({"the distance to a footprint differs", "off its site", "a separation angle differs"});
}

TEST_F(FalsifiedAxis, OtherSites) {
  axis.vertices[3].sites[1] = axis.vertices[50].sites[0];
  expect({"a footprint lies off its site by"});
  axis.vertices[3].sites[1] = SiteId(1U << 30U);
  expect({"a footprint has a site that the solid does not have"});
  axis.vertices[3].sites[1] = SiteId::none();
  EXPECT_TRUE(certify(axis, torus, unlabelled).holds());
}

TEST_F(FalsifiedAxis, OtherAngle) {
  axis.vertices[3].separation_angle = 0.01;
  expect({"a separation angle differs from the angle between the footprints by 0.01 degrees"});
}

TEST_F(FalsifiedAxis, ChordsThroughTheHole) {
  // The vertices are exact and form one tunnel, but no edge runs through the solid.
  axis.vertices = {axis.vertices[0], axis.vertices[32], axis.vertices[64]};
  axis.edges = {{{0, 1}}, {{1, 2}}, {{2, 0}}};
  expect({"of the 3 edges of the axis 3 leave the solid between their ends, by up to 0.1"});
  axis.edges.clear();
  axis.triangles = {{{0, 1, 2}}};
  EXPECT_EQ(certify(axis, torus, unlabelled).edges.outside, 3U) << "edges of triangles, too";
}

TEST_F(FalsifiedAxis, VertexOutside) {
  axis.vertices[10] = vertex_at(Bvh(torus, SiteTable(torus)), axis.vertices[10].position * 1.5);
  expect({"of the 96 vertices of the axis 1 lie outside", "of the 96 edges of the axis 2 leave the solid"});
}

TEST_F(FalsifiedAxis, NonFiniteNumbers) {
  axis.vertices[1].radius = std::numeric_limits<double>::quiet_NaN();
  axis.vertices[2].position.x = std::numeric_limits<double>::infinity();
  axis.vertices[3].footprints[1].z = -std::numeric_limits<double>::infinity();
  expect({"of the 96 vertices of the axis 3 have a coordinate"});
}

TEST_F(FalsifiedAxis, NoAxisAtAll) {
  axis = {};
  expect({"1 component, the axis has 0", "1 tunnel, the axis has 0"});
  EXPECT_NEAR(certify(axis, torus, unlabelled).balls.solid_to_balls, bounds(torus).diagonal(), 1e-12);
}

TEST_F(FalsifiedAxis, MissingBallsAreMeasured) {
  const Certificate whole = certify(axis, torus, unlabelled);
  // Half of the ring lacks balls. Only the topology is wrong, and the other half is 2 away.
  axis.vertices.resize(48);
  axis.edges.resize(47);
  const Certificate half = certify(axis, torus, unlabelled);
  EXPECT_EQ(complaints(half), "the solid has 1 tunnel, the axis has 0\n");
  EXPECT_GT(half.balls.solid_to_balls, 1);
  EXPECT_GT(half.balls.mean_solid_to_balls, 10 * whole.balls.mean_solid_to_balls + 0.1);
}

TEST_F(FalsifiedAxis, InvalidVertexNumber) {
  axis.edges.push_back({{0, 96}});
  EXPECT_THROW((void)certify(axis, torus, unlabelled), InvalidOption);
}

TEST_F(FalsifiedAxis, UnknownGeometryIsNotChecked) {
  for (VertexRow& vertex : axis.vertices) vertex.radius = 0;
  const Certificate c = certify(axis, torus, {.positions = false});
  EXPECT_TRUE(c.holds()) << complaints(c);
  EXPECT_EQ(c.geometry.vertices, 0U);
  EXPECT_FALSE(c.geometry.holds);
}

TEST_F(FalsifiedAxis, RadiiAreCheckedWithoutFootprints) {
  for (VertexRow& vertex : axis.vertices) vertex.footprints = {};
  const Certificate c = certify(axis, torus, {.footprints = false, .labels = false});
  EXPECT_TRUE(c.holds()) << complaints(c);
  EXPECT_EQ(c.geometry.vertices, axis.vertices.size());
  axis.vertices[5].radius *= 1.01;
  EXPECT_FALSE(certify(axis, torus, {.footprints = false, .labels = false}).holds());
}

TEST(Certificate, SolidsOfAnySize) {
  const TriangleMesh plain = make_torus({.ring_segments = 24, .tube_segments = 12});
  const Certificate expected = certify(torus_axis(plain), plain, unlabelled);
  for (const double size : {1e-140, 1e-20, 1e20, 1e140}) {
    const TriangleMesh torus = test::moved(plain, size);
    AxisRows axis = torus_axis(plain);
    for (VertexRow& vertex : axis.vertices) {
      vertex.position *= size;
      vertex.radius *= size;
      for (Vec3d& foot : vertex.footprints) foot *= size;
    }
    Certificate c = certify(axis, torus, unlabelled);
    EXPECT_TRUE(c.holds()) << size << ": " << complaints(c);
    EXPECT_EQ(c.solid, (BettiNumbers{1, 1, 0}));
    EXPECT_NEAR(c.balls.solid_to_balls / size, expected.balls.solid_to_balls, 1e-9);
    EXPECT_NEAR(c.balls.mean_solid_to_balls / size, expected.balls.mean_solid_to_balls, 1e-3);
    axis.vertices[5].radius *= 1.01;
    c = certify(axis, torus, unlabelled);
    EXPECT_NEAR(c.geometry.radius_error / axis.vertices[5].radius, 1 - 1 / 1.01, 1e-9);
    EXPECT_EQ(c.mismatches.size(), 2U) << complaints(c);
  }
}

TEST(Certificate, TheSameForAnyNumberOfThreads) {
  const TriangleMesh torus = make_torus({});
  const AxisRows axis = torus_axis(torus, 300);
  const Certificate one = certify(axis, torus, unlabelled, {.threads = 1});
  for (const int threads : {2, 7}) {
    const Certificate other = certify(axis, torus, unlabelled, {.threads = threads});
    EXPECT_EQ(one.balls.mean_solid_to_balls, other.balls.mean_solid_to_balls);
    EXPECT_EQ(one.balls.solid_to_balls, other.balls.solid_to_balls);
    EXPECT_EQ(one.balls.balls_to_surface, other.balls.balls_to_surface);
    EXPECT_EQ(one.geometry.radius_error, other.geometry.radius_error);
    EXPECT_EQ(one.geometry.footprint_error, other.geometry.footprint_error);
  }
}

TEST(Certificate, CancelStopsIt) {
  const TriangleMesh torus = make_torus({});
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)certify(torus_axis(torus), torus, unlabelled, {.cancel = source.get_token()}), Cancelled);
  const GridSpec grid{{}, {1, 1, 1}, {3, 3, 3}, {}};
  VoxelSet voxels(grid.size);
  EXPECT_THROW((void)certify({}, voxels, grid, nullptr), InvalidOption) << "no solid";
  voxels.insert(1, 1, 1);
  EXPECT_THROW((void)certify({}, voxels, grid, nullptr, {}, {.cancel = source.get_token()}), Cancelled);
}

// ---- Voxels ----

/// A square ring of voxels 3 x 3 wide in a rotated grid, and its axis through the centres of voxels.
struct VoxelRing {
  VoxelSet voxels{{11, 11, 5}};
  GridSpec grid{{5, 6, 7}, {1, 1, 1.5}, {11, 11, 5}, {}};
  AxisRows axis;

  VoxelRing() {
    grid.direction.columns[0] = {0, 0.6, 0.8};
    grid.direction.columns[1] = {0, -0.8, 0.6};
    grid.direction.columns[2] = {1, 0, 0};
    for (std::int64_t k = 1; k < 4; ++k) {
      for (std::int64_t j = 1; j < 10; ++j) {
        for (std::int64_t i = 1; i < 10; ++i) {
          if (i < 4 || i > 6 || j < 4 || j > 6) voxels.insert(i, j, k);
        }
      }
    }
    // The path starts at voxel (2, 2, 2) and follows the ring. All vertices are 1.5 from a side wall.
    std::array<std::int64_t, 2> at{2, 2};
    for (const auto& [di, dj] : {std::array{1, 0}, {0, 1}, {-1, 0}, {0, -1}}) {
      for (int step = 0; step < 6; ++step) {
        add(at[0], at[1]);
        at[0] += di;
        at[1] += dj;
      }
    }
  }

  void add(std::int64_t i, std::int64_t j) {
    const auto count = static_cast<std::uint32_t>(axis.vertices.size());
    const Vec3d p = grid.position(i, j, 2);
    const bool is_upright = i == 2 || i == 8;  // the outer wall is crossed along i
    const double side = is_upright ? (i == 2 ? -1.5 : 1.5) : (j == 2 ? -1.5 : 1.5);
    const Vec3d foot = p + grid.direction.columns[is_upright ? 0 : 1] * side;
    axis.vertices.push_back({p, 1.5, {foot, foot}, {}});
    axis.edges.push_back({{count, (count + 1) % 24}});
  }
};

TEST(VoxelCertificate, HoldsForTheMiddleOfARing) {
  const VoxelRing ring;
  const Certificate c = certify(ring.axis, ring.voxels, ring.grid, nullptr, unlabelled);
  EXPECT_TRUE(c.holds()) << complaints(c);
  EXPECT_EQ(c.edges.edges, 24U);
  EXPECT_EQ(c.against, SolidRule::voxels);
  EXPECT_EQ(c.solid, (BettiNumbers{1, 1, 0}));
  EXPECT_NEAR(c.geometry.tolerance, 1e-6 * std::sqrt(81 + 81 + 4.5 * 4.5), 1e-9);
  EXPECT_GT(c.balls.solid_to_balls, 0.5) << "corners";
  EXPECT_LT(c.balls.solid_to_balls, std::sqrt(1.5 * 1.5 + 1.5 * 1.5 + 2.25 * 2.25) - 1.5);
  EXPECT_NEAR(c.balls.balls_beyond_solid, 0, 1e-12);
}

TEST(VoxelCertificate, BodyByBody) {
  VoxelSet voxels({9, 3, 3});
  for (const std::int64_t i : {1, 2, 3, 6, 7}) voxels.insert(i, 1, 1);
  const GridSpec grid{{}, {1, 1, 1}, voxels.size(), {}};
  AxisRows axis;
  const auto add = [&](double x) {
    const Vec3d p{x, 1, 1};
    axis.vertices.push_back({p, 0.5, {p + Vec3d{0, 0.5, 0}, p + Vec3d{0, 0.5, 0}}, {}});
  };
  add(2);
  add(6.5);
  EXPECT_TRUE(certify(axis, voxels, grid, nullptr, unlabelled).holds())
      << complaints(certify(axis, voxels, grid, nullptr, unlabelled));
  // A site is the voxel beyond the face, or none.
  axis.vertices[0].sites = {SiteId(2 + 9 * (2 + 3 * 1)), SiteId::none()};
  EXPECT_TRUE(certify(axis, voxels, grid, nullptr, unlabelled).holds());
  axis.vertices[0].sites[1] = SiteId(2);
  EXPECT_FALSE(certify(axis, voxels, grid, nullptr, unlabelled).holds());
  axis.vertices.clear();
  add(1);
  add(3);
  EXPECT_EQ(complaints(certify(axis, voxels, grid, nullptr, unlabelled)),
            "body 1 of 2 (around 2 1 1) has 1 component, the axis in it has 2\n"
            "body 2 of 2 (around 6.5 1 1) has 1 component, the axis in it has 0\n");
  axis.vertices.clear();
  add(3);
  add(6);
  axis.edges = {{{0, 1}}};
  const Certificate c = certify(axis, voxels, grid, nullptr, unlabelled);
  EXPECT_EQ(c.edges.outside, 1U) << complaints(c);
}

TEST(VoxelCertificate, FindsFalseRadiiAndTopology) {
  VoxelRing ring;
  ring.axis.vertices[4].radius = 2.25;
  Certificate c = certify(ring.axis, ring.voxels, ring.grid, nullptr, unlabelled);
  EXPECT_EQ(c.mismatches.size(), 2U) << complaints(c);
  EXPECT_NEAR(c.geometry.radius_error, 0.75, 1e-12);
  EXPECT_NEAR(c.balls.balls_beyond_solid, 0.75, 1e-12);
  for (const double size : {1e-120, 1e120}) {
    VoxelRing extreme;
    extreme.grid.origin *= size;
    extreme.grid.spacing *= size;
    for (VertexRow& vertex : extreme.axis.vertices) {
      vertex.position *= size;
      vertex.radius *= size;
      for (Vec3d& foot : vertex.footprints) foot *= size;
    }
    EXPECT_TRUE(certify(extreme.axis, extreme.voxels, extreme.grid, nullptr, unlabelled).holds()) << size;
    extreme.axis.vertices[4].radius *= 1.5;
    c = certify(extreme.axis, extreme.voxels, extreme.grid, nullptr, unlabelled);
    EXPECT_NEAR(c.geometry.radius_error, 0.75 * size, 1e-12 * size);
  }
  ring = {};
  ring.voxels.erase(5, 2, 1);
  ring.voxels.erase(5, 2, 2);
  ring.voxels.erase(5, 2, 3);
  c = certify(ring.axis, ring.voxels, ring.grid, nullptr, unlabelled);
  EXPECT_EQ(c.geometry.outside, 1U) << complaints(c);
  EXPECT_NEAR(c.geometry.outside_by, 0.5, 1e-12);
  EXPECT_NE(complaints(c).find("the solid has 2 tunnels, the axis has 1"), std::string::npos) << complaints(c);
  ring = {};
  ring.voxels.erase(8, 8, 2);
  c = certify(ring.axis, ring.voxels, ring.grid, nullptr, unlabelled);
  EXPECT_NE(complaints(c).find("the solid has 1 void, the axis has 0"), std::string::npos) << complaints(c);
  ring.grid.size[0] = 12;
  EXPECT_THROW((void)certify(ring.axis, ring.voxels, ring.grid, nullptr, unlabelled), InvalidOption);
}

TEST(VoxelCertificate, VoxelsOfAnOpenMeshAreMeasuredAgainstTheMesh) {
  // A box without one of its triangles, and voxels that fill most of it.
  TriangleMesh mesh = box_between({0, 0, 0}, {4, 4, 4});
  mesh.triangles.pop_back();
  VoxelSet voxels({4, 4, 4});
  for (std::int64_t n = 0; n < 64; ++n) voxels.insert(n % 4, n / 4 % 4, n / 16);
  const GridSpec grid{{0.5, 0.5, 0.5}, {1, 1, 1}, {4, 4, 4}, {}};
  const MeshView view = mesh;
  AxisRows axis = ball_axis(mesh, {2, 2, 2});
  Certificate c = certify(axis, voxels, grid, &view, unlabelled);
  EXPECT_TRUE(c.holds()) << complaints(c);
  EXPECT_EQ(c.against, SolidRule::winding);
  EXPECT_EQ(c.solid, (BettiNumbers{1, 0, 0}));
  axis = ball_axis(mesh, {2, 2, 9});
  c = certify(axis, voxels, grid, &view, unlabelled);
  EXPECT_EQ(c.geometry.outside, 1U) << complaints(c);
  EXPECT_EQ(c.mismatches.size(), 1U) << complaints(c);
  TriangleMesh points = make_points({});
  const MeshView no_surface = points;
  EXPECT_THROW((void)certify(axis, voxels, grid, &no_surface), InvalidMesh);
  // A single voxel does not cover the mesh.
  VoxelSet one({1, 1, 1});
  one.insert(0, 0, 0);
  axis = ball_axis(mesh, {2, 2, 2});
  EXPECT_THROW((void)certify(axis, one, {{2, 2, 2}, {1, 1, 1}, {1, 1, 1}, {}}, &view, unlabelled), InvalidGrid);
}

TEST(CertificateSlow, ALargeAxis) {
  // A sphere halfway between the surface and the centre. It is not the axis of the ball, but has as many vertices as an
  // axis may have.
  const TriangleMesh ball = make_sphere({.frequency = 70});
  const Bvh bvh(ball, SiteTable(ball));
  const TriangleMesh inner = make_sphere({.radius = 0.5, .frequency = 70});
  AxisRows axis;
  for (const Vec3d& p : inner.vertices) axis.vertices.push_back(vertex_at(bvh, p));
  for (const Triangle& t : inner.triangles) axis.triangles.push_back({t});
  const auto start = std::chrono::steady_clock::now();
  const auto log = [&](double fraction, std::string_view phase) {
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (fraction == 0 || fraction == 1) std::cout << phase << " " << fraction << ": " << seconds.count() << " s\n";
  };
  const Certificate c = certify(axis, ball, unlabelled, {.threads = 1, .progress = log});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  std::cout << axis.vertices.size() << " vertices, " << ball.triangles.size() << " triangles: " << seconds.count()
            << " s, step " << c.balls.step << "\n";
  EXPECT_EQ(complaints(c), "the solid has 0 voids, the axis has 1\n");
}

}  // namespace
}  // namespace blum
