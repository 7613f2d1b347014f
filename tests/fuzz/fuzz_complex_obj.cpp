// Feeds any bytes to the readers of complexes and medial axes in OBJ files.
#include "fuzz_complex.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_complex(data, size, blum::ComplexFormat::obj);
  blum::fuzz::read_any_medial(data, size, blum::MedialFormat::obj);
  return 0;
}
