// Proves that Betti numbers of voxel sets, counted on whole words of bits, agree with flood fills and cells listed one
// by one. The removal of a simple voxel changes no Betti number around it.
#include "blum/grid/voxel_topology.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {
namespace {

using Index = std::array<std::int64_t, 3>;

/// Components of the voxels of a box inside or outside a set, by flood fill. `steps`: 1 for faces, 3 for corners.
std::int64_t flooded_components(const VoxelSet& voxels, const Index& first, const Index& end, bool inside, int steps) {
  std::set<Index> rest;
  for (std::int64_t k = first[2]; k < end[2]; ++k) {
    for (std::int64_t j = first[1]; j < end[1]; ++j) {
      for (std::int64_t i = first[0]; i < end[0]; ++i) {
        if (voxels.contains(i, j, k) == inside) rest.insert({i, j, k});
      }
    }
  }
  std::int64_t count = 0;
  while (!rest.empty()) {
    ++count;
    std::vector<Index> stack{*rest.begin()};
    rest.erase(rest.begin());
    while (!stack.empty()) {
      const Index at = stack.back();
      stack.pop_back();
      for (int n = 0; n < 27; ++n) {
        const int x = n % 3 - 1;
        const int y = n / 3 % 3 - 1;
        const int z = n / 9 - 1;
        if (std::abs(x) + std::abs(y) + std::abs(z) > steps) continue;
        const auto found = rest.find({at[0] + x, at[1] + y, at[2] + z});
        if (found == rest.end()) continue;
        stack.push_back(*found);
        rest.erase(found);
      }
    }
  }
  return count;
}

/// Counts the cells of all closed voxels once each. Their doubled coordinates are odd along the axes that a cell spans.
std::int64_t listed_euler_characteristic(const VoxelSet& voxels) {
  std::set<Index> cells;
  const Index& size = voxels.size();
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) {
        if (!voxels.contains(i, j, k)) continue;
        for (int n = 0; n < 27; ++n) cells.insert({2 * i + n % 3, 2 * j + n / 3 % 3, 2 * k + n / 9});
      }
    }
  }
  std::int64_t sum = 0;
  for (const Index& cell : cells) sum += (cell[0] + cell[1] + cell[2]) % 2 == 0 ? 1 : -1;
  return sum;
}

std::array<std::int64_t, 3> slow_betti_numbers(const VoxelSet& voxels) {
  const Index& size = voxels.size();
  const std::int64_t components = flooded_components(voxels, {0, 0, 0}, size, true, 3);
  const std::int64_t voids =
      flooded_components(voxels, {-1, -1, -1}, {size[0] + 1, size[1] + 1, size[2] + 1}, false, 1) - 1;
  return {components, components + voids - listed_euler_characteristic(voxels), voids};
}

VoxelSet random_set(const Index& size, double density, std::mt19937& random) {
  VoxelSet voxels(size);
  std::bernoulli_distribution is_in(density);
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) {
        if (is_in(random)) voxels.insert(i, j, k);
      }
    }
  }
  return voxels;
}

TEST(VoxelTopology, RandomSetsHaveTheBettiNumbersOfFloodFills) {
  std::mt19937 random(1);
  for (const Index& size : {Index{1, 1, 1}, Index{7, 6, 5}, Index{63, 4, 3}, Index{64, 3, 4}, Index{65, 3, 3},
                            Index{130, 2, 3}, Index{1, 9, 9}, Index{9, 1, 9}, Index{9, 9, 1}}) {
    for (const double density : {0.0, 0.05, 0.3, 0.6, 0.9, 1.0}) {
      const VoxelSet voxels = random_set(size, density, random);
      EXPECT_EQ(betti_numbers(voxels), slow_betti_numbers(voxels))
          << size[0] << " x " << size[1] << " x " << size[2] << ", density " << density;
    }
  }
}

TEST(VoxelTopology, KnownSetsHaveTheirBettiNumbers) {
  VoxelSet shell({70, 5, 5});
  for (std::int64_t k = 0; k < 5; ++k) {
    for (std::int64_t j = 0; j < 5; ++j) {
      for (std::int64_t i = 0; i < 70; ++i) shell.insert(i, j, k);
    }
  }
  EXPECT_EQ(betti_numbers(shell), (std::array<std::int64_t, 3>{1, 0, 0}));
  shell.erase(64, 2, 2);
  EXPECT_EQ(betti_numbers(shell), (std::array<std::int64_t, 3>{1, 0, 1}));
  for (std::int64_t i = 0; i < 64; ++i) shell.erase(i, 2, 2);  // opens the void
  EXPECT_EQ(betti_numbers(shell), (std::array<std::int64_t, 3>{1, 0, 0}));
  for (std::int64_t i = 65; i < 70; ++i) shell.erase(i, 2, 2);  // a tunnel
  EXPECT_EQ(betti_numbers(shell), (std::array<std::int64_t, 3>{1, 1, 0}));
  VoxelSet corners({2, 2, 2});
  corners.insert(0, 0, 0);
  corners.insert(1, 1, 1);
  EXPECT_EQ(betti_numbers(corners), (std::array<std::int64_t, 3>{1, 0, 0})) << "closed voxels share a corner";
  EXPECT_EQ(betti_numbers(VoxelSet({3, 3, 3})), (std::array<std::int64_t, 3>{0, 0, 0}));
}

TEST(VoxelTopology, OneTwoAndSevenThreadsAgree) {
  std::mt19937 random(2);
  const VoxelSet voxels = random_set({40, 30, 20}, 0.4, random);
  const auto expected = betti_numbers(voxels, {.threads = 1});
  for (const int threads : {2, 7}) EXPECT_EQ(betti_numbers(voxels, {.threads = threads}), expected);
}

TEST(VoxelTopology, CanBeCancelled) {
  std::stop_source source;
  source.request_stop();
  EXPECT_THROW((void)betti_numbers(VoxelSet({8, 8, 8}), {.cancel = source.get_token()}), Cancelled);
}

/// A voxel with its neighbours retracts to itself. Thus it is simple if its neighbours alone have the topology of a
/// point.
TEST(VoxelTopology, AVoxelIsSimpleIfItsNeighboursAreLikeAPoint) {
  std::mt19937 random(3);
  int simple = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const double density = 0.05 + 0.9 * (trial % 10) / 9;
    VoxelSet around = random_set({3, 3, 3}, density, random);
    const Neighbourhood bits = neighbourhood(around, 1, 1, 1);
    around.erase(1, 1, 1);
    const bool expected = betti_numbers(around) == std::array<std::int64_t, 3>{1, 0, 0};
    ASSERT_EQ(is_simple(bits), expected) << "neighbourhood " << bits;
    simple += expected ? 1 : 0;
  }
  EXPECT_GT(simple, 400);
  EXPECT_LT(simple, 3600);
}

TEST(VoxelTopology, NeighbourhoodsAtTheBorderHaveNothingBeyond) {
  VoxelSet voxels({2, 2, 2});
  voxels.insert(0, 0, 0);
  voxels.insert(1, 0, 0);
  EXPECT_EQ(neighbourhood(voxels, 0, 0, 0), 1U << 13 | 1U << 14);
  EXPECT_EQ(neighbourhood(voxels, 1, 1, 1), 1U << (13 - 3 - 9) | 1U << (13 - 1 - 3 - 9));
}

}  // namespace
}  // namespace blum
