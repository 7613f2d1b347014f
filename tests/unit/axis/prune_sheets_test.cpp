// Proves that weak sheets are pruned from their free edges, and strong or closed sheets stay. The topology stays, and
// missing columns are named.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "blum/axis/label_sheets.hpp"
#include "blum/axis/prune_sheets.hpp"
#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using detail::label_sheets;

using test::AxisRows;
using test::EdgeRow;
using test::TriangleRow;
using test::VertexRow;

void label_sheets(AxisRows& axis) {
  Complex complex = axis;
  blum::label_sheets(complex, Incidence(complex.view()));
  axis = complex;
}

BettiNumbers betti_of(const Complex& axis) {
  return homology(axis.view());
}

/// The places of the corners of each triangle.
std::set<std::array<std::array<double, 3>, 3>> places(const AxisRows& axis) {
  std::set<std::array<std::array<double, 3>, 3>> out;
  for (const TriangleRow& t : axis.triangles) {
    std::array<std::array<double, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d& p = axis.vertices[t.vertices[k]].position;
      corners[k] = {p.x, p.y, p.z};
    }
    out.insert(corners);
  }
  return out;
}

std::vector<float> angles_of_sheets(const AxisRows& axis) {
  std::vector<float> angles(axis.sheet_count, 0);
  for (const TriangleRow& t : axis.triangles) angles[t.sheet] = std::max(angles[t.sheet], t.separation_angle);
  return angles;
}

/// A strip of squares along x, each made of two triangles. All triangles have the same angle.
void add_strip(AxisRows& axis, int squares, const Vec3d& from, const Vec3d& across, float angle) {
  const auto first = static_cast<std::uint32_t>(axis.vertices.size());
  for (int k = 0; k <= squares; ++k) {
    for (const Vec3d& side : {Vec3d{}, across}) {
      axis.vertices.emplace_back().position = from + Vec3d{static_cast<double>(k), 0, 0} + side;
    }
  }
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(squares); ++k) {
    const std::uint32_t a = first + 2 * k;
    axis.triangles.push_back({{a, a + 1, a + 3}, angle, 0});
    axis.triangles.push_back({{a, a + 3, a + 2}, angle, 0});
  }
}

TEST(PruneSheets, AWeakDiscBecomesAVertexAndAStrongOneStays) {
  for (const float angle : {30.0F, 90.0F}) {
    AxisRows axis;
    add_strip(axis, 5, {0, 0, 0}, {0, 1, 0}, angle);
    label_sheets(axis);
    const AxisRows left = prune_sheets(axis, 60);
    EXPECT_EQ(left.triangles.size(), angle < 60 ? 0U : 10U);
    EXPECT_EQ(left.vertices.size(), angle < 60 ? 1U : 12U);
    EXPECT_EQ(left.edges.size(), angle < 60 ? 0U : 12U) << "rims";
  }
}

TEST(PruneSheets, ARingLeavesACircle) {
  AxisRows axis;
  add_strip(axis, 6, {0, 0, 0}, {0, 1, 0}, 30);
  for (TriangleRow& t : axis.triangles) {
    for (std::uint32_t& v : t.vertices) v %= 12;  // the last two vertices equal the first two
  }
  axis.vertices.resize(12);
  label_sheets(axis);
  ASSERT_EQ(betti_of(axis), (BettiNumbers{1, 1, 0}));
  const AxisRows left = prune_sheets(axis, 60);
  EXPECT_TRUE(left.triangles.empty());
  EXPECT_EQ(left.edges.size(), 6U);
  EXPECT_EQ(betti_of(left), (BettiNumbers{1, 1, 0}));
}

TEST(PruneSheets, AClosedSheetOfAnyAngleStays) {
  AxisRows axis;
  axis.vertices.resize(4);
  axis.triangles = {{{0, 1, 2}, 1, 0}, {{0, 2, 3}, 1, 0}, {{0, 3, 1}, 1, 0}, {{1, 3, 2}, 1, 0}};
  label_sheets(axis);
  EXPECT_EQ(prune_sheets(axis, 180).triangles.size(), 4U);
}

