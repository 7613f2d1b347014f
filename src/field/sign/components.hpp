// Blum: sets of nodes that share a sign, over a whole grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/winding_number.hpp"

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

/// The blocks of a grid, x fastest.
struct BlockGrid {
  GridSpec grid;
  std::array<std::int64_t, 3> size{};  ///< number of blocks along each axis

  explicit BlockGrid(const GridSpec& nodes);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }
  /// First node of a block.
  [[nodiscard]] std::array<std::int64_t, 3> first(std::size_t block) const;
  /// One past the last node of a block, cut at the grid's end.
  [[nodiscard]] std::array<std::int64_t, 3> last(std::size_t block) const;
};

/// Nodes that are known to lie on the same side: the winding number differs by at most `spread` between them.
struct Component {
  std::uint64_t node = 0;  ///< where to ask: linear index
  float distance = 0;      ///< there
  float spread = 0;
};

/// Sets of nodes of the grid with a common side. Blocks are either whole, or have parts with a number per node.
class Components {
 public:
  Components(const Field& field, const WindingNumber& winding, double slack, const Context& context);

  [[nodiscard]] const BlockGrid& blocks() const { return blocks_; }
  /// Component roots, rising.
  [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
  [[nodiscard]] const Component& component(std::uint32_t root) const { return components_[root]; }
  [[nodiscard]] bool is_whole(std::size_t block) const { return parts_at_[block] == whole; }
  /// Root of a node of a block, given by its place x + 8 y + 64 z there; any place for a whole block.
  [[nodiscard]] std::uint32_t root(std::size_t block, std::size_t place) const {
    return parent_[first_component_[block] + (is_whole(block) ? 0u : part_[parts_at_[block] * block_nodes + place])];
  }

 private:
  struct Join;
  static constexpr std::uint32_t whole = 0xffffffff;

  [[nodiscard]] bool is_whole_block(std::size_t block) const;
  [[nodiscard]] Box3 world_box(std::size_t block) const;
  void classify(const Context& context);
  void split_blocks(const Context& context);
  void collect_joins(std::size_t block, std::vector<Join>& out) const;
  void join_blocks(const Context& context);
  void join(const Join& step);
  [[nodiscard]] std::uint32_t find(std::uint32_t component);
  [[nodiscard]] NodeBlock load(std::size_t block) const;
  [[nodiscard]] std::uint32_t component_at(std::size_t block, std::size_t place) const {
    return first_component_[block] + (is_whole(block) ? 0u : part_[parts_at_[block] * block_nodes + place]);
  }

  const Field& field_;
  const WindingNumber& winding_;
  BlockGrid blocks_;
  StepLimits limits_;
  double longest_step_ = 0;                     ///< largest spacing
  std::vector<float> change_;                   ///< per block: bound on the change of w along one step in or out of it
  std::vector<std::uint32_t> parts_at_;         ///< per block: where its parts are, or `whole`
  std::vector<std::uint16_t> part_;             ///< per node of blocks with parts
  std::vector<std::uint32_t> first_component_;  ///< per block
  std::vector<Component> components_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> roots_;
};

}  // namespace blum::sign
