// Blum: colours of regions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/io/picture.hpp"

namespace blum::cli {

/// Returns the colour of a site. An id has the same colour in every picture. Colours vary in hue and lightness.
[[nodiscard]] Color region_color(std::uint32_t id);

/// Palette of region colours with fewer hues: one row for each lightness and chroma, with all hues.
inline constexpr std::uint32_t palette_rows = 16;
inline constexpr std::uint32_t palette_hues = 256;
/// @param place  row * palette_hues + number of the hue.
[[nodiscard]] Color palette_color(std::uint32_t place);

}  // namespace blum::cli
