#include "png.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/atomic_file.hpp"

namespace blum::cli {

std::uint8_t byte_of(float component) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(component, 0.0F, 1.0F) * 255.0F));
}

void write_png(const std::filesystem::path& path, const Picture& picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels().size() * 3);
  for (const Color& color : picture.pixels()) {
    bytes.push_back(byte_of(color.r));
    bytes.push_back(byte_of(color.g));
    bytes.push_back(byte_of(color.b));
  }
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width());
  image.height = static_cast<png_uint_32>(picture.height());
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<char> encoded(size);
  if (png_image_write_to_memory(&image, encoded.data(), &size, 0, bytes.data(), 0, nullptr) == 0) {
    throw FileError("'" + path.string() + "' cannot be encoded as PNG: " + std::string(image.message));
  }
  AtomicFile file(path);
  file.write(encoded.data(), size);
  file.commit();
}

}  // namespace blum::cli
