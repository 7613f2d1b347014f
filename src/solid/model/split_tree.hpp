// Blum: finding the box that holds a point. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::detail {

struct BoxCell;

/// A tree of planes over boxes that fill a larger one, and come from cutting it again and again.
class SplitTree {
 public:
  SplitTree() = default;
  /// @param boxes  all boxes; the span must stay.  @param own  those that the tree is of, at least one.
  SplitTree(std::span<const BoxCell> boxes, std::vector<std::uint32_t> own);

  /// The box that may hold a point of the large box, moved down (false) or up along each axis by nearly nothing.
  /// Cost: the depth of the tree.
  [[nodiscard]] std::uint32_t find(const Vec3d& p, const std::array<bool, 3>& up) const;

 private:
  struct Node {
    std::size_t axis = 3;  ///< 3: a leaf
    double at = 0;
    std::uint32_t below = 0;  ///< node; of a leaf the box
    std::uint32_t above = 0;
  };

  std::vector<Node> nodes_;
};

}  // namespace blum::detail
