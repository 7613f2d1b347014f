// Proves that the graph of a medial axis contains each part once. Axes made by hand are compared number by number. For
// axes of solids, sums, edges and junctions equal those of the complex.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "axis/axis_parts.hpp"
#include "blum/axis/axis_graph.hpp"
#include "blum/axis/label_sheets.hpp"
#include "blum/axis/prune_sheets.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using detail::add_quantiles;
using detail::label_sheets;
using detail::LinearPart;

using test::AxisRows;
using Numbers = std::vector<std::uint32_t>;

Complex labelled(const AxisRows& rows) {
  Complex complex = rows;
  label_sheets(complex, Incidence(complex.view()));
  return complex;
}

std::uint32_t add_vertex(AxisRows& axis, const Vec3d& position, double radius = 1) {
  axis.vertices.emplace_back().position = position;
  axis.vertices.back().radius = radius;
  return static_cast<std::uint32_t>(axis.vertices.size() - 1);
}

/// Adds a strip of squares between two rows of vertices.
void add_band(AxisRows& axis, const Numbers& low, const Numbers& high) {
  for (std::size_t k = 0; k + 1 < low.size(); ++k) {
    axis.triangles.push_back({{low[k], low[k + 1], high[k + 1]}, 90, 0});
    axis.triangles.push_back({{low[k], high[k + 1], high[k]}, 90, 0});
  }
}

/// Adds points along x.
Numbers add_row(AxisRows& axis, int count, const Vec3d& from) {
  Numbers row;
  for (int k = 0; k < count; ++k) row.push_back(add_vertex(axis, from + Vec3d{static_cast<double>(k), 0, 0}));
  return row;
}

