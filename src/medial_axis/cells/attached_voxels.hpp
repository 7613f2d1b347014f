// Blum: voxels of a model with extra cells attached. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/cells/importance.hpp"
#include "medial_axis/cells/voxel_solid.hpp"

namespace blum::detail {

/// Place of the voxel itself. The place of a cell of its border is x + 3 y + 9 z. Along each axis 0 is the low side, 2
/// the high side; 1 means that the cell spans the axis. The 26 neighbours are numbered in the same way.
inline constexpr unsigned place_of_voxel = 13;

/// Coordinates of a place along the axes: 0, 1 or 2.
constexpr std::array<unsigned, 3> along_axes(unsigned place) {
  return {place % 3, place / 3 % 3, place / 9};
}

/// Returns the place of the cell that spans `axes` from a corner (bits x, y, z: the high side).
constexpr unsigned place_on_border(unsigned corner, unsigned axes) {
  unsigned place = 0;
  for (unsigned a = 3; a-- > 0;) {
    const unsigned at = (axes >> a & 1U) != 0 ? 1 : 2 * (corner >> a & 1U);
    place = 3 * place + at;
  }
  return place;
}

/// For each place, the neighbours that contain the cell at that place, too.
inline constexpr std::array<Neighbourhood, 27> sharers_of_place = [] {
  std::array<Neighbourhood, 27> sharers{};
  for (unsigned p = 0; p < 27; ++p) {
    for (unsigned q = 0; q < 27; ++q) {
      bool shares = q != place_of_voxel;
      for (std::size_t a = 0; a < 3; ++a) {
        shares = shares && (along_axes(q)[a] == 1 || along_axes(q)[a] == along_axes(p)[a]);
      }
      if (shares) sharers[p] |= 1U << q;
    }
  }
  return sharers;
}();

/// Voxels of a model whose 26 neighbours do not determine what they share with the rest: walls pass between voxels, or
/// extra cells are attached. Extra cells that are not faces of voxels stay when voxels are removed.
class AttachedVoxels {
 public:
  /// @param model  contains all its voxels. It must outlive this object.
  AttachedVoxels(const CellComplex& model, const VoxelSet& voxels, const Importance& importance);

  /// Voxels that are cells of the lattice. Other voxels of the model are extra cells.
  [[nodiscard]] const VoxelSet& voxels() const { return plain_; }
  [[nodiscard]] bool contain(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return attached_.contains(i, j, k);
  }
  /// Returns true if elementary collapses can remove a voxel without removing a cell of importance.
  /// @param voxel  one of these.
  /// @param around  the neighbours that are still present.
  [[nodiscard]] bool may_go(std::uint32_t voxel, Neighbourhood around) const;

  /// Returns the rest of the model: `kept` voxels and the extra cells that stay.
  [[nodiscard]] CellComplex rest(const VoxelSet& kept, const Context& context) const;

 private:
  /// Cell in the border of a voxel.
  struct BorderCell {
    Cell cell = 0;
    Neighbourhood sharers = 0;  ///< neighbours that contain it, too
    bool stays = false;         ///< true if it is a cell, or a face of one, that stays
    bool is_important = false;
  };
  /// Voxel and its border, by place: x + 3 y + 9 z, where 1 is the middle along an axis.
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
  std::vector<Attached> list_;                         ///< By ascending voxel.
  std::vector<std::uint8_t> stays_;                    ///< Extra cells: 1 if the cell, or a coface of it, stays.
  std::unordered_set<Cell> plain_staying_;             ///< Cells of the lattice that stay for the same reason.
  std::vector<std::vector<std::uint32_t>> voxels_of_;  ///< Extra cells: voxels of list_ that contain them.
};

/// Thins the voxels of a solid and returns those that are left. Each voxel is examined once, the shallowest first. A
/// voxel stays if its removal would change the topology or take away a cell of importance. The closed voxels collapse
/// to the result: the cells of a simple voxel can be removed by elementary collapses (Couprie, Bertrand 2009).
///
/// If all shallower neighbours of a voxel are removed, only deeper ones are present at its turn. Such voxels are judged
/// in any order, in parallel. Voxels near those that stay follow one by one.
/// @param attached  of the model: its voxels, and those with extra cells attached.
/// @return  the same for any number of threads.
/// @throws Cancelled, OutOfMemory. Cost: about 30 ns per voxel, and 150 ns per voxel near what stays.
[[nodiscard]] VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                                   const Importance& importance, const Context& context);

}  // namespace blum::detail
