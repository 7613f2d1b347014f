#include "common/colors.hpp"

#include <array>

#include "blum/io/color_scale.hpp"

namespace blum::cli {
namespace {

std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

/// @param row  index of lightness and chroma, below palette_rows. @param hue  in degrees.
Color region_color_of(std::uint32_t row, double hue) {
  constexpr std::array<double, 4> lightnesses = {0.66, 0.74, 0.81, 0.87};
  constexpr std::array<double, 4> chromas = {0.070, 0.095, 0.115, 0.085};
  return oklch(lightnesses[row & 3], chromas[row >> 2 & 3], hue);
}

}  // namespace

Color region_color(std::uint32_t id) {
  const std::uint32_t bits = scramble(id + 0x9e3779b9U);  // the same as in the shaders of the viewer's page
  return region_color_of(bits & 15, static_cast<double>(bits >> 8) * (360.0 / 16777216.0));
}

Color palette_color(std::uint32_t place) {
  return region_color_of(place / palette_hues, (place % palette_hues + 0.5) * (360.0 / palette_hues));
}

}  // namespace blum::cli
