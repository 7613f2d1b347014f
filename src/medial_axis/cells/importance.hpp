// Blum: importance of each cell of a solid as a piece of its medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/bits.hpp"
#include "medial_axis/cells/cell_complex.hpp"

namespace blum::detail {

/// Importance of each cell: degrees for some cells, 0 for the others. Memory: 1.5 bytes per lattice node, and 4 bytes
/// for each cell that has a value or is extra.
class Importance {
 public:
  struct Entry {
    Cell cell;
    float degrees;
  };

  Importance() = default;
  /// Assigns to each cell the largest value of all entries for the cell itself or for a cell that has it in its border.
  Importance(const CellStructure& structure, std::span<const Entry> entries);
  Importance(const CellLattice& lattice, std::span<const Entry> entries)
      : Importance(CellStructure(lattice, nullptr), entries) {}

  [[nodiscard]] float of(Cell cell) const {
    if (words_.empty()) return 0;
    if (cell >= first_extra_) return extra_.empty() ? 0 : extra_[cell - first_extra_];
    return (words_[cell >> 6U] >> (cell & 63U) & 1U) == 0 ? 0 : values_[rank(cell)];
  }
  /// Returns bits: bit a is set if the cell that spans axes `a` from the node has a value.
  [[nodiscard]] std::uint8_t cells_at(std::size_t node) const {
    return static_cast<std::uint8_t>(words_[node >> 3U] >> (8 * (node & 7U)));
  }
  [[nodiscard]] std::size_t count() const { return values_.size(); }

 private:
  /// Returns the number of cells with a value that precede a cell of the lattice.
  [[nodiscard]] std::size_t rank(Cell cell) const {
    const std::uint64_t below = words_[cell >> 6U] & ((std::uint64_t{1} << (cell & 63U)) - 1);
    return first_[cell >> 6U] + bit_count(below);
  }

  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> first_;  ///< number of values before each word
  std::vector<float> values_;
  Cell first_extra_ = 0;
  std::vector<float> extra_;
};

}  // namespace blum::detail
