// Blum: voxels of a model that extra cells are attached to. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/cells/importance.hpp"

namespace blum::detail {

/// The voxels of a model whose neighbours do not tell what they share with the rest: where walls pass between voxels,
/// or extra cells are attached to them. Extra cells that are no faces of voxels stay while voxels go.
class AttachedVoxels {
 public:
  /// @param model  with all its voxels. It must stay.
  AttachedVoxels(const CellComplex& model, const VoxelSet& voxels, const Importance& importance);

  /// The voxels that are cells of the lattice: others are extra cells.
  [[nodiscard]] const VoxelSet& voxels() const { return plain_; }
  [[nodiscard]] bool contain(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return attached_.contains(i, j, k);
  }
  /// Whether a voxel can go by elementary collapses, and takes no cell of importance along.
  /// @param voxel  one of these.  @param around  the neighbours that are there.
  [[nodiscard]] bool may_go(std::uint32_t voxel, Neighbourhood around) const;

  /// What is left of the model: some of its voxels, and the extra cells that stay.
  [[nodiscard]] CellComplex rest(const VoxelSet& kept, const Context& context) const;

 private:
  /// A cell in the border of a voxel.
  struct BorderCell {
    Cell cell = 0;
    Neighbourhood sharers = 0;  ///< the neighbours that have it, too
    bool stays = false;         ///< whether an extra cell that stays has it
    bool is_important = false;
  };
  /// A voxel, and its border: place x + 3 y + 9 z, where 1 is the middle along an axis.
  struct Attached {
    std::uint32_t voxel = 0;
    std::array<BorderCell, 27> border;
  };

  void find_plain(const VoxelSet& voxels);
  void find_attached();
  template <class Visit>
  void for_each_voxel_around(Cell cell, const Visit& visit) const;
  void attach_around(Cell cell);
  void find_without_voxel(Cell polyhedron, std::vector<Cell>& found);
  template <class Visit>
  void for_each_attached(const Visit& visit) const;
  void find_closure(const std::array<std::int64_t, 3>& voxel, std::vector<Cell>& cells) const;
  void find_staying();
  void find_borders(const Importance& importance);
  [[nodiscard]] const Attached& at(std::uint32_t voxel) const;
  [[nodiscard]] bool stays(Cell cell) const;

  const CellComplex& model_;
  const CellStructure& structure_;
  VoxelSet plain_;
  VoxelSet attached_;
  std::vector<Attached> list_;                         ///< by rising voxel
  std::vector<std::uint8_t> stays_;                    ///< extra cells: whether it stays, or is a face of one that does
  std::unordered_set<Cell> plain_staying_;             ///< the same of cells of the lattice
  std::vector<std::vector<std::uint32_t>> voxels_of_;  ///< extra cells: voxels of list_ that have it
};

}  // namespace blum::detail
