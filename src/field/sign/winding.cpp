#include "field/sign/winding.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::sign {
namespace {

/// Number of nodes along each side of a block.
inline constexpr std::int64_t block_side = 8;
inline constexpr std::size_t block_nodes = 512;

/// Unsigned distances at the nodes of a block. The index of node (x, y, z) is x + 8 y + 64 z. Nodes outside of the grid
/// have -infinity.
struct NodeBlock {
  alignas(64) std::array<float, block_nodes> distance;
};

/// Partition of a block's nodes into parts. All nodes of a part are certainly on the same side of the surface.
struct BlockParts {
  /// Part index of each node.
  std::array<std::uint16_t, block_nodes> part;
  /// Per part: its node with the largest distance, and a length. Any two of its nodes are connected by a path of at
  /// most this length. Lengths are in steps of the largest spacing.
  std::array<std::uint16_t, block_nodes> representative;
  std::array<std::uint16_t, block_nodes> path;
  std::size_t count = 0;
};

/// Limits of safe steps. A step between two nodes is safe (no triangle lies between them) if their distances add up to
/// more than `limit`.
struct StepLimits {
  Vec3d spacing;
  double slack = 0;  ///< added to each step's length; covers rounding of two distances

  [[nodiscard]] float limit(std::size_t axis) const { return static_cast<float>(spacing[axis] + slack); }
};

/// Blocks of a grid, x fastest.
struct BlockGrid {
  GridSpec grid;
  std::array<std::int64_t, 3> size{};  ///< number of blocks along each axis

  explicit BlockGrid(const GridSpec& nodes);
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(size[0] * size[1] * size[2]); }
  /// Returns the indices of a block's first node.
  [[nodiscard]] std::array<std::int64_t, 3> first(std::size_t block) const;
  /// Returns the indices after a block's last node, limited by the grid's size.
  [[nodiscard]] std::array<std::int64_t, 3> last(std::size_t block) const;
};

/// Set of nodes that are certainly on the same side. The winding number differs by at most `spread` between them.
struct Component {
  std::uint64_t node = 0;  ///< linear index of the node to evaluate
  float distance = 0;      ///< distance at this node
  float spread = 0;
};

/// Partition of the grid's nodes into components on the same side. A block is either whole (in one component), or
/// divided into parts; then each node has a part index.
class Components {
 public:
  Components(const Field& field, const WindingNumber& winding, double slack, const Context& context);

  [[nodiscard]] const BlockGrid& blocks() const { return blocks_; }
  /// Returns the roots of all components, ascending. A root is the index that represents its component.
  [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
  [[nodiscard]] const Component& component(std::uint32_t root) const { return components_[root]; }
  [[nodiscard]] bool is_whole(std::size_t block) const { return parts_at_[block] == whole; }
  /// Returns the root of the component that contains a node. `place` is the node's index in the block, x + 8 y + 64 z;
  /// it is ignored for a whole block.
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
  double longest_step_ = 0;  ///< Largest spacing of the grid.
  /// Per block: bound on the change of the winding number over one step within the block or across its border.
  std::vector<float> change_;
  std::vector<std::uint32_t> parts_at_;         ///< Per block: index of its parts; `whole` if it has none.
  std::vector<std::uint16_t> part_;             ///< Part index of each node, for blocks with parts.
  std::vector<std::uint32_t> first_component_;  ///< Per block: index of its first component before joining.
  std::vector<Component> components_;
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint32_t> roots_;
};

/// One bit per node: bit x + 8 y of word z.
using NodeSet = std::array<std::uint64_t, 8>;

constexpr std::array<std::size_t, 3> stride{1, 8, 64};

/// Returns the set of nodes from which the step to the next node along an axis is safe.
NodeSet safe_steps(const NodeBlock& block, std::size_t axis, float limit) {
  NodeSet steps{};
  for (std::size_t node = 0; node + stride[axis] < block_nodes; ++node) {
    const bool is_safe = block.distance[node] + block.distance[node + stride[axis]] > limit;
    steps[node / 64] |= static_cast<std::uint64_t>(is_safe) << (node % 64);
  }
  // The last node along an axis has no next node.
  if (axis == 0) {
    for (std::uint64_t& word : steps) word &= 0x7f7f7f7f7f7f7f7fu;
  }
  if (axis == 1) {
    for (std::uint64_t& word : steps) word &= 0x00ffffffffffffffu;
  }
  return steps;
}

/// Returns the set, extended by all nodes within one safe step of it.
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

/// Makes the nodes of a set the next part. `steps` is the number of steps from its first node to its furthest one.
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

/// For a lone node (the only node of its part), returns a neighbour across a face or space diagonal. The step to this
/// neighbour must be safe, and it must not be a lone node. Returns block_nodes if there is none.
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

/// Adds each lone node to the part of its diagonal_neighbour(), and renumbers the parts without gaps.
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
    // A path between two added nodes has one more diagonal at each end, of at most 2 steps each.
    parts.path[count] = static_cast<std::uint16_t>(parts.path[p] == 0 ? 0 : parts.path[p] + 4);
    ++count;
  }
  for (std::size_t node = 0; node < block_nodes; ++node) {
    if (block.distance[node] >= 0) parts.part[node] = number[target[parts.part[node]]];
  }
  parts.count = count;
}

