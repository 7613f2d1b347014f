// Blum: curves of voxels as a graph. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::centrelines {

inline constexpr std::int32_t no_node = -1;

/// Voxels in a row, each a neighbour of the next.
struct Chain {
  std::array<std::int32_t, 2> nodes{no_node, no_node};
  std::vector<std::uint32_t> voxels;  ///< those of its nodes included; of a closed one, the first is also the last
  bool is_there = true;
};

struct ChainNode {
  std::uint32_t voxel = 0;
  std::vector<std::uint32_t> chains;  ///< one that comes back is there twice
  bool is_there = true;
};

struct CurveGraph {
  std::vector<ChainNode> nodes;
  std::vector<Chain> chains;
};

/// The graph of thin voxels, by their linear indices. Its edges join neighbours: a spanning forest of the shortest
/// ones, and one for each tunnel.
///
/// The union of the closed voxels has the homotopy type of the complex of those that touch one another pairwise, since
/// boxes that do so have a point in common. Of its edges beside the forest those stay that no triangle closes: pairs by
/// reduction modulo 2, as in persistent homology. So the graph has the components and tunnels of the voxels, and of
/// neighbours that touch crosswise it keeps no small loops.
[[nodiscard]] CurveGraph curve_graph(const VoxelSet& voxels, const Vec3d& spacing, const Context& context);

/// Components and loops.
[[nodiscard]] BettiNumbers betti_numbers(const CurveGraph& graph);

}  // namespace blum::centrelines
