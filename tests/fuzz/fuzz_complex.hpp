// Blum: what the fuzz targets of the readers of complexes share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "blum/core/error.hpp"
#include "blum/io/complex_io.hpp"
#include "fuzz_medial.hpp"

namespace blum::fuzz {

inline void require_sound(const Columns& columns) {
  require(columns.size() <= max_file_columns);
  for (const Column& column : columns) {
    require(!column.name.empty() && column.components <= max_file_columns && column.rows() == columns.rows());
  }
}

inline void require_sound_complex(const Complex& complex) {
  require(problem_of(complex).empty());
  require_sound(complex.vertex_columns);
  require_sound(complex.edge_columns);
  require_sound(complex.triangle_columns);
}

/// Reads bytes as a complex: either Blum refuses them with an error of its own, or the result is sound.
inline void read_any_complex(const std::uint8_t* data, std::size_t size, ComplexFormat format) {
  try {
    const ComplexFile file = read_complex(std::as_bytes(std::span(data, size)), format, "fuzz");
    require_sound_complex(file.complex);
    for (const NamedComplex& further : file.further) require_sound_complex(further.complex);
  } catch (const FormatError&) {
    return;
  }
}

}  // namespace blum::fuzz
