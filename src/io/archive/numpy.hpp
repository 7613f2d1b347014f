// Blum: arrays of NumPy (.npy). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/grid/voxel_image.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/bytes/scalar_type.hpp"

namespace blum::volume_io {

/// What the header of a .npy file says.
struct NpyHeader {
  enum class Kind : std::uint8_t { scalar, text };
  Kind kind = Kind::scalar;
  ScalarType type = ScalarType::u8;
  std::size_t text_length = 0;  ///< characters (32 bits each) of one entry, for text
  std::endian order = std::endian::native;
  bool fortran = false;
  std::vector<std::uint64_t> shape;

  /// @throws FormatError with `name` when the product does not fit 2^40.
  [[nodiscard]] std::uint64_t count(const std::string& name) const;
};

/// The header (format version 1.0, padded to 64 bytes) of an array in C order and the machine's byte order.
/// @param dtype  the type without byte order, for example "f4".
[[nodiscard]] std::string npy_header(std::string_view dtype, const std::vector<std::uint64_t>& shape);
/// The type of a scalar without byte order, for example "f4".
[[nodiscard]] std::string_view npy_dtype(ScalarType type);

/// Reads the header and leaves the stream at the first value. @throws FormatError.
[[nodiscard]] NpyHeader read_npy_header(ByteStream& stream);
/// The number of values of a scalar array. @throws FormatError for text, or when the stream cannot hold that many.
[[nodiscard]] std::uint64_t check_npy_values(const ByteStream& stream, const NpyHeader& header);
/// Reads values as they come, in the machine's byte order. @throws FormatError.
void read_npy_raw(ByteStream& stream, const NpyHeader& header, std::span<std::byte> out);
/// Reads the values of a scalar array, in C order of its shape. @throws FormatError, OutOfMemory.
[[nodiscard]] VoxelImage::Values read_npy_values(ByteStream& stream, const NpyHeader& header);
/// Sizes of an image whose array is indexed [z, y, x], in x, y, z order. @throws FormatError for other than 1 to 3
/// axes.
[[nodiscard]] std::array<std::int64_t, 3> npy_image_size(const NpyHeader& header, const std::string& name);

}  // namespace blum::volume_io
