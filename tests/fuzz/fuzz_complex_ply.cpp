// Feeds any bytes to the readers of complexes and medial axes in PLY files.
#include "fuzz_complex.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_complex(data, size, blum::ComplexFormat::ply);
  blum::fuzz::read_any_medial(data, size, blum::MedialFormat::ply);
  return 0;
}
