// Blum: colours of distances. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/io/picture.hpp"

namespace blum {

/// From OKLCh (Ottosson 2020): lightness 0 to 1, chroma about 0 to 0.3, hue in degrees. Colours that a screen cannot
/// show lose chroma.
[[nodiscard]] Color oklch(double lightness, double chroma, double hue);

/// Signed distance, as a part of the largest one: 0 is light; to 1 (outside) it turns deep blue, to -1 (inside) deep
/// orange, with lightness falling evenly on both sides.
[[nodiscard]] Color diverging_color(double t);
/// Unsigned distance, 0 (light) to 1 (dark), with lightness falling evenly.
[[nodiscard]] Color sequential_color(double t);

inline constexpr Color paper_color{1, 1, 1};
inline constexpr Color ink_color{0.11F, 0.12F, 0.14F};
/// Beyond the band, and where there is no site.
inline constexpr Color nothing_color{0.80F, 0.80F, 0.80F};

/// Which colours values have.
class ColorScale {
 public:
  /// Light at `lowest`, dark at `highest` and beyond. Both are finite.
  [[nodiscard]] static ColorScale sequential(double lowest, double highest);
  /// Light at zero, deep orange at `lowest`, deep blue at `highest`. Each side has its own scale, so that small depths
  /// show beside large distances; but at most four times the other's.
  [[nodiscard]] static ColorScale diverging(double lowest, double highest);

  /// The place of a value on the scale: 0 to 1, from -1 where it diverges. Not a number stays so.
  [[nodiscard]] double place(double value) const;
  /// Its colour; nothing_color where it is not finite.
  [[nodiscard]] Color color(double value) const;
  /// The colour at a place.
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
  double start_ = 0;  ///< the value that is light
  double up_ = 1;     ///< from there to the deepest colour
  double down_ = 1;
};

}  // namespace blum
