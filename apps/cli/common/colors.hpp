// Blum: colours of regions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/io/picture.hpp"

namespace blum::cli {

/// The colour of a site: the same for the same id in every picture, spread over hue and lightness.
[[nodiscard]] Color region_color(std::uint32_t id);

/// The colours of regions with fewer hues: a row for each lightness and chroma, in which the hue runs.
inline constexpr std::uint32_t palette_rows = 16;
inline constexpr std::uint32_t palette_hues = 256;
/// @param place  row * palette_hues + number of the hue.
[[nodiscard]] Color palette_color(std::uint32_t place);

}  // namespace blum::cli
