// Blum: thinning of voxels to curves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::centrelines {

/// Removes simple voxels, the shallowest first, and returns those that are left. Voxels with one neighbour stay as
/// ends. The closed voxels collapse to the result.
/// @param voxels   none at the border of their box.
/// @param depth    above zero for exactly these voxels; one value per voxel of the box.
/// @param spacing  of the voxels.
/// @return  the same for any number of threads. @throws Cancelled.
[[nodiscard]] VoxelSet thin_to_curves(const VoxelSet& voxels, std::span<const float> depth, const Vec3d& spacing,
                                      const Context& context);

}  // namespace blum::centrelines
