// Blum: brute-force distances in voxel images, for tests and comparison. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::reference {

struct NearestVoxel {
  double squared = 0;  ///< squared distance between the centres of the two voxels, in squared units of the spacing
  SiteId site;         ///< nearest voxel; the smallest linear index if several voxels are equally near
};

/// Returns the squared distance between the centres of two voxels, given by linear indices.
[[nodiscard]] double squared_distance(const GridSpec& grid, std::size_t a, std::size_t b);

/// Returns the target voxel (targets[i] != 0) nearest to one voxel, by an exhaustive search in double precision. If
/// there are no targets, the site is none(). Cost: O(voxels).
[[nodiscard]] NearestVoxel nearest_voxel(const GridSpec& grid, const std::vector<std::uint8_t>& targets,
                                         std::size_t voxel);

}  // namespace blum::reference
