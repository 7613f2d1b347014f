// Blum: points of a solid in the components that cells stand for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/surface/governors.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {

/// Calls use(indices) for each voxel of the solid that contains a cell of the lattice.
template <class Use>
void for_each_voxel_inside(const GovernorField& governors, const CellLattice& lattice, Cell cell, const Use& use) {
  lattice.for_each_cube_around(cell, [&](const std::array<std::int64_t, 3>& at) {
    if (governors.solid().voxels.contains(at[0], at[1], at[2])) use(at);
  });
}

/// Known points of the components of the solid that the cells of a model represent. Points of extra cells are stored
/// when they are first computed, because all adjacent cells need them. Functions may be called from many threads.
class Witnesses {
 public:
  /// Cost: 56 bytes for each extra cell.
  Witnesses(const GovernorField& governors, const CellStructure& structure);

  /// Returns the deepest known point of the component of a cell, or nullopt if all known points are on the surface.
  [[nodiscard]] std::optional<Stop> home_of(Cell cell) const;
  /// Returns the centre of the deepest voxel of the solid that contains a cell of the lattice; nullopt if there is
  /// none.
  [[nodiscard]] std::optional<Stop> deepest_voxel(Cell cell) const;
  /// Returns all known points of the component of a vertex, the deepest first.
  [[nodiscard]] std::vector<Stop> landmarks_of(Cell vertex) const;

  [[nodiscard]] const GovernorField& governors() const { return governors_; }
  [[nodiscard]] const CellStructure& structure() const { return structure_; }

 private:
  enum class State : std::uint8_t { unknown, being_written, known };
  /// Closest point of the surface to the witness (the known point) of an extra cell, if the witness is inside the
  /// solid.
  struct Known {
    std::atomic<State> state{State::unknown};
    std::optional<NearestPoint> nearest;
  };

  [[nodiscard]] std::optional<Stop> witness_of(Cell extra) const;
  template <class Use>
  void for_each_witness(Cell cell, const Use& use) const;

  const GovernorField& governors_;
  const CellStructure& structure_;
  SolidPaths paths_;
  mutable std::vector<Known> known_;
};

}  // namespace blum::detail
