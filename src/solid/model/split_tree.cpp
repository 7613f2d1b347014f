#include "solid/model/split_tree.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "solid/model/box_cells.hpp"

namespace blum::detail {
namespace {

/// How many of the boxes, sorted by where they begin along an axis, lie below a plane that cuts none; the plane nearest
/// to the middle of the list.
std::optional<std::size_t> cut_of(std::span<const BoxCell> boxes, std::span<const std::uint32_t> sorted,
                                  std::size_t axis) {
  std::optional<std::size_t> best;
  double reach = boxes[sorted[0]].high[axis];
  const auto from_middle = [&](std::size_t k) {
    return std::max(2 * k, sorted.size()) - std::min(2 * k, sorted.size());
  };
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    if (boxes[sorted[k]].low[axis] >= reach && (!best || from_middle(k) < from_middle(*best))) best = k;
    reach = std::max(reach, boxes[sorted[k]].high[axis]);
  }
  return best;
}

}  // namespace

SplitTree::SplitTree(std::span<const BoxCell> boxes, std::vector<std::uint32_t> own) {
  std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> waiting;
  nodes_.emplace_back();
  waiting.emplace_back(0, std::move(own));
  while (!waiting.empty()) {
    auto [node, list] = std::move(waiting.back());
    waiting.pop_back();
    nodes_[node].below = list.front();
    for (std::size_t axis = 0; axis < 3 && list.size() > 1; ++axis) {
      std::sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
        return boxes[a].low[axis] != boxes[b].low[axis] ? boxes[a].low[axis] < boxes[b].low[axis] : a < b;
      });
      const std::optional<std::size_t> cut = cut_of(boxes, list, axis);
      if (!cut) continue;
      const auto middle = list.begin() + static_cast<std::ptrdiff_t>(*cut);
      const auto below = static_cast<std::uint32_t>(nodes_.size());
      nodes_[node] = {axis, boxes[*middle].low[axis], below, below + 1};
      nodes_.resize(nodes_.size() + 2);
      waiting.emplace_back(below, std::vector(list.begin(), middle));
      waiting.emplace_back(below + 1, std::vector(middle, list.end()));
      break;
    }
  }
}

std::uint32_t SplitTree::find(const Vec3d& p, const std::array<bool, 3>& up) const {
  const Node* node = nodes_.data();
  while (node->axis < 3) {
    const double coordinate = p[node->axis];
    const bool is_above = up[node->axis] ? coordinate >= node->at : coordinate > node->at;
    node = &nodes_[is_above ? node->above : node->below];
  }
  return node->below;
}

}  // namespace blum::detail