constexpr std::size_t blocks_per_range = 64;
/// Largest allowed change of the winding number over a part of a block, and over a component.
constexpr double part_spread = 0.2;
constexpr double component_spread = 0.4;
/// If one step may change the winding number by more, parts would contain little more than one node each. Such a block
/// joins no component, but is evaluated in boxes that are halved repeatedly. Most of these boxes lie further from the
/// boundary.
constexpr float change_to_ask_at = 0.05F;
/// Longer than any path within a block, so that it does not limit the parts.
constexpr std::size_t unlimited_steps = 511;

float rounded_up(double value) {
  return value < 1e30 ? std::nextafter(static_cast<float>(value), HUGE_VALF) : HUGE_VALF;
}

/// Finds the parts of a block. A part's nodes are connected by safe steps along the axes, and at most `max_steps` from
/// its first node. Lone nodes then join the part of a diagonal neighbour if that is safe.
/// @param max_steps  if 0, every node becomes a part.
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

BlockGrid::BlockGrid(const GridSpec& nodes) : grid(nodes) {
  for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = (nodes.size[axis] + block_side - 1) / block_side;
}

std::array<std::int64_t, 3> BlockGrid::first(std::size_t block) const {
  const auto b = static_cast<std::int64_t>(block);
  return {block_side * (b % size[0]), block_side * (b / size[0] % size[1]), block_side * (b / (size[0] * size[1]))};
}

std::array<std::int64_t, 3> BlockGrid::last(std::size_t block) const {
  std::array<std::int64_t, 3> out = first(block);
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = std::min(out[axis] + block_side, grid.size[axis]);
  return out;
}

/// Safe step between nodes of neighbouring blocks.
struct Components::Join {
  std::uint32_t a = 0, b = 0;
  float change = 0;  ///< largest change of the winding number over the step
};

Components::Components(const Field& field, const WindingNumber& winding, double slack, const Context& context)
    : field_(field), winding_(winding), blocks_(field.grid), limits_{field.grid.spacing, slack} {
  longest_step_ = std::max({field.grid.spacing.x, field.grid.spacing.y, field.grid.spacing.z});
  classify(context);
  split_blocks(context);
  join_blocks(context);
}

Box3 Components::world_box(std::size_t block) const {
  const std::array<std::int64_t, 3> first = blocks_.first(block);
  const std::array<std::int64_t, 3> last = blocks_.last(block);
  Box3 box;
  for (int corner = 0; corner < 8; ++corner) {
    // The box is extended by one step on all sides, so that it contains all steps to neighbouring blocks.
    box.extend(blocks_.grid.position((corner & 1) != 0 ? last[0] : first[0] - 1,
                                     (corner & 2) != 0 ? last[1] : first[1] - 1,
                                     (corner & 4) != 0 ? last[2] : first[2] - 1));
  }
  return box;
}