/// Adds a square around the z axis. The first vertex is repeated at the end.
Numbers add_square(AxisRows& axis, double side, double z) {
  Numbers row;
  for (const auto& [x, y] : {std::array{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    row.push_back(add_vertex(axis, {side / 2 * x, side / 2 * y, z}));
  }
  row.push_back(row.front());
  return row;
}

/// Checks the facts that hold for every axis.
void expect_whole(const Complex& complex, const AxisGraph& graph) {
  const MedialView axis(complex);
  std::map<std::array<std::uint32_t, 2>, int> listed;  // 1 for seams, 2 for curves
  for (std::size_t e = 0; e < axis.edges.size(); ++e) {
    const auto [low, high] = std::minmax(axis.edges[e][0], axis.edges[e][1]);
    if (axis.edge_role(e) == MedialRole::seam) listed[{low, high}] = 1;
    if (axis.edge_role(e) == MedialRole::curve) listed[{low, high}] = 2;
  }
  std::set<std::uint32_t> junctions;
  for (const AxisJunction& junction : graph.junctions) EXPECT_TRUE(junctions.insert(junction.vertex).second);
  for (std::uint32_t v = 0; v < axis.positions.size(); ++v) {
    EXPECT_TRUE(axis.role(v) != MedialRole::junction || junctions.contains(v)) << v;
  }
  std::size_t ends = 0;
  for (const auto& [lines, kind] : {std::pair{&graph.seams, 1}, {&graph.curves, 2}}) {
    for (const AxisLine& line : *lines) {
      ASSERT_EQ(line.vertices.size(), line.radii.size());
      EXPECT_DOUBLE_EQ(line.arc_length.back(), line.length);
      EXPECT_EQ(line.closed, !line.junctions);
      for (std::size_t k = 1; k < line.vertices.size(); ++k) {
        const auto [low, high] = std::minmax(line.vertices[k - 1], line.vertices[k]);
        const auto found = listed.find({low, high});
        ASSERT_NE(found, listed.end());
        EXPECT_EQ(found->second, kind);
        listed.erase(found);
        EXPECT_TRUE(k + 1 == line.vertices.size() || !junctions.contains(line.vertices[k]));
      }
      if (line.closed) {
        EXPECT_EQ(line.vertices.front(), line.vertices.back());
        EXPECT_FALSE(junctions.contains(line.vertices.front()));
      } else {
        ends += 2;
        EXPECT_EQ(graph.junctions[(*line.junctions)[0]].vertex, line.vertices.front());
        EXPECT_EQ(graph.junctions[(*line.junctions)[1]].vertex, line.vertices.back());
        EXPECT_LE((*line.junctions)[0], (*line.junctions)[1]);
      }
    }
  }
  EXPECT_TRUE(listed.empty()) << "edges in no line";
  for (const AxisJunction& junction : graph.junctions) ends -= junction.seams.size() + junction.curves.size();
  EXPECT_EQ(ends, 0U);
  double area = 0;
  std::size_t triangles = 0;
  std::set<std::uint32_t> seams;
  for (const AxisSheet& sheet : graph.sheets) {
    area += sheet.area;
    triangles += sheet.triangles;
    seams.insert(sheet.seams.begin(), sheet.seams.end());
    EXPECT_LE(sheet.thickness.minimum, sheet.thickness.median);
    EXPECT_LE(sheet.thickness.median, sheet.thickness.maximum);
    EXPECT_GE(2, sheet.euler_characteristic);
    for (const std::uint32_t seam : sheet.seams) {
      const Numbers& along = graph.seams[seam].sheets;
      EXPECT_TRUE(std::find(along.begin(), along.end(), sheet.sheet) != along.end());
    }
  }
  EXPECT_EQ(seams.size(), graph.seams.size());
  EXPECT_EQ(triangles, axis.triangles.size());
  EXPECT_DOUBLE_EQ(area, graph.area);
}

AxisGraph whole_graph(const Complex& complex) {
  AxisGraph graph = axis_graph(complex);
  expect_whole(complex, graph);
  return graph;
}

TEST(AxisGraph, NothingHasNoParts) {
  const AxisGraph graph = axis_graph(Complex{});
  EXPECT_TRUE(graph.sheets.empty() && graph.seams.empty() && graph.curves.empty() && graph.junctions.empty());
  EXPECT_EQ(graph.area, 0);
}

TEST(AxisGraph, VerticesAloneArePoints) {
  AxisRows axis;
  add_row(axis, 2, {3, 4, 5});
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.junctions.size(), 2U);
  EXPECT_EQ(graph.junctions[1].kind, JunctionKind::point);
  EXPECT_EQ(graph.junctions[1].position, (Vec3d{4, 4, 5}));
}

TEST(AxisGraph, CurvesAreChainsWithTheirRadii) {
  AxisRows axis;  // a Y of three curves, and a closed curve
  const std::uint32_t centre = add_vertex(axis, {0, 0, 0}, 4);
  for (const Vec3d& way : {Vec3d{1, 0, 0}, Vec3d{0, 2, 0}, Vec3d{0, 0, 3}}) {
    const std::uint32_t middle = add_vertex(axis, way, 2);
    const std::uint32_t end = add_vertex(axis, way * 4.0, 1);
    axis.edges.push_back({{middle, centre}});
    axis.edges.push_back({{middle, end}});
  }
  const Numbers loop = add_square(axis, 2, 9);
  for (std::size_t k = 0; k < 4; ++k) axis.edges.push_back({{loop[k + 1], loop[k]}});
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.curves.size(), 4U);
  EXPECT_EQ(graph.curves[1].vertices, (Numbers{0, 3, 4}));
  EXPECT_EQ(graph.curves[1].length, 8);
  EXPECT_EQ(graph.curves[1].arc_length, (std::vector<double>{0, 2, 8}));
  EXPECT_EQ(graph.curves[1].radii, (std::vector<double>{4, 2, 1}));
  EXPECT_EQ(graph.curves[1].radius.minimum, 1);
  // Three quarters of the length run from 2 to 1, the rest from 2 to 4.
  EXPECT_NEAR(graph.curves[1].radius.median, 1 + 2.0 / 3, 1e-12);
  EXPECT_EQ(graph.curves[1].radius.maximum, 4);
  EXPECT_TRUE(graph.curves[3].closed);
  EXPECT_EQ(graph.curves[3].length, 8);
  EXPECT_EQ(graph.curves[3].vertices, (Numbers{7, 8, 9, 10, 7}));
  EXPECT_EQ(graph.curve_length, 4 + 8 + 12 + 8);
  ASSERT_EQ(graph.junctions.size(), 4U);
  EXPECT_EQ(graph.junctions[0].kind, JunctionKind::junction);
  EXPECT_EQ(graph.junctions[0].curves, (Numbers{0, 1, 2}));
  EXPECT_EQ(graph.junctions[2].kind, JunctionKind::curve_end);
}

