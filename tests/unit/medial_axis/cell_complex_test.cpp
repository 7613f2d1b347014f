// Proves that the cells of voxels, their faces and their cofaces equal those of direct enumeration.
#include "medial_axis/cells/cell_complex.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <vector>

#include "blum/grid/voxel_topology.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::CellComplex;

/// A cell as its middle, in half steps: odd along the axes that it spans.
using Middle = std::array<std::int64_t, 3>;

Middle middle_of(const CellLattice& lattice, Cell cell) {
  Middle middle = lattice.place(node_of(cell));
  for (std::size_t a = 0; a < 3; ++a) middle[a] = 2 * middle[a] + (axes_of(cell) >> a & 1U);
  return middle;
}

/// The middles of the cells of closed voxels.
std::set<Middle> middles_of(const VoxelSet& voxels) {
  std::set<Middle> middles;
  test::for_each_voxel(voxels.size(), 0, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    if (!voxels.contains(i, j, k)) return;
    for (std::int64_t n = 0; n < 27; ++n) middles.insert({2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9});
  });
  return middles;
}

std::size_t count_cells(const CellComplex& complex) {
  std::size_t count = 0;
  for (const std::uint8_t byte : complex.bytes()) count += static_cast<std::size_t>(std::popcount(byte));
  return count;
}

const std::vector<std::array<std::int64_t, 3>> sizes{{5, 5, 5}, {9, 4, 6}, {3, 3, 3}, {70, 5, 4}, {130, 3, 3}};

TEST(CellComplex, CellsAreThoseOfTheClosedVoxels) {
  Random random(1);
  for (const auto& size : sizes) {
    for (const double density : {0.02, 0.3, 0.7, 1.0}) {
      const VoxelSet voxels = test::random_voxels(size, density, random);
      const CellComplex complex(voxels, {});
      const std::set<Middle> expected = middles_of(voxels);
      for (std::size_t node = 0; node < complex.lattice().node_count(); ++node) {
        for (CellAxes axes = 0; axes < 8; ++axes) {
          const Cell cell = cell_at(node, axes);
          ASSERT_EQ(complex.contains(cell), expected.contains(middle_of(complex.lattice(), cell)))
              << "node " << node << ", axes " << axes;
        }
      }
      EXPECT_EQ(count_cells(complex), expected.size());
    }
  }
}

TEST(CellComplex, CellsByDimensionGiveTheEulerCharacteristic) {
  Random random(2);
  const VoxelSet voxels = test::random_voxels({20, 21, 22}, 0.4, random);
  const CellComplex complex(voxels, {});
  std::int64_t sum = 0;
  for (std::size_t node = 0; node < complex.lattice().node_count(); ++node) {
    for (CellAxes axes = 0; axes < 8; ++axes) {
      const Cell cell = cell_at(node, axes);
      if (complex.contains(cell)) sum += dimension_of(cell) % 2 == 0 ? 1 : -1;
    }
  }
  EXPECT_EQ(sum, euler_characteristic(voxels));
}

TEST(CellComplex, ThreadsDoNotMatter) {
  Random random(3);
  const VoxelSet voxels = test::random_voxels({40, 30, 25}, 0.5, random);
  const CellComplex one(voxels, {.threads = 1});
  for (const int threads : {2, 7}) {
    const CellComplex other(voxels, {.threads = threads});
    EXPECT_TRUE(std::equal(one.bytes().begin(), one.bytes().end(), other.bytes().begin(), other.bytes().end()));
  }
}

TEST(CellComplex, OnlyCofaceIsTheSingleCellWithTheFace) {
  Random random(4);
  CellComplex complex(test::random_voxels({8, 8, 8}, 0.5, random), {});
  const CellLattice& lattice = complex.lattice();
  // Random cells are erased, so remaining cells may lack faces.
  for (int n = 0; n < 400; ++n) complex.erase(static_cast<Cell>(random.below(8 * lattice.node_count())));
  int free_faces = 0;
  for (std::int64_t k = 1; k < 8; ++k) {
    for (std::int64_t j = 1; j < 8; ++j) {
      for (std::int64_t i = 1; i < 8; ++i) {
        for (CellAxes axes = 0; axes < 7; ++axes) {
          const Cell cell = cell_at(lattice.node(i, j, k), axes);
          std::vector<Cell> there;
          lattice.for_each_coface(cell, [&](Cell coface) {
            if (complex.contains(coface)) there.push_back(coface);
          });
          ASSERT_EQ(complex.only_coface(cell), there.size() == 1 ? there[0] : cell);
          free_faces += there.size() == 1 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(free_faces, 50);
}

}  // namespace
}  // namespace blum
