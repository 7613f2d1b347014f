// Blum: which cells touch those that are no cells of the voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "blum/grid/ranked_cells.hpp"
#include "blum/solid/body_cells.hpp"

namespace blum {

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

}  // namespace blum
