// Blum: pictures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace blum {

/// Colour in sRGB, each component in [0, 1].
struct Color {
  float r = 0, g = 0, b = 0;
  [[nodiscard]] friend Color mix(const Color& a, const Color& b, float t) {
    return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
  }
};

/// Returns a component of a colour, 0 to 1, as a byte of a file, 0 to 255. Values outside of [0, 1] are clamped.
[[nodiscard]] std::uint8_t byte_of(float component);

/// Picture. Rows are numbered from the top, and pixels of a row from the left.
class Picture {
 public:
  /// @param width, height  pixels, at least 1.
  Picture(int width, int height, const Color& fill)
      : width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill) {}
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] Color& at(int x, int y) {
    return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] const std::vector<Color>& pixels() const { return pixels_; }

 private:
  int width_;
  int height_;
  std::vector<Color> pixels_;
};

}  // namespace blum
