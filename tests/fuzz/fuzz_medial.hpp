// Blum: what the fuzz targets of the readers of medial axes share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::fuzz {

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Reads bytes as a medial axis: either Blum refuses them with an error of its own, or the result is sound.
inline void read_any_medial(const std::uint8_t* data, std::size_t size, MedialFormat format) {
  MedialFile file;
  try {
    file = read_medial(std::as_bytes(std::span(data, size)), format, "fuzz");
  } catch (const FormatError&) {
    return;
  }
  require(problem_of_medial(file.complex).empty());
  if (file.nested) {
    require(problem_of_medial(*file.nested).empty());
    require(file.least_theta >= 0 && file.least_theta <= 180);
    static_cast<void>(MedialLevels(*file.nested));
  }
  if (file.metadata.grid) validate(*file.metadata.grid);
}

}  // namespace blum::fuzz
