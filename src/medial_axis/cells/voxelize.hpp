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

/// A solid as voxels, and how it came to be.
struct Voxelized {
  VoxelSolid solid;
  BodyReport report;
};

/// Voxels of a body with its Betti numbers, as choose_voxels finds them.
/// @param spacing  mesh units. @param shift  how far the grid is moved along each axis, voxels.
[[nodiscard]] Voxelized voxelize_body(const SolidBody& body, double spacing, const Context& context, double shift = 0);

/// Splits the model of a body further than it had to be: see body_cells(). Voxels, depths and sites stay.
void split_further(Voxelized& voxelized, const SolidBody& body, std::span<const Box3> finer, const Context& context);

/// The voxels whose centre has a winding number above 1/2.
[[nodiscard]] Voxelized voxelize_by_winding(const MeshView& mesh, double spacing, const Context& context,
                                            double shift = 0);

/// Voxels of an image, with a layer of others around the smallest box that holds them.
/// @param first  the place in the image of the box's voxel (0, 0, 0); may be -1.
/// @param all  its voxels, at least one; on the grid of their centres.
[[nodiscard]] Voxelized voxelize_image(const VoxelSet& all, const GridSpec& grid, std::array<std::int64_t, 3>& first,
                                       const Context& context);

}  // namespace blum::detail
