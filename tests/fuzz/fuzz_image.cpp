// Reads arbitrary bytes as an image. The reader must reject them or return an image that validate() accepts.
#include "blum/io/image_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const blum::ImageFormat format(BLUM_FORMAT);
  return blum::fuzz::feed(data, size,
                          [](std::span<const std::byte> bytes) { blum::validate(blum::read_image(bytes, format)); });
}