NodeBlock Components::load(std::size_t block) const {
  const std::array<std::int64_t, 3> first = blocks_.first(block);
  const std::array<std::int64_t, 3> last = blocks_.last(block);
  NodeBlock out;
  out.distance.fill(-HUGE_VALF);
  for (std::int64_t z = first[2]; z < last[2]; ++z) {
    for (std::int64_t y = first[1]; y < last[1]; ++y) {
      const float* row = field_.distance.data() + blocks_.grid.index(first[0], y, z);
      const auto place = static_cast<std::size_t>(8 * (y - first[1]) + 64 * (z - first[2]));
      std::copy(row, row + (last[0] - first[0]), out.distance.data() + place);
    }
  }
  return out;
}

/// Returns true if every step within the block is safe and the winding number changes little enough over the block.
bool Components::is_whole_block(std::size_t block) const {
  const std::array<std::int64_t, 3> first = blocks_.first(block);
  const std::array<std::int64_t, 3> last = blocks_.last(block);
  std::array<std::int64_t, 3> middle;
  Vec3d reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = (first[axis] + last[axis]) / 2;
    reach[axis] = static_cast<double>(std::max(last[axis] - 1 - middle[axis], middle[axis] - first[axis])) *
                  blocks_.grid.spacing[axis];
  }
  const double steps = (reach.x + reach.y + reach.z) * 2 / longest_step_;
  if (static_cast<double>(change_[block]) * steps > part_spread) return false;
  const double at_middle = static_cast<double>(field_.distance[blocks_.grid.index(middle[0], middle[1], middle[2])]);
  // The ball around the middle node contains the block and no triangle.
  if (at_middle > length(reach) + limits_.slack) return true;
  const auto safe = static_cast<float>((longest_step_ + limits_.slack) / 2);
  if (at_middle <= static_cast<double>(safe)) return false;
  for (std::int64_t z = first[2]; z < last[2]; ++z) {
    for (std::int64_t y = first[1]; y < last[1]; ++y) {
      const float* row = field_.distance.data() + blocks_.grid.index(first[0], y, z);
      if (*std::min_element(row, row + (last[0] - first[0])) <= safe) return false;
    }
  }
  return true;
}

void Components::classify(const Context& context) {
  change_.assign(blocks_.count(), 0.0f);
  parts_at_.assign(blocks_.count(), whole);
  std::vector<std::uint8_t> has_parts(blocks_.count(), 0);
  parallel_for(context, blocks_.count(), blocks_per_range, "", [&](const WorkRange& range) {
    for (std::size_t block = range.begin; block < range.end; ++block) {
      if (!winding_.is_piecewise_constant()) {
        const double enough = static_cast<double>(change_to_ask_at) / longest_step_;
        change_[block] = rounded_up(winding_.gradient_bound(world_box(block), enough) * longest_step_);
      }
      if (change_[block] > change_to_ask_at) change_[block] = HUGE_VALF;
      has_parts[block] = change_[block] == HUGE_VALF || is_whole_block(block) ? 0 : 1;
    }
  });
  std::uint32_t next = 0;
  for (std::size_t block = 0; block < has_parts.size(); ++block) {
    if (has_parts[block] != 0) parts_at_[block] = next++;
  }
  part_.resize(std::size_t{next} * block_nodes);
}

