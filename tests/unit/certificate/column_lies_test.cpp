// Proves that a certificate rejects false labels, false angles of triangles and edges, and false claims of an axis.
// Each test falsifies one item of a true axis.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
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
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

/// A true axis and the claims of its file.
struct True {
  TriangleMesh mesh;
  AxisRows axis;
  MedialClaims claims;
};

True axis_of(TriangleMesh mesh, int resolution, double theta, bool is_lean) {
  const MedialAxis axis = medial_axis(mesh, {.resolution = resolution});
  const double voxel = axis.report().bodies.front().spacing;
  True made{std::move(mesh), axis.simplify(theta), {}};
  made.claims.metadata.version = "1";
  made.claims.metadata.solid_rule = to_string(axis.report().rule);
  made.claims.metadata.theta = theta;
  made.claims.metadata.lambda = 0;
  made.claims.metadata.spacing = voxel;
  if (!is_lean) return made;
  const DecimatedAxis lean = decimate(axis.fitted(theta), voxel / 4);
  made.axis = lean.axis;
  made.claims.metadata.deviation = lean.deviation;
  return made;
}

const True& bracket() {
  static const True made = axis_of(make_bracket({}), 40, 60, true);
  return made;
}

std::string complaints(const True& given) {
  std::string all;
  for (const std::string& one : verify(given.axis, given.claims, given.mesh, {.balls = false}).mismatches) {
    all += one + "\n";
  }
  return all;
}

void expect_refused(const True& lie, const std::string& reason) {
  const std::string found = complaints(lie);
  EXPECT_NE(found.find(reason), std::string::npos) << "found: " << found;
}

template <class Row>
void shuffle_angles(std::vector<Row>& rows) {
  Random random(7);
  for (std::size_t k = rows.size(); k > 1; --k) {
    const auto other = static_cast<std::size_t>(random.uniform() * static_cast<double>(k));
    std::swap(rows[k - 1].separation_angle, rows[std::min(other, k - 1)].separation_angle);
  }
}

TEST(ColumnLies, WhatIsTrueHolds) {
  for (const double theta : {20.0, 120.0}) {
    for (const bool is_lean : {false, true}) {
      EXPECT_EQ(complaints(axis_of(make_bracket({}), 32, theta, is_lean)), "") << theta << is_lean;
      EXPECT_EQ(complaints(axis_of(make_torus({}), 32, theta, is_lean)), "") << theta << is_lean;
      EXPECT_EQ(complaints(axis_of(make_organic({}), 32, theta, is_lean)), "") << theta << is_lean;
      EXPECT_EQ(complaints(axis_of(make_star({}), 32, theta, is_lean)), "") << theta << is_lean;
    }
  }
  EXPECT_EQ(complaints(bracket()), "");
}

TEST(ColumnLies, DoubledCells) {
  True lie = bracket();
  lie.axis.triangles.push_back(lie.axis.triangles.front());
  expect_refused(lie, "cells are listed twice");
  lie = bracket();
  lie.axis.edges.push_back(lie.axis.edges.front());
  expect_refused(lie, "cells are listed twice");
}

TEST(ColumnLies, ShuffledSheets) {
  True lie = bracket();
  for (std::size_t t = 0; t < lie.axis.triangles.size(); ++t) {
    lie.axis.triangles[t].sheet = static_cast<std::uint32_t>(t % lie.axis.sheet_count);
  }
  expect_refused(lie, "sheets are not connected");
}

TEST(ColumnLies, GapsInTheNumbersOfSheets) {
  True lie = bracket();
  ASSERT_GT(lie.axis.sheet_count, 10U);
  for (TriangleRow& triangle : lie.axis.triangles) triangle.sheet += triangle.sheet > 3 ? 1 : 0;
  ++lie.axis.sheet_count;
  expect_refused(lie, "1 sheet numbers below the largest are not used");
}

TEST(ColumnLies, OneSheet) {
  True lie = bracket();
  for (TriangleRow& triangle : lie.axis.triangles) triangle.sheet = 0;
  expect_refused(lie, "sheets are not connected");
}

TEST(ColumnLies, ASheetForEachTriangle) {
  True lie = bracket();
  for (std::size_t t = 0; t < lie.axis.triangles.size(); ++t) {
    lie.axis.triangles[t].sheet = static_cast<std::uint32_t>(t);
  }
  expect_refused(lie, "that are not seams separate two sheets");
}

TEST(ColumnLies, FalseRoles) {
  for (const MedialRole role : {MedialRole::sheet, MedialRole::rim, MedialRole::junction}) {
    True lie = bracket();
    for (VertexRow& vertex : lie.axis.vertices) vertex.role = role;
    expect_refused(lie, "vertices have a role");
  }
  True lie = bracket();
  lie.axis.vertices.front().role =
      lie.axis.vertices.front().role == MedialRole::seam ? MedialRole::rim : MedialRole::seam;
  expect_refused(lie, "1 vertices have a role");
  for (const MedialRole role : {MedialRole::rim, MedialRole::seam, MedialRole::curve}) {
    lie = bracket();
    for (EdgeRow& edge : lie.axis.edges) edge.role = role;
    expect_refused(lie, "edges have a role");
  }
}

