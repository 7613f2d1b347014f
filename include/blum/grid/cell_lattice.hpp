// Blum: the cells of a lattice of cubes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "blum/core/error.hpp"

namespace blum {

/// Cell of the lattice: a vertex, edge, square or cube. The number of a cell is 8 * node + axes. A cell extends one
/// step from its node along each axis whose bit is set in `axes` (x 1, y 2, z 4).
using Cell = std::uint32_t;
using CellAxes = unsigned;

constexpr CellAxes axes_of(Cell cell) {
  return cell & 7U;
}
constexpr std::size_t node_of(Cell cell) {
  return cell >> 3U;
}
constexpr Cell cell_at(std::size_t node, CellAxes axes) {
  return static_cast<Cell>(node << 3U | axes);
}
constexpr int dimension_of(Cell cell) {
  return std::popcount(axes_of(cell));
}

/// Returns the axis (0, 1, 2) of a bit (1, 2, 4).
constexpr std::size_t axis_of(CellAxes bit) {
  return static_cast<std::size_t>(std::countr_zero(bit));
}
/// Returns the axis at right angles to a square.
constexpr std::size_t normal_axis(Cell square) {
  return axis_of(7U ^ axes_of(square));
}

/// Lattice of the cubes of a box. Node (i, j, k) is the corner that the cubes (i, j, k) and (i - 1, j - 1, k - 1)
/// share. The cell of node (i, j, k) that extends along all three axes is cube (i, j, k). In the lattice of an image,
/// the cubes are the voxels.
class CellLattice {
 public:
  CellLattice() = default;
  /// @param cubes  numbers of cubes along x, y, z, each >= 0.
  /// @throws InvalidGrid if the numbers of cells need more than 32 bits (for boxes of more than 811^3 cubes).
  explicit CellLattice(const std::array<std::int64_t, 3>& cubes);

  [[nodiscard]] std::size_t node_count() const { return count_; }
  [[nodiscard]] std::size_t node(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i);
  }
  [[nodiscard]] std::array<std::int64_t, 3> place(std::size_t node) const {
    const auto n = static_cast<std::int64_t>(node);
    return {n % size_[0], n / size_[0] % size_[1], n / (size_[0] * size_[1])};
  }
  /// Returns the difference of the indices of neighbouring nodes along an axis.
  [[nodiscard]] std::size_t stride(std::size_t axis) const { return stride_[axis]; }
  [[nodiscard]] const std::array<std::int64_t, 3>& size() const { return size_; }

  /// Returns the cube below a square and the cube above it, along the square's normal axis. Both cubes must be in the
  /// lattice.
  [[nodiscard]] std::array<Cell, 2> cubes_beside(Cell square) const {
    const Cell above = square | 7U;
    return {static_cast<Cell>(above - 8 * stride_[normal_axis(square)]), above};
  }

  /// Calls visit(face) for each face of a given cell: a cell of one dimension less in its border.
  template <class Visit>
  void for_each_face(Cell cell, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CellAxes bit = 1U << axis;
      if ((cell & bit) == 0) continue;
      visit(cell ^ bit);
      visit(static_cast<Cell>((cell ^ bit) + 8 * stride_[axis]));
    }
  }
  /// Calls visit(coface) for each coface of a given cell. A coface is a cell of one dimension more, with the given cell
  /// in its border. All cofaces must be in the lattice.
  template <class Visit>
  void for_each_coface(Cell cell, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CellAxes bit = 1U << axis;
      if ((cell & bit) != 0) continue;
      visit(cell | bit);
      visit(static_cast<Cell>((cell | bit) - 8 * stride_[axis]));
    }
  }
  /// Calls visit(indices i, j, k) for each cube that contains a given cell, also for cubes outside of the lattice. A
  /// cube contains itself.
  template <class Visit>
  void for_each_cube_around(Cell cell, const Visit& visit) const {
    const std::array<std::int64_t, 3> at = place(node_of(cell));
    for (CellAxes behind = 0; behind < 8; ++behind) {
      if ((behind & axes_of(cell)) != 0) continue;
      visit(std::array<std::int64_t, 3>{at[0] - (behind & 1U), at[1] - (behind >> 1U & 1U), at[2] - (behind >> 2U)});
    }
  }

 private:
  std::array<std::int64_t, 3> size_{0, 0, 0};  ///< number of nodes along x, y, z
  std::array<std::size_t, 3> stride_{0, 0, 0};
  std::size_t count_ = 0;
};

}  // namespace blum
