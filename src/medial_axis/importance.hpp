// Blum: how much each cell of a solid looks like a piece of its medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "medial_axis/cell_complex.hpp"

namespace blum {

/// Degrees for some cells of a lattice, and 0 for the others. One byte per node, and 4 more per cell that has a value.
class Importance {
 public:
  struct Entry {
    Cell cell;
    float degrees;
  };

  Importance() = default;
  /// @param entries  by rising cell, each once.
  Importance(std::size_t node_count, std::span<const Entry> entries);

  [[nodiscard]] float of(Cell cell) const {
    if (words_.empty()) return 0;
    const std::uint64_t word = words_[cell >> 6U];
    const unsigned bit = cell & 63U;
    if ((word >> bit & 1U) == 0) return 0;
    const std::uint64_t below = word & ((std::uint64_t{1} << bit) - 1);
    return values_[first_[cell >> 6U] + static_cast<std::size_t>(std::popcount(below))];
  }
  [[nodiscard]] std::size_t count() const { return values_.size(); }

 private:
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> first_;  ///< values before each word
  std::vector<float> values_;
};

}  // namespace blum
