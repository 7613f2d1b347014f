// Blum: bodies and images as voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/solid/solid.hpp"
#include "medial_axis/cells/voxel_solid.hpp"

namespace blum::detail {

/// A solid that is represented by voxels, and a report of its construction.
struct Voxelized {
  VoxelSolid solid;
  BodyReport report;
};

/// Returns the cellular model of a body: voxels and extra cells. The report lists the boxes in which the model's
/// topology may differ from the body's topology.
/// @param spacing  mesh units.
/// @param shift  additional displacement of the grid, in voxels, the same along all axes.
[[nodiscard]] Voxelized voxelize_body(const SolidBody& body, double spacing, const Context& context, double shift = 0);

/// Replaces the extra cells of a body's model by those of a model that is also split in the boxes `finer`; see
/// body_cells(). Voxels, depths and sites do not change.
void split_further(Voxelized& voxelized, const SolidBody& body, std::span<const Box3> finer, const Context& context);

/// Returns the solid of the voxels at whose centres the winding number is above 1/2.
[[nodiscard]] Voxelized voxelize_by_winding(const MeshView& mesh, double spacing, const Context& context,
                                            double shift = 0);

/// Returns the solid of the voxels of an image. Its box is the smallest one that contains these voxels, plus one layer
/// of empty voxels on each side.
/// @param first  receives the indices in the image of the box's voxel (0, 0, 0). An index may be -1.
/// @param all  the voxels of the image that are in the solid, at least one.
/// @param grid  its nodes are the centres of the image's voxels.
[[nodiscard]] Voxelized voxelize_image(const VoxelSet& all, const GridSpec& grid, std::array<std::int64_t, 3>& first,
                                       const Context& context);

}  // namespace blum::detail
