// Blum: distance transforms of images on the CPU. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/field/distance_transform.hpp"

namespace blum::cpu {

/// Computes blum::distance_transforms() of a valid image, on the CPU.
[[nodiscard]] std::vector<Field> distance_transforms(const VoxelImageView& image,
                                                     std::span<const LabelSelection> selections,
                                                     const DistanceTransformOptions& options, const Context& context);

}  // namespace blum::cpu
