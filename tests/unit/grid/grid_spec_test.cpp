// Proves the grid convention: the number of nodes, their positions, and which grids are refused.
#include "blum/grid/grid_spec.hpp"

#include <gtest/gtest.h>

#include "blum/core/error.hpp"

namespace blum {
namespace {

TEST(GridSpec, LongestPaddedSideGetsTheResolution) {
  const GridSpec grid = grid_around({{0, 0, 0}, {10, 5, 1}}, 121, 0.1);
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{121, 71, 31}));
  EXPECT_NEAR(grid.spacing.x, 0.1, 1e-12);
  EXPECT_NEAR(grid.origin.x, -1, 1e-9);
  EXPECT_NEAR(grid.origin.y, -1, 1e-9);
  EXPECT_NEAR(grid.origin.z, -1, 1e-9);
}

TEST(GridSpec, OtherAxesAreCoveredAndCentred) {
  const GridSpec grid = grid_in({{0, 0, 0}, {10, 5.5, 0}}, 11);
  EXPECT_EQ(grid.size, (std::array<std::int64_t, 3>{11, 7, 1}));
  EXPECT_NEAR(grid.origin.y, -0.25, 1e-12);
  EXPECT_EQ(grid.origin.z, 0);
}

TEST(GridSpec, RefusesEmptyBoxesAndInvalidOptions) {
  EXPECT_THROW((void)grid_around(Box3{}, 64), InvalidGrid);
  EXPECT_THROW((void)grid_around({{1, 1, 1}, {1, 1, 1}}, 64), InvalidGrid);
  EXPECT_THROW((void)grid_around({{0, 0, 0}, {1, 1, 1}}, 1), InvalidOption);
  EXPECT_THROW((void)grid_around({{0, 0, 0}, {1, 1, 1}}, 64, -1), InvalidOption);
  EXPECT_THROW((void)grid_in_with_spacing({{0, 0, 0}, {1, 1, 1}}, 1e-9), InvalidGrid);
}

}  // namespace
}  // namespace blum
