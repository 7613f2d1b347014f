// Blum: scalar types of image files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "blum/core/buffer.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum::volume_io {

/// Scalar types, in the order of the alternatives of VoxelImage::Values.
enum class ScalarType : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };

[[nodiscard]] std::size_t scalar_size(ScalarType type);
[[nodiscard]] ScalarType scalar_type(const VoxelImageView::Values& values);

/// Returns `count` values of one type, all zero. @throws OutOfMemory.
[[nodiscard]] VoxelImage::Values make_values(ScalarType type, std::size_t count);
[[nodiscard]] std::span<std::byte> as_bytes(VoxelImage::Values& values);
[[nodiscard]] std::span<const std::byte> as_bytes(const VoxelImageView::Values& values);

/// Reverses the bytes of every value if the file's byte order is not the machine's.
void to_native(std::span<std::byte> bytes, ScalarType type, std::endian order);

/// Converts the values to float. @throws OutOfMemory.
[[nodiscard]] Buffer<float> to_float(const VoxelImage::Values& values);

}  // namespace blum::volume_io
