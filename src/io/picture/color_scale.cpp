#include "blum/io/color_scale.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/io/color_bar.hpp"

namespace blum {
namespace {

struct Linear {
  double r = 0, g = 0, b = 0;
  [[nodiscard]] bool in_gamut() const { return std::min({r, g, b}) >= -1e-4 && std::max({r, g, b}) <= 1.0001; }
};

Linear linear_of(double lightness, double a, double b) {
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

float gamma(double linear) {
  const double c = std::clamp(linear, 0.0, 1.0);
  return static_cast<float>(c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

struct Stop {
  double lightness, chroma, hue;
};

/// Returns the colour at t, from 0 to 1. Colours between the equidistant stops are mixed in OKLCh.
Color from_stops(std::span<const Stop> stops, double t) {
  const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), stops.size() - 2);
  const double f = at - static_cast<double>(i);
  const auto between = [&](double Stop::* part) { return stops[i].*part + (stops[i + 1].*part - stops[i].*part) * f; };
  return oklch(between(&Stop::lightness), between(&Stop::chroma), between(&Stop::hue));
}

constexpr std::array<Stop, 5> outside = {
    {{0.965, 0.020, 215}, {0.825, 0.075, 228}, {0.680, 0.115, 243}, {0.530, 0.130, 257}, {0.385, 0.120, 268}}};
constexpr std::array<Stop, 5> inside = {
    {{0.965, 0.035, 90}, {0.855, 0.105, 78}, {0.730, 0.150, 58}, {0.590, 0.160, 42}, {0.450, 0.130, 32}}};
constexpr std::array<Stop, 6> whole = {{{0.965, 0.060, 105},
                                        {0.840, 0.125, 130},
                                        {0.710, 0.120, 168},
                                        {0.570, 0.100, 215},
                                        {0.430, 0.110, 265},
                                        {0.290, 0.110, 300}}};

}  // namespace

Color oklch(double lightness, double chroma, double hue) {
  const double angle = hue * std::numbers::pi / 180;
  const auto with = [&](double c) { return linear_of(lightness, c * std::cos(angle), c * std::sin(angle)); };
  Linear color = with(chroma);
  if (!color.in_gamut()) {
    // Finds, by bisection, the largest chroma that the screen can show. Coarser steps of a few per cent would cause
    // false borders in ramps.
    double low = 0;
    double high = chroma;
    for (int step = 0; step < 24; ++step) {
      const double middle = (low + high) / 2;
      (with(middle).in_gamut() ? low : high) = middle;
    }
    color = with(low);
  }
  return {gamma(color.r), gamma(color.g), gamma(color.b)};
}

Color diverging_color(double t) {
  return t < 0 ? from_stops(inside, -t) : from_stops(outside, t);
}

Color sequential_color(double t) {
  return from_stops(whole, t);
}

ColorScale::ColorScale(double lowest, double highest, bool diverges)
    : lowest_(lowest), highest_(highest), diverges_(diverges) {}

ColorScale ColorScale::sequential(double lowest, double highest) {
  ColorScale scale(lowest, highest, false);
  scale.start_ = lowest;
  scale.up_ = scale.down_ = std::max(highest - lowest, std::numeric_limits<double>::min());
  return scale;
}

ColorScale ColorScale::diverging(double lowest, double highest) {
  ColorScale scale(lowest, highest, true);
  const double deepest = std::max(0.0, -lowest);
  const double farthest = std::max(0.0, highest);
  const double largest = std::max({deepest, farthest, std::numeric_limits<double>::min()});
  scale.up_ = std::max(farthest, largest / 4);
  scale.down_ = std::max(deepest, largest / 4);
  return scale;
}

double ColorScale::place(double value) const {
  const double from_start = value - start_;
  return std::clamp(from_start / (from_start < 0 ? down_ : up_), diverges_ ? -1.0 : 0.0, 1.0);
}

Color ColorScale::color(double value) const {
  return std::isfinite(value) ? color_at(place(value)) : nothing_color;
}

namespace {

constexpr double text_height = color_bar_text_height;
constexpr int bar_width = 20;
constexpr int title_rows = 24;

/// Returns a level as text. It has as many decimals as the step between levels, for example "0.15" for a step of 0.05.
std::string level_text(double level, double step) {
  const int decimals = static_cast<int>(std::max(0.0, std::ceil(-std::log10(step) - 1e-9)));
  if (decimals > 5 || std::abs(level) >= 1e6) return level == 0 ? "0" : rounded_text(level);
  char text[40];
  const auto result =
      std::to_chars(text, text + sizeof(text), level == 0 ? 0.0 : level, std::chars_format::fixed, decimals);
  return {text, result.ptr};
}

/// Returns the values that are labelled with a number, at most about one per 34 pixels.
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
