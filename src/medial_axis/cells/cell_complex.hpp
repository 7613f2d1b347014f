// Blum: complexes of voxels and extra cells. SPDX-License-Identifier: Apache-2.0
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

/// Faces and cofaces of the extra cells of a model (see BodyCells). Also contains those faces and cofaces of lattice
/// cells that are extra cells. The number of an extra cell as a Cell is `first()` plus its index.
class ExtraIncidence {
 public:
  explicit ExtraIncidence(BodyCells cells);

  [[nodiscard]] Cell first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] const ExtraCell& cell(Cell extra) const { return cells_[extra - first_]; }
  [[nodiscard]] std::span<const Cell> faces_of(Cell extra) const { return faces_[extra - first_]; }
  [[nodiscard]] std::span<const Cell> cofaces_of(Cell extra) const { return cofaces_[extra - first_]; }

  /// Returns true if a lattice cell is mixed: if one of its faces or cofaces is an extra cell.
  [[nodiscard]] bool is_mixed(Cell cell) const { return mixed_.contains(cell); }
  /// Returns all mixed cells, ascending.
  [[nodiscard]] std::vector<Cell> mixed() const { return mixed_.cells(); }
  /// Returns the faces of a mixed cell that are extra cells.
  [[nodiscard]] std::span<const Cell> extra_faces_of(Cell mixed) const { return faces_of_mixed_[mixed_.number(mixed)]; }
  [[nodiscard]] std::span<const Cell> extra_cofaces_of(Cell mixed) const {
    return cofaces_of_mixed_[mixed_.number(mixed)];
  }
  /// Returns the lattice cells that extra cells replace, so that they are not part of the model; ascending.
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

/// Faces and cofaces of all cells of a lattice, and of the extra cells if the model has any.
class CellStructure {
 public:
  CellStructure() = default;
  /// @param extra  null if the model has no extra cells.
  CellStructure(const CellLattice& lattice, std::shared_ptr<const ExtraIncidence> extra)
      : lattice_(lattice), extra_(std::move(extra)) {}

  [[nodiscard]] const CellLattice& lattice() const { return lattice_; }
  /// Returns null if the model has no extra cells.
  [[nodiscard]] const ExtraIncidence* extra() const { return extra_.get(); }
  [[nodiscard]] std::size_t extra_count() const { return extra_ ? extra_->size() : 0; }
  /// Returns the number of the first extra cell.
  [[nodiscard]] Cell first_extra() const { return static_cast<Cell>(8 * lattice_.node_count()); }
  [[nodiscard]] bool is_extra(Cell cell) const { return extra_ && cell >= extra_->first(); }
  [[nodiscard]] int dimension(Cell cell) const {
    return is_extra(cell) ? extra_->cell(cell).dimension : dimension_of(cell);
  }

  /// Calls visit(face) for the cells of one dimension less in a cell's border. For a cell of the lattice, this includes
  /// faces that extra cells replace. No complex contains such replaced faces.
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
  /// Calls visit(coface) for the cells of one dimension more around a cell. If the cell is a cell of the lattice, all
  /// its cofaces must lie in the lattice.
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

/// Set of cells that contains the faces of each of its cells. Memory: one byte per lattice node and one per extra cell.
class CellComplex {
 public:
  CellComplex() = default;
  /// Makes the union of the closed voxels of a set. No voxel may lie in the outermost layer of the set's box.
  CellComplex(const VoxelSet& voxels, const Context& context);
  /// Makes the complex of a whole model: its voxels and all its extra cells.
  CellComplex(const VoxelSet& voxels, std::shared_ptr<const ExtraIncidence> extra, const Context& context);

  /// Makes the complex of the voxels of a model, without its extra cells and without the cells that these replace.
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
  /// Adds a cell of the structure and all its faces.
  /// @param cell  must not be a lattice cell that extra cells replace.
  void insert_closure(Cell cell);
  /// Returns one byte for each lattice node. Bit a of byte n is set if the cell that spans axes `a` from node n is in
  /// the complex.
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return cells_.span(); }
  /// Calls visit(cell) for all cells, ascending; cells of the lattice come first.
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
  /// Returns the only coface of a cell, or the cell itself if it has none or several.
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
  std::vector<std::uint8_t> extra_;  ///< per extra cell: 1 if in the complex
};

}  // namespace blum::detail