TEST(PruneSheets, AWeakSheetBetweenStrongOnesIsRemovedUpToTheSeam) {
  // Three strips meet at one line: two strong ones and a weak one.
  AxisRows axis;
  add_strip(axis, 4, {0, 0, 0}, {0, 1, 0}, 90);
  add_strip(axis, 4, {0, 0, 0}, {0, -1, 0}, 90);
  add_strip(axis, 4, {0, 0, 0}, {0, 0, 1}, 20);
  for (TriangleRow& t : axis.triangles) {
    for (std::uint32_t& v : t.vertices) v = v % 2 == 0 ? v % 10 : v;  // their edges on y = z = 0 are identified
  }
  std::vector<std::uint32_t> number(axis.vertices.size());
  std::vector<VertexRow> used;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    number[v] = static_cast<std::uint32_t>(used.size());
    if (v < 10 || v % 2 == 1) used.push_back(axis.vertices[v]);
  }
  for (TriangleRow& t : axis.triangles) {
    for (std::uint32_t& v : t.vertices) v = number[v];
  }
  axis.vertices = used;
  label_sheets(axis);
  ASSERT_EQ(axis.sheet_count, 3U);
  const AxisRows left = prune_sheets(axis, 60);
  EXPECT_EQ(left.triangles.size(), 16U);
  EXPECT_EQ(left.sheet_count, 1U) << "where two sheets are left, they are one";
  EXPECT_EQ(left.vertices.size(), 15U);
}

TEST(PruneSheets, KeepsTheTopologyOfSolidsAndLeavesSheetsWhole) {
  for (const std::string name : {"bracket", "plate", "box", "void_cube", "torus", "gear"}) {
    SCOPED_TRACE(name);
    MedialAxisOptions options;
    options.resolution = 48;
    const MedialAxis axis = medial_axis(make_shape(name), options);
    const AxisRows whole = axis.simplify(0);
    AxisRows before = whole;
    for (const double theta : {20.0, 60.0, 100.0, 170.0}) {
      const AxisRows left = prune_sheets(before, theta);
      EXPECT_EQ(betti_of(left), axis.report().betti) << theta;
      const auto inner = places(left);
      const auto outer = places(before);
      EXPECT_TRUE(std::includes(outer.begin(), outer.end(), inner.begin(), inner.end())) << theta;
      const AxisRows again = prune_sheets(left, theta);
      EXPECT_LE(again.triangles.size(), left.triangles.size());
      before = left;
    }
    const std::vector<float> angles = angles_of_sheets(whole);
    const auto strong = static_cast<std::size_t>(std::count_if(
        whole.triangles.begin(), whole.triangles.end(), [&](const TriangleRow& t) { return angles[t.sheet] > 100; }));
    EXPECT_GE(prune_sheets(whole, 100).triangles.size(), strong) << "a sheet that is strong somewhere stays whole";
  }
}

TEST(PruneSheets, RejectsInvalidAngles) {
  EXPECT_THROW(static_cast<void>(prune_sheets(AxisRows{}, -1)), InvalidOption);
  EXPECT_THROW(static_cast<void>(prune_sheets(AxisRows{}, 181)), InvalidOption);
  EXPECT_TRUE(prune_sheets(AxisRows{}, 60).positions.empty());
}

TEST(PruneSheets, NamesMissingColumnsAndAddsNone) {
  Complex axis;
  axis.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  axis.triangles = {{0, 1, 2}};
  try {
    static_cast<void>(prune_sheets(axis, 60));
    FAIL() << "nothing says what goes";
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("'separation_angle' of triangles"), std::string::npos) << error.what();
  }
  axis.triangle_columns.resize(1);
  axis.triangle_columns.add<float>("separation_angle", 1, 90);
  axis.triangle_columns.add<std::int32_t>("sheet");
  const Complex left = prune_sheets(axis, 60);
  EXPECT_EQ(left.triangles.size(), 1U);
  EXPECT_EQ(left.vertex_columns.find("radius"), nullptr);
  EXPECT_NE(left.vertex_columns.find("role"), nullptr);
}

}  // namespace
}  // namespace blum
