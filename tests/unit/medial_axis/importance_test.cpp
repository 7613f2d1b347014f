// Proves that each cell has the largest importance of the cells that contain it, and other cells have none. The
// reference is a plain map.
#include "medial_axis/cells/importance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "blum/core/random.hpp"

namespace blum {
namespace {

using detail::Importance;

/// Adds a cell, its faces, their faces and so on.
void add_closure(const CellLattice& lattice, Cell cell, float degrees, std::map<Cell, float>& values) {
  float& value = values[cell];
  value = std::max(value, degrees);
  lattice.for_each_face(cell, [&](Cell face) { add_closure(lattice, face, degrees, values); });
}

/// Squares, edges and vertices off the border. The values are whole degrees including 0, so that many are equal.
std::vector<Importance::Entry> random_entries(const CellLattice& lattice, std::size_t count, Random& random) {
  std::vector<Importance::Entry> entries;
  while (entries.size() < count) {
    std::array<std::int64_t, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = 1 + static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(lattice.size()[a] - 2)));
    }
    const auto axes = static_cast<CellAxes>(random.below(7));
    entries.push_back({cell_at(lattice.node(at[0], at[1], at[2]), axes), static_cast<float>(random.below(20))});
  }
  return entries;
}

TEST(Importance, CellsHaveTheLargestValueOfTheCellsAroundThem) {
  Random random(1);
  for (const std::size_t count : {0U, 1U, 5U, 100U, 1000U}) {
    const CellLattice lattice({9, 7, 6});
    const std::vector<Importance::Entry> entries = random_entries(lattice, count, random);
    std::map<Cell, float> expected;
    for (const auto& [cell, degrees] : entries) add_closure(lattice, cell, degrees, expected);
    const Importance importance(lattice, entries);
    EXPECT_EQ(importance.count(), expected.size());
    for (std::size_t node = 0; node < lattice.node_count(); ++node) {
      std::uint8_t cells = 0;
      for (CellAxes axes = 0; axes < 8; ++axes) {
        const auto at = expected.find(cell_at(node, axes));
        if (at != expected.end()) cells |= static_cast<std::uint8_t>(1U << axes);
        ASSERT_EQ(importance.of(cell_at(node, axes)), at == expected.end() ? 0 : at->second);
      }
      ASSERT_EQ(importance.cells_at(node), cells);
    }
  }
}

TEST(Importance, NoFaceHasLessThanItsCell) {
  Random random(2);
  const CellLattice lattice({12, 12, 12});
  const Importance importance(lattice, random_entries(lattice, 500, random));
  for (std::size_t node = 0; node < lattice.node_count(); ++node) {
    for (CellAxes axes = 1; axes < 8; ++axes) {
      const Cell cell = cell_at(node, axes);
      if (importance.of(cell) == 0) continue;
      lattice.for_each_face(cell, [&](Cell face) { ASSERT_GE(importance.of(face), importance.of(cell)); });
    }
  }
}

TEST(Importance, DefaultImportanceIsZero) {
  EXPECT_EQ(Importance().of(12345), 0);
  EXPECT_EQ(Importance().count(), 0U);
}

}  // namespace
}  // namespace blum