TEST(AxisGraph, AJunctionListsACurveThatReturnsToItTwice) {
  AxisRows axis;
  const Numbers loop = add_square(axis, 2, 0);
  for (std::size_t k = 0; k < 4; ++k) axis.edges.push_back({{loop[k], loop[k + 1]}});
  axis.edges.push_back({{loop[2], add_vertex(axis, {-5, -5, 0})}});
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.curves.size(), 2U);
  EXPECT_FALSE(graph.curves[0].closed);
  EXPECT_EQ(graph.junctions[0].curves, (Numbers{0, 0, 1}));
}

TEST(AxisGraph, DistinguishesDiscsRingsAndSpheres) {
  AxisRows disc;
  add_band(disc, add_row(disc, 6, {0, 0, 0}), add_row(disc, 6, {0, 1, 0}));
  for (std::size_t v = 0; v < disc.vertices.size(); ++v) {
    disc.vertices[v].radius = v % 6 < 4 ? 1 : 3;  // four of five squares have a mean of at most 2
    disc.vertices[v].separation_angle = 100;
  }
  AxisGraph graph = whole_graph(labelled(disc));
  ASSERT_EQ(graph.sheets.size(), 1U);
  EXPECT_EQ(graph.area, 5);
  EXPECT_EQ(graph.rim_length, 12);
  EXPECT_EQ(graph.sheets[0].thickness.minimum, 2);
  EXPECT_NEAR(graph.sheets[0].thickness.median, 2, 1e-12);
  EXPECT_EQ(graph.sheets[0].thickness.maximum, 6);
  EXPECT_EQ(graph.sheets[0].separation_angle.median, 100);
  EXPECT_NEAR(length(graph.sheets[0].centroid - Vec3d{2.5, 0.5, 0}), 0, 1e-12);
  EXPECT_EQ(graph.sheets[0].boundary_loops, 1U);
  EXPECT_EQ(graph.sheets[0].euler_characteristic, 1);
  EXPECT_TRUE(graph.junctions.empty());

  AxisRows ring;
  add_band(ring, add_square(ring, 2, 0), add_square(ring, 2, 1));
  graph = whole_graph(labelled(ring));
  EXPECT_EQ(graph.sheets[0].boundary_loops, 2U);
  EXPECT_EQ(graph.sheets[0].euler_characteristic, 0);
  EXPECT_EQ(graph.area, 8);

  AxisRows sphere;
  add_row(sphere, 4, {0, 0, 0});
  sphere.vertices[2].position = {0, 1, 0};
  sphere.vertices[3].position = {0, 0, 1};
  sphere.triangles = {{{0, 1, 2}, 1, 0}, {{0, 2, 3}, 1, 0}, {{0, 3, 1}, 1, 0}, {{1, 3, 2}, 1, 0}};
  graph = whole_graph(labelled(sphere));
  EXPECT_EQ(graph.sheets[0].boundary_loops, 0U);
  EXPECT_EQ(graph.sheets[0].euler_characteristic, 2);
  EXPECT_TRUE(graph.seams.empty() && graph.junctions.empty());
}

TEST(AxisGraph, SheetsThatMeetHaveASeam) {
  AxisRows axis;
  const Numbers line = add_row(axis, 5, {0, 0, 0});
  for (const Vec3d& way : {Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}})
    add_band(axis, line, add_row(axis, 5, way));
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.seams.size(), 1U);
  EXPECT_EQ(graph.seams[0].sheets, (Numbers{0, 1, 2}));
  EXPECT_EQ(graph.seams[0].length, 4);
  EXPECT_EQ(graph.seams[0].vertices, line);
  ASSERT_EQ(graph.junctions.size(), 2U);
  EXPECT_EQ(graph.junctions[0].kind, JunctionKind::seam_end);
  EXPECT_EQ(graph.junctions[0].sheets, (Numbers{0, 1, 2}));
  ASSERT_EQ(graph.sheets.size(), 3U);
  EXPECT_EQ(graph.sheets[1].seams, (Numbers{0}));
  EXPECT_EQ(graph.sheets[1].seam_length, 4);
  EXPECT_EQ(graph.sheets[1].rim_length, 6);
  EXPECT_EQ(graph.sheets[1].boundary_loops, 1U);
}

