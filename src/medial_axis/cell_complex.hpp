// Blum: cubical complexes on the lattice of a voxel image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

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
