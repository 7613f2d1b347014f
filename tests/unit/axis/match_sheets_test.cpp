// Proves that sheets of two axes are matched by the areas that they share. Shared areas of sheets made by hand are
// known. Axes without sheets match nothing, and wrong arguments are refused.
#include "blum/axis/match_sheets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;
using Sides = std::array<std::uint32_t, 2>;
using Numbers = std::vector<std::uint32_t>;

/// Adds a rectangle in a plane of constant z, as two triangles of a sheet.
void add_rectangle(AxisRows& axis, const Vec3d& low, double width, double depth, std::uint32_t sheet) {
  const auto first = static_cast<std::uint32_t>(axis.vertices.size());
  for (const auto& [x, y] : {std::array{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
    axis.vertices.emplace_back().position = low + Vec3d{x * width, y * depth, 0};
    axis.vertices.back().radius = 1;
  }
  axis.triangles.push_back({{first, first + 1, first + 2}, 90, sheet});
  axis.triangles.push_back({{first, first + 2, first + 3}, 90, sheet});
}

/// Adds the columns of patches: for each triangle, the patches on its sides. The sheets of patches are given.
Complex with_patches(Complex axis, const std::vector<std::array<std::int32_t, 2>>& sides,
                     std::vector<std::int32_t> sheets) {
  for (std::size_t k = 0; k < 2; ++k) {
    std::vector<std::int32_t> column;
    for (const auto& pair : sides) column.push_back(pair[k]);
    axis.triangle_columns.add({std::string(medial_columns::patches[k]), 1, std::move(column)});
  }
  axis.triangle_columns.add({std::string(medial_columns::patch_sheet), 1, std::move(sheets)});
  return axis;
}

std::vector<std::optional<std::uint32_t>> partners(const MatchedAxis& axis) {
  std::vector<std::optional<std::uint32_t>> out;
  for (const MatchedSheet& sheet : axis.sheets) out.push_back(sheet.partner);
  return out;
}

/// Three rectangles side by side, with areas 4, 2 and 0.04.
AxisRows three() {
  AxisRows out;
  add_rectangle(out, {0, 0, 0}, 2, 2, 0);
  add_rectangle(out, {2, 0, 0}, 1, 2, 1);
  add_rectangle(out, {3, 0, 0}, 0.02, 2, 2);
  return out;
}

TEST(MatchSheets, AnAxisMatchesItself) {
  const SheetMatches found = match_sheets(three(), three());
  for (const MatchedAxis& axis : {found.first, found.second}) {
    ASSERT_EQ(axis.sheets.size(), 3U);
    EXPECT_EQ(partners(axis), (std::vector<std::optional<std::uint32_t>>{0, 1, 2}));
    EXPECT_EQ(axis.matched, 3U);
    EXPECT_EQ(axis.large, 2U) << "the last one has 0.66 % of the area";
    EXPECT_EQ(axis.large_matched, 2U);
    EXPECT_NEAR(axis.area, 6.04, 1e-12);
    EXPECT_NEAR(axis.matched_area, 6.04, 1e-12);
    EXPECT_DOUBLE_EQ(axis.matched_share, 1);
    EXPECT_FALSE(axis.sheets[2].large);
    for (const MatchedSheet& sheet : axis.sheets) {
      ASSERT_EQ(sheet.overlaps.size(), 1U);
      EXPECT_EQ(sheet.overlaps[0].sheet, sheet.sheet);
      EXPECT_EQ(sheet.overlaps[0].share, 1);
      EXPECT_DOUBLE_EQ(sheet.on_partner, sheet.area);
      EXPECT_DOUBLE_EQ(sheet.on_other, sheet.area);
      EXPECT_LT(sheet.largest_distance.value(), 1e-14);
      EXPECT_FALSE(sheet.sides);
    }
  }
  EXPECT_DOUBLE_EQ(found.tolerance, 0.01 * std::hypot(3.02, 2));
  EXPECT_EQ(found.compared_sides, 0U);
  EXPECT_TRUE(found.same_large_sheets);
}

/// The second axis has other numbers, other triangles, and its borders lie elsewhere.
TEST(MatchSheets, SharedAreasAreThoseOfTheOverlaps) {
  AxisRows other;
  add_rectangle(other, {2.25, 0, 0.01}, 0.75, 2, 4);
  add_rectangle(other, {0, 0, 0.01}, 2.25, 0.5, 7);
  add_rectangle(other, {0, 0.5, 0.01}, 2.25, 1.5, 7);
  const SheetMatches found = match_sheets(three(), other, {.tolerance = 0.011});
  EXPECT_EQ(partners(found.first), (std::vector<std::optional<std::uint32_t>>{7, 4, std::nullopt}));
  EXPECT_EQ(partners(found.second), (std::vector<std::optional<std::uint32_t>>{1, 0}));
  const MatchedSheet& left = found.first.sheets[0];
  ASSERT_EQ(left.overlaps.size(), 1U);
  EXPECT_DOUBLE_EQ(left.overlaps[0].area, 4);
  EXPECT_NEAR(left.largest_distance.value(), 0.01, 1e-15);
  const MatchedSheet& right = found.first.sheets[1];
  ASSERT_EQ(right.overlaps.size(), 2U);
  EXPECT_EQ(right.overlaps[0].sheet, 4U);
  EXPECT_NEAR(right.overlaps[0].area, 1.5, 0.01);
  EXPECT_EQ(right.overlaps[1].sheet, 7U);
  EXPECT_NEAR(right.overlaps[1].share, 0.25, 0.005);
  EXPECT_NEAR(right.on_other, 2, 1e-12);
  EXPECT_NEAR(right.on_partner, 1.5, 0.01);
  const MatchedSheet& strip = found.first.sheets[2];
  EXPECT_LT(strip.on_other, 0.02) << "only points within 0.011 - 0.01 of the border lie on the other axis";
  EXPECT_NEAR(strip.largest_distance.value(), std::hypot(0.02, 0.01), 2e-3);
  const MatchedSheet& joined = found.second.sheets[1];
  EXPECT_EQ(joined.sheet, 7U);
  ASSERT_EQ(joined.overlaps.size(), 2U);
  EXPECT_NEAR(joined.overlaps[0].area, 4, 0.01);
  EXPECT_NEAR(joined.overlaps[1].area, 0.5, 0.01);
  EXPECT_NEAR(found.second.matched_area, 5.5, 0.02);
  EXPECT_NEAR(found.second.matched_share, 5.5 / 6, 0.003);
  EXPECT_TRUE(found.same_large_sheets);
}

/// A sheet over two equal halves has half of its area on each. A third is not more than half, so thirds have no
/// partner.
TEST(MatchSheets, ASheetThatIsCutHasNoPartner) {
  AxisRows whole;
  add_rectangle(whole, {}, 2, 1, 0);
  AxisRows halves;
  add_rectangle(halves, {0, 0, 0}, 1, 1, 0);
  add_rectangle(halves, {1, 0, 0}, 1, 1, 1);
  const SheetMatches found = match_sheets(whole, halves, {.points = 1000});
  ASSERT_EQ(found.first.sheets[0].overlaps.size(), 2U);
  EXPECT_NEAR(found.first.sheets[0].overlaps[0].share, 0.5, 0.01);
  AxisRows thirds;
  for (std::uint32_t k = 0; k < 3; ++k) add_rectangle(thirds, {2.0 / 3 * k, 0, 0}, 2.0 / 3, 1, k);
  const SheetMatches cut = match_sheets(whole, thirds);
  EXPECT_EQ(cut.first.matched, 0U);
  EXPECT_EQ(cut.second.matched, 0U);
  EXPECT_EQ(cut.first.sheets[0].overlaps.size(), 3U);
  EXPECT_NEAR(cut.first.sheets[0].on_other, 2, 1e-12);
  EXPECT_DOUBLE_EQ(cut.first.matched_share, 0);
  EXPECT_FALSE(cut.same_large_sheets);
}

TEST(MatchSheets, SheetsFartherThanTheToleranceDoNotMatch) {
  AxisRows moved = three();
  for (test::VertexRow& vertex : moved.vertices) vertex.position.z += 0.1;
  const SheetMatches far = match_sheets(three(), moved);
  EXPECT_EQ(far.first.matched, 0U);
  for (const MatchedSheet& sheet : far.first.sheets) {
    EXPECT_TRUE(sheet.overlaps.empty());
    EXPECT_EQ(sheet.on_other, 0);
    EXPECT_NEAR(sheet.largest_distance.value(), 0.1, 1e-12);
  }
  EXPECT_FALSE(far.same_large_sheets);
  EXPECT_EQ(match_sheets(three(), moved, {.tolerance = 0.11}).first.matched, 3U);
  EXPECT_EQ(match_sheets(three(), moved, {.tolerance = 0}).first.matched, 0U);
}

TEST(MatchSheets, SidesAreThePairOfPatchesWithTheLargestArea) {
  AxisRows rows;
  add_rectangle(rows, {0, 0, 0}, 2, 1, 0);
  add_rectangle(rows, {2, 0, 0}, 1, 1, 0);
  add_rectangle(rows, {0, 0, 1}, 1, 1, 1);
  const Complex first = with_patches(rows, {{0, 3}, {0, 3}, {1, 3}, {1, 3}, {2, 2}, {2, 2}}, {0, 0, 1, 1, -1, -1});
  Complex second = with_patches(rows, {{0, 3}, {0, 3}, {1, 3}, {1, 3}, {2, 4}, {2, 4}}, {0, 0, 1, 1, 2, 2});
  const SheetMatches found = match_sheets(first, second);
  ASSERT_EQ(found.first.sheets.size(), 2U);
  EXPECT_EQ(found.first.sheets[0].sides, (Sides{0, 3}));
  EXPECT_NEAR(found.first.sheets[0].sides_share, 2.0 / 3, 1e-12);
  EXPECT_EQ(found.first.sheets[1].sides, (Sides{2, 2}));
  EXPECT_EQ(found.second.sheets[1].sides, (Sides{2, 4}));
  EXPECT_EQ(found.first.matched, 2U);
  EXPECT_EQ(found.compared_sides, 2U);
  EXPECT_EQ(found.same_sides, 1U);
  EXPECT_FALSE(found.same_large_sheets) << "the patches of the second sheet differ";
  const SheetMatches of_patches = match_sheets(first, second, {.of_patches = true});
  EXPECT_EQ(partners(of_patches.first), (std::vector<std::optional<std::uint32_t>>{0, 1}));
  EXPECT_EQ(partners(of_patches.second), (std::vector<std::optional<std::uint32_t>>{0, 1, std::nullopt}));
  EXPECT_EQ(of_patches.same_sides, 2U);
  EXPECT_NEAR(of_patches.first.area, 3, 1e-12) << "triangles inside a patch are left out";
  EXPECT_FALSE(of_patches.same_large_sheets);
  const auto outside = second.triangle_columns.edit<std::int32_t>("patch_a");
  for (std::int32_t& number : outside) number = -1;
  EXPECT_FALSE(match_sheets(first, second).second.sheets[0].sides) << "-1 is not a patch";
}

/// Where no pair of patches has more than half of a sheet, small differences decide which one is the largest.
TEST(MatchSheets, SidesAreComparedOnlyIfTheyHaveMostOfTheArea) {
  AxisRows rows;
  add_rectangle(rows, {0, 0, 0}, 1, 1, 0);
  add_rectangle(rows, {1, 0, 0}, 1, 1, 0);
  const std::vector<std::int32_t> one_sheet(4, 0);
  const Complex first = with_patches(rows, {{0, 3}, {0, 3}, {1, 3}, {1, 3}}, one_sheet);
  const Complex second = with_patches(rows, {{1, 3}, {1, 3}, {2, 3}, {2, 3}}, one_sheet);
  const SheetMatches found = match_sheets(first, second);
  EXPECT_DOUBLE_EQ(found.first.sheets[0].sides_share, 0.5);
  EXPECT_EQ(found.first.sheets[0].sides, (Sides{0, 3}));
  EXPECT_EQ(found.second.sheets[0].sides, (Sides{1, 3}));
  EXPECT_EQ(found.compared_sides, 0U);
  EXPECT_TRUE(found.same_large_sheets);
}

TEST(MatchSheets, AxesWithoutSheetsMatchNothing) {
  AxisRows curve;
  curve.vertices.resize(2);
  curve.vertices[1].position = {1, 0, 0};
  curve.edges.push_back({{0, 1}});
  for (const Complex& empty : {Complex(), Complex(curve)}) {
    const SheetMatches none = match_sheets(empty, empty);
    EXPECT_TRUE(none.first.sheets.empty() && none.second.sheets.empty());
    EXPECT_EQ(none.first.matched_share, 0);
    EXPECT_EQ(none.tolerance, 0);
    EXPECT_TRUE(none.same_large_sheets);
    const SheetMatches one = match_sheets(three(), empty);
    ASSERT_EQ(one.first.sheets.size(), 3U);
    for (const MatchedSheet& sheet : one.first.sheets) {
      EXPECT_FALSE(sheet.partner || sheet.largest_distance);
      EXPECT_TRUE(sheet.overlaps.empty());
    }
    EXPECT_FALSE(one.same_large_sheets);
    EXPECT_FALSE(match_sheets(empty, three()).same_large_sheets);
    EXPECT_TRUE(match_sheets(empty, empty, {.of_patches = true}).first.sheets.empty());
  }
}

/// Sheets without area have no points. Each other sheet has points, however small it is.
TEST(MatchSheets, SmallSheetsHavePointsAndFlatOnesHaveNone) {
  AxisRows rows = three();
  add_rectangle(rows, {5, 0, 0}, 1, 0, 5);
  add_rectangle(rows, {6, 0, 0}, 1e-9, 1e-9, 9);
  const SheetMatches found = match_sheets(rows, rows, {.points = 1});
  EXPECT_EQ(partners(found.first), (std::vector<std::optional<std::uint32_t>>{0, 1, 2, std::nullopt, 9}));
  EXPECT_EQ(found.first.sheets[3].area, 0);
  EXPECT_FALSE(found.first.sheets[3].largest_distance);
}

TEST(MatchSheets, ThreadsDoNotChangeTheResult) {
  AxisRows other = three();
  for (test::VertexRow& vertex : other.vertices) vertex.position.x += 0.013;
  const SheetMatches one = match_sheets(three(), other, {}, {.threads = 1});
  const SheetMatches four = match_sheets(three(), other, {}, {.threads = 4});
  for (std::size_t s = 0; s < one.first.sheets.size(); ++s) {
    EXPECT_EQ(one.first.sheets[s].on_partner, four.first.sheets[s].on_partner);
    EXPECT_EQ(one.first.sheets[s].largest_distance, four.first.sheets[s].largest_distance);
  }
}

TEST(MatchSheets, WrongArgumentsAreRefused) {
  const auto message = [](const Complex& first, const Complex& second,
                          const SheetMatchOptions& options) -> std::string {
    try {
      static_cast<void>(match_sheets(first, second, options));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const Complex axis = three();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double tolerance : {-1.0, nan, HUGE_VAL}) {
    EXPECT_NE(message(axis, axis, {.tolerance = tolerance}).find("tolerance is"), std::string::npos);
  }
  for (const double share : {-0.1, 1.1, nan}) {
    EXPECT_NE(message(axis, axis, {.large_share = share}).find("large_share is"), std::string::npos);
  }
  EXPECT_NE(message(axis, axis, {.points = 0}).find("points is 0"), std::string::npos);
  EXPECT_NE(message(axis, axis, {.of_patches = true}).find("'patch_sheet'"), std::string::npos);
  Complex bare = axis;
  bare.triangle_columns = Columns(bare.triangles.size());
  EXPECT_NE(message(axis, bare, {}).find("no column 'sheet'"), std::string::npos);
  EXPECT_NE(message(bare, axis, {}).find("no column 'sheet'"), std::string::npos);
  Complex broken = axis;
  broken.triangles[0][0] = 1000;
  EXPECT_NE(message(broken, axis, {}), "");
}

}  // namespace
}  // namespace blum
