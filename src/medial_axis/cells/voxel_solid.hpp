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

/// Voxels of a solid, and the closest site of the surface for each voxel of the box. The outermost voxels of the box
/// are not in the solid.
struct VoxelSolid {
  GridSpec grid;        ///< Its nodes are the voxel centres.
  VoxelSet voxels;      ///< Voxels of the solid.
  Buffer<float> depth;  ///< Distance to the surface, positive inside; mesh units.
  Buffer<SiteId> site;  ///< Closest site.
  /// The extra cells of a polyhedron's model. Null if the solid is an image or was made by winding numbers; its voxels
  /// are then the whole model.
  std::shared_ptr<const ExtraIncidence> extra = {};
  bool is_exact = false;  ///< true if the solid is the union of the closed voxels, as for images
};

/// Fills a set with the voxels deeper than a limit, except those of the outermost layer of the box.
/// @param depth  for each voxel, x fastest: distance to the surface, positive inside, mesh units.  @throws Cancelled.
void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context);

}  // namespace blum::detail
