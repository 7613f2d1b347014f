// Blum: disjoint sets. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace blum::detail {

/// Disjoint sets of indices. The smallest index of a set represents it, so results do not depend on the order of joins.
class UnionFind {
 public:
  UnionFind() = default;
  explicit UnionFind(std::size_t count) { reset(count); }

  /// Makes `count` sets of one index each.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  [[nodiscard]] std::uint32_t find(std::uint32_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  /// Joins the sets of two indices. Returns true if they were different sets.
  bool join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
    return true;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace blum::detail
