// Blum: the voxels around a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/cells/attached_voxels.hpp"
#include "medial_axis/cells/importance.hpp"
#include "medial_axis/cells/voxel_solid.hpp"

namespace blum::detail {

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
