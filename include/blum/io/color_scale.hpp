// Blum: colours of distances. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/io/picture.hpp"

namespace blum {

/// Returns a colour given in OKLCh (Ottosson 2020): lightness 0 to 1, chroma about 0 to 0.3, hue in degrees. Colours
/// that a screen cannot show lose chroma.
[[nodiscard]] Color oklch(double lightness, double chroma, double hue);

/// Returns the colour of a signed distance, divided by the largest one. 0 is light. Towards 1 (outside) it turns deep
/// blue, towards -1 (inside) deep orange. Lightness falls evenly on both sides.
[[nodiscard]] Color diverging_color(double t);
/// Returns the colour of an unsigned distance, 0 (light) to 1 (dark). Lightness falls evenly.
[[nodiscard]] Color sequential_color(double t);

inline constexpr Color paper_color{1, 1, 1};
inline constexpr Color ink_color{0.11F, 0.12F, 0.14F};
/// Colour of values beyond the band, or without a site.
inline constexpr Color nothing_color{0.80F, 0.80F, 0.80F};

/// Map from values to colours.
class ColorScale {
 public:
  /// Returns a scale that is light at `lowest`, and dark at `highest` and beyond. Both must be finite.
  [[nodiscard]] static ColorScale sequential(double lowest, double highest);
  /// Returns a scale that is light at zero, deep orange at `lowest` and deep blue at `highest`. Each side has its own
  /// scale, so that small depths are visible beside large distances. One scale is at most four times the other.
  [[nodiscard]] static ColorScale diverging(double lowest, double highest);

  /// Returns the place of a value on the scale: 0 to 1, or -1 to 1 if it diverges. NaN stays NaN.
  [[nodiscard]] double place(double value) const;
  /// Returns the colour of a value; nothing_color if it is not finite.
  [[nodiscard]] Color color(double value) const;
  /// Returns the colour at a place.
  [[nodiscard]] Color color_at(double place) const {
    return diverges_ ? diverging_color(place) : sequential_color(place);
  }

  [[nodiscard]] double lowest() const { return lowest_; }
  [[nodiscard]] double highest() const { return highest_; }
  [[nodiscard]] bool diverges() const { return diverges_; }

 private:
  ColorScale(double lowest, double highest, bool diverges);

  double lowest_, highest_;
  bool diverges_;
  double start_ = 0;  ///< value that is light
  double up_ = 1;     ///< from there to the deepest colour
  double down_ = 1;
};

}  // namespace blum