void Components::split_blocks(const Context& context) {
  // Components are found for each range of blocks separately, and then numbered in the order of blocks.
  const std::size_t range_count = (blocks_.count() + blocks_per_range - 1) / blocks_per_range;
  std::vector<std::vector<Component>> found(range_count);
  first_component_.assign(blocks_.count(), 0);
  parallel_for(context, blocks_.count(), blocks_per_range, "", [&](const WorkRange& range) {
    std::vector<Component>& out = found[range.begin / blocks_per_range];
    BlockParts parts;
    for (std::size_t block = range.begin; block < range.end; ++block) {
      const std::array<std::int64_t, 3> first = blocks_.first(block);
      const std::array<std::int64_t, 3> last = blocks_.last(block);
      first_component_[block] = static_cast<std::uint32_t>(out.size());
      const double change = static_cast<double>(change_[block]);
      if (is_whole(block)) {
        const std::size_t node =
            blocks_.grid.index((first[0] + last[0]) / 2, (first[1] + last[1]) / 2, (first[2] + last[2]) / 2);
        const auto steps = static_cast<double>(last[0] - first[0] + last[1] - first[1] + last[2] - first[2]);
        out.push_back({node, field_.distance[node], change > 0 ? rounded_up(change * steps) : 0.0f});
        continue;
      }
      const std::size_t max_steps =
          change > 0 ? static_cast<std::size_t>(std::min(part_spread / 2 / change, double{unlimited_steps}))
                     : unlimited_steps;
      find_parts(load(block), limits_, max_steps, parts);
      std::copy(parts.part.begin(), parts.part.end(),
                part_.begin() + static_cast<std::ptrdiff_t>(parts_at_[block] * block_nodes));
      for (std::size_t p = 0; p < parts.count; ++p) {
        const std::int64_t place = parts.representative[p];
        const std::size_t node =
            blocks_.grid.index(first[0] + place % 8, first[1] + place / 8 % 8, first[2] + place / 64);
        const double path = parts.path[p];
        out.push_back({node, field_.distance[node], path > 0 && change > 0 ? rounded_up(change * path) : 0.0f});
      }
    }
  });
  std::size_t total = 0;
  for (const auto& part : found) total += part.size();
  if (total >= whole) {
    throw OutOfMemory("the sign of this grid falls into " + std::to_string(total) +
                      " separate sets of nodes, more than 2^32 - 1: compute the field in slabs");
  }
  components_.reserve(total);
  for (std::size_t range = 0; range < range_count; ++range) {
    const auto base = static_cast<std::uint32_t>(components_.size());
    const std::size_t end = std::min((range + 1) * blocks_per_range, blocks_.count());
    for (std::size_t block = range * blocks_per_range; block < end; ++block) first_component_[block] += base;
    components_.insert(components_.end(), found[range].begin(), found[range].end());
    std::vector<Component>().swap(found[range]);
  }
}

void Components::collect_joins(std::size_t block, std::vector<Join>& out) const {
  const std::array<std::int64_t, 3> first = blocks_.first(block);
  const std::array<std::int64_t, 3> last = blocks_.last(block);
  const GridSpec& grid = blocks_.grid;
  constexpr std::array<std::int64_t, 3> stride{1, 8, 64};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (last[axis] == grid.size[axis]) continue;
    const std::size_t next = block + static_cast<std::size_t>(axis == 0   ? 1
                                                              : axis == 1 ? blocks_.size[0]
                                                                          : blocks_.size[0] * blocks_.size[1]);
    const bool is_single = is_whole(block) && is_whole(next);
    const float limit = limits_.limit(axis);
    const float change = std::min(change_[block], change_[next]);
    const std::size_t across = grid.index(axis == 0, axis == 1, axis == 2);
    const std::size_t u_axis = axis == 0 ? 1 : 0;
    const std::size_t v_axis = axis == 2 ? 1 : 2;
    std::pair<std::uint32_t, std::uint32_t> previous{whole, whole};
    for (std::int64_t v = first[v_axis]; v < last[v_axis]; ++v) {
      for (std::int64_t u = first[u_axis]; u < last[u_axis]; ++u) {
        std::array<std::int64_t, 3> at{};
        at[axis] = last[axis] - 1;
        at[u_axis] = u;
        at[v_axis] = v;
        const std::size_t node = grid.index(at[0], at[1], at[2]);
        if (!(field_.distance[node] + field_.distance[node + across] > limit)) continue;
        const std::int64_t base = (u - first[u_axis]) * stride[u_axis] + (v - first[v_axis]) * stride[v_axis];
        const auto place = static_cast<std::size_t>(base + 7 * stride[axis]);
        const std::pair pair{component_at(block, place), component_at(next, static_cast<std::size_t>(base))};
        if (pair != previous) out.push_back({pair.first, pair.second, change});
        previous = pair;
        if (is_single) break;
      }
      if (is_single && previous.first != whole) break;
    }
  }
}

std::uint32_t Components::find(std::uint32_t c) {
  while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
  return c;
}

