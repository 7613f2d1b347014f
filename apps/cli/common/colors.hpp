// Blum: colours of regions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/io/picture.hpp"

namespace blum::cli {

/// Returns the colour of a site (a Voronoi region). An id has the same colour in every picture. Colours of different
/// ids vary in hue and lightness.
[[nodiscard]] Color region_color(std::uint32_t id);

/// Palette of region colours with a limited number of hues. Each row has one lightness and one chroma, and contains all
/// hues.
inline constexpr std::uint32_t palette_rows = 16;
inline constexpr std::uint32_t palette_hues = 256;
/// @param place  row * palette_hues + index of the hue.
[[nodiscard]] Color palette_color(std::uint32_t place);

}  // namespace blum::cli
