// Blum: a solid as voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/cells/cell_complex.hpp"

namespace blum::detail {

/// The voxels of a solid, and for each voxel of the box the closest site of the surface. The outermost voxels of the
/// box are not in the solid.
struct VoxelSolid {
  GridSpec grid;        ///< its nodes are the voxel centres
  VoxelSet voxels;      ///< those that make the solid
  Buffer<float> depth;  ///< distance to the surface, positive inside; mesh units
  Buffer<SiteId> site;  ///< the closest one
  /// Of a polyhedron: what its model has beside the voxels of `voxels`. Null for others, which are their voxels.
  std::shared_ptr<const ExtraIncidence> extra = {};
  bool is_exact = false;  ///< whether the solid is the union of the closed voxels, as those of images are
};

/// Makes a set that of the voxels deeper than a limit, those of the box's outermost layer left out.
/// @param depth  per voxel, x fastest: distance to the surface, positive inside, mesh units.  @throws Cancelled.
void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context);

}  // namespace blum::detail
