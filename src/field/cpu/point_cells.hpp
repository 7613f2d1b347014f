// Blum: cells of points and their division. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

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

struct PointScratch::Impl {
  TileScratch tile;
  /// Working data of a cell with children. It consists of bits that assign candidates to children, candidates prepared
  /// for leaves, and the list of the current child.
  struct Level {
    std::array<ChildBits, kind_count> bits;
    std::array<LeafColumns, 3> leaf;
    Candidates child;
  };
  std::array<Level, morton_levels + 1> levels;
};

}  // namespace blum::cpu