TEST(AxisGraph, ASeamAllAroundIsClosed) {
  AxisRows axis;  // a tube with a plate around it
  const Numbers middle = add_square(axis, 2, 0);
  add_band(axis, middle, add_square(axis, 2, 1));
  add_band(axis, middle, add_square(axis, 2, -1));
  add_band(axis, middle, add_square(axis, 4, 0));
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.seams.size(), 1U);
  EXPECT_TRUE(graph.seams[0].closed);
  EXPECT_EQ(graph.seams[0].length, 8);
  EXPECT_TRUE(graph.junctions.empty());
  for (const AxisSheet& sheet : graph.sheets) EXPECT_EQ(sheet.boundary_loops, 2U);
}

TEST(AxisGraph, ASheetThatMeetsItselfIsCutThere) {
  AxisRows axis;  // a ring on a plate along a line: the wall of the ring meets the line twice
  const Numbers line = add_row(axis, 3, {0, 0, 0});
  const Numbers left = add_row(axis, 3, {0, -1, 1});
  const Numbers right = add_row(axis, 3, {0, 1, 1});
  add_band(axis, line, left);
  add_band(axis, left, right);
  add_band(axis, right, line);
  add_band(axis, line, add_row(axis, 3, {0, 0, -1}));
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.sheets.size(), 2U);
  EXPECT_EQ(graph.sheets[0].seam_length, 4) << "both sides";
  EXPECT_EQ(graph.sheets[0].boundary_loops, 1U) << "cut open it is a strip";
  EXPECT_EQ(graph.sheets[0].euler_characteristic, 1);
  EXPECT_EQ(graph.seams[0].sheets, (Numbers{0, 1}));
}

TEST(AxisGraph, ReportsCurvesOnSheetsAndTouchingSheets) {
  AxisRows axis;
  const Numbers low = add_row(axis, 3, {0, 0, 0});
  add_band(axis, low, add_row(axis, 3, {0, 1, 0}));
  axis.edges.push_back({{add_vertex(axis, {1, -1, 0}), low[1]}});
  const Numbers other{low[2], add_vertex(axis, {3, 0, 0})};
  add_band(axis, other, {add_vertex(axis, {2, 0, 1}), add_vertex(axis, {3, 0, 1})});
  const AxisGraph graph = whole_graph(labelled(axis));
  ASSERT_EQ(graph.junctions.size(), 3U);
  EXPECT_EQ(graph.junctions[0].kind, JunctionKind::curve_foot);
  EXPECT_EQ(graph.junctions[0].sheets, (Numbers{0}));
  EXPECT_EQ(graph.junctions[1].kind, JunctionKind::contact);
  EXPECT_EQ(graph.junctions[1].sheets, (Numbers{0, 1}));
  EXPECT_EQ(graph.junctions[2].kind, JunctionKind::curve_end);
  EXPECT_EQ(graph.curves[0].sheets, (Numbers{0}));
}

TEST(AxisGraph, SheetsWithoutTrianglesAreNotListed) {
  AxisRows axis;
  add_band(axis, add_row(axis, 3, {0, 0, 0}), add_row(axis, 3, {0, 1, 0}));
  Complex complex = labelled(axis);
  for (std::int32_t& sheet : complex.triangle_columns.edit<std::int32_t>("sheet")) sheet = 3;
  const AxisGraph graph = axis_graph(complex);
  ASSERT_EQ(graph.sheets.size(), 1U);
  EXPECT_EQ(graph.sheets[0].sheet, 3U);
}

TEST(AxisGraph, RejectsMissingAndInvalidColumns) {
  AxisRows axis;
  add_band(axis, add_row(axis, 3, {0, 0, 0}), add_row(axis, 3, {0, 1, 0}));
  Complex complex = labelled(axis);
  complex.triangle_columns.erase("sheet");
  EXPECT_THROW(static_cast<void>(axis_graph(complex)), InvalidOption);
  complex = labelled(axis);
  complex.vertex_columns.erase("radius");
  EXPECT_THROW(static_cast<void>(axis_graph(complex)), InvalidOption);
  complex = labelled(axis);
  complex.vertex_columns.edit<double>("radius")[1] = -1;
  EXPECT_THROW(static_cast<void>(axis_graph(complex)), InvalidOption);
}

