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

/// Sequence of voxels, each a neighbour of the next one.
struct Chain {
  std::array<std::int32_t, 2> nodes{no_node, no_node};
  /// Voxels of the chain, including those of its nodes. The last voxel of a closed chain is also its first.
  std::vector<std::uint32_t> voxels;
  bool is_there = true;
};

struct ChainNode {
  std::uint32_t voxel = 0;
  std::vector<std::uint32_t> chains;  ///< chains that end here; a chain with both ends here is listed twice
  bool is_there = true;
};

struct CurveGraph {
  std::vector<ChainNode> nodes;
  std::vector<Chain> chains;
};

/// Returns the graph of thinned voxels, which it identifies by linear indices. Its edges join neighbours: the edges of
/// a spanning forest of least length, and one more edge for each tunnel.
///
/// Boxes that touch one another pairwise have a point in common. So the union of the closed voxels has the homotopy
/// type of the complex of voxels that touch pairwise. An edge outside of the forest is kept unless its loop is a sum,
/// modulo 2, of the borders of triangles of neighbours. The reduction of persistent homology finds these edges. So the
/// graph has as many components and tunnels as the voxels. Neighbours that touch diagonally add no loops.
[[nodiscard]] CurveGraph curve_graph(const VoxelSet& voxels, const Vec3d& spacing, const Context& context);

/// Returns the numbers of components and loops of a graph; the number of voids is 0.
[[nodiscard]] BettiNumbers betti_numbers(const CurveGraph& graph);

}  // namespace blum::centrelines
