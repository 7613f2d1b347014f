// Blum: cells of points and how they divide. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "field/cpu/point_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// Cells with no more points than this are not divided.
inline constexpr std::size_t points_per_leaf = 64;

/// Whether a cell's children may be given to the kernel, which divides what it is given at least once: those of the
/// last level can't be divided, as their points are not sorted further.
[[nodiscard]] inline bool has_divisible_children(const PointCell& cell) {
  return cell.level + 1 < MortonPoints::levels;
}

/// The eight children of a cell, of which some have no points; bit a of their number is set for the upper half along
/// axis a. @param cell  not of the last level.
[[nodiscard]] std::array<PointCell, 8> children_of(const MortonPoints& points, const PointCell& cell);

struct PointScratch::Impl {
  TileScratch tile;
  /// Of a cell with children: which candidates go to which child, prepared for leaves, and the list of the child at
  /// hand.
  struct Level {
    std::array<ChildBits, kind_count> bits;
    std::array<LeafColumns, 3> leaf;
    Candidates child;
  };
  std::array<Level, MortonPoints::levels + 1> levels;
};

}  // namespace blum::cpu
