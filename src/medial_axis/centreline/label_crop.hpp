// Blum: the voxels of one label, cut out of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum::centrelines {

using Place = std::array<std::int64_t, 3>;

/// The voxels of one value.
struct LabelBox {
  std::int64_t label = 0;
  std::uint64_t voxels = 0;
  Place low{};   ///< of the box around them
  Place high{};  ///< likewise, within
};

/// All values but 0, rising. @throws InvalidImage where one is no whole number; Cancelled.
[[nodiscard]] std::vector<LabelBox> label_boxes(const VoxelImageView& image, const Context& context);
/// The voxels that a rule selects; none: an empty box.
[[nodiscard]] LabelBox selection_box(const VoxelImageView& image, const LabelSelection& selection,
                                     const Context& context);

/// The selected voxels within a box, and two layers of others around. The border's voxels are never selected.
/// @throws Cancelled.
[[nodiscard]] VoxelSet crop(const VoxelImageView& image, const LabelSelection& selection, const LabelBox& box,
                            const Context& context);

/// How far voxel 0 of a crop is before that of its box.
inline constexpr std::int64_t margin = 2;

}  // namespace blum::centrelines
