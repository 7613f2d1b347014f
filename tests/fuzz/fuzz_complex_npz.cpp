// Feeds any bytes to the readers of complexes and medial axes in NPZ files.
#include "fuzz_complex.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_complex(data, size, blum::ComplexFormat::npz);
  blum::fuzz::read_any_medial(data, size, blum::MedialFormat::npz);
  return 0;
}
