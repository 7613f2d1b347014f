// Reads any bytes as a field in the npz format: the reader must give a field or an error of Blum, nothing else.
#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/error.hpp"
#include "blum/io/field_io.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const blum::Field field = blum::read_field(std::as_bytes(std::span(data, size)), blum::FieldFormat::npz);
    blum::validate(field.grid);
    if (field.distance.size() != field.grid.node_count()) __builtin_trap();
  } catch (const blum::Error&) {
    return 0;  // refused with a reason
  }
  return 0;
}
