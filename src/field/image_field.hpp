// Blum: functions for image fields that all devices share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/field/distance_transform.hpp"
#include "field/image_request.hpp"

namespace blum::detail {

/// Checks the number of selected voxels.
/// @throws InvalidImage if no voxel is selected, or if the field is signed and all voxels are selected.
void check_selected(std::size_t selected, const VoxelImageView& image, const ImageRequest& request);

/// Fills all members of an image's field except the values. Allocates memory for the values and sets it in the request.
/// @throws OutOfMemory.
void begin_field(const VoxelImageView& image, const DistanceTransformOptions& options, ImageRequest& request,
                 Field& field);

}  // namespace blum::detail
