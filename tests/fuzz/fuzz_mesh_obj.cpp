// Feeds any bytes to the OBJ reader.
#include "fuzz_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_mesh(data, size, blum::MeshFormat::obj);
  return 0;
}
