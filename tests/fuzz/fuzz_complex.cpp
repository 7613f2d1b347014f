// Reads arbitrary bytes as a complex and as a medial axis. The readers must reject them or return sound complexes.
#include "blum/complex/medial_columns.hpp"
#include "blum/io/complex_io.hpp"
#include "blum/io/medial_io.hpp"
#include "fuzz.hpp"

namespace blum::fuzz {
namespace {

void require_sound(const Columns& columns) {
  require(columns.size() <= max_file_columns);
  for (const Column& column : columns) {
    require(!column.name.empty() && column.components <= max_file_columns && column.rows() == columns.rows());
  }
}

void require_sound(const Complex& complex) {
  require(problem_of(complex).empty());
  require_sound(complex.vertex_columns);
  require_sound(complex.edge_columns);
  require_sound(complex.triangle_columns);
}

void require_sound(const MedialFile& file) {
  require(problem_of_medial(CompleteAxis(file.complex).get()).empty());
  if (file.nested) {
    require(problem_of_nested(*file.nested).empty());
    require(file.least_theta >= 0 && file.least_theta <= 180);
    static_cast<void>(MedialLevels(*file.nested));
  }
  if (file.metadata.grid) validate(*file.metadata.grid);
}

}  // namespace
}  // namespace blum::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const blum::ComplexFormat format(BLUM_FORMAT);
  blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    const blum::ComplexFile file = blum::read_complex(bytes, format, "fuzz");
    blum::fuzz::require_sound(file.complex);
    for (const blum::NamedComplex& further : file.further) blum::fuzz::require_sound(further.complex);
  });
  return blum::fuzz::feed(data, size, [](std::span<const std::byte> bytes) {
    blum::fuzz::require_sound(blum::read_medial(bytes, format, "fuzz"));
  });
}
