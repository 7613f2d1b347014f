// Blum: small text in pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "png.hpp"

namespace blum::cli {

/// How wide a text is, in pixels, at a given height of its digits.
[[nodiscard]] double text_width(std::string_view text, double height);

/// Draws a text with smooth edges in Blum's own stroke font: digits, lower-case letters and + - . , = ( ) : / %.
/// Other characters leave a gap.
/// @param x         left edge, in pixels.
/// @param baseline  in pixels from the top.
/// @param height    of the digits, in pixels.
void draw_text(Picture& picture, double x, double baseline, double height, std::string_view text, const Color& color);

}  // namespace blum::cli
