// Blum: the voxels that lie deep in a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::detail {

/// Makes a set that of the voxels deeper than a limit, those of the box's outermost layer left out.
/// @param depth  per voxel, x fastest: distance to the surface, positive inside, mesh units.  @throws Cancelled.
void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context);

}  // namespace blum::detail
