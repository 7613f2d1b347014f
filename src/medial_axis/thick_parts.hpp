// Blum: where a solid is thick. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/voxel_solid.hpp"

namespace blum {

/// The voxels of the box with one deeper than a limit at most so many steps away along each axis.
/// @param depth   mesh units.
/// @param within  voxels, 0 to 32.
[[nodiscard]] VoxelSet voxels_near_deep_ones(const VoxelSolid& solid, double depth, int within, const Context& context);

}  // namespace blum
