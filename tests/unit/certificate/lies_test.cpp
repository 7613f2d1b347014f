// Proves that a certificate rejects false axes. Each test falsifies one item of a true axis and checks the reported
// mismatch.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/axis/decimate.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::VertexRow;

constexpr double theta = 60;

/// A true axis and the claims of its file.
struct True {
  TriangleMesh mesh;
  AxisRows axis;
  MedialClaims claims;
  double voxel = 0;
};

True axis_of(TriangleMesh mesh, int resolution, double angle = theta) {
  const MedialAxis axis = medial_axis(mesh, {.resolution = resolution});
  True made{std::move(mesh), {}, {}, axis.report().bodies.front().spacing};
  const DecimatedAxis lean = decimate(axis.simplify(angle), made.voxel / 4);
  made.axis = lean.axis;
  made.claims.metadata.version = "1";
  made.claims.metadata.solid_rule = to_string(axis.report().rule);
  made.claims.metadata.theta = angle;
  made.claims.metadata.lambda = 0;
  made.claims.metadata.spacing = made.voxel;
  made.claims.metadata.deviation = lean.deviation;
  return made;
}

const True& bracket() {
  static const True made = axis_of(make_bracket({}), 40);
  return made;
}

const True& box() {
  static const True made = axis_of(make_box({}), 32);
  return made;
}

Certificate verdict(const True& given) {
  return verify(given.axis, given.claims, given.mesh, {.balls = false});
}

/// The mismatches of a certificate as one text.
std::string complaints(const Certificate& certificate) {
  std::string all;
  for (const std::string& one : certificate.mismatches) all += one + "\n";
  return all;
}

/// Expects that a false axis is rejected for a reason.
void expect_refused(const True& lie, const std::string& reason) {
  const Certificate found = verdict(lie);
  EXPECT_FALSE(found.holds());
  EXPECT_NE(complaints(found).find(reason), std::string::npos) << complaints(found);
}

/// Moves a vertex and sets its exact radius and footprint.
void put_honestly(VertexRow& vertex, const Vec3d& place, const Bvh& bvh) {
  vertex.position = place;
  const NearestSite nearest = *bvh.nearest(place);
  vertex.radius = nearest.distance;
  vertex.footprints = {nearest.point, nearest.point};
  vertex.sites = {nearest.site, nearest.site};
  vertex.separation_angle = 0;
}

/// Moves all vertices in this way.
template <class Move>
void move_honestly(True& lie, const Move& move) {
  const SiteTable sites(lie.mesh);
  const Bvh bvh(lie.mesh, sites);
  for (VertexRow& vertex : lie.axis.vertices) put_honestly(vertex, move(vertex), bvh);
}

TEST(Lies, WhatIsTrueHolds) {
  for (const True* made : {&bracket(), &box()}) {
    const Certificate found = verdict(*made);
    EXPECT_TRUE(found.holds()) << complaints(found);
    EXPECT_TRUE(found.medial.holds);
    EXPECT_GT(found.medial.medial_share, 0.99);
    EXPECT_GT(found.medial.close_share, 0.8);
    EXPECT_GT(found.medial.balls, 1000U);
    EXPECT_EQ(found.medial.missed_share, 0);
  }
}

TEST(Lies, AllVerticesHalfwayToTheWall) {
  for (const True* made : {&bracket(), &box()}) {
    True lie = *made;
    move_honestly(lie, [](const VertexRow& v) { return (v.position + v.footprints[0]) * 0.5; });
    expect_refused(lie, "of the sheets and curves that should lie between two walls");
  }
}

TEST(Lies, AllVerticesHalfwayToTheWallWithoutAngles) {
  True lie = box();
  move_honestly(lie, [](const VertexRow& v) { return (v.position + v.footprints[0]) * 0.5; });
  for (auto& triangle : lie.axis.triangles) triangle.separation_angle = 0;
  for (auto& edge : lie.axis.edges) edge.separation_angle = 0;
  expect_refused(lie, "the axis misses");
}

TEST(Lies, AllVerticesHalfwayToTheWallOfACoarseGrid) {
  for (const True* made : {&bracket(), &box()}) {
    for (const double parts : {8.0, 16.0, 32.0}) {
      True lie = *made;
      move_honestly(lie, [](const VertexRow& v) { return (v.position + v.footprints[0]) * 0.5; });
      lie.claims.metadata.spacing = bounds(lie.mesh).diagonal() / parts;
      expect_refused(lie, "of the sheets and curves that should lie between two walls");
      lie.claims.metadata.deviation = bounds(lie.mesh).diagonal() / 16;
      expect_refused(lie, "closer to the middle than a quarter of their distance to the walls");
    }
  }
}

