// Blum: boxes of triangles that change one by one, to find those near a place. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A binary tree over boxes in an order that keeps neighbours together. Boxes may be replaced: those above follow.
/// Cost of a change and of a question about a small place: the logarithm of their number.
class TriangleBoxes {
 public:
  /// @param boxes  an empty one for what is not there, and will not be. @throws Cancelled.
  TriangleBoxes(std::span<const Box3> boxes, const Context& context);

  void replace(std::uint32_t index, const Box3& box);

  /// Calls visit(index) for the boxes that touch a box, until it returns false. @return whether it never did.
  template <class Visit>
  bool for_each_touching(const Box3& box, const Visit& visit) const {
    std::size_t stack[most_depth];
    std::size_t size = 0;
    stack[size++] = 1;
    while (size > 0) {
      const std::size_t node = stack[--size];
      if (!touch(nodes_[node], box)) continue;
      if (node >= leaves_) {
        if (!visit(at_leaf_[node - leaves_])) return false;
        continue;
      }
      stack[size++] = 2 * node + 1;
      stack[size++] = 2 * node;
    }
    return true;
  }

 private:
  static constexpr std::size_t most_depth = 64;

  static bool touch(const Box3& a, const Box3& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
  }

  std::size_t leaves_ = 1;   ///< a power of two; node k has the children 2 k and 2 k + 1, leaves come last
  std::vector<Box3> nodes_;  ///< the first one is not used
  std::vector<std::uint32_t> at_leaf_;
  std::vector<std::uint32_t> leaf_of_;
};

}  // namespace blum::detail
