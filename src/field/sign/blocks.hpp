// Blum: which nodes of a small block certainly lie on the same side. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/core/vec3.hpp"

namespace blum::sign {

/// Nodes along each side of a block.
inline constexpr std::int64_t block_side = 8;
inline constexpr std::size_t block_nodes = 512;

/// Unsigned distances at the nodes of a block, node (x, y, z) at x + 8 y + 64 z; -infinity outside the grid.
struct NodeBlock {
  alignas(64) std::array<float, block_nodes> distance;
};

/// Sets of nodes of a block that certainly lie on the same side.
struct BlockParts {
  /// Part of each node.
  std::array<std::uint16_t, block_nodes> part;
  /// Per part: its node with the largest distance, and the length of a path (in steps of the largest spacing) that
  /// suffices between any two of its nodes.
  std::array<std::uint16_t, block_nodes> representative;
  std::array<std::uint16_t, block_nodes> path;
  std::size_t count = 0;
};

/// Steps between nodes are safe where their distances add up to more than `limit` for the step's direction.
struct StepLimits {
  Vec3d spacing;
  double slack = 0;  ///< added to each step's length: what rounding may have added to two distances

  [[nodiscard]] float limit(std::size_t axis) const { return static_cast<float>(spacing[axis] + slack); }
};

/// Finds the parts of a block: nodes joined by safe steps along the axes, at most `max_steps` from the part's first
/// node; lone nodes then join a neighbour across a diagonal where that is safe too.
/// @param max_steps  0 leaves every node on its own.
void find_parts(const NodeBlock& block, const StepLimits& limits, std::size_t max_steps, BlockParts& out);

}  // namespace blum::sign
