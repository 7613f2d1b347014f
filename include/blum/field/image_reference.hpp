// Blum: brute-force distances in voxel images, for tests and for trust. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::reference {

struct NearestVoxel {
  double squared = 0;  ///< squared distance between the voxel centres, in squared units of the spacing
  SiteId site;         ///< the smallest linear index among the voxels whose squared distance equals the minimum
};

/// Squared distance between the centres of two voxels, given by linear indices.
[[nodiscard]] double squared_distance(const GridSpec& grid, std::size_t a, std::size_t b);

/// Looks at every target voxel (targets[i] != 0) for one voxel, in double; site is none() where there is no target.
/// Cost: O(voxels).
[[nodiscard]] NearestVoxel nearest_voxel(const GridSpec& grid, const std::vector<std::uint8_t>& targets,
                                         std::size_t voxel);

}  // namespace blum::reference