AxisSpread spread_of(const std::vector<LinearPart>& parts) {
  AxisSpread spread{1e300, 0, 0, -1e300};
  for (const LinearPart& part : parts) {
    spread.minimum = std::min(spread.minimum, part.values[0]);
    spread.maximum = std::max(spread.maximum, part.values[2]);
  }
  add_quantiles(parts, spread);
  return spread;
}

TEST(AxisGraph, LowValuesAndMediansAreWeighted) {
  const auto constant = [](double value, double weight) { return LinearPart::on_edge(value, value, weight); };
  const AxisSpread some = spread_of({constant(5, 1), constant(1, 1), constant(3, 3)});
  EXPECT_NEAR(some.low, 1, 1e-12);
  EXPECT_NEAR(some.median, 3, 1e-12);
  const AxisSpread without = spread_of({constant(2, 0), constant(1, 0), constant(4, 0), constant(3, 0)});
  EXPECT_NEAR(without.low, 1, 1e-12);
  EXPECT_NEAR(without.median, 2, 1e-12);
  const AxisSpread crumb = spread_of({constant(1, 0.01), constant(4, 0.98), constant(5, 0.01)});
  EXPECT_NEAR(crumb.low, 4, 1e-12) << "one small triangle is not a wall";
}

TEST(AxisGraph, LowValuesAndMediansAreThoseOfLinearFunctions) {
  const AxisSpread edge = spread_of({LinearPart::on_edge(3, 1, 7)});
  EXPECT_NEAR(edge.low, 1.1, 1e-12);
  EXPECT_NEAR(edge.median, 2, 1e-12);
  const AxisSpread triangle = spread_of({LinearPart::on_triangle({1, 0, 0}, 2)});
  EXPECT_NEAR(triangle.low, 1 - std::sqrt(0.95), 1e-12);
  EXPECT_NEAR(triangle.median, 1 - std::sqrt(0.5), 1e-12);
  // The result is the same if the middle edges cut the triangle into four.
  const std::array<double, 3> whole{0.2, 1.3, 0.7};
  const std::array<double, 3> middles{0.75, 1.0, 0.45};  // on the edges 01, 12, 20
  const AxisSpread one = spread_of({LinearPart::on_triangle(whole, 4)});
  const AxisSpread four =
      spread_of({LinearPart::on_triangle({whole[0], middles[0], middles[2]}, 1),
                 LinearPart::on_triangle({whole[1], middles[1], middles[0]}, 1),
                 LinearPart::on_triangle({whole[2], middles[2], middles[1]}, 1), LinearPart::on_triangle(middles, 1)});
  EXPECT_NEAR(one.low, four.low, 1e-12);
  EXPECT_NEAR(one.median, four.median, 1e-12);
}

/// A wall of increasing thickness has few triangles after simplification.
TEST(AxisGraph, SimplificationKeepsTheDistributionOfThickness) {
  const std::vector<Point2> outline{{0, 0}, {6, 0}, {6, 1.5}, {0, 0.3}};
  const TriangleMesh mesh = make_extrusion(outline, {}, {.thickness = 5});
  const MedialAxis axis = medial_axis(mesh, {.resolution = 64});
  const auto largest = [&](const Complex& complex) {
    const AxisGraph graph = axis_graph(complex, mesh);
    return *std::max_element(graph.sheets.begin(), graph.sheets.end(),
                             [](const auto& a, const auto& b) { return a.area < b.area; });
  };
  const AxisSheet whole = largest(axis.fitted(120));
  const AxisSheet lean = largest(axis.lean(120, 0.25 * 6.0 / 64).axis);
  EXPECT_LT(lean.triangles * 4, whole.triangles);
  EXPECT_NEAR(lean.thickness.low, whole.thickness.low, 0.02 * whole.thickness.low);
  EXPECT_NEAR(lean.thickness.median, whole.thickness.median, 0.02 * whole.thickness.median);
  EXPECT_NEAR(lean.separation_angle.low, whole.separation_angle.low, 1);
}

