#include "solid/clean/triangle_boxes.hpp"

#include "blum/geometry/space_order.hpp"

namespace blum::detail {

TriangleBoxes::TriangleBoxes(std::span<const Box3> boxes, const Context& context) : leaf_of_(boxes.size()) {
  std::vector<std::uint32_t> there;
  for (std::uint32_t k = 0; k < boxes.size(); ++k) {
    if (!boxes[k].is_empty()) there.push_back(k);
  }
  at_leaf_ = space_order(there.size(), [&](std::size_t k) { return boxes[there[k]].center(); }, context);
  while (leaves_ < there.size()) leaves_ *= 2;
  nodes_.resize(2 * leaves_);
  for (std::uint32_t leaf = 0; leaf < at_leaf_.size(); ++leaf) {
    at_leaf_[leaf] = there[at_leaf_[leaf]];
    leaf_of_[at_leaf_[leaf]] = leaf;
    nodes_[leaves_ + leaf] = boxes[at_leaf_[leaf]];
  }
  for (std::size_t node = leaves_ - 1; node > 0; --node) {
    nodes_[node] = nodes_[2 * node];
    nodes_[node].extend(nodes_[2 * node + 1]);
  }
}

void TriangleBoxes::replace(std::uint32_t index, const Box3& box) {
  std::size_t node = leaves_ + leaf_of_[index];
  nodes_[node] = box;
  for (node /= 2; node > 0; node /= 2) {
    Box3 around = nodes_[2 * node];
    around.extend(nodes_[2 * node + 1]);
    if (around.lower == nodes_[node].lower && around.upper == nodes_[node].upper) return;
    nodes_[node] = around;
  }
}

}  // namespace blum::detail
