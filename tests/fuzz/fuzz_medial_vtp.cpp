// Feeds any bytes to the reader of medial axes in VTP files.
#include "fuzz_medial.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_medial(data, size, blum::MedialFormat::vtp);
  return 0;
}