TEST(ColumnLies, UnlistedEdges) {
  True lie = bracket();
  lie.axis.edges.erase(lie.axis.edges.begin());
  expect_refused(lie, "1 edges of rims and seams are not listed");
}

TEST(ColumnLies, EdgesInsideOfSheetsAreListed) {
  True lie = bracket();
  for (const TriangleRow& triangle : lie.axis.triangles) {
    lie.axis.edges.push_back({{triangle.vertices[0], triangle.vertices[1]}, 0, MedialRole::rim});
  }
  expect_refused(lie, "listed edges lie inside sheets");
}

TEST(ColumnLies, FalseAnglesOfTriangles) {
  for (const float factor : {0.25F, 0.5F, 0.8F}) {
    True lie = bracket();
    for (TriangleRow& triangle : lie.axis.triangles) triangle.separation_angle *= factor;
    expect_refused(lie, "have a smaller separation angle than each of their corners");
  }
  True lie = bracket();
  for (TriangleRow& triangle : lie.axis.triangles) triangle.separation_angle = 180;
  expect_refused(lie, "have a larger separation angle than any point examined near them");
  lie = bracket();
  shuffle_angles(lie.axis.triangles);
  expect_refused(lie, "separation angle");
}

TEST(ColumnLies, AllAnglesZero) {
  True lie = bracket();
  for (TriangleRow& triangle : lie.axis.triangles) triangle.separation_angle = 0;
  for (EdgeRow& edge : lie.axis.edges) edge.separation_angle = 0;
  expect_refused(lie, "have a smaller separation angle than each of their corners");
}

TEST(ColumnLies, FalseAnglesOfEdges) {
  True lie = bracket();
  for (EdgeRow& edge : lie.axis.edges) edge.separation_angle = 180;
  expect_refused(lie, "have a larger separation angle than each of their triangles");
  lie = bracket();
  for (EdgeRow& edge : lie.axis.edges) edge.separation_angle *= 0.25F;
  expect_refused(lie, "below the largest of their triangles");
  lie = bracket();
  shuffle_angles(lie.axis.edges);
  expect_refused(lie, "separation angle");
}

TEST(ColumnLies, TheAxisOfASmallerAngle) {
  True lie = bracket();
  lie.claims.metadata.theta = 120;
  expect_refused(lie, "lies on rims of sheets without an angle above 120 degrees");
}

TEST(ColumnLies, ImpossibleFigures) {
  const auto refused = [](std::optional<double> MedialMetadata::* const member, double value, const char* what) {
    True lie = bracket();
    lie.claims.metadata.*member = value;
    expect_refused(lie, std::string("says that its ") + what);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {-1.0, 181.0, nan}) refused(&MedialMetadata::theta, value, "theta");
  for (const double value : {-1.0, 1e3, nan}) {
    refused(&MedialMetadata::lambda, value, "lambda");
    refused(&MedialMetadata::spacing, value, "spacing");
    refused(&MedialMetadata::deviation, value, "deviation");
  }
  refused(&MedialMetadata::spacing, 0, "spacing");
}

TEST(ColumnLies, FootprintsOfTheMirroredVertex) {
  True lie = bracket();
  ASSERT_GT(lie.axis.vertices.size(), 100U);
  VertexRow& first = lie.axis.vertices.front();
  const auto other =
      std::max_element(lie.axis.vertices.begin(), lie.axis.vertices.end(), [&](const VertexRow& a, const VertexRow& b) {
        return squared_length(a.position - first.position) < squared_length(b.position - first.position);
      });
  std::swap(first.footprints, other->footprints);
  std::swap(first.sites, other->sites);
  expect_refused(lie, "the distance to a footprint differs from the radius");
}

TEST(ColumnLies, ATriangleAcrossTheHole) {
  True lie{make_torus({}), {}, {}};
  const SiteTable sites(lie.mesh);
  const Bvh bvh(lie.mesh, sites);
  for (const double turn : {0.0, 2.0, 4.0}) {
    const Vec3d at{std::cos(turn), std::sin(turn), 0};
    const NearestSite nearest = *bvh.nearest(at);
    lie.axis.vertices.push_back({at, nearest.distance, {nearest.point, nearest.point}, {nearest.site, nearest.site}});
  }
  lie.axis.triangles.push_back({{0, 1, 2}});
  expect_refused(lie, "triangles leave the solid between their edges");
}

}  // namespace
}  // namespace blum
