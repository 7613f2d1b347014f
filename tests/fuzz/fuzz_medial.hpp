// Blum: what the fuzz targets of the readers of medial axes share. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::fuzz {

/// Reads bytes as a medial axis: either Blum refuses them with an error of its own, or the result is sound.
inline void read_any_medial(const std::uint8_t* data, std::size_t size, MedialFormat format) {
  MedialFile file;
  try {
    file = read_medial(std::as_bytes(std::span(data, size)), format, "fuzz");
  } catch (const FormatError&) {
    return;
  }
  const MedialComplex& complex = file.complex;
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  for (const MedialVertex& v : complex.vertices) {
    require(is_finite(v.position) && std::isfinite(v.radius) && v.radius >= 0 && std::isfinite(v.separation_angle));
    require(is_finite(v.footprints[0]) && is_finite(v.footprints[1]) && v.role <= MedialRole::junction);
  }
  for (const MedialEdge& e : complex.edges) {
    for (const std::uint32_t index : e.vertices) require(index < complex.vertices.size());
    require(std::isfinite(e.separation_angle) && e.role <= MedialRole::junction);
  }
  for (const MedialTriangle& t : complex.triangles) {
    for (const std::uint32_t index : t.vertices) require(index < complex.vertices.size());
    require(std::isfinite(t.separation_angle) && t.sheet < complex.sheet_count);
  }
  require(complex.sheet_count <= complex.triangles.size());
  if (file.metadata.grid) validate(*file.metadata.grid);
}

}  // namespace blum::fuzz
