// Proves that a certificate rejects sheets between two pairs of walls, seams of two sheets, and axes without a sheet
// that random balls show. Each test falsifies one item of a true axis or diagram.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/label_sheets.hpp"
#include "blum/certified/verify_axis.hpp"
#include "blum/complex/homology.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;

/// A true axis and the claims of its file.
struct True {
  TriangleMesh mesh;
  Complex axis;
  MedialClaims claims;
};

True axis_of(const std::string& shape, double theta, int resolution = 48) {
  True made{make_shape(shape), {}, {}};
  const MedialAxis axis = medial_axis(made.mesh, {.resolution = resolution});
  made.axis = axis.fitted(theta);
  made.claims.metadata.theta = theta;
  made.claims.metadata.lambda = 0;
  made.claims.metadata.spacing = axis.report().bodies.front().spacing;
  made.claims.metadata.fitted = true;
  return made;
}

True axis_of_diagram(const std::string& shape, VoronoiMethod method, double theta) {
  True made{make_shape(shape), {}, {}};
  VoronoiComplex walls = voronoi_complex(made.mesh, {.part = VoronoiPart::medial_axis, .method = method});
  add_patch_columns(walls.complex, voronoi_patches(made.mesh, voronoi_sites(made.mesh, walls.report), {}));
  made.axis = collapse_axis(walls.complex, theta);
  made.claims.metadata.theta = theta;
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

/// Returns an axis without the triangles of a sheet. All roles and sheets of the result are right.
Complex without_sheet(const AxisRows& rows, std::uint32_t sheet) {
  AxisRows out;
  std::vector<bool> is_used(rows.vertices.size(), false);
  for (const TriangleRow& triangle : rows.triangles) {
    if (triangle.sheet == sheet) continue;
    out.triangles.push_back(triangle);
    for (const std::uint32_t v : triangle.vertices) is_used[v] = true;
  }
  for (const EdgeRow& edge : rows.edges) {
    if (edge.role != MedialRole::curve) continue;
    out.edges.push_back(edge);
    for (const std::uint32_t v : edge.vertices) is_used[v] = true;
  }
  std::vector<std::uint32_t> number(rows.vertices.size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    number[v] = static_cast<std::uint32_t>(out.vertices.size());
    if (is_used[v]) out.vertices.push_back(rows.vertices[v]);
  }
  for (TriangleRow& triangle : out.triangles) {
    for (std::uint32_t& v : triangle.vertices) v = number[v];
  }
  for (EdgeRow& edge : out.edges) {
    for (std::uint32_t& v : edge.vertices) v = number[v];
  }
  Complex axis = out;
  detail::label_sheets(axis, Incidence(axis.view()));
  return axis;
}

/// Returns the areas of all sheets.
std::vector<double> areas_of(const AxisRows& rows) {
  std::vector<double> areas(rows.sheet_count, 0);
  for (const TriangleRow& triangle : rows.triangles) {
    const auto& [a, b, c] = triangle.vertices;
    const Vec3d& at = rows.vertices[a].position;
    areas[triangle.sheet] += length(cross(rows.vertices[b].position - at, rows.vertices[c].position - at)) / 2;
  }
  return areas;
}

/// Returns pairs of sheets that have a seam edge in common.
std::set<std::array<std::uint32_t, 2>> neighbours(const AxisRows& rows) {
  const Complex axis = rows;
  const Incidence incidence(axis.view());
  std::set<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const auto at = incidence.triangles_of_edge()[e];
    for (const std::uint32_t t : at) {
      for (const std::uint32_t u : at) {
        if (rows.triangles[t].sheet < rows.triangles[u].sheet) {
          pairs.insert({rows.triangles[t].sheet, rows.triangles[u].sheet});
        }
      }
    }
  }
  return pairs;
}

/// Returns an axis in which two sheets have one number.
Complex merged(AxisRows rows, const std::array<std::uint32_t, 2>& sheets) {
  for (TriangleRow& triangle : rows.triangles) {
    if (triangle.sheet == sheets[1]) {
      triangle.sheet = sheets[0];
    } else if (triangle.sheet > sheets[1]) {
      --triangle.sheet;
    }
  }
  return rows;
}

TEST(SheetLies, ASeamOfTwoSheets) {
  True lie = axis_of("box", 60, 24);
  AxisRows rows(lie.axis);
  const auto third = std::find_if(rows.edges.begin(), rows.edges.end(),
                                  [](const EdgeRow& edge) { return edge.role == MedialRole::seam; });
  ASSERT_NE(third, rows.edges.end());
  const auto has = [&](const TriangleRow& triangle) {
    return std::count(triangle.vertices.begin(), triangle.vertices.end(), third->vertices[0]) +
               std::count(triangle.vertices.begin(), triangle.vertices.end(), third->vertices[1]) ==
           2;
  };
  rows.triangles.erase(std::find_if(rows.triangles.begin(), rows.triangles.end(), has));
  lie.axis = rows;
  expect_refused(lie, "a seam at ");
  expect_refused(lie, "has only the sheets ");
}

TEST(SheetLies, AMissingSheet) {
  const True made = axis_of("box", 60, 24);
  const AxisRows rows(made.axis);
  const BettiNumbers betti = homology(made.axis.view());
  std::size_t lies = 0;
  for (std::uint32_t sheet = 0; sheet < rows.sheet_count; ++sheet) {
    True lie = made;
    lie.axis = without_sheet(rows, sheet);
    if (homology(lie.axis.view()) != betti) continue;
    ++lies;
    expect_refused(lie, "the axis misses sheets between ");
  }
  EXPECT_GE(lies, 4U);
}

TEST(SheetLies, TwoSheetsWithOneNumber) {
  const True made = axis_of_diagram("box", VoronoiMethod::cubes, 10);
  const AxisRows rows(made.axis);
  const std::vector<double> areas = areas_of(rows);
  const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (const auto& [a, b] : neighbours(rows)) {
    if (std::min(areas[a], areas[b]) < 0.02 * total) continue;
    True lie = made;
    lie.axis = merged(rows, {a, b});
    EXPECT_NE(complaints(lie), "") << a << " and " << b;
  }
}

TEST(SheetLies, OtherSites) {
  True lie = axis_of_diagram("bracket", VoronoiMethod::automatic, 10);
  ASSERT_EQ(complaints(lie), "");
  const auto sites = lie.axis.triangle_columns.edit<std::int32_t>("site_a");
  std::rotate(sites.begin(), sites.begin() + 1000, sites.end());
  expect_refused(lie, "have a footprint on another site, the first one at ");
}

TEST(SheetLies, OtherPatches) {
  True lie = axis_of_diagram("bracket", VoronoiMethod::automatic, 10);
  const auto sheets = lie.axis.triangle_columns.edit<std::int32_t>(medial_columns::patch_sheet);
  std::replace(sheets.begin(), sheets.end(), 1, 0);
  expect_refused(lie, "sheet 0 of patches lies between two pairs of patches");
}

TEST(SlowSheetLies, WhatIsTrueHolds) {
  for (const char* const shape : {"box", "bracket", "wedge", "torus", "void_cube", "gear"}) {
    for (const double theta : {1.0, 10.0, 60.0, 120.0, 170.0}) {
      EXPECT_EQ(complaints(axis_of(shape, theta)), "") << shape << " " << theta;
    }
  }
}

}  // namespace
}  // namespace blum
