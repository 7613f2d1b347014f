#include "field/sign/blocks.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace blum::sign {
namespace {

/// One bit per node: word z, bit x + 8 y.
using NodeSet = std::array<std::uint64_t, 8>;

constexpr std::array<std::size_t, 3> stride{1, 8, 64};

/// Bit of a node is set where the step to its next neighbour along an axis is safe.
NodeSet safe_steps(const NodeBlock& block, std::size_t axis, float limit) {
  NodeSet steps{};
  for (std::size_t node = 0; node + stride[axis] < block_nodes; ++node) {
    const bool is_safe = block.distance[node] + block.distance[node + stride[axis]] > limit;
    steps[node / 64] |= static_cast<std::uint64_t>(is_safe) << (node % 64);
  }
  // The last node of a row (or slice) has no next one.
  if (axis == 0) {
    for (std::uint64_t& word : steps) word &= 0x7f7f7f7f7f7f7f7fu;
  }
  if (axis == 1) {
    for (std::uint64_t& word : steps) word &= 0x00ffffffffffffffu;
  }
  return steps;
}

/// All nodes within one safe step of a set, and the set itself.
NodeSet grown(const NodeSet& set, const std::array<NodeSet, 3>& steps) {
  NodeSet out;
  for (std::size_t z = 0; z < 8; ++z) {
    const std::uint64_t s = set[z];
    out[z] = s | (s & steps[0][z]) << 1 | (s >> 1 & steps[0][z]) | (s & steps[1][z]) << 8 | (s >> 8 & steps[1][z]);
  }
  for (std::size_t z = 0; z < 7; ++z) {
    out[z + 1] |= set[z] & steps[2][z];
    out[z] |= set[z + 1] & steps[2][z];
  }
  return out;
}

NodeSet nodes_in_grid(const NodeBlock& block) {
  NodeSet out{};
  for (std::size_t node = 0; node < block_nodes; ++node) {
    out[node / 64] |= static_cast<std::uint64_t>(block.distance[node] >= 0) << (node % 64);
  }
  return out;
}

/// Gives the nodes of a set the next part.
void add_part(const NodeBlock& block, const NodeSet& set, std::size_t steps, BlockParts& out) {
  const auto part = static_cast<std::uint16_t>(out.count++);
  std::size_t best = block_nodes;
  for (std::size_t z = 0; z < 8; ++z) {
    for (std::uint64_t bits = set[z]; bits != 0; bits &= bits - 1) {
      const std::size_t node = 64 * z + static_cast<std::size_t>(std::countr_zero(bits));
      out.part[node] = part;
      if (best == block_nodes || block.distance[node] > block.distance[best]) best = node;
    }
  }
  out.representative[part] = static_cast<std::uint16_t>(best);
  out.path[part] = static_cast<std::uint16_t>(2 * steps);
}

/// A neighbour across a face or space diagonal that a lone node can reach safely and that is not alone itself;
/// block_nodes where there is none.
std::size_t diagonal_neighbour(const NodeBlock& block, const StepLimits& limits, const BlockParts& parts,
                               std::size_t node) {
  const auto x = static_cast<int>(node % 8), y = static_cast<int>(node / 8 % 8), z = static_cast<int>(node / 64);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (std::abs(dx) + std::abs(dy) + std::abs(dz) < 2) continue;
        const int nx = x + dx, ny = y + dy, nz = z + dz;
        if (((nx | ny | nz) & ~7) != 0) continue;
        // NOLINTNEXTLINE(bugprone-misplaced-widening-cast): below 512
        const auto other = static_cast<std::size_t>(nx + 8 * ny + 64 * nz);
        if (!(block.distance[other] >= 0) || parts.path[parts.part[other]] == 0) continue;
        const double step = length(Vec3d{dx * limits.spacing.x, dy * limits.spacing.y, dz * limits.spacing.z});
        if (static_cast<double>(block.distance[node]) + static_cast<double>(block.distance[other]) >
            step + limits.slack) {
          return other;
        }
      }
    }
  }
  return block_nodes;
}

/// Lets lone nodes join a part across a diagonal, and closes the gaps in the numbering.
void join_lone_nodes(const NodeBlock& block, const StepLimits& limits, BlockParts& parts) {
  std::array<std::uint16_t, block_nodes> target;
  bool any = false;
  for (std::size_t p = 0; p < parts.count; ++p) {
    target[p] = static_cast<std::uint16_t>(p);
    if (parts.path[p] != 0) continue;
    const std::size_t neighbour = diagonal_neighbour(block, limits, parts, parts.representative[p]);
    if (neighbour == block_nodes) continue;
    target[p] = parts.part[neighbour];
    any = true;
  }
  if (!any) return;
  std::array<std::uint16_t, block_nodes> number{};
  std::size_t count = 0;
  for (std::size_t p = 0; p < parts.count; ++p) {
    if (target[p] != p) continue;
    number[p] = static_cast<std::uint16_t>(count);
    parts.representative[count] = parts.representative[p];
    // Two lone nodes of a part are a diagonal (at most 2 steps long) each away from it.
    parts.path[count] = static_cast<std::uint16_t>(parts.path[p] == 0 ? 0 : parts.path[p] + 4);
    ++count;
  }
  for (std::size_t node = 0; node < block_nodes; ++node) {
    if (block.distance[node] >= 0) parts.part[node] = number[target[parts.part[node]]];
  }
  parts.count = count;
}

}  // namespace

void find_parts(const NodeBlock& block, const StepLimits& limits, std::size_t max_steps, BlockParts& out) {
  out.count = 0;
  out.part.fill(0);
  const std::array<NodeSet, 3> steps{safe_steps(block, 0, limits.limit(0)), safe_steps(block, 1, limits.limit(1)),
                                     safe_steps(block, 2, limits.limit(2))};
  NodeSet left = nodes_in_grid(block);
  for (std::size_t z = 0; z < 8; ++z) {
    while (left[z] != 0) {
      NodeSet set{};
      set[z] = left[z] & (0 - left[z]);
      std::size_t taken_steps = 0;
      for (; taken_steps < max_steps; ++taken_steps) {
        NodeSet next = grown(set, steps);
        for (std::size_t k = 0; k < 8; ++k) next[k] &= left[k];
        if (next == set) break;
        set = next;
      }
      for (std::size_t k = 0; k < 8; ++k) left[k] &= ~set[k];
      add_part(block, set, taken_steps, out);
    }
  }
  if (max_steps > 0) join_lone_nodes(block, limits, out);
}

}  // namespace blum::sign
