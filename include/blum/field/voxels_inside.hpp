// Blum: the voxels inside a mesh, by winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// The voxels whose centre has a winding number above 1/2, by the field's own signs: as voxels, the solid of a mesh
/// that bounds no polyhedron (SolidRule::winding).
/// @param grid  of the voxels' centres: for a medial axis its own, MedialAxisReport::grid.
/// @throws as distance_field(). Cost: that of a field with SignMode::winding; 16 bytes per voxel.
[[nodiscard]] VoxelSet voxels_inside(const MeshView& mesh, const GridSpec& grid, const Context& context = {});

}  // namespace blum
