// Blum: what fields of images have in common on every device. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/field/distance_transform.hpp"
#include "field/image_request.hpp"

namespace blum::detail {

/// @throws InvalidImage where the selected voxels leave nothing to measure to.
void check_selected(std::size_t selected, const VoxelImageView& image, const ImageRequest& request);

/// Everything of an image's field but its values, for which there is memory then, which the request is told of.
/// @throws OutOfMemory.
void begin_field(const VoxelImageView& image, const DistanceTransformOptions& options, ImageRequest& request,
                 Field& field);

}  // namespace blum::detail
