// Blum: PNG files, read by libpng. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

namespace blum::test {

/// The content of a PNG file, four bytes per pixel.
struct ReadPng {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  bool has_alpha = false;
  std::vector<std::uint8_t> bytes;

  [[nodiscard]] std::array<int, 4> at(std::size_t x, std::size_t y) const {
    const std::uint8_t* const pixel = &bytes[4 * (y * width + x)];
    return {pixel[0], pixel[1], pixel[2], pixel[3]};
  }
};

inline ReadPng read_png(std::span<const std::byte> file) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, file.data(), file.size()) == 0) throw std::runtime_error(image.message);
  ReadPng out{image.width, image.height, (image.format & PNG_FORMAT_FLAG_ALPHA) != 0, {}};
  image.format = PNG_FORMAT_RGBA;
  out.bytes.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, out.bytes.data(), 0, nullptr) == 0) {
    throw std::runtime_error(image.message);
  }
  return out;
}

}  // namespace blum::test
