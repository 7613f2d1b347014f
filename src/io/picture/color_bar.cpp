#include "blum/io/color_bar.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/io/color_scale.hpp"

namespace blum {
namespace {

constexpr double text_height = color_bar_text_height;
constexpr int bar_width = 20;
constexpr int title_rows = 24;

/// A level as text with as many decimals as the step has: "0.15".
std::string level_text(double level, double step) {
  const int decimals = static_cast<int>(std::max(0.0, std::ceil(-std::log10(step) - 1e-9)));
  if (decimals > 5 || std::abs(level) >= 1e6) return level == 0 ? "0" : rounded_text(level);
  char text[40];
  const auto result =
      std::to_chars(text, text + sizeof(text), level == 0 ? 0.0 : level, std::chars_format::fixed, decimals);
  return {text, result.ptr};
}

/// The values that get a number, at most about one for each 40 pixels.
std::vector<double> labelled_levels(const ColorBar& bar, int pixels) {
  std::vector<double> levels;
  if (bar.step <= 0) return levels;
  double shown = bar.step;
  const double range = bar.maximum - bar.minimum;
  for (const double factor : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0}) {
    shown = bar.step * factor;
    if (range / shown * 34 <= pixels) break;
  }
  for (double k = std::ceil(bar.minimum / shown); k * shown <= bar.maximum; ++k) levels.push_back(k * shown);
  return levels;
}

}  // namespace

void draw_frame(Picture& picture, int x0, int y0, int width, int height) {
  const auto shade = [&](int x, int y) { picture.at(x, y) = mix(picture.at(x, y), ink_color, 0.45F); };
  for (int x = x0 - 1; x <= x0 + width; ++x) {
    shade(x, y0 - 1);
    shade(x, y0 + height);
  }
  for (int y = y0; y < y0 + height; ++y) {
    shade(x0 - 1, y);
    shade(x0 + width, y);
  }
}

double round_step(double range, double wanted) {
  const double rough = range / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double lead = rough / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

int width_of(const ColorBar& bar, int height) {
  double widest = text_width(bar.title, text_height) - bar_width - 10;
  for (const double level : labelled_levels(bar, height)) {
    widest = std::max(widest, text_width(level_text(level, bar.step), text_height));
  }
  return bar_width + 10 + static_cast<int>(std::ceil(widest));
}

void draw(Picture& picture, const ColorBar& bar, int left, int top, int height) {
  const int y0 = top + title_rows;
  draw_text(picture, left, top + text_height, text_height, bar.title, ink_color);
  const double range = bar.maximum - bar.minimum;
  const double per_pixel = range / height;
  for (int y = 0; y < height; ++y) {
    const Color color = bar.color(bar.maximum - (y + 0.5) * per_pixel, per_pixel);
    for (int x = 0; x < bar_width; ++x) picture.at(left + x, y0 + y) = color;
  }
  draw_frame(picture, left, y0, bar_width, height);
  for (const double level : labelled_levels(bar, height)) {
    const double y = y0 + (bar.maximum - level) / per_pixel;
    for (int x = 0; x < 5; ++x) {
      const int row = std::clamp(static_cast<int>(y), y0, y0 + height - 1);
      picture.at(left + bar_width + 1 + x, row) = mix(paper_color, ink_color, 0.6F);
    }
    draw_text(picture, left + bar_width + 10, y + text_height / 2, text_height, level_text(level, bar.step), ink_color);
  }
}

}  // namespace blum