void Components::join(const Join& step) {
  const std::uint32_t a = find(step.a);
  const std::uint32_t b = find(step.b);
  if (a == b) return;
  Component& x = components_[std::min(a, b)];
  const Component& y = components_[std::max(a, b)];
  float spread = 0;
  if (x.spread > 0 || y.spread > 0 || step.change > 0) {
    spread =
        rounded_up(static_cast<double>(x.spread) + static_cast<double>(y.spread) + static_cast<double>(step.change));
    if (static_cast<double>(spread) > component_spread) return;
  }
  parent_[std::max(a, b)] = std::min(a, b);
  if (y.distance > x.distance) {
    x.node = y.node;
    x.distance = y.distance;
  }
  x.spread = spread;
}

void Components::join_blocks(const Context& context) {
  const std::size_t range_count = (blocks_.count() + blocks_per_range - 1) / blocks_per_range;
  std::vector<std::vector<Join>> joins(range_count);
  parallel_for(context, blocks_.count(), blocks_per_range, "", [&](const WorkRange& range) {
    for (std::size_t block = range.begin; block < range.end; ++block) {
      collect_joins(block, joins[range.begin / blocks_per_range]);
    }
  });
  parent_.resize(components_.size());
  for (std::size_t c = 0; c < parent_.size(); ++c) parent_[c] = static_cast<std::uint32_t>(c);
  // This loop runs on one thread, in the order of blocks, because the order decides which joins stay within the allowed
  // spread.
  for (const std::vector<Join>& range : joins) {
    for (const Join& step : range) join(step);
  }
  for (std::uint32_t c = 0; c < parent_.size(); ++c) {
    parent_[c] = find(c);
    if (parent_[c] == c) roots_.push_back(c);
  }
}

}  // namespace
}  // namespace blum::sign

namespace blum {
namespace {

using sign::Components;

constexpr std::size_t queries_per_range = 64;
constexpr std::size_t blocks_per_range = 16;

constexpr std::int64_t few_nodes = 8;

enum class Side : std::uint8_t { outside, inside, varies };

using Corner = std::array<std::int64_t, 3>;

/// Writes the signs of the nodes of one grid.
class SignWriter {
 public:
  SignWriter(Field& field, const WindingNumber& winding, double slack)
      : field_(field), winding_(winding), slack_(slack) {}

  void negate(std::size_t node) {
    if (field_.distance[node] > 0) field_.distance[node] = -field_.distance[node];
  }

  void negate_box(const Corner& first, const Corner& last) {
    for_each_node(first, last, [&](std::size_t node, const Corner&) { negate(node); });
  }

  void ask_node(std::size_t node, const Corner& at) {
    ++queries_;
    if (winding_.is_inside(field_.grid.position(at[0], at[1], at[2]))) negate(node);
  }

  /// Evaluates a box of nodes over which the winding number may cross 1/2. If the number cannot reach 1/2 from its
  /// value at the box's middle, all nodes get one answer. Otherwise the box is divided into eight.
  void ask_box(const Corner& first, const Corner& last) {
    const Corner size{last[0] - first[0], last[1] - first[1], last[2] - first[2]};
    const Corner middle{first[0] + size[0] / 2, first[1] + size[1] / 2, first[2] + size[2] / 2};
    const std::size_t node = field_.grid.index(middle[0], middle[1], middle[2]);
    // For so few nodes, evaluating each costs less than a bound on the change.
    if (size[0] * size[1] * size[2] <= few_nodes) {
      for_each_node(first, last, [&](std::size_t each, const Corner& at) { ask_node(each, at); });
      return;
    }
    if (const std::optional<bool> side = common_side(first, last, middle, node)) {
      if (*side) negate_box(first, last);
      return;
    }
    for (int octant = 0; octant < 8; ++octant) {
      Corner from = first;
      Corner to = last;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        ((octant >> axis & 1) != 0 ? from : to)[axis] = middle[axis];
      }
      if (from[0] < to[0] && from[1] < to[1] && from[2] < to[2]) ask_box(from, to);
    }
  }

  template <class Visit>
  void for_each_node(const Corner& first, const Corner& last, const Visit& visit) {
    for (std::int64_t z = first[2]; z < last[2]; ++z) {
      for (std::int64_t y = first[1]; y < last[1]; ++y) {
        const std::size_t row = field_.grid.index(0, y, z);
        for (std::int64_t x = first[0]; x < last[0]; ++x) visit(row + static_cast<std::size_t>(x), {x, y, z});
      }
    }
  }

  [[nodiscard]] std::size_t queries() const { return queries_; }

