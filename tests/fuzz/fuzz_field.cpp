// Reads arbitrary bytes as a field. The reader must reject them or return a field that fits its grid.
#include "blum/io/field_io.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const blum::FieldFormat format(BLUM_FORMAT);
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    const blum::Field field = blum::read_field(bytes, format);
    blum::validate(field.grid);
    blum::fuzz::require(field.distance.size() == field.grid.node_count());
  });
}
