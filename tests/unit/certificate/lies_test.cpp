// Proves that a certificate refuses axes that lie: each test takes a true one, falsifies one thing, and looks at what
// is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/geometry/bvh.hpp"
#include "blum/io/verify_medial.hpp"
#include "blum/medial_axis/decimate.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::VertexRow;

constexpr double theta = 60;

/// A true axis and what its file would say.
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

/// What a certificate complains of, in one line.
std::string complaints(const Certificate& certificate) {
  std::string all;
  for (const std::string& one : certificate.mismatches) all += one + "\n";
  return all;
}

/// That a lie is refused, saying this.
void expect_refused(const True& lie, const std::string& reason) {
  const Certificate found = verdict(lie);
  EXPECT_FALSE(found.holds());
  EXPECT_NE(complaints(found).find(reason), std::string::npos) << complaints(found);
}

/// Moves vertices, and gives them the radii and the footprints that they have there.
template <class Move>
void move_honestly(True& lie, const Move& move) {
  const SiteTable sites(lie.mesh);
  const Bvh bvh(lie.mesh, sites);
  for (VertexRow& vertex : lie.axis.vertices) {
    vertex.position = move(vertex);
    const NearestSite nearest = *bvh.nearest(vertex.position);
    vertex.radius = nearest.distance;
    vertex.footprints = {nearest.point, nearest.point};
    vertex.sites = {nearest.site, nearest.site};
    vertex.separation_angle = 0;
  }
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
    expect_refused(lie, "middle between two");
  }
}

TEST(Lies, AllVerticesHalfwayToTheWallThatSayNothingOfAngles) {
  True lie = box();
  move_honestly(lie, [](const VertexRow& v) { return (v.position + v.footprints[0]) * 0.5; });
  for (auto& triangle : lie.axis.triangles) triangle.separation_angle = 0;
  for (auto& edge : lie.axis.edges) edge.separation_angle = 0;
  expect_refused(lie, "the axis misses");
}

TEST(Lies, AllVerticesHalfAVoxelOff) {
  True lie = bracket();
  move_honestly(lie, [&](const VertexRow& v) {
    const Vec3d towards = v.footprints[0] - v.position;
    return v.position + towards * std::min(0.5 * lie.voxel / length(towards), 0.9);
  });
  expect_refused(lie, "middle between two");
}

}  // namespace
}  // namespace blum
