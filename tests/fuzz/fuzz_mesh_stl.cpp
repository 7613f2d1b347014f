// Feeds any bytes to the STL reader.
#include "fuzz_mesh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  blum::fuzz::read_any_mesh(data, size, blum::MeshFormat::stl);
  return 0;
}
