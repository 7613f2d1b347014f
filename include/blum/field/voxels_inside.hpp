// Blum: the voxels inside a mesh, by winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// Returns the voxels whose centre is inside a mesh. A centre is inside if the mesh's winding number there is above
/// 1/2, as for SignMode::winding. These voxels represent the solid of a mesh that bounds no polyhedron
/// (SolidRule::winding).
/// @param grid  grid whose nodes are the voxel centres; for the solid of a medial axis, MedialAxisReport::grid.
/// @throws as distance_field().
/// Cost: as a field with SignMode::winding. Memory: 16 bytes per voxel.
[[nodiscard]] VoxelSet voxels_inside(const MeshView& mesh, const GridSpec& grid, const Context& context = {});

}  // namespace blum
