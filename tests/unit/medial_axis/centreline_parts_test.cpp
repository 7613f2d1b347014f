// Proves that thinning, the graph of neighbours and pruning keep components and tunnels of random voxels. Thinned
// voxels cannot be thinned further.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/centreline/curve_graph.hpp"
#include "medial_axis/centreline/prune_spurs.hpp"
#include "medial_axis/centreline/sections.hpp"
#include "medial_axis/centreline/thin_to_curves.hpp"

namespace blum::centrelines {
namespace {

constexpr std::array<std::int64_t, 3> size{14, 13, 12};

/// Random voxels, none of them at the border.
VoxelSet random_voxels(std::uint32_t seed, double density) {
  std::mt19937 random(seed);
  std::bernoulli_distribution is_in(density);
  VoxelSet voxels(size);
  for (std::int64_t k = 1; k + 1 < size[2]; ++k) {
    for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
      for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
        if (is_in(random)) voxels.insert(i, j, k);
      }
    }
  }
  return voxels;
}

/// Random depths: thinning keeps the topology in any order.
std::vector<float> random_depths(const VoxelSet& voxels, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> any(0.5F, 3);
  std::vector<float> depth;
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) depth.push_back(voxels.contains(i, j, k) ? any(random) : 0);
    }
  }
  return depth;
}

template <class Visit>
void for_each_set(const Visit& visit) {
  for (const double density : {0.05, 0.15, 0.3, 0.5, 0.8, 0.97}) {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) visit(random_voxels(seed, density), seed);
  }
}

TEST(CentrelineParts, FillingRemovesAllVoidsAndNoVoxel) {
  for_each_set([](const VoxelSet& voxels, std::uint32_t /*seed*/) {
    VoxelSet filled = voxels;
    EXPECT_EQ(fill_voids(filled), betti_numbers(voxels)[2]);
    EXPECT_EQ(betti_numbers(filled)[2], 0);
    for (std::int64_t k = 0; k < size[2]; ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t i = 0; i < size[0]; ++i) {
          EXPECT_TRUE(!voxels.contains(i, j, k) || filled.contains(i, j, k));
        }
      }
    }
    VoxelSet again = filled;
    EXPECT_EQ(fill_voids(again), 0);
    EXPECT_EQ(again, filled);
  });
}

TEST(CentrelineParts, ThinningKeepsTheTopologyAndLeavesNothingToThin) {
  for_each_set([](VoxelSet voxels, std::uint32_t seed) {
    fill_voids(voxels);
    const std::vector<float> depth = random_depths(voxels, seed);
    const VoxelSet thin = thin_to_curves(voxels, depth, {1, 1, 1}, {});
    EXPECT_EQ(betti_numbers(thin), betti_numbers(voxels));
    for (std::int64_t k = 0; k < size[2]; ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t i = 0; i < size[0]; ++i) {
          if (!thin.contains(i, j, k)) continue;
          EXPECT_TRUE(voxels.contains(i, j, k));
          const Neighbourhood around = neighbourhood(thin, i, j, k);
          EXPECT_TRUE(!is_simple(around) || std::popcount(around) == 2);  // including the voxel itself
        }
      }
    }
  });
}

TEST(CentrelineParts, GraphsOfNeighboursHaveTheTopologyOfTheVoxels) {
  for_each_set([](const VoxelSet& voxels, std::uint32_t /*seed*/) {
    const BettiNumbers wanted = betti_numbers(voxels);  // of complete sets, which are not thin
    const BettiNumbers found = betti_numbers(curve_graph(voxels, {1, 0.7, 2}, {}));
    EXPECT_EQ(found[0], wanted[0]);
    EXPECT_EQ(found[1], wanted[1]);
  });
}

TEST(CentrelineParts, PruningKeepsTheTopologyAndValidReferences) {
  for_each_set([](VoxelSet voxels, std::uint32_t seed) {
    fill_voids(voxels);
    const std::vector<float> depth = random_depths(voxels, seed);
    CurveGraph graph = curve_graph(thin_to_curves(voxels, depth, {1, 1, 1}, {}), {1, 1, 1}, {});
    const BettiNumbers before = betti_numbers(graph);
    prune_spurs(graph, {depth, size, {1, 1, 1}}, seed % 3, {});
    EXPECT_EQ(betti_numbers(graph), before);
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
      EXPECT_NE(graph.nodes[n].chains.size(), 2U);
      for (const std::uint32_t c : graph.nodes[n].chains) {
        const auto& nodes = graph.chains[c].nodes;
        EXPECT_TRUE(nodes[0] == static_cast<std::int32_t>(n) || nodes[1] == static_cast<std::int32_t>(n));
      }
    }
    for (const Chain& chain : graph.chains) {
      const bool is_closed = chain.nodes[0] == no_node;
      EXPECT_EQ(chain.nodes[1] == no_node, is_closed);
      if (is_closed) {
        EXPECT_EQ(chain.voxels.front(), chain.voxels.back());
        continue;
      }
      EXPECT_EQ(chain.voxels.front(), graph.nodes[static_cast<std::size_t>(chain.nodes[0])].voxel);
      EXPECT_EQ(chain.voxels.back(), graph.nodes[static_cast<std::size_t>(chain.nodes[1])].voxel);
    }
  });
}

TEST(CentrelineParts, SharesAreTrilinearAndSectionsOfAPrismHaveItsArea) {
  constexpr std::array<std::int64_t, 3> box{20, 20, 12};
  std::vector<float> depth;
  for (std::int64_t k = 0; k < box[2]; ++k) {
    for (std::int64_t j = 0; j < box[1]; ++j) {
      for (std::int64_t i = 0; i < box[0]; ++i) {
        depth.push_back(i >= 5 && i < 14 && j >= 6 && j < 13 && k > 0 && k < 11 ? 3.0F : 0.0F);
      }
    }
  }
  const LabelShare label(depth, box, {1, 1, 0.5});
  EXPECT_EQ(label.at({9, 9, 3}), 1);
  EXPECT_DOUBLE_EQ(label.at({4.25, 9, 3}), 0.25);
  EXPECT_DOUBLE_EQ(label.at({4.5, 5.5, 3}), 0.25);
  EXPECT_EQ(label.at({-1, 5, 3}), 0);
  EXPECT_EQ(label.at({9, 9, 99}), 0);
  const Section section = label.section({9, 9.3, 3}, {0, 0, 1});
  EXPECT_NEAR(section.area, 9 * 7, 0.6);
  EXPECT_NEAR(section.centroid.x, 9, 0.05);
  EXPECT_NEAR(section.centroid.y, 9, 0.05);
  EXPECT_NEAR(label.way_out({9, 9, 3}, {1, 0, 0}, 20), 4.5, 0.01);
  EXPECT_EQ(label.way_out({9, 9, 3}, {1, 0, 0}, 2), 2);
}

}  // namespace
}  // namespace blum::centrelines
