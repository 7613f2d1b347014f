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

inline void require(bool holds) {
  if (!holds) std::abort();
}

/// Of an axis of one angle, or of all.
template <class Complex>
void require_sound(const Complex& complex) {
  for (const MedialVertex& v : complex.vertices) {
    require(is_finite(v.position) && std::isfinite(v.radius) && v.radius >= 0 && std::isfinite(v.separation_angle));
    require(is_finite(v.footprints[0]) && is_finite(v.footprints[1]) && v.role <= MedialRole::junction);
  }
  for (const auto& e : complex.edges) {
    for (const std::uint32_t index : e.vertices) require(index < complex.vertices.size());
    require(std::isfinite(e.separation_angle) && e.role <= MedialRole::junction);
  }
  for (const auto& t : complex.triangles) {
    for (const std::uint32_t index : t.vertices) require(index < complex.vertices.size());
    require(std::isfinite(t.separation_angle) && t.sheet < complex.sheet_count);
  }
  require(complex.sheet_count <= complex.triangles.size());
}

/// Reads bytes as a medial axis: either Blum refuses them with an error of its own, or the result is sound.
inline void read_any_medial(const std::uint8_t* data, std::size_t size, MedialFormat format) {
  MedialFile file;
  try {
    file = read_medial(std::as_bytes(std::span(data, size)), format, "fuzz");
  } catch (const FormatError&) {
    return;
  }
  require_sound(file.complex);
  if (file.nested) {
    require_sound(*file.nested);
    require(std::isfinite(file.nested->least_theta));
    require(file.nested->vertex_until.size() == file.nested->vertices.size());
    for (const float until : file.nested->vertex_until) require(!std::isnan(until));
    for (const NestedEdge& e : file.nested->edges) require(!std::isnan(e.from) && !std::isnan(e.until));
    for (const NestedTriangle& t : file.nested->triangles) require(!std::isnan(t.until));
  }
  if (file.metadata.grid) validate(*file.metadata.grid);
}

}  // namespace blum::fuzz
