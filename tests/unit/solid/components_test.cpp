// Proves that components of a solid in a square and in a cube are joined, numbered and classified correctly.
#include "solid/model/components.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace blum::detail {
namespace {

using End = SquareComponents::End;

constexpr auto no_hole = [](std::span<const std::uint32_t>) { return false; };

TEST(SquareComponents, SidesJoinedAtCornersAreOneComponent) {
  SquareComponents square;
  square.start(4);
  square.join(0, 2);
  square.join(0, 3);
  square.join(1, 2);
  square.join(1, 3);
  EXPECT_TRUE(square.finish(no_hole));
  EXPECT_EQ(square.count(), 1U);
  EXPECT_EQ(square.of_interval(3), 0U);
}

TEST(SquareComponents, AreJoinedByArcsAndNumberedByIntervals) {
  SquareComponents square;
  square.start(5);
  // One arc from border to border joins 1 and 4. Two arcs that meet inside join 0 and 3. 2 is alone.
  square.add_arc({true, 4}, {true, 1});
  square.add_arc({true, 3}, {false, 70});
  square.add_arc({false, 70}, {true, 0});
  square.add_arc({true, 2}, {true, 2});
  EXPECT_TRUE(square.finish(no_hole));
  EXPECT_EQ(square.count(), 3U);
  EXPECT_EQ((std::array{square.of_interval(0), square.of_interval(1), square.of_interval(2), square.of_interval(3),
                        square.of_interval(4)}),
            (std::array{0U, 1U, 2U, 0U, 1U}));
  EXPECT_EQ((std::array{square.of_arc(0), square.of_arc(1), square.of_arc(2), square.of_arc(3)}),
            (std::array{1U, 0U, 0U, 2U}));
}

TEST(SquareComponents, ClosedCurvesAreQueriedAndNumberedLast) {
  SquareComponents square;
  const auto fill = [&] {
    square.start(1);
    square.add_arc({false, 5}, {false, 6});  // a curve of arcs 0, 2, 3
    square.add_arc({false, 9}, {false, 8});  // a curve of arcs 1, 4
    square.add_arc({false, 7}, {false, 6});
    square.add_arc({false, 5}, {false, 7});
    square.add_arc({false, 8}, {false, 9});
  };
  fill();
  std::vector<std::vector<std::uint32_t>> asked;
  const auto take = [&](std::span<const std::uint32_t> loop) {
    asked.emplace_back(loop.begin(), loop.end());
    return false;
  };
  EXPECT_TRUE(square.finish(take));
  EXPECT_EQ(asked, (std::vector<std::vector<std::uint32_t>>{{0, 2, 3}, {1, 4}}));
  EXPECT_EQ(square.count(), 3U);
  EXPECT_EQ(square.of_interval(0), 0U);
  EXPECT_EQ(square.of_arc(3), 1U);
  EXPECT_EQ(square.of_arc(4), 2U);
  fill();
  EXPECT_FALSE(square.finish([](std::span<const std::uint32_t> loop) { return loop.front() == 1; }));
  square.start(2);  // the previous content is erased
  EXPECT_TRUE(square.finish(no_hole));
  EXPECT_EQ(square.count(), 2U);
}

constexpr auto flat = [](std::uint32_t) { return std::int64_t{0}; };

/// Adds the sides of a cube by number, joined by its edges and corners.
void add_whole_cube(CubeComponents& cube) {
  for (std::size_t one = 0; one < 6; ++one) {
    for (std::size_t other = one + 1; other < 6; ++other) {
      if (one / 2 != other / 2) cube.join_at_interval(one, other);
    }
  }
  for (std::size_t corner = 0; corner < 8; ++corner) cube.add_corner(corner & 1U);
}

TEST(CubeComponents, AWholeCubeIsABall) {
  CubeComponents cube;
  cube.start(6);
  add_whole_cube(cube);
  EXPECT_TRUE(cube.finish(flat));
  EXPECT_EQ(cube.count(), 1U);
}

TEST(CubeComponents, ARodThroughOppositeSidesIsABallAndAHandleIsNot) {
  CubeComponents cube;
  // The wall of a rod is a tube without ends, with Euler number 0.
  cube.start(3);
  cube.add_arc(11, 0);
  cube.add_arc(4, 1);
  cube.add_arc(11, 2);
  cube.add_arc(11, 2);
  EXPECT_TRUE(cube.finish([](std::uint32_t piece) { return std::int64_t{piece == 4 ? 1 : 0}; }));
  EXPECT_EQ(cube.count(), 2U);
  EXPECT_EQ((std::array{cube.of_part(0), cube.of_part(1), cube.of_part(2)}), (std::array{0U, 1U, 0U}));
  // Two sides and a piece of Euler number -2 add up to 0, so the boundary has a handle.
  cube.start(2);
  cube.add_arc(0, 0);
  cube.add_arc(0, 1);
  EXPECT_FALSE(cube.finish([](std::uint32_t) { return std::int64_t{-2}; }));
  EXPECT_EQ(cube.count(), 1U);
}

TEST(CubeComponents, EachBoundaryIsClassifiedSeparately) {
  // Euler numbers 3 and 1 have the sum of two spheres.
  CubeComponents cube;
  cube.start(2);
  cube.add_arc(7, 0);
  cube.add_arc(8, 1);
  EXPECT_FALSE(cube.finish([](std::uint32_t piece) { return std::int64_t{piece == 7 ? 2 : 0}; }));
  EXPECT_EQ(cube.count(), 2U);
}

TEST(CubeComponents, PiecesCountOnceForAnyNumberOfArcs) {
  CubeComponents cube;
  cube.start(6);
  add_whole_cube(cube);
  // A dent in the middle of an edge removes half of the edge and has arcs in both sides.
  for (int k = 0; k < 5; ++k) cube.add_arc(3, static_cast<std::size_t>(k % 2) * 2);
  cube.join_at_interval(0, 2);
  EXPECT_TRUE(cube.finish([](std::uint32_t) { return std::int64_t{1}; }));
  EXPECT_EQ(cube.count(), 1U);
}

}  // namespace
}  // namespace blum::detail
