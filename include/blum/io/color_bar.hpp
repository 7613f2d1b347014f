// Blum: colour bars with numbers, and small text in pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "blum/io/picture.hpp"

namespace blum {

/// Returns the width of a text, in pixels, at a given height of its digits.
[[nodiscard]] double text_width(std::string_view text, double height);

/// Draws a text with smooth edges in Blum's own stroke font: digits, lower-case letters and + - . , = ( ) : / %. Other
/// characters leave a gap.
/// @param x         left edge, in pixels.
/// @param baseline  in pixels from the top.
/// @param height    of the digits, in pixels.
void draw_text(Picture& picture, double x, double baseline, double height, std::string_view text, const Color& color);

/// Draws a thin grey line around a rectangle, beside its pixels. Rectangle and line must lie in the picture.
void draw_frame(Picture& picture, int x0, int y0, int width, int height);

/// Returns 1, 2 or 5 times a power of ten, such that about `wanted` steps fit into a range.
/// @param range  > 0, finite.
[[nodiscard]] double round_step(double range, double wanted);

/// Bar that runs from the largest value, at the top, to the smallest, with a title above and numbers to the right.
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  /// Numbers stand at multiples of the step: at all, or at every second, fifth, ... so that they have room. 0: none.
  double step = 0;
  std::string title;
  /// Returns the colour of a value; `per_pixel` is the difference from one row to the next.
  std::function<Color(double value, double per_pixel)> color;
};

/// Height of the digits of the bar's numbers, pixels.
inline constexpr double color_bar_text_height = 11;

/// Returns the width of bar, numbers and title together, in pixels.
/// @param height  of the bar, in pixels.
[[nodiscard]] int width_of(const ColorBar& bar, int height);
/// Draws the title in the 24 rows from `top`, and the bar in the `height` rows below them.
/// @param left  left edge of the bar, in pixels.
void draw(Picture& picture, const ColorBar& bar, int left, int top, int height);

}  // namespace blum
