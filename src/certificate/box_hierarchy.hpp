// Blum: boxes in a tree, for the verifier of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum::verifier {

/// Squared distance of a point from a box; 0 inside.
[[nodiscard]] inline double squared_distance(const Vec3d& p, const Box3& box) {
  const Vec3d outside = max(max(box.lower - p, p - box.upper), Vec3d{0, 0, 0});
  return squared_length(outside);
}

/// A binary tree over the boxes of things, halved at the median until few are left. It knows nothing of the things.
class BoxHierarchy {
 public:
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  ///< place in order() of its first thing, or its first child; the second one follows
    std::uint32_t count = 0;  ///< of its things; 0 where it has children
  };

  BoxHierarchy() = default;
  /// @throws Cancelled. Cost: O(n log n).
  explicit BoxHierarchy(const std::vector<Box3>& boxes, const Context& context = {});

  /// The things, those of one leaf beside each other.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] std::uint32_t node_count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  [[nodiscard]] const Node& node(std::uint32_t index) const { return nodes_[index]; }

  /// For each node the largest of the values of its things, given in the order of order().
  [[nodiscard]] std::vector<double> node_maxima(std::span<const double> values) const;

  /// Goes down into the nodes whose bound(node) is below the best value so far, the lower one first, and calls
  /// best = visit(place in order()) for their things.
  template <class Bound, class Visit>
  void search(double best, const Bound& bound, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::pair<double, std::uint32_t>, 64> stack;  // one more for each level, and levels halve
    std::size_t size = 0;
    stack[size++] = {bound(0), 0};
    while (size > 0) {
      const auto [least, index] = stack[--size];
      if (!(least < best)) continue;
      const Node& node = nodes_[index];
      for (std::uint32_t k = 0; k < node.count; ++k) best = visit(node.first + k);
      if (node.count > 0) continue;
      std::pair<double, std::uint32_t> near{bound(node.first), node.first};
      std::pair<double, std::uint32_t> far{bound(node.first + 1), node.first + 1};
      if (far.first < near.first) std::swap(near, far);
      if (far.first < best) stack[size++] = far;
      if (near.first < best) stack[size++] = near;
    }
  }

 private:
  void sort_halves(Node& node, const std::vector<Box3>& boxes);

  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace blum::verifier
