#include "certificate/box_hierarchy.hpp"

#include <algorithm>
#include <cmath>

namespace blum::verifier {
namespace {

constexpr std::uint32_t most_per_leaf = 4;
/// Sorting fewer things than this takes no time that a caller who wants to stop would notice.
constexpr std::uint32_t few = 4096;

}  // namespace

BoxHierarchy::BoxHierarchy(const std::vector<Box3>& boxes, const Context& context) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  order_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) order_[k] = k;
  if (count == 0) return;
  nodes_.push_back({{}, 0, count});
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first;
    const std::uint32_t size = nodes_[n].count;
    if (size > few || n % few == 0) throw_if_cancelled(context);
    Box3 middles;
    for (std::uint32_t k = first; k < first + size; ++k) {
      nodes_[n].box.extend(boxes[order_[k]]);
      middles.extend(boxes[order_[k]].center());
    }
    if (size <= most_per_leaf) continue;
    const Vec3d extent = middles.size();
    const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const std::uint32_t half = size / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + size, [&](std::uint32_t a, std::uint32_t b) {
      const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
      const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
      return at_a != at_b ? at_a < at_b : a < b;
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, first, half});
    nodes_.push_back({{}, first + half, size - half});
  }
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
