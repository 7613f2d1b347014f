// Blum: complexes of voxels, and of cells beside them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "blum/grid/ranked_cells.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/solid/body_cells.hpp"

namespace blum::detail {

/// The faces and cofaces of the extra cells of a model (see BodyCells), and those that cells of the voxels have among
/// the extra ones. An extra cell is named by `first()` and its number.
class ExtraIncidence {
 public:
  explicit ExtraIncidence(BodyCells cells);

  [[nodiscard]] Cell first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] const ExtraCell& cell(Cell extra) const { return cells_[extra - first_]; }
  [[nodiscard]] std::span<const Cell> faces_of(Cell extra) const { return faces_[extra - first_]; }
  [[nodiscard]] std::span<const Cell> cofaces_of(Cell extra) const { return cofaces_[extra - first_]; }

  /// Whether a cell of the voxels has a face or coface that is extra.
  [[nodiscard]] bool is_mixed(Cell cell) const { return mixed_.contains(cell); }
  /// All of these, rising.
  [[nodiscard]] std::vector<Cell> mixed() const { return mixed_.cells(); }
  /// The extra ones of a mixed cell.
  [[nodiscard]] std::span<const Cell> extra_faces_of(Cell mixed) const { return faces_of_mixed_[mixed_.number(mixed)]; }
  [[nodiscard]] std::span<const Cell> extra_cofaces_of(Cell mixed) const {
    return cofaces_of_mixed_[mixed_.number(mixed)];
  }
  /// Cells of the voxels that are none of the model, rising.
  [[nodiscard]] std::span<const Cell> replaced() const { return replaced_; }
  [[nodiscard]] bool is_replaced(Cell cell) const {
    return std::binary_search(replaced_.begin(), replaced_.end(), cell);
  }

 private:
  Cell first_ = 0;
  std::vector<ExtraCell> cells_;
  IndexRows faces_;
  IndexRows cofaces_;
  RankedCells mixed_;
  IndexRows faces_of_mixed_;
  IndexRows cofaces_of_mixed_;
  std::vector<Cell> replaced_;
};

/// How the cells of a lattice, and extra ones where a model has any, touch each other.
class CellStructure {
 public:
  CellStructure() = default;
  /// @param extra  may be null.
  CellStructure(const CellLattice& lattice, std::shared_ptr<const ExtraIncidence> extra)
      : lattice_(lattice), extra_(std::move(extra)) {}

  [[nodiscard]] const CellLattice& lattice() const { return lattice_; }
  /// Null where there are none.
  [[nodiscard]] const ExtraIncidence* extra() const { return extra_.get(); }
  [[nodiscard]] std::size_t extra_count() const { return extra_ ? extra_->size() : 0; }
  /// The first extra cell.
  [[nodiscard]] Cell first_extra() const { return static_cast<Cell>(8 * lattice_.node_count()); }
  [[nodiscard]] bool is_extra(Cell cell) const { return extra_ && cell >= extra_->first(); }
  [[nodiscard]] int dimension(Cell cell) const {
    return is_extra(cell) ? extra_->cell(cell).dimension : dimension_of(cell);
  }

  /// Calls visit(face) for the cells of one dimension less in a cell's border. Of a cell of the lattice, all faces in
  /// the lattice are visited, also those that extra ones stand for, which no complex holds.
  template <class Visit>
  void for_each_face(Cell cell, const Visit& visit) const {
    if (is_extra(cell)) {
      for (const Cell face : extra_->faces_of(cell)) visit(face);
      return;
    }
    lattice_.for_each_face(cell, visit);
    if (!extra_ || !extra_->is_mixed(cell)) return;
    for (const Cell face : extra_->extra_faces_of(cell)) visit(face);
  }
  /// The same for the cells of one dimension more around a cell; none in the lattice may lie beyond it.
  template <class Visit>
  void for_each_coface(Cell cell, const Visit& visit) const {
    if (is_extra(cell)) {
      for (const Cell coface : extra_->cofaces_of(cell)) visit(coface);
      return;
    }
    lattice_.for_each_coface(cell, visit);
    if (!extra_ || !extra_->is_mixed(cell)) return;
    for (const Cell coface : extra_->extra_cofaces_of(cell)) visit(coface);
  }

 private:
  CellLattice lattice_;
  std::shared_ptr<const ExtraIncidence> extra_;
};

/// A set of cells that holds the faces of each of its cells. One byte per lattice node, and one per extra cell.
class CellComplex {
 public:
  CellComplex() = default;
  /// The union of the closed voxels of a set, none of which may lie in the outermost layer of its box.
  CellComplex(const VoxelSet& voxels, const Context& context);
  /// A whole model: voxels and all its extra cells.
  CellComplex(const VoxelSet& voxels, std::shared_ptr<const ExtraIncidence> extra, const Context& context);

  /// Voxels of a model, without any extra cells.
  CellComplex(const VoxelSet& voxels, CellStructure structure, const Context& context);

  [[nodiscard]] CellComplex clone() const {
    CellComplex copy;
    copy.structure_ = structure_;
    copy.cells_ = cells_.clone();
    copy.extra_ = extra_;
    return copy;
  }
  [[nodiscard]] const CellLattice& lattice() const { return structure_.lattice(); }
  [[nodiscard]] const CellStructure& structure() const { return structure_; }
  [[nodiscard]] bool contains(Cell cell) const {
    if (structure_.is_extra(cell)) return extra_[cell - structure_.first_extra()] != 0;
    return (cells_[node_of(cell)] >> axes_of(cell) & 1U) != 0;
  }
  void erase(Cell cell) {
    if (structure_.is_extra(cell)) {
      extra_[cell - structure_.first_extra()] = 0;
    } else {
      cells_[node_of(cell)] &= static_cast<std::uint8_t>(~(1U << axes_of(cell)));
    }
  }
  /// Adds a cell of the structure and all its faces. @param cell  none of the lattice that extra cells stand for.
  void insert_closure(Cell cell);
  /// Bit a of byte n: whether cell (n, axes a) is in the complex.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return cells_.span(); }
  /// Calls visit(cell) for all cells, those of the lattice first, rising.
  template <class Visit>
  void for_each_cell(const Visit& visit) const {
    for (std::size_t node = 0; node < cells_.size(); ++node) {
      for (unsigned rest = cells_[node]; rest != 0; rest &= rest - 1) {
        visit(cell_at(node, static_cast<CellAxes>(std::countr_zero(rest))));
      }
    }
    for (std::size_t k = 0; k < extra_.size(); ++k) {
      if (extra_[k] != 0) visit(structure_.first_extra() + static_cast<Cell>(k));
    }
  }
  /// The only coface of a cell; the cell itself where there is none, or more than one.
  [[nodiscard]] Cell only_coface(Cell cell) const {
    Cell found = cell;
    int count = 0;
    structure_.for_each_coface(cell, [&](Cell coface) {
      if (!contains(coface)) return;
      found = coface;
      ++count;
    });
    return count == 1 ? found : cell;
  }

 private:
  CellStructure structure_;
  Buffer<std::uint8_t> cells_;
  std::vector<std::uint8_t> extra_;  ///< 1 where it is in the complex
};

}  // namespace blum::detail