TEST(Lies, AllVerticesHalfAVoxelOff) {
  True lie = bracket();
  move_honestly(lie, [&](const VertexRow& v) {
    const Vec3d towards = v.footprints[0] - v.position;
    return v.position + towards * std::min(0.5 * lie.voxel / length(towards), 0.9);
  });
  expect_refused(lie, "have the same footprint twice");
}

TEST(Lies, OneVertexMoved) {
  True lie = bracket();
  lie.axis.vertices[lie.axis.vertices.size() / 2].position += Vec3d{1e-3, 2e-3, -1e-3};
  expect_refused(lie, "the distance to a footprint differs from the radius");
}

TEST(Lies, OneVertexMovedWithItsRadiusAndFootprint) {
  for (const double voxels : {6.0, 8.0}) {
    True lie = box();
    VertexRow& deepest = *std::max_element(lie.axis.vertices.begin(), lie.axis.vertices.end(),
                                           [](const auto& a, const auto& b) { return a.radius < b.radius; });
    const SiteTable sites(lie.mesh);
    const Vec3d towards = deepest.footprints[0] - deepest.position;
    put_honestly(deepest, deepest.position + towards * (voxels * lie.voxel / length(towards)), Bvh(lie.mesh, sites));
    expect_refused(lie, "the middle, the first one at");
  }
}

TEST(Lies, AllVerticesShifted) {
  True lie = bracket();
  for (VertexRow& vertex : lie.axis.vertices) vertex.position += Vec3d{0, 0, 2 * lie.voxel};
  expect_refused(lie, "a radius differs from the exact distance");
}

TEST(Lies, VerticesSpreadOverTheSolid) {
  True lie = box();
  Random random(3);
  move_honestly(lie, [&](const VertexRow&) { return (random.in_cube() - Vec3d{0.5, 0.5, 0.5}) * 0.9; });
  expect_refused(lie, "have the same footprint twice");
}

TEST(Lies, ErasedSecondFootprints) {
  True lie = bracket();
  for (VertexRow& vertex : lie.axis.vertices) {
    vertex.footprints[1] = vertex.footprints[0];
    vertex.sites[1] = vertex.sites[0];
    vertex.separation_angle = 0;
  }
  expect_refused(lie, "have the same footprint twice");
}

TEST(Lies, SecondFootprintsOfOtherVertices) {
  True lie = bracket();
  for (std::size_t v = 1; v < lie.axis.vertices.size(); ++v) {
    std::swap(lie.axis.vertices[v].footprints[1], lie.axis.vertices[v - 1].footprints[1]);
  }
  expect_refused(lie, "the distance to a footprint differs from the radius");
}

TEST(Lies, FootprintsOffTheSurface) {
  True lie = bracket();
  for (VertexRow& vertex : lie.axis.vertices) {
    const Vec3d out = vertex.footprints[1] - vertex.position;
    vertex.footprints[1] = vertex.position + Vec3d{-out.y, out.x, out.z};
  }
  expect_refused(lie, "a footprint lies off the surface");
}

TEST(Lies, SitesOfOtherFootprints) {
  True lie = bracket();
  for (VertexRow& vertex : lie.axis.vertices) std::swap(vertex.sites[0], vertex.sites[1]);
  expect_refused(lie, "a footprint lies off its site");
}

TEST(Lies, NonexistentSites) {
  True lie = bracket();
  lie.axis.vertices[3].sites[0] = SiteId(1'000'000);
  expect_refused(lie, "has a site that the solid does not have");
}

TEST(Lies, ErasedSites) {
  True lie = bracket();
  lie.axis.vertices[3].sites[1] = SiteId();
  expect_refused(lie, "1 vertex has a footprint without a site");
  for (VertexRow& vertex : lie.axis.vertices) vertex.sites = {};
  expect_refused(lie, "have a footprint without a site");
  lie.claims.metadata.version.clear();
  EXPECT_EQ(complaints(verdict(lie)), "") << "other programs need not name them";
}

TEST(Lies, ScaledRadii) {
  for (const double by : {0.5, 0.999, 1.001, 2.0}) {
    True lie = bracket();
    for (VertexRow& vertex : lie.axis.vertices) vertex.radius *= by;
    expect_refused(lie, "a radius differs from the exact distance");
  }
}

