// Blum: rows of indices in one array. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace blum {

/// Rows of indices, one row for each cell. All rows are stored in one array.
class IndexRows {
 public:
  IndexRows() = default;
  /// @param first  start of each row in `items`, and the end of the last row. Its size is the number of cells plus 1.
  IndexRows(std::vector<std::size_t> first, std::vector<std::uint32_t> items)
      : first_(std::move(first)), items_(std::move(items)) {}

  [[nodiscard]] std::size_t size() const { return first_.empty() ? 0 : first_.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t cell) const {
    return std::span(items_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> items_;
};

namespace detail {

/// Returns one row for each of `cell_count` cells. Row c contains the indices of the things that use cell c, in
/// ascending order. For example, the cells are vertices, and the things are the edges between them.
/// @param cells_of  cells_of(k) returns the cells that thing k uses, as a range.
template <class CellsOf>
[[nodiscard]] IndexRows rows_of(std::size_t thing_count, std::size_t cell_count, const CellsOf& cells_of) {
  std::vector<std::size_t> first(cell_count + 1, 0);
  for (std::size_t k = 0; k < thing_count; ++k) {
    for (const std::uint32_t cell : cells_of(k)) ++first[cell + std::size_t{1}];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> items(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < thing_count; ++k) {
    for (const std::uint32_t cell : cells_of(k)) items[next[cell]++] = static_cast<std::uint32_t>(k);
  }
  return {std::move(first), std::move(items)};
}

}  // namespace detail
}  // namespace blum
