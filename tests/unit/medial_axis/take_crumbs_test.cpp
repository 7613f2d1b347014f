// Proves that small sheets on other sheets are removed as a whole, with the cells that only they have. Sheets that
// stand out, large sheets and sheets that close a void stay.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/homology.hpp"
#include "blum/complex/incidence.hpp"
#include "medial_axis/fit/trim.hpp"

namespace blum {
namespace {

using detail::AxisLists;
using detail::AxisVertex;
using detail::CrumbLimits;
using detail::take_crumbs;

constexpr std::uint32_t side = 8;
constexpr CrumbLimits limits{4, 0.1};

std::uint32_t at(std::uint32_t i, std::uint32_t j) {
  return j * (side + 1) + i;
}

AxisVertex vertex(const Vec3d& position) {
  AxisVertex vertex;
  vertex.position = position;
  return vertex;
}

/// A square in the plane z = 0, made of triangles with legs of length 1.
AxisLists square() {
  AxisLists lists;
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) lists.vertices.push_back(vertex({double(i), double(j), 0}));
  }
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      lists.add_triangle({at(i, j), at(i + 1, j), at(i + 1, j + 1)}, 180);
      lists.add_triangle({at(i, j), at(i + 1, j + 1), at(i, j + 1)}, 180);
    }
  }
  return lists;
}

std::uint32_t add_vertex(AxisLists& lists, const Vec3d& position) {
  lists.vertices.push_back(vertex(position));
  return static_cast<std::uint32_t>(lists.vertices.size() - 1);
}

/// Adds a triangle on the edge from (2, 2) to (3, 2) and returns its third vertex.
std::uint32_t add_flap(AxisLists& lists, const Vec3d& own, float angle = 180) {
  const std::uint32_t v = add_vertex(lists, own);
  lists.add_triangle({at(2, 2), at(3, 2), v}, angle);
  return v;
}

bool take(AxisLists& lists, const CrumbLimits& with = limits) {
  return take_crumbs(lists, Incidence({lists.vertices.size(), lists.edges, lists.triangles}), with, {});
}

BettiNumbers betti_of(const AxisLists& lists) {
  return homology(ComplexView{lists.vertices.size(), lists.edges, lists.triangles});
}

void expect_square(const AxisLists& lists) {
  const AxisLists expected = square();
  EXPECT_EQ(lists.triangles, expected.triangles);
  EXPECT_EQ(lists.triangle_angles, expected.triangle_angles);
  EXPECT_TRUE(lists.edges.empty());
  ASSERT_EQ(lists.vertices.size(), expected.vertices.size());
  for (std::size_t v = 0; v < lists.vertices.size(); ++v) {
    EXPECT_EQ(lists.vertices[v].position, expected.vertices[v].position);
  }
}

TEST(TakeCrumbs, TakesATriangleBetweenVerticesOfASheetThatItLiesOn) {
  AxisLists lists = square();
  lists.add_triangle({at(2, 2), at(3, 2), at(4, 3)}, 180);  // its side from (2, 2) to (4, 3) is free
  ASSERT_TRUE(take(lists));
  expect_square(lists);
}

TEST(TakeCrumbs, TakesATriangleWithAVertexOfItsOwn) {
  AxisLists lists = square();
  add_flap(lists, {2.5, 2.6, 0.05});
  ASSERT_TRUE(take(lists));
  expect_square(lists);
}

TEST(TakeCrumbs, TakesAStripOfSeveralTriangles) {
  AxisLists lists = square();
  std::array<std::uint32_t, 3> own{};
  for (std::uint32_t k = 0; k < 3; ++k) own[k] = add_vertex(lists, {2.0 + k, 2.5, 0.02});
  for (std::uint32_t k = 0; k < 2; ++k) {
    lists.add_triangle({at(2 + k, 2), at(3 + k, 2), own[k]}, 180);
    lists.add_triangle({at(3 + k, 2), own[k + 1], own[k]}, 180);
  }
  ASSERT_TRUE(take(lists));
  expect_square(lists);
}

TEST(TakeCrumbs, TakesCrumbsOnCrumbs) {
  AxisLists lists = square();
  add_flap(lists, {2.5, 2.6, 0.03});
  add_flap(lists, {2.5, 2.4, -0.03});
  ASSERT_TRUE(take(lists));
  expect_square(lists);
}

TEST(TakeCrumbs, LeavesSheetsThatStandOut) {
  AxisLists lists = square();
  add_flap(lists, {2.5, 2, 0.5}, 90);
  EXPECT_FALSE(take(lists));
  EXPECT_EQ(lists.triangles.size(), square().triangles.size() + 1);
}

TEST(TakeCrumbs, LeavesLargeSheets) {
  AxisLists lists = square();
  add_flap(lists, {2.5, 2.6, 0.05});
  EXPECT_FALSE(take(lists, {0.2, 0.1}));
  EXPECT_TRUE(take(lists, {0.4, 0.1}));
}

TEST(TakeCrumbs, LeavesSheetsThatCloseAVoid) {
  // A tent over two triangles: its sides lie on the square, but none of them is free.
  AxisLists lists = square();
  const std::uint32_t top = add_vertex(lists, {2.5, 2.5, 0.05});
  const std::array<std::uint32_t, 4> base{at(2, 2), at(3, 2), at(3, 3), at(2, 3)};
  for (std::size_t k = 0; k < 4; ++k) lists.add_triangle({base[k], base[(k + 1) % 4], top}, 180);
  const AxisLists before = lists;
  ASSERT_EQ(betti_of(before), (BettiNumbers{1, 0, 1}));
  EXPECT_FALSE(take(lists));
  EXPECT_EQ(lists.triangles, before.triangles);
}

TEST(TakeCrumbs, LeavesSheetsWhoseRemovalWouldLeaveACurve) {
  // A flap spans a hole of the sheet. Without it an edge over the hole would remain.
  AxisLists lists = square();
  lists.triangles.erase(lists.triangles.begin() + 2 * (3 * side + 3), lists.triangles.begin() + 2 * (3 * side + 3) + 2);
  lists.triangle_angles.resize(lists.triangles.size());
  lists.add_triangle({at(3, 3), at(4, 3), at(3, 4)}, 180);
  const AxisLists before = lists;
  const BettiNumbers betti = betti_of(before);
  (void)take(lists);
  EXPECT_EQ(betti_of(lists), betti);
  EXPECT_TRUE(lists.edges.empty());
}

TEST(TakeCrumbs, LeavesCurvesAsTheyAre) {
  AxisLists lists = square();
  const std::uint32_t own = add_flap(lists, {2.5, 2.6, 0.05});
  const std::uint32_t end = add_vertex(lists, {2.5, 2.6, 5});
  lists.add_edge({own, end}, 120);
  const BettiNumbers betti = betti_of(lists);
  (void)take(lists);
  EXPECT_EQ(betti_of(lists), betti);
  EXPECT_EQ(lists.edges.size(), 1U);
}

}  // namespace
}  // namespace blum
