// Blum: selected voxels of an image, as bits. SPDX-License-Identifier: Apache-2.0
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

/// Returns the selected voxels of an image. The set may be empty.
/// @param image  must pass validate(image).
/// @throws InvalidImage, InvalidOption, Cancelled. Cost: limited by memory bandwidth. Memory: 1/8 byte per voxel for
/// the result, and another 1/8 byte per voxel during the computation.
[[nodiscard]] VoxelSet selected_voxels(const VoxelImageView& image, const LabelSelection& selection,
                                       const Context& context = {});

namespace detail {

/// Selected voxels as rows of bits. Bit x of row r is set if voxel x of row r is selected. Each row starts with a new
/// 64-bit word, and the bits after its last voxel are 0. A row may also be read as groups of 16 bits, in rising x.
struct MaskBits {
  std::size_t words_per_row = 0;
  Buffer<std::uint64_t> words;
};

/// Fills the bits of an image that is divided into rows of `row_length` voxels. Returns the number of selected voxels.
/// Reuses the buffer of `mask` if it has the right size. @throws InvalidOption if the threshold is NaN; Cancelled.
std::size_t select_voxels(const VoxelImageView& image, const LabelSelection& selection, std::size_t row_length,
                          const Context& context, MaskBits& mask);

}  // namespace detail
}  // namespace blum
