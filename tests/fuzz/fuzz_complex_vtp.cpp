// Feeds any bytes to the readers of complexes and medial axes in VTP files.
#include "fuzz_complex.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_complex(data, size, blum::ComplexFormat::vtp);
  blum::fuzz::read_any_medial(data, size, blum::MedialFormat::vtp);
  return 0;
}
