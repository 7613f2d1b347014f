// Blum: ranks of integer matrices, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace blum::verifier {

/// The entries of a matrix row that are not 0, as pairs (column, value) in ascending order of columns.
using SparseRow = std::vector<std::pair<std::uint32_t, std::int64_t>>;

/// Sorts entries by column, adds those of the same column, and removes zeros.
void tidy(SparseRow& row);

/// Elimination of rows over the integers, or modulo 2. Each row is reduced by all earlier pivots. Pivot entries are 1
/// or -1, so rows are never multiplied by other numbers. So the pivot rows are a basis of a direct summand of the same
/// rank.
class Elimination {
 public:
  enum class Over : std::uint8_t { integers, two };

  /// @param pivot_columns  pivots are chosen only in columns below this; other columns are only carried along.
  /// @param most_steps     number of entries that may be processed before the elimination gives up.
  Elimination(Over over, std::size_t pivot_columns, std::size_t most_steps)
      : over_(over), order_(pivot_columns, none), most_steps_(most_steps) {}

  /// Reduces a row. If it then has an entry of 1 or -1 below `pivot_columns`, it becomes a pivot row. If it has no
  /// entries there, it is kept in left().
  void add(SparseRow row);

  [[nodiscard]] std::size_t rank() const { return pivots_.size(); }
  /// Returns true if every row became a pivot row or was fully reduced. Over the integers, a row may have neither 1 nor
  /// -1 as an entry.
  [[nodiscard]] bool is_complete() { return !gave_up_ && retry(); }
  [[nodiscard]] const std::vector<SparseRow>& left() const { return left_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  void reduce(SparseRow& row);
  /// Returns false for a row that has entries in pivot columns, but no pivot.
  bool take(SparseRow& row);
  bool retry();

  Over over_;
  std::vector<std::uint32_t> order_;  ///< for each column: index of its pivot row
  std::vector<SparseRow> pivots_;
  std::vector<std::uint32_t> column_of_;  ///< for each pivot row: its column
  std::vector<SparseRow> left_, aside_;
  std::size_t most_steps_, steps_ = 0;
  bool gave_up_ = false;
};

/// Returns the rank modulo 2. Cost: rows^2 * columns / 64.
[[nodiscard]] std::size_t rank_modulo_2(const std::vector<SparseRow>& rows, std::size_t columns);

}  // namespace blum::verifier