/// An L of a thick and a thin plate. Above 90 degrees no sheet runs into the corner, and both plates are one sheet.
TEST(AxisGraph, LowThicknessIsThatOfTheThinnerOfTwoWalls) {
  const std::vector<Point2> outline{{0, 0}, {4, 0}, {4, 0.6}, {0.5, 0.6}, {0.5, 3}, {0, 3}};
  const TriangleMesh mesh = make_extrusion(outline, {}, {.thickness = 5});
  const AxisGraph graph = axis_graph(medial_axis(mesh, {.resolution = 64}).fitted(120), mesh);
  const auto wall = std::max_element(graph.sheets.begin(), graph.sheets.end(),
                                     [](const auto& a, const auto& b) { return a.area < b.area; });
  EXPECT_GT(wall->area, 0.9 * graph.area);
  EXPECT_NEAR(wall->thickness.low, 0.5, 1e-6);
  EXPECT_NEAR(wall->thickness.median, 0.6, 1e-6);
}

// ---- Axes of solids ----

TEST(AxisGraph, AWallOfABoxLiesBetweenItsTwoFaces) {
  const TriangleMesh box = make_shape("box", {{"size_x", 3}, {"size_y", 2}, {"size_z", 0.5}});
  MedialAxisOptions options;
  options.resolution = 48;
  const Complex axis = medial_axis(box, options).simplify(60);
  const AxisGraph graph = axis_graph(axis, box);
  expect_whole(axis, graph);
  ASSERT_EQ(graph.patches.size(), 6U);
  for (const AxisPatch& patch : graph.patches) EXPECT_EQ(patch.faces, 2U);
  double area = 0;
  for (const AxisPatch& patch : graph.patches) area += patch.area;
  EXPECT_NEAR(area, 2 * (3 * 2 + 3 * 0.5 + 2 * 0.5), 1e-9);
  const auto wall = std::max_element(graph.sheets.begin(), graph.sheets.end(),
                                     [](const auto& a, const auto& b) { return a.area < b.area; });
  EXPECT_NEAR(wall->thickness.minimum, 0.5, 0.05) << "at a seam";
  EXPECT_NEAR(wall->thickness.median, 0.5, 1e-9);
  EXPECT_NEAR(wall->separation_angle.median, 180, 1e-6);
  EXPECT_NEAR(wall->area, 2.5 * 1.5, 0.1);
  ASSERT_FALSE(wall->patch_pairs.empty());
  const AxisPatchPair& pair = wall->patch_pairs.front();
  ASSERT_EQ(pair.first.size() + pair.second.size(), 2U);
  EXPECT_GT(pair.share, 0.9);
  const Vec3d& normal = graph.patches[pair.first[0]].normal;
  EXPECT_NEAR(std::abs(normal.z), 1, 1e-12);
  EXPECT_EQ(graph.patches[pair.second[0]].normal, -normal);
}

TEST(AxisGraph, ReportsCellsKeptOnlyForHomotopy) {
  AxisRows axis;
  const Numbers line = add_row(axis, 5, {0, 0, 0});
  for (const Vec3d& way : {Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}})
    add_band(axis, line, add_row(axis, 5, way));
  for (std::size_t t = 0; t < axis.triangles.size(); ++t) {
    axis.triangles[t].separation_angle = t < 8 ? 90 : t < 16 ? 60 : t < 22 ? 0 : 120;
  }
  const std::uint32_t foot = add_vertex(axis, {0, 0, 3});
  const std::uint32_t middle = add_vertex(axis, {0, 0, 4});
  axis.edges.push_back({{foot, middle}, 30});
  axis.edges.push_back({{middle, add_vertex(axis, {0, 0, 6})}, 150});
  const Complex complex = labelled(axis);
  const auto graph_at = [&](std::optional<double> theta) {
    AxisGraphOptions options;
    options.homotopy_angle = theta;
    return axis_graph(complex, options);
  };
  const AxisGraph graph = graph_at(60);
  ASSERT_EQ(graph.sheets.size(), 3U);
  EXPECT_EQ(graph.sheets[0].homotopy_area, 0);
  EXPECT_EQ(graph.sheets[1].homotopy_area, 4) << "60 degrees are no more than theta";
  EXPECT_EQ(graph.sheets[2].homotopy_area, 3);
  EXPECT_FALSE(graph.sheets[0].for_homotopy);
  EXPECT_TRUE(graph.sheets[1].for_homotopy);
  EXPECT_FALSE(graph.sheets[2].for_homotopy);
  EXPECT_EQ(graph.homotopy_area, 7);
  ASSERT_EQ(graph.curves.size(), 1U);
  EXPECT_EQ(graph.curves[0].homotopy_length, 1);
  EXPECT_EQ(graph.homotopy_curve_length, 1);
  EXPECT_EQ(graph_at(0).homotopy_area, 3);
  const AxisGraph unknown = graph_at({});
  EXPECT_EQ(unknown.homotopy_area, 0);
  EXPECT_FALSE(unknown.sheets[1].for_homotopy);
  EXPECT_THROW(static_cast<void>(graph_at(-1)), InvalidOption);
}

