// Blum: bodies and images as voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "medial_axis/solid_bodies.hpp"
#include "medial_axis/voxel_solid.hpp"

namespace blum {

/// A solid as voxels, and how it came to be.
struct Voxelized {
  VoxelSolid solid;
  BodyReport report;
};

/// Voxels of a body with its Betti numbers, as choose_voxels finds them.
/// @param spacing  mesh units.
[[nodiscard]] Voxelized voxelize_body(const SolidBody& body, double spacing, const Context& context);

/// The voxels whose centre has a winding number above 1/2.
[[nodiscard]] Voxelized voxelize_by_winding(const MeshView& mesh, double spacing, const Context& context);

/// The selected voxels of an image, with a layer of others around the smallest box that holds them.
/// @param first  the place in the image of the box's voxel (0, 0, 0); may be -1.
/// @throws InvalidImage where no voxel is selected.
[[nodiscard]] Voxelized voxelize_image(const VoxelImageView& image, const LabelSelection& selection,
                                       std::array<std::int64_t, 3>& first, const Context& context);

}  // namespace blum
