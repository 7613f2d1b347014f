#include "certificate/box_hierarchy.hpp"

#include <algorithm>
#include <cmath>

#include "blum/core/parallel.hpp"

namespace blum::verifier {
namespace {

constexpr std::uint32_t most_per_leaf = 2;
/// Largest number of ranges into which the nodes of a level are divided.
constexpr std::size_t most_ranges = 64;

}  // namespace

BoxHierarchy::BoxHierarchy(const std::vector<Box3>& boxes, const Context& context) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  if (count == 0) return;
  std::vector<Thing> things(count);
  for (std::uint32_t k = 0; k < count; ++k) things[k] = {boxes[k].lower + boxes[k].upper, k};
  nodes_.push_back({{}, 0, count});
  for (std::size_t begin = 0; begin < nodes_.size();) {
    const std::size_t end = nodes_.size();
    parallel_for(context, end - begin, (end - begin) / most_ranges + 1, {}, [&](const WorkRange& range) {
      for (std::size_t n = begin + range.begin; n < begin + range.end; ++n) sort_halves(nodes_[n], things);
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
  order_.reserve(count);
  for (const Thing& thing : things) order_.push_back(thing.index);
  for (std::size_t n = nodes_.size(); n-- > 0;) {  // children come after their parents
    Node& node = nodes_[n];
    for (std::uint32_t k = 0; k < node.count; ++k) node.box.extend(boxes[order_[node.first + k]]);
    if (node.count > 0) continue;
    node.box = nodes_[node.first].box;
    node.box.extend(nodes_[node.first + 1].box);
  }
  pairs_.resize(nodes_.size() / 2);
  for (std::uint32_t n = 1; n < nodes_.size(); ++n) pairs_[pair_of(n)].set(place_in_pair(n), nodes_[n].box);
}

/// Moves the lower half of a node's items, along its longest side, to the front.
void BoxHierarchy::sort_halves(const Node& node, std::vector<Thing>& things) {
  if (node.count <= most_per_leaf) return;
  const auto begin = things.begin() + node.first;
  Box3 middles;
  for (std::uint32_t k = 0; k < node.count; ++k) middles.extend(begin[k].middle);
  const Vec3d extent = middles.size();
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  std::nth_element(begin, begin + node.count / 2, begin + node.count, [axis](const Thing& a, const Thing& b) {
    return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis] : a.index < b.index;
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
