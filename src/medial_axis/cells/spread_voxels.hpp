// Blum: voxels near those of a set. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// The voxels of the box with one of a set at most so many steps away along each axis. @param within  voxels, 0 to 32.
[[nodiscard]] VoxelSet spread(const VoxelSet& from, int within, const Context& context);

}  // namespace blum
