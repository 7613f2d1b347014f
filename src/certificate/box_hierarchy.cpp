#include "certificate/box_hierarchy.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/parallel.hpp"

namespace blum::verifier {
namespace {

constexpr std::uint32_t most_per_leaf = 2;
/// Nodes of a level are shared out in so many ranges.
constexpr std::size_t most_ranges = 64;

}  // namespace

BoxHierarchy::BoxHierarchy(const std::vector<Box3>& boxes, const Context& context) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  order_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) order_[k] = k;
  if (count == 0) return;
  nodes_.push_back({{}, 0, count});
  for (std::size_t begin = 0; begin < nodes_.size();) {
    const std::size_t end = nodes_.size();
    parallel_for(context, end - begin, (end - begin) / most_ranges + 1, {}, [&](const WorkRange& range) {
      for (std::size_t n = begin + range.begin; n < begin + range.end; ++n) sort_halves(nodes_[n], boxes);
    });
    for (std::size_t n = begin; n < end; ++n) {
      const auto [box, first, size] = nodes_[n];
      if (size <= most_per_leaf) continue;
      nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
      nodes_[n].count = 0;
      nodes_.push_back({{}, first, size / 2});
      nodes_.push_back({{}, first + size / 2, size - size / 2});
    }
    begin = end;
  }
  pairs_.resize(nodes_.size() / 2);
  for (std::uint32_t n = 1; n < nodes_.size(); ++n) pairs_[pair_of(n)].set(place_in_pair(n), nodes_[n].box);
}

/// Finds the box of a node, and puts things of the lower half of its longest side first.
void BoxHierarchy::sort_halves(Node& node, const std::vector<Box3>& boxes) {
  Box3 middles;
  for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
    node.box.extend(boxes[order_[k]]);
    middles.extend(boxes[order_[k]].center());
  }
  if (node.count <= most_per_leaf) return;
  const Vec3d extent = middles.size();
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto begin = order_.begin() + node.first;
  std::nth_element(begin, begin + node.count / 2, begin + node.count, [&](std::uint32_t a, std::uint32_t b) {
    const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
    const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
    return at_a != at_b ? at_a < at_b : a < b;
  });
}

std::vector<BoxHierarchy::Places> BoxHierarchy::places() const {
  std::vector<Places> all(nodes_.size());
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children come after their parents
    const Node& node = nodes_[n];
    all[n] = node.count > 0 ? Places(node.first, node.first + node.count)
                            : Places(all[node.first].first, all[node.first + 1].second);
  }
  return all;
}

std::vector<double> BoxHierarchy::node_maxima(std::span<const double> values) const {
  std::vector<double> largest(nodes_.size(), -HUGE_VAL);
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children come after their parents
    const Node& node = nodes_[n];
    for (std::uint32_t k = 0; k < node.count; ++k) largest[n] = std::max(largest[n], values[node.first + k]);
    if (node.count == 0) largest[n] = std::max(largest[node.first], largest[node.first + 1]);
  }
  return largest;
}

}  // namespace blum::verifier
