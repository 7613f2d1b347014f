// Blum: cells of points and their division. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "field/cpu/point_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// Cells with at most this many points are not divided.
inline constexpr std::size_t points_per_leaf = 64;

/// Returns true if a cell's children may be given to the kernel, which divides each cell at least once. Children of the
/// last level cannot be divided, because their points are not sorted further.
[[nodiscard]] inline bool has_divisible_children(const PointCell& cell) {
  return cell.level + 1 < MortonPoints::levels;
}

/// Returns the eight children of a cell, of which some have no points. Bit a of their number is set for the upper half
/// along axis a.
/// @param cell  not of the last level.
[[nodiscard]] std::array<PointCell, 8> children_of(const MortonPoints& points, const PointCell& cell);

struct PointScratch::Impl {
  TileScratch tile;
  /// Data of a cell with children: which candidates go to which child, candidates prepared for leaves, and the list of
  /// the current child.
  struct Level {
    std::array<ChildBits, kind_count> bits;
    std::array<LeafColumns, 3> leaf;
    Candidates child;
  };
  std::array<Level, MortonPoints::levels + 1> levels;
};

}  // namespace blum::cpu