TEST(Lies, ScaledAxis) {
  True lie = box();
  for (VertexRow& vertex : lie.axis.vertices) {
    vertex.position *= 0.5;
    vertex.radius *= 0.5;
    for (Vec3d& foot : vertex.footprints) foot *= 0.5;
  }
  expect_refused(lie, "a radius differs from the exact distance");
}

TEST(Lies, FalseAnglesOfVertices) {
  True lie = bracket();
  for (VertexRow& vertex : lie.axis.vertices) vertex.separation_angle = 180;
  expect_refused(lie, "a separation angle differs from the angle between the footprints");
}

/// Keeps only the triangles that `keep` selects, and all edges and vertices.
template <class Keep>
void drop_triangles(True& lie, const Keep& keep) {
  std::erase_if(lie.axis.triangles, [&](const test::TriangleRow& t) { return !keep(t); });
}

TEST(Lies, MissingTriangle) {
  True lie = bracket();
  lie.axis.triangles.erase(lie.axis.triangles.begin() + static_cast<std::ptrdiff_t>(lie.axis.triangles.size() / 2));
  expect_refused(lie, "tunnel");
}

TEST(Lies, MissingSheets) {
  True lie = bracket();
  ASSERT_GT(lie.axis.sheet_count, 10U);
  drop_triangles(lie, [](const test::TriangleRow& t) { return t.sheet < 2; });
  expect_refused(lie, "the axis misses");
}

TEST(Lies, HalfOfTheSheetsMissing) {
  True lie = box();
  drop_triangles(lie, [](const test::TriangleRow& t) { return t.sheet % 2 == 0; });
  expect_refused(lie, "the axis misses");
}

TEST(Lies, ASmallSheetOffTheMiddle) {
  // The sheet has less than a hundredth of the total area, so among all samples it would not count. It hangs on a
  // vertex, so the topology stays. It lies beside the apex of the upper pyramid of the box, and nowhere in the middle
  // between its walls.
  True lie = box();
  const SiteTable sites(lie.mesh);
  const Bvh bvh(lie.mesh, sites);
  const auto deepest = std::max_element(lie.axis.vertices.begin(), lie.axis.vertices.end(),
                                        [](const VertexRow& a, const VertexRow& b) { return a.radius < b.radius; });
  const auto apex = static_cast<std::uint32_t>(deepest - lie.axis.vertices.begin());
  const auto first = static_cast<std::uint32_t>(lie.axis.vertices.size());
  for (const Vec3d& at : {Vec3d{0.05, -0.05, 0.35}, Vec3d{0.05, 0.05, 0.35}}) {
    VertexRow vertex = lie.axis.vertices[apex];
    put_honestly(vertex, at, bvh);
    vertex.role = MedialRole::rim;
    lie.axis.vertices.push_back(vertex);
  }
  for (const std::array<std::uint32_t, 2>& ends : {std::array{apex, first}, {first, first + 1}, {apex, first + 1}}) {
    lie.axis.edges.push_back({ends, 170, MedialRole::rim});
  }
  lie.axis.triangles.push_back({{apex, first, first + 1}, 170, lie.axis.sheet_count++});
  expect_refused(lie, "lie mostly off the middle");
}

TEST(Lies, ATreeInsteadOfTheAxis) {
  // A curve that ends at the centre of the box replaces the axis. It has the homotopy type of the box.
  True lie = box();
  const SiteTable sites(lie.mesh);
  const Bvh bvh(lie.mesh, sites);
  AxisRows tree;
  for (const double x : {-0.2, -0.1, 0.0}) {
    const NearestSite nearest = *bvh.nearest(Vec3d{x, 0, 0});
    tree.vertices.push_back(
        {{x, 0, 0}, nearest.distance, {nearest.point, nearest.point}, {nearest.site, nearest.site}});
  }
  tree.edges = {{{0, 1}}, {{1, 2}}};
  lie.axis = tree;
  expect_refused(lie, "the axis misses");
}

/// Replaces the axis by one vertex.
void leave_one_vertex(True& lie, const Vec3d& at) {
  const SiteTable sites(lie.mesh);
  const NearestSite nearest = *Bvh(lie.mesh, sites).nearest(at);
  lie.axis = {};
  lie.axis.vertices = {{at, nearest.distance, {nearest.point, nearest.point}, {nearest.site, nearest.site}}};
  lie.axis.vertices.front().role = MedialRole::curve;
}

