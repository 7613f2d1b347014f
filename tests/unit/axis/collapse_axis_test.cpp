// Proves that walls collapse by their angles from free edges, and that cells needed for homotopy stay. Larger angles
// leave a part of the result of smaller ones, and invalid input is rejected.
#include "blum/axis/collapse_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/complex/medial_columns.hpp"
#include "support/medial_rows.hpp"

namespace blum {
namespace {

using test::AxisRows;

/// A strip of `steps` squares, each of two triangles, with one angle for each square.
AxisRows strip(const std::vector<float>& angles, bool is_closed) {
  AxisRows axis;
  const auto steps = static_cast<std::uint32_t>(angles.size());
  const std::uint32_t columns = is_closed ? steps : steps + 1;
  for (std::uint32_t k = 0; k < columns; ++k) {
    const double turn = 2 * std::numbers::pi * k / steps;
    const Vec3d at = is_closed ? Vec3d{std::cos(turn), std::sin(turn), 0} : Vec3d{static_cast<double>(k), 0, 0};
    axis.vertices.emplace_back().position = at;
    axis.vertices.emplace_back().position = at + Vec3d{0, 0, 1};
  }
  for (std::uint32_t k = 0; k < steps; ++k) {
    const std::uint32_t a = 2 * k;
    const std::uint32_t b = 2 * ((k + 1) % columns);
    axis.triangles.push_back({{a, b, b + 1}, angles[k], 0});
    axis.triangles.push_back({{a, b + 1, a + 1}, angles[k], 0});
  }
  axis.sheet_count = 1;
  return axis;
}

std::size_t triangles_at(const Complex& walls, double theta) {
  return collapse_axis(walls, theta).triangles.size();
}

TEST(CollapseAxis, RemovesSmallerAnglesFromFreeEdges) {
  const Complex walls = strip({10, 20, 30, 40}, false);
  EXPECT_EQ(triangles_at(walls, 0), 8U);
  EXPECT_EQ(triangles_at(walls, 15), 6U);
  EXPECT_EQ(triangles_at(walls, 30), 2U);
  // The strip is contractible, so a vertex remains.
  const Complex nothing = collapse_axis(walls, 180);
  EXPECT_EQ(nothing.positions.size(), 1U);
  EXPECT_TRUE(nothing.triangles.empty() && nothing.edges.empty());
  EXPECT_TRUE(problem_of_medial(nothing).empty());
}

TEST(CollapseAxis, LeavesCellsThatHomotopyNeeds) {
  const Complex ring = collapse_axis(strip({10, 20, 50, 20, 10, 50}, true), 30);
  EXPECT_EQ(ring.triangles.size(), 4U) << "squares of 50 degrees";
  EXPECT_EQ(homology(ring.view()), (BettiNumbers{1, 1, 0}));
  EXPECT_TRUE(problem_of_medial(ring).empty());
  const MedialCounts counts = count(ring);
  EXPECT_EQ(counts.sheets, 2U);
  EXPECT_GT(counts.curve_edges, 0U);
  const Complex curve = collapse_axis(strip({10, 20, 50, 20, 10, 50}, true), 60);
  EXPECT_TRUE(curve.triangles.empty());
  EXPECT_EQ(homology(curve.view()), (BettiNumbers{1, 1, 0}));
}

/// Vertices on a seam may have larger separation angles than the triangles beside it. The seam then stays as a curve.
TEST(CollapseAxis, LeavesSeamsOfLargerAngles) {
  AxisRows axis;
  for (int k = 0; k <= 4; ++k) {
    for (const Vec3d& side : {Vec3d{0, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 1}, Vec3d{0, -1, -1}}) {
      axis.vertices.emplace_back().position = Vec3d{static_cast<double>(k), 0, 0} + side;
      axis.vertices.back().separation_angle = side.y == 0 ? 120 : 60;
    }
  }
  for (std::uint32_t k = 0; k < 4; ++k) {
    for (const std::uint32_t side : {1U, 2U, 3U}) {
      const std::uint32_t a = 4 * k;
      axis.triangles.push_back({{a, a + 4, a + side}, 60, 0});
      axis.triangles.push_back({{a + 4, a + 4 + side, a + side}, 60, 0});
    }
  }
  axis.sheet_count = 1;
  const Complex curve = collapse_axis(axis, 90);
  EXPECT_TRUE(curve.triangles.empty());
  EXPECT_EQ(curve.edges.size(), 4U);
  EXPECT_EQ(triangles_at(axis, 50), 24U);
  EXPECT_TRUE(collapse_axis(axis, 130).edges.empty());
}

/// A closed surface does not have a free edge.
TEST(CollapseAxis, LeavesClosedSurfaces) {
  AxisRows axis;
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    axis.vertices.emplace_back().position = p;
  }
  for (const auto& corners : {std::array{0U, 2U, 1U}, {0U, 1U, 3U}, {1U, 2U, 3U}, {2U, 0U, 3U}}) {
    axis.triangles.push_back({corners, 10, 0});
  }
  axis.sheet_count = 1;
  EXPECT_EQ(triangles_at(axis, 180), 4U);
}

TEST(CollapseAxis, LargerAnglesLeavePartsOfTheResultOfSmallerOnes) {
  const Complex walls = strip({40, 5, 33, 12, 28, 19, 7, 50, 3}, true);
  std::set<std::array<double, 9>> before;
  const auto places = [](const Complex& axis) {
    std::set<std::array<double, 9>> out;
    for (const auto& [a, b, c] : axis.triangles) {
      const Vec3d& p = axis.positions[a];
      const Vec3d& q = axis.positions[b];
      const Vec3d& r = axis.positions[c];
      out.insert({p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z});
    }
    return out;
  };
  before = places(collapse_axis(walls, 0));
  for (const double theta : {4.0, 10.0, 20.0, 30.0, 45.0, 90.0}) {
    const std::set<std::array<double, 9>> now = places(collapse_axis(walls, theta));
    EXPECT_TRUE(std::includes(before.begin(), before.end(), now.begin(), now.end())) << theta;
    before = now;
  }
}

TEST(CollapseAxis, RejectsInvalidAnglesColumnsAndTriangles) {
  const Complex walls = strip({10, 20}, false);
  EXPECT_THROW((void)collapse_axis(walls, -1), InvalidOption);
  EXPECT_THROW((void)collapse_axis(walls, 181), InvalidOption);
  EXPECT_THROW((void)collapse_axis(walls, std::nan("")), InvalidOption);
  for (const std::string_view name :
       {medial_columns::radius, medial_columns::footprints[0], medial_columns::footprints[1], medial_columns::sites[0],
        medial_columns::separation_angle}) {
    Complex less = walls;
    less.vertex_columns.erase(name);
    EXPECT_THROW((void)collapse_axis(less, 0), InvalidOption) << name;
  }
  Complex less = walls;
  less.triangle_columns.erase(medial_columns::separation_angle);
  EXPECT_THROW((void)collapse_axis(less, 0), InvalidOption);
  Complex wrong = walls;
  wrong.triangles[0] = {0, 0, 1};
  EXPECT_THROW((void)collapse_axis(wrong, 0), InvalidMesh);
}

}  // namespace
}  // namespace blum
