// Proves that the cells of a lattice, their faces and their cofaces agree with direct enumeration.
#include "blum/grid/cell_lattice.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <set>

#include "blum/core/error.hpp"

namespace blum {
namespace {

/// A cell by its middle, in half steps: coordinates are odd along the axes that the cell spans.
using Middle = std::array<std::int64_t, 3>;

Middle middle_of(const CellLattice& lattice, Cell cell) {
  Middle middle = lattice.place(node_of(cell));
  for (std::size_t a = 0; a < 3; ++a) middle[a] = 2 * middle[a] + (axes_of(cell) >> a & 1U);
  return middle;
}

/// The middles that lie half a step away along an axis whose coordinate is odd (faces) or even (cofaces).
std::set<Middle> middles_around(const Middle& middle, std::int64_t parity) {
  std::set<Middle> around;
  for (std::size_t a = 0; a < 3; ++a) {
    if (middle[a] % 2 != parity) continue;
    for (const std::int64_t step : {-1, 1}) {
      Middle next = middle;
      next[a] += step;
      around.insert(next);
    }
  }
  return around;
}

TEST(CellLattice, FacesAndCofacesAreHalfAStepAway) {
  const CellLattice lattice({6, 5, 4});
  for (std::int64_t k = 1; k < 4; ++k) {
    for (std::int64_t j = 1; j < 5; ++j) {
      for (std::int64_t i = 1; i < 6; ++i) {
        for (CellAxes axes = 0; axes < 8; ++axes) {
          const Cell cell = cell_at(lattice.node(i, j, k), axes);
          const Middle middle = middle_of(lattice, cell);
          std::set<Middle> faces;
          std::set<Middle> cofaces;
          lattice.for_each_face(cell, [&](Cell face) { faces.insert(middle_of(lattice, face)); });
          lattice.for_each_coface(cell, [&](Cell coface) { cofaces.insert(middle_of(lattice, coface)); });
          ASSERT_EQ(faces, middles_around(middle, 1));
          ASSERT_EQ(cofaces, middles_around(middle, 0));
        }
      }
    }
  }
}

TEST(CellLattice, PlacesAndNodesAreInverse) {
  const CellLattice lattice({6, 5, 4});
  ASSERT_EQ(lattice.node_count(), 7U * 6U * 5U);
  for (std::size_t node = 0; node < lattice.node_count(); ++node) {
    const auto [i, j, k] = lattice.place(node);
    ASSERT_EQ(lattice.node(i, j, k), node);
    if (i + 1 < 7 && j + 1 < 6 && k + 1 < 5) {
      ASSERT_EQ(lattice.node(i + 1, j, k), node + lattice.stride(0));
      ASSERT_EQ(lattice.node(i, j + 1, k), node + lattice.stride(1));
      ASSERT_EQ(lattice.node(i, j, k + 1), node + lattice.stride(2));
    }
  }
}

TEST(CellLattice, BoxesOfTooManyCellsAreRefused) {
  EXPECT_NO_THROW((void)CellLattice({811, 811, 811}));
  EXPECT_THROW((void)CellLattice({812, 812, 812}), InvalidGrid);
  EXPECT_THROW((void)CellLattice({1, 1, 1 << 28}), InvalidGrid);
}

}  // namespace
}  // namespace blum