 private:
  [[nodiscard]] std::optional<bool> common_side(const Corner& first, const Corner& last, const Corner& middle,
                                                std::size_t node) {
    Vec3d reach;
    Box3 box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      reach[axis] = static_cast<double>(std::max(middle[axis] - first[axis], last[axis] - 1 - middle[axis])) *
                    field_.grid.spacing[axis];
    }
    const double radius = length(reach);
    if (!(std::abs(static_cast<double>(field_.distance[node])) > radius + slack_)) return std::nullopt;
    for (int corner = 0; corner < 8; ++corner) {
      box.extend(field_.grid.position((corner & 1) != 0 ? last[0] - 1 : first[0],
                                      (corner & 2) != 0 ? last[1] - 1 : first[1],
                                      (corner & 4) != 0 ? last[2] - 1 : first[2]));
    }
    constexpr double most = 0.6;
    const double change = winding_.gradient_bound(box, most / radius) * radius;
    if (!(change < most)) return std::nullopt;
    ++queries_;
    return winding_.side(field_.grid.position(middle[0], middle[1], middle[2]), change);
  }

  Field& field_;
  const WindingNumber& winding_;
  double slack_;
  std::size_t queries_ = 0;
};

double common_diagonal(const MeshView& mesh, const GridSpec& grid) {
  Box3 box = bounds(mesh);
  box.extend(bounds(grid));
  return box.diagonal();
}

/// Returns the side of every component, indexed by its root.
std::vector<Side> ask_components(const Components& components, const WindingNumber& winding, const GridSpec& grid,
                                 const Context& context) {
  const std::vector<std::uint32_t>& roots = components.roots();
  std::vector<Side> sides(roots.empty() ? 0 : roots.back() + 1, Side::outside);
  parallel_for(context, roots.size(), queries_per_range, "sign", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const sign::Component& component = components.component(roots[i]);
      const auto node = static_cast<std::int64_t>(component.node);
      const Vec3d query =
          grid.position(node % grid.size[0], node / grid.size[0] % grid.size[1], node / (grid.size[0] * grid.size[1]));
      std::optional<bool> side;
      if (component.spread > 0) {
        side = winding.side(query, static_cast<double>(component.spread));
      } else {
        side = winding.is_inside(query);
      }
      sides[roots[i]] = !side ? Side::varies : *side ? Side::inside : Side::outside;
    }
  });
  return sides;
}

void write_block(const Components& components, const std::vector<Side>& sides, std::size_t block, SignWriter& writer) {
  const Corner first = components.blocks().first(block);
  const Corner last = components.blocks().last(block);
  if (components.is_whole(block)) {
    const Side side = sides[components.root(block, 0)];
    if (side == Side::inside) writer.negate_box(first, last);
    if (side == Side::varies) writer.ask_box(first, last);
    return;
  }
  writer.for_each_node(first, last, [&](std::size_t node, const Corner& at) {
    const auto place = static_cast<std::size_t>(at[0] - first[0] + 8 * (at[1] - first[1]) + 64 * (at[2] - first[2]));
    const Side side = sides[components.root(block, place)];
    if (side == Side::inside) writer.negate(node);
    if (side == Side::varies) writer.ask_node(node, at);
  });
}

}  // namespace

WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const WindingNumber& winding,
                                     const Context& context) {
  // Covers the errors of two distances, each at most 1e-6 of the diagonal, and the rounding of their sum.
  const double slack = 4e-6 * common_diagonal(mesh, field.grid);
  const Components components(field, winding, slack, context);
  const std::vector<Side> sides = ask_components(components, winding, field.grid, context);
  std::atomic<std::size_t> queries{components.roots().size()};
  parallel_for(context, components.blocks().count(), blocks_per_range, "", [&](const WorkRange& range) {
    SignWriter writer(field, winding, slack);
    for (std::size_t block = range.begin; block < range.end; ++block) write_block(components, sides, block, writer);
    queries += writer.queries();
  });
  return {queries, components.roots().size()};
}

WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const SiteTable& sites,
                                     const Context& context) {
  const WindingNumber winding(mesh, sites, context);
  return apply_winding_sign(field, mesh, winding, context);
}

}  // namespace blum
