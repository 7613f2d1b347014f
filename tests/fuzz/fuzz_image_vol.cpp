// Reads any bytes as an image in the vol format: the reader must give an image or an error of Blum, nothing else.
#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/error.hpp"
#include "blum/io/image_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    blum::validate(blum::read_image(std::as_bytes(std::span(data, size)), blum::ImageFormat::vol));
  } catch (const blum::Error&) {
    return 0;  // refused with a reason
  }
  return 0;
}
