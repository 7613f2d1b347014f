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

/// Places number the 27 cells of a closed voxel: x + 3 y + 9 z. Along each axis, 0 is the low side and 2 the high side;
/// 1 means that the cell spans the axis. This is the place of the voxel itself. The 26 neighbours of a voxel are
/// numbered in the same way.
inline constexpr unsigned place_of_voxel = 13;

/// Returns the coordinates x, y and z of a place, each 0, 1 or 2.
constexpr std::array<unsigned, 3> along_axes(unsigned place) {
  return {place % 3, place / 3 % 3, place / 9};
}

/// Returns the place of the cell that spans `axes` from a corner of the voxel (bits x, y, z: 1 on the high side).
constexpr unsigned place_on_border(unsigned corner, unsigned axes) {
  unsigned place = 0;
  for (unsigned a = 3; a-- > 0;) {
    const unsigned at = (axes >> a & 1U) != 0 ? 1 : 2 * (corner >> a & 1U);
    place = 3 * place + at;
  }
  return place;
}

/// For each place, the neighbours of the voxel that also contain the cell at that place.
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

/// Voxels of a model that touch an extra cell, or a cell that stays. The 26 neighbours of such a voxel do not determine
/// which cells it shares with the rest of the model. Extra cells that no voxel contains stay when voxels are removed,
/// and so do their faces.
class AttachedVoxels {
 public:
  /// @param model  a complex that contains all `voxels`. It must outlive this object.
  AttachedVoxels(const CellComplex& model, const VoxelSet& voxels, const Importance& importance);

  /// Returns the voxels that are cells of the lattice. The model's other voxels are replaced by extra cells.
  [[nodiscard]] const VoxelSet& voxels() const { return plain_; }
  [[nodiscard]] bool contain(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return attached_.contains(i, j, k);
  }
  /// Returns true if elementary collapses can remove a voxel without removing a cell whose importance is above 0.
  /// @param voxel  a voxel for which contain() is true.
  /// @param around  the neighbours that have not been removed.
  [[nodiscard]] bool may_go(std::uint32_t voxel, Neighbourhood around) const;

  /// Returns the model without the removed voxels: the voxels `kept` with their extra faces, and the cells that stay.
  [[nodiscard]] CellComplex rest(const VoxelSet& kept, const Context& context) const;

 private:
  /// Cell in the border of a voxel.
  struct BorderCell {
    Cell cell = 0;
    Neighbourhood sharers = 0;  ///< neighbours that also contain the cell
    bool stays = false;         ///< true if the cell stays when all voxels are removed
    bool is_important = false;
  };
  /// Voxel and the cells of its border, indexed by place (see place_of_voxel).
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
  std::vector<Attached> list_;                         ///< Ascending by voxel index.
  std::vector<std::uint8_t> stays_;                    ///< Per extra cell: 1 if it stays.
  std::unordered_set<Cell> plain_staying_;             ///< Lattice cells that stay.
  std::vector<std::vector<std::uint32_t>> voxels_of_;  ///< Per extra cell: voxels of list_ that contain it.
};

/// Thins the voxels of a solid and returns the voxels that are left. The result is as if the voxels were examined one
/// by one, the shallowest first. A voxel stays if its removal would change the topology or remove a cell whose
/// importance is above 0. The closed voxels collapse to the result: the cells of a simple voxel can be removed by
/// elementary collapses (Couprie, Bertrand 2009).
///
/// First, each voxel is examined as if all its shallower neighbours were removed. This first examination runs in
/// parallel, in any order. Then the voxels that could not be removed, and the deeper neighbours of voxels that stay,
/// are examined one by one.
/// @param attached  the voxels of the model, and which of them touch extra cells.
/// @return  a result that does not depend on the number of threads.
/// @throws Cancelled, OutOfMemory. Cost: about 30 ns per voxel, and 150 ns per voxel that is examined again.
[[nodiscard]] VoxelSet thin_voxels(const VoxelSolid& solid, const AttachedVoxels& attached, const CellLattice& lattice,
                                   const Importance& importance, const Context& context);

}  // namespace blum::detail
