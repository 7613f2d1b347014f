// Proves that the views of the columns of a medial axis show their contents. Missing columns, columns of other types
// and other complexes are reported.
#include "blum/complex/medial_columns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace blum {
namespace {

/// A triangle with its rims, and a curve.
Complex small_axis() {
  Complex axis;
  axis.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  axis.edges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}};
  axis.triangles = {{0, 1, 2}};
  add_missing_medial_columns(axis);
  axis.vertex_columns.edit<double>("radius")[1] = 0.5;
  axis.vertex_columns.edit<double>("footprint_1", 3)[5] = 7;
  axis.vertex_columns.edit<std::int32_t>("site_0")[2] = 12;
  axis.vertex_columns.edit<std::int32_t>("role")[0] = static_cast<std::int32_t>(MedialRole::junction);
  for (std::size_t e = 0; e < 3; ++e) {
    axis.edge_columns.edit<std::int32_t>("role")[e] = static_cast<std::int32_t>(MedialRole::rim);
  }
  return axis;
}

TEST(MedialColumns, AreFoundByName) {
  const Complex axis = small_axis();
  EXPECT_EQ(problem_of_medial(axis), "");
  const MedialView view(axis);
  EXPECT_EQ(view.radius[1], 0.5);
  EXPECT_EQ(view.footprint(1, 1), (Vec3d{0, 0, 7}));
  EXPECT_EQ(view.site(2, 0), SiteId(12));
  EXPECT_FALSE(view.site(2, 1).has_value());
  EXPECT_EQ(view.role(0), MedialRole::junction);
  EXPECT_EQ(view.role(1), MedialRole::sheet);
  EXPECT_EQ(view.edge_role(3), MedialRole::curve);
  EXPECT_EQ(view.cells().vertex_count, 4U);
  EXPECT_EQ(sheet_count(axis), 1U);
  const MedialCounts counts = count(axis);
  EXPECT_EQ(counts.rim_edges, 3U);
  EXPECT_EQ(counts.curve_edges, 1U);
  EXPECT_EQ(counts.junctions, 1U);
}

TEST(MedialColumns, AddingMissingColumnsKeepsTheOthers) {
  Complex axis = small_axis();
  const Complex before = axis;
  add_missing_medial_columns(axis);
  EXPECT_EQ(axis.vertex_columns, before.vertex_columns);
  EXPECT_EQ(axis.edge_columns, before.edge_columns);
  EXPECT_EQ(axis.triangle_columns, before.triangle_columns);
  axis.vertex_columns.erase("radius");
  add_missing_medial_columns(axis);
  EXPECT_EQ(MedialView(axis).radius[1], 0);
  EXPECT_FALSE(CompleteAxis(axis).is_copy());
  axis.edge_columns.erase("role");
  EXPECT_EQ(MedialView(CompleteAxis(axis).get()).edge_role(0), MedialRole::curve);
  EXPECT_EQ(axis.edge_columns.find("role"), nullptr);
}

TEST(MedialColumns, NamesMissingColumnsAndOtherTypes) {
  const auto message = [](const std::function<void(Complex&)>& spoil) {
    Complex axis = small_axis();
    spoil(axis);
    EXPECT_NE(problem_of_medial(axis), "");
    try {
      const MedialView view(axis);
    } catch (const InvalidOption& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](Complex& a) { a.vertex_columns.erase("radius"); }).find("'radius'"), std::string::npos);
  EXPECT_NE(message([](Complex& a) { a.triangle_columns.erase("sheet"); }).find("'sheet'"), std::string::npos);
  EXPECT_NE(message([](Complex& a) {
              a.edge_columns.erase("separation_angle");
              a.edge_columns.add<double>("separation_angle");
            }).find("float64"),
            std::string::npos);
  EXPECT_NE(message([](Complex& a) { a.positions.pop_back(); }).find("4 rows"), std::string::npos);
  EXPECT_NE(message([](Complex& a) { a.edge_columns.erase("role"); }).find("of edges, which is needed; .vtp"),
            std::string::npos);
  EXPECT_THROW(MedialLevels{small_axis()}, InvalidOption);
  EXPECT_NE(problem_of_nested(small_axis()).find("'until'"), std::string::npos);
}

TEST(MedialColumns, ReportsTheProblemOfInvalidAxes) {
  const auto expect = [](const char* problem, const std::function<void(Complex&)>& spoil) {
    Complex axis = small_axis();
    spoil(axis);
    EXPECT_NE(problem_of_medial(axis).find(problem), std::string::npos) << problem_of_medial(axis);
  };
  const double nan = std::nan("");
  expect("vertex 2 (counted from 0) has a radius", [](Complex& a) { a.vertex_columns.edit<double>("radius")[2] = -1; });
  expect("a footprint", [&](Complex& a) { a.vertex_columns.edit<double>("footprint_0", 3)[1] = nan; });
  expect("an angle", [&](Complex& a) { a.vertex_columns.edit<double>("separation_angle")[1] = nan; });
  expect("a site", [](Complex& a) { a.vertex_columns.edit<std::int32_t>("site_1")[1] = -2; });
  expect("an unknown role", [](Complex& a) { a.vertex_columns.edit<std::int32_t>("role")[1] = 5; });
  expect("edge 0 (counted from 0) has a role other",
         [](Complex& a) { a.edge_columns.edit<std::int32_t>("role")[0] = 0; });
  expect("1 triangles", [](Complex& a) { a.triangle_columns.edit<std::int32_t>("sheet")[0] = 1; });
  expect("a negative sheet number", [](Complex& a) { a.triangle_columns.edit<std::int32_t>("sheet")[0] = -1; });
  expect("edge 1 uses vertex 9", [](Complex& a) { a.edges[1][0] = 9; });
}

TEST(MedialColumns, LevelsMayBeInfiniteButAreNumbers) {
  Complex axis = small_axis();
  const float never = std::numeric_limits<float>::infinity();
  axis.vertex_columns.add<float>("until", 1, never);
  axis.edge_columns.add<float>("from");
  axis.edge_columns.add<float>("until", 1, never);
  axis.triangle_columns.add<float>("until", 1, 20);
  EXPECT_EQ(problem_of_nested(axis), "");
  EXPECT_EQ(MedialLevels(axis).triangle_until[0], 20);
  axis.edge_columns.edit<float>("from")[2] = std::nanf("");
  EXPECT_NE(problem_of_nested(axis).find("edge 2 (counted from 0) has an angle"), std::string::npos);
  EXPECT_EQ(problem_of_medial(axis), "") << "an axis may have any columns of these names";
}

}  // namespace
}  // namespace blum
