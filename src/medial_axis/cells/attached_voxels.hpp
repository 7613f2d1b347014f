// Blum: voxels of a model that extra cells are attached to. SPDX-License-Identifier: Apache-2.0
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

/// The border of a voxel has a place for each of its cells, x + 3 y + 9 z: along each axis 0 at the low side, 1 where
/// the cell spans it, 2 at the high side. Neighbours have the same places.
inline constexpr unsigned place_of_voxel = 13;

/// Along each axis, where a place lies: 0, 1, 2.
constexpr std::array<unsigned, 3> along_axes(unsigned place) {
  return {place % 3, place / 3 % 3, place / 9};
}

/// The place of the cell that spans `axes` from a corner (bits x, y, z: the high side).
constexpr unsigned place_on_border(unsigned corner, unsigned axes) {
  unsigned place = 0;
  for (unsigned a = 3; a-- > 0;) {
    const unsigned at = (axes >> a & 1U) != 0 ? 1 : 2 * (corner >> a & 1U);
    place = 3 * place + at;
  }
  return place;
}

/// For each place the neighbours that have the cell there, too.
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

/// What is left of a solid's voxels when simple ones go, the shallowest first, each looked at once. A voxel stays where
/// its removal would change the topology, or take away a cell that has importance. The closed voxels collapse to those
/// that are left: a simple voxel's cells go by elementary collapses (Couprie, Bertrand 2009).
///
/// Where all shallower neighbours of a voxel go, only deeper ones are left at its turn: such voxels are judged in any
/// order, in parallel. The others, near what stays, follow one by one.
/// @param attached  of the model: its voxels, and which of them extra cells are attached to.
/// @return  the same for any number of threads.
/// @throws Cancelled, OutOfMemory. Cost: about 30 ns per voxel, and 150 ns per voxel near what stays.
[[nodiscard]] VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                                   const Importance& importance, const Context& context);

}  // namespace blum::detail