TEST(AxisGraph, CountsMembranesAsTheCertificateDoes) {
  // The surface around a void stays closed, even if no vertex has a separation angle of 150 degrees.
  const TriangleMesh mesh = make_shape("void_cube", {});
  MedialAxisOptions options;
  options.resolution = 32;
  const MedialAxis axis = medial_axis(mesh, options);
  for (const double theta : {60.0, 150.0}) {
    SCOPED_TRACE(theta);
    const Complex fitted = axis.fitted(theta);
    CertificateOptions certificate_options;
    certificate_options.theta = theta;
    certificate_options.balls = false;
    certificate_options.spacing = axis.report().bodies.front().spacing;
    const Certificate certificate = certify(fitted, mesh, certificate_options);
    AxisGraphOptions graph_options;
    graph_options.homotopy_angle = theta;
    const AxisGraph graph = axis_graph(fitted, graph_options);
    EXPECT_NEAR(graph.homotopy_area / graph.area, certificate.medial.homotopy_share, 1e-9);
    EXPECT_EQ(graph.homotopy_area > 0.2 * graph.area, theta > 100);
  }
}

TEST(AxisGraph, PatchesJoinFacetsUpToTheirAngle) {
  const TriangleMesh cylinder = make_shape("cylinder", {{"sides", 12}});
  Complex nothing;
  EXPECT_EQ(axis_graph(nothing, cylinder).patches.size(), 3U) << "bends by 30 degrees are smooth";
  EXPECT_EQ(axis_graph(nothing, cylinder, {.patch_angle = 29}).patches.size(), 14U);
  EXPECT_EQ(axis_graph(nothing, cylinder, {.patch_angle = 90}).patches.size(), 1U);
  EXPECT_EQ(axis_graph(nothing, cylinder, {.patch_angle = 90}).patches[0].normal, (Vec3d{}));
  EXPECT_THROW(static_cast<void>(axis_graph(nothing, cylinder, {.patch_angle = 181})), InvalidOption);
}

TEST(AxisGraph, AnotherMeshIsRefused) {
  const TriangleMesh torus = make_shape("torus", {});
  MedialAxisOptions options;
  options.resolution = 24;
  const Complex axis = medial_axis(torus, options).simplify(60);
  EXPECT_THROW(static_cast<void>(axis_graph(axis, make_shape("box", {}))), InvalidOption);
}

TEST(AxisGraph, GraphsOfSolidsAreWhole) {
  for (const char* const name : {"torus", "bracket", "cylinder", "plate", "ellipsoid"}) {
    SCOPED_TRACE(name);
    const TriangleMesh mesh = make_shape(name, {});
    MedialAxisOptions options;
    options.resolution = 32;
    const MedialAxis axis = medial_axis(mesh, options);
    for (const double theta : {0.0, 60.0, 170.0})
      expect_whole(axis.simplify(theta), axis_graph(axis.simplify(theta), mesh));
    const Complex pruned = prune_sheets(axis.simplify(0), 100);
    expect_whole(pruned, axis_graph(pruned, mesh));
  }
}

}  // namespace
}  // namespace blum
