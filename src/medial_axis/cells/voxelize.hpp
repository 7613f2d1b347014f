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

/// Solid as voxels, and a report of its construction.
struct Voxelized {
  VoxelSolid solid;
  BodyReport report;
};

/// Returns the cellular model of a body: voxels and extra cells. The report contains places where the model may lack
/// the body's topology.
/// @param spacing  mesh units.
/// @param shift  displacement of the grid along each axis, voxels.
[[nodiscard]] Voxelized voxelize_body(const SolidBody& body, double spacing, const Context& context, double shift = 0);

/// Splits the model of a body in the boxes `finer`, too: see body_cells(). Voxels, depths and sites stay.
void split_further(Voxelized& voxelized, const SolidBody& body, std::span<const Box3> finer, const Context& context);

/// Returns the voxels whose centre has a winding number above 1/2.
[[nodiscard]] Voxelized voxelize_by_winding(const MeshView& mesh, double spacing, const Context& context,
                                            double shift = 0);

/// Returns the voxels of an image, in the smallest box that contains them plus a layer of empty voxels.
/// @param first  output: place in the image of the box's voxel (0, 0, 0); may be -1.
/// @param all  voxels of the image, at least one; `grid` has their centres as nodes.
[[nodiscard]] Voxelized voxelize_image(const VoxelSet& all, const GridSpec& grid, std::array<std::int64_t, 3>& first,
                                       const Context& context);

}  // namespace blum::detail
