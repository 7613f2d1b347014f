// Proves that labels distinguish sheets, rims, seams, curves and junctions of complexes made by hand.
#include "blum/axis/label_sheets.hpp"
#include "blum/complex/incidence.hpp"
#include "support/medial_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace blum {
namespace {

using detail::label_sheets;

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

using enum MedialRole;
using Face = std::array<std::uint32_t, 3>;
using Edge = std::array<std::uint32_t, 2>;

void label_sheets(AxisRows& axis) {
  Complex complex = axis;
  blum::label_sheets(complex, Incidence(complex.view()));
  axis = complex;
}

AxisRows labelled(std::size_t vertices, const std::vector<Face>& faces, const std::vector<Edge>& curves = {}) {
  AxisRows complex;
  complex.vertices.resize(vertices);
  for (const Face& face : faces) {
    complex.triangles.push_back({face, static_cast<float>(10 + complex.triangles.size()), 99});
  }
  for (const Edge& edge : curves) complex.edges.push_back({edge, 5, curve});
  label_sheets(complex);
  return complex;
}

std::vector<MedialRole> roles_of(const AxisRows& complex) {
  std::vector<MedialRole> roles;
  for (const VertexRow& vertex : complex.vertices) roles.push_back(vertex.role);
  return roles;
}

std::vector<std::uint32_t> sheets_of(const AxisRows& complex) {
  std::vector<std::uint32_t> sheets;
  for (const TriangleRow& triangle : complex.triangles) sheets.push_back(triangle.sheet);
  return sheets;
}

/// The edges of a role, each with its smaller vertex first.
std::vector<Edge> edges_of(const AxisRows& complex, MedialRole role) {
  std::vector<Edge> edges;
  for (const EdgeRow& edge : complex.edges) {
    if (edge.role == role) edges.push_back(edge.vertices);
  }
  return edges;
}

TEST(LabelSheets, ASquareIsASheetWithARim) {
  const AxisRows complex = labelled(4, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(complex.sheet_count, 1U);
  EXPECT_EQ(sheets_of(complex), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(edges_of(complex, rim), (std::vector<Edge>{{0, 1}, {0, 3}, {1, 2}, {2, 3}}));
  EXPECT_EQ(complex.edges.size(), 4U) << "the diagonal is no edge of a role";
  EXPECT_EQ(roles_of(complex), std::vector<MedialRole>(4, rim));
}

TEST(LabelSheets, AnInnerVertexIsInTheSheet) {
  const AxisRows complex = labelled(5, {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  EXPECT_EQ(roles_of(complex), (std::vector<MedialRole>{rim, rim, rim, rim, sheet}));
}

/// Vertices 0, 1, 2 lie on the seam. Three strips of two squares begin there.
TEST(LabelSheets, ThreeSheetsMeetInASeam) {
  std::vector<Face> faces;
  for (const std::uint32_t first : {3U, 6U, 9U}) {
    for (std::uint32_t k = 0; k < 2; ++k) {
      faces.push_back({k, k + 1, first + k});
      faces.push_back({k + 1, first + k + 1, first + k});
    }
  }
  const AxisRows complex = labelled(12, faces);
  EXPECT_EQ(complex.sheet_count, 3U);
  EXPECT_EQ(sheets_of(complex), (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}));
  EXPECT_EQ(edges_of(complex, seam), (std::vector<Edge>{{0, 1}, {1, 2}}));
  EXPECT_EQ(edges_of(complex, rim).size(), 12U);
  std::vector<MedialRole> expected(12, rim);
  expected[0] = expected[2] = junction;
  expected[1] = seam;
  EXPECT_EQ(roles_of(complex), expected);
}

/// A point at a given distance from the x axis, in a plane rotated around it.
Vec3d on_page(double x, double distance, double degrees) {
  const double turn = degrees * std::numbers::pi / 180;
  return {x, distance * std::cos(turn), distance * std::sin(turn)};
}

/// Adds a narrow strip between the first and the second page at an edge of the fold, so that the bend has two steps.
/// @param edge  its ends; @param to  the outer ends of the square of the second page.
void put_strip(AxisRows& book, double fold, const Edge& edge, const Edge& to) {
  const auto beside = static_cast<std::uint32_t>(book.vertices.size());
  for (const std::uint32_t v : edge) {
    book.vertices.emplace_back().position = on_page(book.vertices[v].position.x, 0.1, 180 - 0.5 * fold);
  }
  for (const Face& face :
       {Face{edge[0], edge[1], beside}, Face{edge[1], beside + 1, beside}, Face{beside, beside + 1, to[0]},
        Face{beside + 1, to[1], to[0]}, Face{edge[0], beside, to[0]}, Face{edge[1], to[1], beside + 1}}) {
    book.triangles.push_back({face, 10, 0});
  }
}

/// A book of two pages, folded by an angle along the x axis, and a third page. At the fold the third page lacks one of
/// its 16 edges.
AxisRows torn_book(double fold, bool is_in_two_steps = false) {
  constexpr std::uint32_t steps = 16;
  AxisRows complex;
  const auto row_of_vertices = [&](double distance, double degrees) {
    std::vector<std::uint32_t> row;
    for (std::uint32_t k = 0; k <= steps; ++k) {
      row.push_back(static_cast<std::uint32_t>(complex.vertices.size()));
      complex.vertices.emplace_back().position = on_page(k, distance, degrees);
    }
    return row;
  };
  const std::vector<std::uint32_t> fold_line = row_of_vertices(0, 0);
  for (const double degrees : {0.0, 180 - fold, 180 + 0.5 * (180 - fold)}) {
    std::vector<std::uint32_t> from = fold_line;
    for (const double distance : {1, 2}) {
      const std::vector<std::uint32_t> to = row_of_vertices(distance, degrees);
      for (std::uint32_t k = 0; k < steps; ++k) {
        if (is_in_two_steps && degrees == 180 - fold && distance == 1 && k == steps / 2) {
          put_strip(complex, fold, {from[k], from[k + 1]}, {to[k], to[k + 1]});
          continue;
        }
        const bool is_missing = degrees > 180 && distance == 1 && k == steps / 2;
        if (!is_missing) complex.triangles.push_back({{from[k], from[k + 1], to[k]}, 10, 0});
        complex.triangles.push_back({{from[k + 1], to[k + 1], to[k]}, 10, 0});
      }
      from = to;
    }
  }
  label_sheets(complex);
  return complex;
}

TEST(LabelSheets, ATornSeamDoesNotJoinSheets) {
  EXPECT_EQ(torn_book(90).sheet_count, 3U);
  EXPECT_EQ(torn_book(40).sheet_count, 3U);
  EXPECT_EQ(torn_book(20).sheet_count, 2U) << "nearly flat: they are one sheet";
}

TEST(LabelSheets, ATornSeamDoesNotJoinSheetsInSmallSteps) {
  EXPECT_EQ(torn_book(60, true).sheet_count, 3U) << "twice 30 degrees";
  EXPECT_EQ(torn_book(20, true).sheet_count, 2U);
}

TEST(LabelSheets, ASharpFoldFarFromSeamsIsOneSheet) {
  AxisRows complex;
  for (const Vec3d& at : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    complex.vertices.emplace_back().position = at;
  }
  complex.triangles = {{{0, 1, 2}, 10, 0}, {{1, 0, 3}, 10, 0}};
  label_sheets(complex);
  EXPECT_EQ(complex.sheet_count, 1U);
}

TEST(LabelSheets, EdgesHaveTheLargestAngleOfTheirTriangles) {
  const AxisRows complex = labelled(5, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}});
  for (const EdgeRow& edge : complex.edges) {
    const float expected = edge.role == seam                                    ? 12
                           : std::max(edge.vertices[0], edge.vertices[1]) == 2U ? 10
                           : std::max(edge.vertices[0], edge.vertices[1]) == 3U ? 11
                                                                                : 12;
    EXPECT_EQ(edge.separation_angle, expected);
  }
  EXPECT_EQ(edges_of(complex, seam), (std::vector<Edge>{{0, 1}}));
}

TEST(LabelSheets, SheetsThatTouchInAVertexAreSeparate) {
  const AxisRows rims = labelled(5, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(rims.sheet_count, 2U);
  EXPECT_EQ(roles_of(rims), (std::vector<MedialRole>{junction, rim, rim, rim, rim}));
  // Two closed surfaces touch in a vertex.
  const AxisRows closed =
      labelled(7, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 4, 5}, {0, 4, 6}, {0, 5, 6}, {4, 5, 6}});
  EXPECT_EQ(closed.sheet_count, 2U);
  EXPECT_TRUE(closed.edges.empty());
  EXPECT_EQ(roles_of(closed), (std::vector<MedialRole>{junction, sheet, sheet, sheet, sheet, sheet, sheet}));
  // A rim touches a closed surface.
  const AxisRows both = labelled(6, {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 4, 5}});
  EXPECT_EQ(roles_of(both), (std::vector<MedialRole>{junction, sheet, sheet, sheet, rim, rim}));
}

