// Blum: voxels with the topology of the solid that they stand for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/medial_axis/medial_axis.hpp"

namespace blum {

/// How voxels came to have the wanted topology.
struct RepairReport {
  bool is_right = false;    ///< whether the voxels have the wanted Betti numbers
  BettiNumbers betti{};     ///< theirs
  std::size_t removed = 0;  ///< voxels whose centre is inside, but that are left out
  std::size_t added = 0;    ///< voxels whose centre is outside, but that are taken in
  double deviation = 0;     ///< the largest distance from the surface of the centre of a voxel left out or taken in
};

/// Makes a set that of the voxels deeper than a limit, those of the box's outermost layer left out.
/// @param depth  as for choose_voxels.  @throws Cancelled.
void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context);

/// Chooses voxels with the Betti numbers of a connected solid: those whose centre is inside where that will do; else,
/// within `tolerance` of the surface, what simple voxels added to (or taken from) a set of the right topology make of
/// it; else what grows from the deepest voxel, with as many handles and voids as the solid has, the deepest first.
/// Simple voxels change no topology, so that the result is right whenever the report says so.
///
/// @param depth      per voxel, x fastest: distance to the surface, positive inside, mesh units.
/// @param wanted     of one connected solid: its first number is 1.
/// @param tolerance  mesh units, one voxel diagonal say.
/// @param voxels     the result; those of the outermost layer of the box are never taken in.
/// @throws Cancelled.
[[nodiscard]] RepairReport choose_voxels(std::span<const float> depth, const BettiNumbers& wanted, double tolerance,
                                         VoxelSet& voxels, const Context& context);

}  // namespace blum
