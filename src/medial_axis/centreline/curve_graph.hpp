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
  std::vector<std::uint32_t> voxels;  ///< those of its nodes included; in a closed chain the first is also the last
  bool is_there = true;
};

struct ChainNode {
  std::uint32_t voxel = 0;
  std::vector<std::uint32_t> chains;  ///< one that comes back is listed twice
  bool is_there = true;
};

struct CurveGraph {
  std::vector<ChainNode> nodes;
  std::vector<Chain> chains;
};

/// Returns the graph of thin voxels, by their linear indices. Its edges join neighbours: a spanning forest of the
/// shortest edges, and one edge for each tunnel.
///
/// Boxes that touch one another pairwise have a point in common. So the union of the closed voxels has the homotopy
/// type of the complex of voxels that touch pairwise. An edge outside of the forest is kept if no triangle closes it:
/// pairs are found by reduction modulo 2, as in persistent homology. So the graph has the components and tunnels of the
/// voxels. It keeps no small loops of neighbours that touch crosswise.
[[nodiscard]] CurveGraph curve_graph(const VoxelSet& voxels, const Vec3d& spacing, const Context& context);

/// Returns the numbers of components and loops.
[[nodiscard]] BettiNumbers betti_numbers(const CurveGraph& graph);

}  // namespace blum::centrelines
