// Blum: cells of points and their division. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "field/cpu/point_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// Cells with at most this many points are not divided further.
inline constexpr std::size_t points_per_leaf = 96;

/// Returns true if the children of a cell may be passed to the kernel. The kernel divides each cell at least once.
/// Cells of the last level cannot be divided, because their points are not sorted further.
[[nodiscard]] inline bool has_divisible_children(const PointCell& cell) {
  return cell.level + 1 < morton_levels;
}

/// Returns the eight children of a cell. Some may have no points. Bit a of a child's index is set for the upper half
/// along axis a.
/// @param cell  must not be of the last level.
[[nodiscard]] std::array<PointCell, 8> children_of(MortonOrder order, const PointCell& cell);

/// Indices of records of one kind that may be closest somewhere in a cell. After finish(), whole vectors may be read
/// past the end: all entries are valid indices.
class RecordIndices {
 public:
  static constexpr std::size_t padding = 16;

  /// Empties the list and makes room for `capacity` indices.
  void reset(std::size_t capacity) {
    if (indices_.size() < capacity + padding) indices_ = Buffer<std::uint32_t>(capacity + capacity / 2 + 4 * padding);
    count_ = 0;
  }
  /// Returns where the next indices are written; grow() must follow.
  [[nodiscard]] std::uint32_t* end() { return indices_.data() + count_; }
  void grow(std::size_t count) { count_ += count; }
  void restart() { count_ = 0; }
  void finish() { std::fill_n(end(), padding, 0U); }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const std::uint32_t* data() const { return indices_.data(); }

 private:
  Buffer<std::uint32_t> indices_;
  std::size_t count_ = 0;
};

/// Records that may be closest somewhere in a cell: vertices, edges and faces. Slivers are copied, because they are
/// rare.
struct PointCandidates {
  std::array<RecordIndices, sliver_kind> of_kind;
  RecordList slivers;

  /// Returns the number of candidates without slivers.
  [[nodiscard]] std::size_t listed() const { return of_kind[0].count() + of_kind[1].count() + of_kind[2].count(); }
  [[nodiscard]] std::size_t count() const { return listed() + slivers.count(); }
};

struct PointScratch::Impl {
  TileScratch tile;
  PointCandidates found;
  /// Candidates of the children of the current cell, for each level of the recursion.
  struct Level {
    std::array<PointCandidates, 8> child;
  };
  std::array<Level, morton_levels + 1> levels;
  std::vector<std::uint32_t> sites;  ///< of the candidates of the current leaf
};

}  // namespace blum::cpu
