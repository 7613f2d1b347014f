// Blum: which voxels of an image are selected, as bits. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// The selected voxels of an image, which may be none.
/// @param image  must pass validate(image).
/// @throws InvalidImage, InvalidOption, Cancelled. Cost: the speed of memory; 1/8 byte per voxel, twice.
[[nodiscard]] VoxelSet selected_voxels(const VoxelImageView& image, const LabelSelection& selection,
                                       const Context& context = {});

namespace detail {

/// Rows of bits: bit x of row r is set when the voxel is selected. A row starts on a new 64-bit word; the bits beyond
/// its last voxel are clear. A row is also read as little groups of 16 bits, in rising x.
struct MaskBits {
  std::size_t words_per_row = 0;
  Buffer<std::uint64_t> words;
};

/// Fills the bits of an image cut into rows of `row_length` voxels, and counts the selected voxels.
/// The buffer is reused where it has the right size. @throws InvalidOption when the threshold is NaN; Cancelled.
std::size_t select_voxels(const VoxelImageView& image, const LabelSelection& selection, std::size_t row_length,
                          const Context& context, MaskBits& mask);

}  // namespace detail
}  // namespace blum
