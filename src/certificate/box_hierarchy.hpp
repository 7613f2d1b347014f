// Blum: a tree of boxes, for the verifier of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/vec3.hpp"

namespace blum::verifier {

/// Returns the squared distance of a point from a box; 0 inside.
[[nodiscard]] inline double squared_distance(const Vec3d& p, const Box3& box) {
  const Vec3d outside = max(max(box.lower - p, p - box.upper), Vec3d{0, 0, 0});
  return squared_length(outside);
}

/// A number for each of two siblings in a tree.
using Two = std::array<double, 2>;

/// Two boxes stored side by side, so that the compiler vectorizes operations on both.
struct TwoBoxes {
  std::array<Two, 3> lower{}, upper{};

  void set(std::size_t k, const Box3& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis][k] = box.lower[axis];
      upper[axis][k] = box.upper[axis];
    }
  }
};

/// Returns the squared distances of a point from two boxes, or of two points from one box each; 0 inside.
[[nodiscard]] inline Two squared_distances(const std::array<Two, 3>& p, const TwoBoxes& boxes) {
  Two sum{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double below = boxes.lower[axis][k] - p[axis][k];
      const double above = p[axis][k] - boxes.upper[axis][k];
      const double outside = below < above ? above : below;
      const double least = outside < 0 ? 0 : outside;
      sum[k] += least * least;
    }
  }
  return sum;
}
[[nodiscard]] inline Two squared_distances(const Vec3d& p, const TwoBoxes& boxes) {
  return squared_distances({{{p.x, p.x}, {p.y, p.y}, {p.z, p.z}}}, boxes);
}

/// A binary tree over the boxes of items. Nodes are halved at the median until few items are left. The tree stores only
/// boxes and indices of the items.
class BoxHierarchy {
 public:
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  ///< index of its first item in order(), or of its first child; the second follows
    std::uint32_t count = 0;  ///< number of its items; 0 if it has children
  };

  BoxHierarchy() = default;
  /// @throws Cancelled. Cost: O(n log n).
  explicit BoxHierarchy(const std::vector<Box3>& boxes, const Context& context = {});

  /// Returns the indices of the items, leaf by leaf.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  [[nodiscard]] const Node& node(std::uint32_t index) const { return nodes_[index]; }
  /// Returns the index of the pair of siblings that contains a node. The root belongs to no pair.
  [[nodiscard]] static constexpr std::size_t pair_of(std::size_t node) { return (node - 1) / 2; }
  /// Returns which node of its pair a node is: 0 or 1.
  [[nodiscard]] static constexpr std::size_t place_in_pair(std::size_t node) { return (node - 1) % 2; }
  /// Returns the boxes of a first child and its sibling.
  [[nodiscard]] const TwoBoxes& two_boxes(std::uint32_t first_child) const { return pairs_[pair_of(first_child)]; }

  /// For each node: the range of all items below it in order(), from the first to one past the last.
  using Places = std::pair<std::uint32_t, std::uint32_t>;
  [[nodiscard]] std::vector<Places> places() const;

  /// Returns for each node the largest value of the items below it. `values` are in the order of order().
  [[nodiscard]] std::vector<double> node_maxima(std::span<const double> values) const;

  /// Searches the nodes whose bound is below the best value so far, nodes of lower bound first. For each item at index
  /// k in order(), it calls best = visit(k). bounds(first child) returns the bounds of that child and its sibling. The
  /// root is always searched.
  template <class Bounds, class Visit>
  void search(double best, const Bounds& bounds, const Visit& visit) const {
    if (nodes_.empty()) return;
    struct Item {
      double least;
      std::uint32_t node;
    };
    InlineList<Item, 64> stack;  // one more item per level; each level halves the items
    stack.push_back({-HUGE_VAL, 0});
    while (!stack.empty()) {
      const auto [least, index] = stack.pop_back();
      if (!(least < best)) continue;
      const Node& node = nodes_[index];
      for (std::uint32_t k = 0; k < node.count; ++k) best = visit(node.first + k);
      if (node.count > 0) continue;
      const Two both = bounds(node.first);
      Item near{both[0], node.first};
      Item far{both[1], node.first + 1};
      if (far.least < near.least) std::swap(near, far);
      if (far.least < best) stack.push_back(far);
      if (near.least < best) stack.push_back(near);
    }
  }

  /// Calls visit(k) for the items, by index in order(), of all nodes for whose boxes may_meet(box) returns true. The
  /// search stops when visit() returns false. The root is always searched.
  template <class MayMeet, class Visit>
  void visit_where(const MayMeet& may_meet, const Visit& visit) const {
    const auto distance_to = [&](std::uint32_t n) { return may_meet(nodes_[n].box) ? 0.0 : 2.0; };
    search(
        1, [&](std::uint32_t first_child) { return Two{distance_to(first_child), distance_to(first_child + 1)}; },
        [&](std::uint32_t place) { return visit(place) ? 1.0 : -1.0; });
  }

 private:
  struct Thing {
    Vec3d middle;  ///< twice the centre of its box
    std::uint32_t index = 0;
  };
  static void sort_halves(const Node& node, std::vector<Thing>& things);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<TwoBoxes> pairs_;  ///< for each pair of siblings
};

}  // namespace blum::verifier
