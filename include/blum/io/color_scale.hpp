// Blum: colours of distances. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/io/picture.hpp"

namespace blum {

/// Returns the sRGB colour of OKLCh values (Ottosson 2020): lightness 0 to 1, chroma about 0 to 0.3, hue in degrees.
/// The chroma of colours that a screen cannot show is reduced.
[[nodiscard]] Color oklch(double lightness, double chroma, double hue);

/// Returns the colour of a signed distance divided by the largest distance, -1 to 1. The colour is light at 0, deep
/// blue at 1 (outside) and deep orange at -1 (inside). Lightness decreases evenly on both sides.
[[nodiscard]] Color diverging_color(double t);
/// Returns the colour of an unsigned distance divided by the largest distance: light at 0, dark at 1. Lightness
/// decreases evenly.
[[nodiscard]] Color sequential_color(double t);

inline constexpr Color paper_color{1, 1, 1};
inline constexpr Color ink_color{0.11F, 0.12F, 0.14F};
/// Colour of nodes beyond the band, or without a site.
inline constexpr Color nothing_color{0.80F, 0.80F, 0.80F};

/// Map from values to colours.
class ColorScale {
 public:
  /// Returns a scale that is light at `lowest` and below, and dark at `highest` and above. Both values must be finite.
  [[nodiscard]] static ColorScale sequential(double lowest, double highest);
  /// Returns a scale that is light at zero, deep orange at `lowest` and deep blue at `highest`. Values below and above
  /// zero are scaled separately, so that small depths are visible beside large distances. The two scales differ by at
  /// most a factor of four, so the side with a much smaller range has no deep colours.
  [[nodiscard]] static ColorScale diverging(double lowest, double highest);

  /// Returns the position of a value on the scale: 0 to 1, or -1 to 1 if the scale is diverging. NaN stays NaN.
  [[nodiscard]] double place(double value) const;
  /// Returns the colour of a value; nothing_color if the value is not finite.
  [[nodiscard]] Color color(double value) const;
  /// Returns the colour at a position on the scale.
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
  double start_ = 0;  ///< value of the light colour
  double up_ = 1;     ///< difference between `start_` and the value of the deepest colour above it
  double down_ = 1;
};

}  // namespace blum