TEST(Lies, OneVertexOfACoarseGrid) {
  True lie = box();
  leave_one_vertex(lie, {0.01, 0.02, 0});
  lie.claims.metadata.spacing = bounds(lie.mesh).diagonal() / 8;
  lie.claims.metadata.deviation = bounds(lie.mesh).diagonal() / 16;
  expect_refused(lie, "the axis misses");
}

TEST(Lies, OneVertexInsteadOfAThinPlate) {
  // The plate is less than 3 voxels thick.
  True thin = axis_of(make_box({.size = {1, 0.7, 0.03}}), 64);
  EXPECT_EQ(complaints(verdict(thin)), "");
  leave_one_vertex(thin, {-0.49, -0.34, -0.005});
  expect_refused(thin, "the axis misses");
}

/// A large box and a small one that is less than 3 voxels thick.
TriangleMesh box_and_bar() {
  TriangleMesh both = make_box({});
  const TriangleMesh bar = make_box({.size = {0.5, 0.05, 0.05}});
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  for (const Vec3d& v : bar.vertices) both.vertices.push_back(v + Vec3d{0, 1, 0});
  for (const auto& [a, b, c] : bar.triangles) both.triangles.push_back({a + first, b + first, c + first});
  return both;
}

TEST(Lies, OneVertexInASmallBody) {
  True lie = axis_of(box_and_bar(), 64);
  const Certificate found = verdict(lie);
  EXPECT_EQ(complaints(found), "");
  EXPECT_EQ(found.medial.bodies_unseen, 0U);
  AxisRows own;  // the axis of the large box only
  std::vector<std::uint32_t> number(lie.axis.vertices.size(), 0);
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (lie.axis.vertices[v].position.y > 0.75) continue;
    number[v] = static_cast<std::uint32_t>(own.vertices.size());
    own.vertices.push_back(lie.axis.vertices[v]);
  }
  const auto is_of_bar = [&](std::uint32_t v) { return lie.axis.vertices[v].position.y > 0.75; };
  for (test::TriangleRow t : lie.axis.triangles) {
    if (is_of_bar(t.vertices[0])) continue;
    for (std::uint32_t& v : t.vertices) v = number[v];
    own.triangles.push_back(t);
  }
  for (test::EdgeRow e : lie.axis.edges) {
    if (is_of_bar(e.vertices[0])) continue;
    for (std::uint32_t& v : e.vertices) v = number[v];
    own.edges.push_back(e);
  }
  leave_one_vertex(lie, {-0.23, 0.99, -0.01});
  own.vertices.push_back(lie.axis.vertices.front());
  own.sheet_count = 1;
  for (const test::TriangleRow& t : own.triangles) own.sheet_count = std::max(own.sheet_count, t.sheet + 1);
  lie.axis = own;
  expect_refused(lie, "in 1 of the bodies the axis misses");
}

TEST(Lies, ALambdaAsLargeAsTheSolidSkipsTheCheckForMissingParts) {
  True point = box();
  leave_one_vertex(point, {0.01, 0.02, 0});
  EXPECT_FALSE(verdict(point).holds());
  point.claims.metadata.lambda = bounds(point.mesh).diagonal();
  const Certificate found = verdict(point);
  EXPECT_TRUE(found.holds()) << complaints(found);
  EXPECT_FALSE(found.medial.judges_missing);
  EXPECT_EQ(found.checked.lambda, point.claims.metadata.lambda);
}

TEST(Lies, TheAxisOfALargerAngle) {
  True lie = axis_of(make_box({}), 32, 120);
  lie.claims.metadata.theta = 20;
  expect_refused(lie, "the axis misses");
}

TEST(Lies, TheAxisOfAnotherSolid) {
  True lie = bracket();
  lie.axis = box().axis;
  expect_refused(lie, "differs");
  lie = box();
  lie.mesh = make_box({.size = {1, 1, 1.1}});
  expect_refused(lie, "differs");
}

TEST(Lies, FalseRuleOfTheSolid) {
  True lie = box();
  lie.claims.metadata.solid_rule = "voxels";
  expect_refused(lie, "the file says that its solid is 'voxels'");
}

TEST(Lies, MissingColumnsThatBlumWrites) {
  for (bool MedialClaims::* const has :
       {&MedialClaims::has_radii, &MedialClaims::has_footprints, &MedialClaims::has_angles, &MedialClaims::has_sites}) {
    True lie = box();
    lie.claims.*has = false;
    expect_refused(lie, "contains no");
  }
}

}  // namespace
}  // namespace blum
