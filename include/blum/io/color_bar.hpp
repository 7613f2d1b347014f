// Blum: colour bars with scale numbers, and small texts in pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "blum/io/picture.hpp"

namespace blum {

/// Returns the width of a text in pixels, if its digits have a given height in pixels.
[[nodiscard]] double text_width(std::string_view text, double height);

/// Draws a text with smooth edges in Blum's own stroke font: digits, lower-case letters and + - . , = ( ) : / %. Other
/// characters leave a gap.
/// @param x         left edge of the text, in pixels.
/// @param baseline  position of the bottom of the digits, in pixels from the top of the picture.
/// @param height    height of the digits, in pixels.
void draw_text(Picture& picture, double x, double baseline, double height, std::string_view text, const Color& color);

/// Draws a thin grey line around a rectangle, on the pixels just outside of it. Rectangle and line must lie in the
/// picture.
void draw_frame(Picture& picture, int x0, int y0, int width, int height);

/// Returns a step of 1, 2 or 5 times a power of ten, such that about `wanted` steps fit into a range.
/// @param range  > 0, finite.
[[nodiscard]] double round_step(double range, double wanted);

/// Vertical colour bar, with the largest value at the top. A title is above the bar, and numbers are to the right of
/// it.
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  /// Numbers are written at multiples of `step`. If there is not enough room, only every second, fifth, ... multiple
  /// has a number. 0: no numbers.
  double step = 0;
  std::string title;
  /// Returns the colour of a value; `per_pixel` is the difference between the values of one row and the next.
  std::function<Color(double value, double per_pixel)> color;
};

/// Height of the digits of the bar's numbers, in pixels.
inline constexpr double color_bar_text_height = 11;

/// Returns the width of bar, numbers and title together, in pixels.
/// @param height  height of the bar, in pixels.
[[nodiscard]] int width_of(const ColorBar& bar, int height);
/// Draws the title in 24 rows, of which `top` is the first, and the bar in the `height` rows below them.
/// @param left  left edge of the bar, in pixels.
void draw(Picture& picture, const ColorBar& bar, int left, int top, int height);

}  // namespace blum
