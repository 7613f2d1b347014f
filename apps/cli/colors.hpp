// Blum: colours of pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "png.hpp"

namespace blum::cli {

/// From OKLCh (Ottosson 2020): lightness 0 to 1, chroma about 0 to 0.3, hue in degrees. Colours that a screen cannot
/// show lose chroma.
[[nodiscard]] Color oklch(double lightness, double chroma, double hue);

/// Signed distance, as a part of the largest one: 0 is light; to 1 (outside) it turns deep blue, to -1 (inside) deep
/// orange, with lightness falling evenly on both sides.
[[nodiscard]] Color diverging_color(double t);
/// Unsigned distance, 0 (light) to 1 (dark), with lightness falling evenly.
[[nodiscard]] Color sequential_color(double t);

/// The colour of a site: the same for the same id in every picture, spread over hue and lightness.
[[nodiscard]] Color region_color(std::uint32_t id);

/// The colours of regions with fewer hues: a row for each lightness and chroma, in which the hue runs.
inline constexpr std::uint32_t palette_rows = 16;
inline constexpr std::uint32_t palette_hues = 256;
/// @param place  row * palette_hues + number of the hue.
[[nodiscard]] Color palette_color(std::uint32_t place);

inline constexpr Color paper_color{1, 1, 1};
inline constexpr Color ink_color{0.11F, 0.12F, 0.14F};
/// Beyond the band, and where there is no site.
inline constexpr Color nothing_color{0.80F, 0.80F, 0.80F};

}  // namespace blum::cli