TEST(LabelSheets, ACurveEndsOnASheet) {
  const std::vector<Face> fan{{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const AxisRows inside = labelled(7, fan, {{4, 5}, {5, 6}});
  EXPECT_EQ(roles_of(inside), (std::vector<MedialRole>{rim, rim, rim, rim, junction, curve, curve}));
  const AxisRows at_rim = labelled(6, fan, {{5, 0}});
  EXPECT_EQ(roles_of(at_rim), (std::vector<MedialRole>{junction, rim, rim, rim, sheet, curve}));
  EXPECT_EQ(edges_of(at_rim, curve), (std::vector<Edge>{{5, 0}}));
}

TEST(LabelSheets, CurvesMeetInJunctions) {
  const AxisRows circle = labelled(3, {}, {{0, 1}, {1, 2}, {2, 0}});
  EXPECT_EQ(roles_of(circle), std::vector<MedialRole>(3, curve));
  EXPECT_EQ(circle.sheet_count, 0U);
  const AxisRows star = labelled(4, {}, {{0, 1}, {0, 2}, {3, 0}});
  EXPECT_EQ(roles_of(star), (std::vector<MedialRole>{junction, curve, curve, curve}));
}

TEST(LabelSheets, AVertexAloneIsOnNoSheet) {
  EXPECT_EQ(roles_of(labelled(1, {})), std::vector<MedialRole>{curve});
}

TEST(LabelSheets, ACurveThatEndsOnASeamIsAJunction) {
  const AxisRows complex = labelled(6, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, {{0, 5}});
  EXPECT_EQ(roles_of(complex), (std::vector<MedialRole>{junction, junction, rim, rim, rim, curve}));
}

TEST(LabelSheets, CountsAreThoseOfTheParts) {
  const MedialCounts counts = count(labelled(8, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}, {{0, 5}, {5, 6}}));
  EXPECT_EQ(counts.vertices, 8U);
  EXPECT_EQ(counts.triangles, 3U);
  EXPECT_EQ(counts.sheets, 3U);
  EXPECT_EQ(counts.curve_edges, 2U);
  EXPECT_EQ(counts.rim_edges, 6U);
  EXPECT_EQ(counts.seam_edges, 1U);
  EXPECT_EQ(counts.junctions, 2U);
}

}  // namespace
}  // namespace blum
