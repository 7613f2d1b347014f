// Blum: thinning of voxels to curves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::centrelines {

/// Removes simple voxels, the shallowest first, and returns the voxels that are left. Voxels with exactly one neighbour
/// stay, as ends of curves. The closed voxels collapse to the result.
/// @param voxels   none of them lies in the outermost layer of the box.
/// @param depth    one value for each voxel of the box: above zero for `voxels`, zero for others.
/// @param spacing  sides of a voxel.
/// @return  a result that does not depend on the number of threads. @throws Cancelled.
[[nodiscard]] VoxelSet thin_to_curves(const VoxelSet& voxels, std::span<const float> depth, const Vec3d& spacing,
                                      const Context& context);

}  // namespace blum::centrelines
