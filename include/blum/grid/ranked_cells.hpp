// Blum: numbered sets of cells. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/grid/cell_lattice.hpp"

namespace blum {

/// Set of cells of a lattice. The cells in the set are numbered 0, 1, 2, ... in rising order. Memory: two bytes per
/// node.
class RankedCells {
 public:
  RankedCells() = default;
  explicit RankedCells(const CellLattice& lattice) : words_(lattice.node_count() / 8 + 1) {}

  void insert(Cell cell) { words_[cell >> 6U].bits |= bit(cell); }
  /// Numbers the cells of the set. No cell may be inserted afterwards.
  void finish() {
    std::uint32_t count = 0;
    for (Word& word : words_) {
      word.before = count;
      count += static_cast<std::uint32_t>(std::popcount(word.bits));
    }
    count_ = count;
  }

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool contains(Cell cell) const { return (words_[cell >> 6U].bits & bit(cell)) != 0; }
  /// Returns the number of a cell. The cell must be in the set.
  [[nodiscard]] std::uint32_t number(Cell cell) const {
    const Word& word = words_[cell >> 6U];
    return word.before + static_cast<std::uint32_t>(std::popcount(word.bits & (bit(cell) - 1)));
  }
  /// Returns all cells of the set in rising order. A cell's number is its index in this list.
  [[nodiscard]] std::vector<Cell> cells() const {
    std::vector<Cell> out;
    out.reserve(count_);
    for (std::size_t w = 0; w < words_.size(); ++w) {
      for (std::uint64_t rest = words_[w].bits; rest != 0; rest &= rest - 1) {
        out.push_back(static_cast<Cell>(64 * w + static_cast<std::size_t>(std::countr_zero(rest))));
      }
    }
    return out;
  }

 private:
  struct Word {
    std::uint64_t bits = 0;
    std::uint32_t before = 0;
  };
  static std::uint64_t bit(Cell cell) { return std::uint64_t{1} << (cell & 63U); }

  std::vector<Word> words_;
  std::size_t count_ = 0;
};

}  // namespace blum
