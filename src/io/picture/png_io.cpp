#include "blum/io/png_io.hpp"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

#include "blum/io/atomic_file.hpp"

namespace blum {
namespace {

constexpr std::uint32_t largest_side = 1000000;  // pixels; libpng's own limit

std::size_t channel_count(PngChannels channels) {
  return static_cast<std::size_t>(channels);
}

void check(const PixelView& pixels) {
  const auto is_side = [](std::uint32_t side) { return side >= 1 && side <= largest_side; };
  const std::string size = std::to_string(pixels.width) + " x " + std::to_string(pixels.height) + " pixels";
  if (!is_side(pixels.width) || !is_side(pixels.height)) {
    throw InvalidOption("PNG files hold 1 to 1,000,000 pixels a side, not " + size);
  }
  const std::size_t wanted = channel_count(pixels.channels) * pixels.width * pixels.height;
  if (pixels.bytes.size() != wanted) {
    throw InvalidOption("a picture of " + size + " needs " + std::to_string(wanted) + " bytes, but has " +
                        std::to_string(pixels.bytes.size()));
  }
}

std::vector<std::uint8_t> bytes_of(const Picture& picture) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(picture.pixels().size() * 3);
  for (const Color& color : picture.pixels()) {
    bytes.push_back(byte_of(color.r));
    bytes.push_back(byte_of(color.g));
    bytes.push_back(byte_of(color.b));
  }
  return bytes;
}

PixelView view_of(const Picture& picture, const std::vector<std::uint8_t>& bytes) {
  return {bytes, static_cast<std::uint32_t>(picture.width()), static_cast<std::uint32_t>(picture.height()),
          PngChannels::rgb};
}

}  // namespace

std::uint8_t byte_of(float component) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(component, 0.0F, 1.0F) * 255.0F));
}

std::vector<std::byte> encode_png(const PixelView& pixels) {
  check(pixels);
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = pixels.width;
  image.height = pixels.height;
  image.format = pixels.channels == PngChannels::rgb ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  try {
    std::vector<std::byte> encoded(size);
    if (png_image_write_to_memory(&image, encoded.data(), &size, 0, pixels.bytes.data(), 0, nullptr) == 0) {
      throw FileError("a picture of " + std::to_string(pixels.width) + " x " + std::to_string(pixels.height) +
                      " pixels cannot be encoded as PNG: " + std::string(image.message));
    }
    encoded.resize(size);
    return encoded;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory("not enough memory to encode a picture as PNG");
  }
}

std::vector<std::byte> encode_png(const Picture& picture) {
  const std::vector<std::uint8_t> bytes = bytes_of(picture);
  return encode_png(view_of(picture, bytes));
}

void write_png(const std::filesystem::path& path, const PixelView& pixels) {
  const std::vector<std::byte> encoded = encode_png(pixels);
  AtomicFile file(path);
  file.write(encoded.data(), encoded.size());
  file.commit();
}

void write_png(const std::filesystem::path& path, const Picture& picture) {
  const std::vector<std::uint8_t> bytes = bytes_of(picture);
  write_png(path, view_of(picture, bytes));
}

}  // namespace blum
