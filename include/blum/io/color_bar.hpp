// Blum: bars of colours with numbers, and small text in pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "blum/io/picture.hpp"

namespace blum {

/// How wide a text is, in pixels, at a given height of its digits.
[[nodiscard]] double text_width(std::string_view text, double height);

/// Draws a text with smooth edges in Blum's own stroke font: digits, lower-case letters and + - . , = ( ) : / %.
/// Other characters leave a gap.
/// @param x         left edge, in pixels.
/// @param baseline  in pixels from the top.
/// @param height    of the digits, in pixels.
void draw_text(Picture& picture, double x, double baseline, double height, std::string_view text, const Color& color);

/// A thin grey line around a rectangle, beside its pixels. They and the line lie in the picture.
void draw_frame(Picture& picture, int x0, int y0, int width, int height);

/// 1, 2 or 5 times a power of ten, such that about `wanted` steps fit into a range.
/// @param range  > 0, finite.
[[nodiscard]] double round_step(double range, double wanted);

/// A bar that runs from the largest value, at the top, to the smallest, with a title above and numbers to the right.
struct ColorBar {
  double minimum = 0;
  double maximum = 1;
  /// Numbers are at multiples of it, of all, or of every second, fifth, ... so that they have room; 0: none.
  double step = 0;
  std::string title;
  /// The colour of a value; `per_pixel` is the difference from one row to the next.
  std::function<Color(double value, double per_pixel)> color;
};

/// Digits of the bar's numbers, pixels.
inline constexpr double color_bar_text_height = 11;

/// How wide bar, numbers and title are, in pixels.
/// @param height  of the bar, in pixels.
[[nodiscard]] int width_of(const ColorBar& bar, int height);
/// Draws the bar with its title in the 24 rows from `top`, and its own `height` rows below them.
/// @param left  of the bar, in pixels.
void draw(Picture& picture, const ColorBar& bar, int left, int top, int height);

}  // namespace blum
