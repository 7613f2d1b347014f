// Blum: cubical complexes on the lattice of a voxel image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// A vertex, edge, square or cube of the lattice: 8 * node + axes. It spans one step from its node along each axis
/// whose bit is set in `axes` (x 1, y 2, z 4).
using Cell = std::uint32_t;
using CellAxes = unsigned;

inline CellAxes axes_of(Cell cell) {
  return cell & 7U;
}
inline std::size_t node_of(Cell cell) {
  return cell >> 3U;
}
inline Cell cell_at(std::size_t node, CellAxes axes) {
  return static_cast<Cell>(node << 3U | axes);
}
inline int dimension_of(Cell cell) {
  return std::popcount(axes_of(cell));
}

/// The lattice around the voxels of a box: node (i, j, k) is the corner that voxel (i, j, k) has in common with
/// (i - 1, j - 1, k - 1), and cell (node, all axes) is voxel (i, j, k).
class CellLattice {
 public:
  CellLattice() = default;
  /// @throws InvalidImage for more cells than 32 bits count (boxes above 811^3 voxels).
  explicit CellLattice(const std::array<std::int64_t, 3>& voxels);

  [[nodiscard]] std::size_t node_count() const { return count_; }
  [[nodiscard]] std::size_t node(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((k * size_[1] + j) * size_[0] + i);
  }
  [[nodiscard]] std::array<std::int64_t, 3> place(std::size_t node) const {
    const auto n = static_cast<std::int64_t>(node);
    return {n % size_[0], n / size_[0] % size_[1], n / (size_[0] * size_[1])};
  }
  /// From a node to the next along an axis.
  [[nodiscard]] std::size_t stride(std::size_t axis) const { return stride_[axis]; }
  [[nodiscard]] const std::array<std::int64_t, 3>& size() const { return size_; }

  /// Calls visit(face) for the cells of one dimension less in a cell's border.
  template <class Visit>
  void for_each_face(Cell cell, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CellAxes bit = 1U << axis;
      if ((cell & bit) == 0) continue;
      visit(cell ^ bit);
      visit(static_cast<Cell>((cell ^ bit) + 8 * stride_[axis]));
    }
  }
  /// Calls visit(coface) for the cells of one dimension more around a cell; none may lie beyond the lattice.
  template <class Visit>
  void for_each_coface(Cell cell, const Visit& visit) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CellAxes bit = 1U << axis;
      if ((cell & bit) != 0) continue;
      visit(cell | bit);
      visit(static_cast<Cell>((cell | bit) - 8 * stride_[axis]));
    }
  }

 private:
  std::array<std::int64_t, 3> size_{0, 0, 0};  ///< nodes
  std::array<std::size_t, 3> stride_{0, 0, 0};
  std::size_t count_ = 0;
};

/// A set of cells that holds the faces of each of its cells. One byte per lattice node.
class CellComplex {
 public:
  CellComplex() = default;
  /// The union of the closed voxels of a set, none of which may lie in the outermost layer of its box.
  CellComplex(const VoxelSet& voxels, const Context& context);

  [[nodiscard]] CellComplex clone() const {
    CellComplex copy;
    copy.lattice_ = lattice_;
    copy.cells_ = cells_.clone();
    return copy;
  }
  [[nodiscard]] const CellLattice& lattice() const { return lattice_; }
  [[nodiscard]] bool contains(Cell cell) const { return (cells_[node_of(cell)] >> axes_of(cell) & 1U) != 0; }
  void erase(Cell cell) { cells_[node_of(cell)] &= static_cast<std::uint8_t>(~(1U << axes_of(cell))); }
  /// Bit a of byte n: whether cell (n, axes a) is in the complex.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return cells_.span(); }
  /// The only coface of a cell; the cell itself where there is none, or more than one.
  [[nodiscard]] Cell only_coface(Cell cell) const {
    Cell found = cell;
    int count = 0;
    lattice_.for_each_coface(cell, [&](Cell coface) {
      if (!contains(coface)) return;
      found = coface;
      ++count;
    });
    return count == 1 ? found : cell;
  }

 private:
  CellLattice lattice_;
  Buffer<std::uint8_t> cells_;
};

}  // namespace blum
