// Blum: ranks of integer matrices, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace blum::verifier {

/// The entries of a row of a matrix that are not 0, columns rising.
using SparseRow = std::vector<std::pair<std::uint32_t, std::int64_t>>;

/// Sorts entries by their columns, and adds those of the same one.
void tidy(SparseRow& row);

/// Rows over the integers, or modulo 2, freed of the pivots of those before. Pivots are 1 or -1, so that rows are never
/// multiplied: as many rows as there are pivots span a direct summand of rank as high, and are a basis of it.
class Elimination {
 public:
  enum class Over : std::uint8_t { integers, two };

  /// @param pivot_columns  columns from here on are carried along.
  /// @param most_steps  entries that may be looked at before it gives up.
  Elimination(Over over, std::size_t pivot_columns, std::size_t most_steps)
      : over_(over), order_(pivot_columns, none), most_steps_(most_steps) {}

  /// Reduces a row; what is left below `pivot_columns` becomes a pivot. Rows without any there are kept in left().
  void add(SparseRow row);

  [[nodiscard]] std::size_t rank() const { return pivots_.size(); }
  /// Whether every row is a pivot or left: over the integers, a row may have neither 1 nor -1.
  [[nodiscard]] bool is_complete() { return !gave_up_ && retry(); }
  [[nodiscard]] const std::vector<SparseRow>& left() const { return left_; }

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  void reduce(SparseRow& row);
  /// False for a row that has entries in pivot columns, but no pivot.
  bool take(SparseRow& row);
  bool retry();

  Over over_;
  std::vector<std::uint32_t> order_;  ///< of each column: the pivot that it is
  std::vector<SparseRow> pivots_;
  std::vector<std::uint32_t> column_of_;  ///< of each pivot
  std::vector<SparseRow> left_, aside_;
  std::size_t most_steps_, steps_ = 0;
  bool gave_up_ = false;
};

/// The rank modulo 2. Cost: rows^2 columns / 64.
[[nodiscard]] std::size_t rank_modulo_2(const std::vector<SparseRow>& rows, std::size_t columns);

}  // namespace blum::verifier
