// Blum: PNG files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/picture.hpp"

namespace blum {

/// Channels of a pixel of a PNG file. The value of an enumerator is the number of bytes per pixel.
enum class PngChannels : std::uint8_t {
  rgb = 3,
  rgba = 4  ///< the last channel is opacity: 255 is opaque
};

/// View of pixels in memory, in sRGB: rows from the top, pixels from the left, one byte for each channel.
struct PixelView {
  std::span<const std::uint8_t> bytes;
  std::uint32_t width = 0;   ///< pixels, 1 to 1,000,000
  std::uint32_t height = 0;  ///< pixels, 1 to 1,000,000
  PngChannels channels = PngChannels::rgb;
};

/// Returns the bytes of a PNG file with 8 bits per channel. The same pixels give the same bytes.
/// @throws InvalidOption if a size is beyond its limits, or the number of bytes does not match the size.
/// @throws FileError if libpng reports an error.
/// @throws OutOfMemory.
/// Cost: about 80 ns per pixel, and memory for an uncompressed copy.
[[nodiscard]] std::vector<std::byte> encode_png(const PixelView& pixels);
[[nodiscard]] std::vector<std::byte> encode_png(const Picture& picture);

/// Writes pixels to a file, which appears complete or not at all.
/// @throws as encode_png(), FileError.
void write_png(const std::filesystem::path& path, const PixelView& pixels);
void write_png(const std::filesystem::path& path, const Picture& picture);

}  // namespace blum
