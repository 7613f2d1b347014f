#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/io/color_bar.hpp"

namespace blum {
namespace {

struct Point {
  double x = 0, y = 0;
};
using Stroke = std::vector<Point>;

/// Glyph, given by strokes that are separated by blanks. The first character of a stroke defines how its points are
/// joined: '-' by straight lines, '~' by a smooth curve, '@' by a smooth closed curve. A point is two digits, x and y.
/// The baseline is at y = 2, the top of small letters at 6 and that of digits at 8.
struct Glyph {
  char character;
  const char* strokes;
};

constexpr Glyph glyphs[] = {
    {'0', "@02424808"},
    {'1', "-072822"},
    {'2', "~0608484502 -0242"},
    {'3', "~0708484525 ~2545420203"},
    {'4', "-32380444"},
    {'5', "-480805 ~052646420203"},
    {'6', "@02424606 ~380704"},
    {'7', "-084812"},
    {'8', "@05454808 @02424505"},
    {'9', "@04444808 ~464312"},
    {'-', "-0545"},
    {'+', "-0545 -2327"},
    {'.', "-0202"},
    {',', "-1201"},
    {'=', "-0444 -0646"},
    {'(', "~28060321"},
    {')', "~08262301"},
    {':', "-0303 -0606"},
    {'/', "-0248"},
    {'%', "-0248 -0808 -4242"},
    {'a', "@02424606 -4642"},
    {'b', "@02424606 -0802"},
    {'c', "~454606024243"},
    {'d', "@02424606 -4842"},
    {'e', "-0444 ~444606024243"},
    {'f', "~381816 -1612 -0636"},
    {'g', "@02424606 -4641 ~41400001"},
    {'h', "-0802 ~04064644 -4442"},
    {'i', "-0602 -0808"},
    {'j', "-1611 ~111000 -1818"},
    {'k', "-0802 -360432"},
    {'l', "-0802"},
    {'m', "-0602 ~04062624 -2422 ~24264644 -4442"},
    {'n', "-0602 ~04064644 -4442"},
    {'o', "@02424606"},
    {'p', "@02424606 -0600"},
    {'q', "@02424606 -4640"},
    {'r', "-0602 ~040636"},
    {'s', "~4546060444420203"},
    {'t', "-1813 ~131232 -0636"},
    {'u', "-0604 ~04024244 -4642"},
    {'v', "-062246"},
    {'w', "-0612263246"},
    {'x', "-0642 -0246"},
    {'y', "-0622 -4600"},
    {'z', "-06460242"},
};

constexpr double digit_units = 6;  // height of digits above the baseline, in units of the font
constexpr double gap_units = 1.9;
constexpr double space_units = 2.2;

/// Smooths a stroke by corner cutting (Chaikin). The ends of an open curve are kept.
Stroke smooth(Stroke points, bool closed) {
  for (int round = 0; round < 3; ++round) {
    Stroke finer;
    if (!closed) finer.push_back(points.front());
    const std::size_t sides = closed ? points.size() : points.size() - 1;
    for (std::size_t i = 0; i < sides; ++i) {
      const Point a = points[i];
      const Point b = points[(i + 1) % points.size()];
      finer.push_back({0.75 * a.x + 0.25 * b.x, 0.75 * a.y + 0.25 * b.y});
      finer.push_back({0.25 * a.x + 0.75 * b.x, 0.25 * a.y + 0.75 * b.y});
    }
    if (!closed) finer.push_back(points.back());
    points = std::move(finer);
  }
  if (closed) points.push_back(points.front());
  return points;
}

std::vector<Stroke> strokes_of(char character) {
  const auto* const found = std::find_if(std::begin(glyphs), std::end(glyphs),
                                         [&](const Glyph& glyph) { return glyph.character == character; });
  std::vector<Stroke> strokes;
  if (found == std::end(glyphs)) return strokes;
  const std::string_view text = found->strokes;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    Stroke stroke;
    for (std::size_t i = at + 1; i + 1 < end; i += 2) {
      stroke.push_back({static_cast<double>(text[i] - '0'), static_cast<double>(text[i + 1] - '0' - 2)});
    }
    const char kind = text[at];
    strokes.push_back(kind == '-' ? stroke : smooth(stroke, kind == '@'));
    at = end + 1;
  }
  return strokes;
}

double width_units(const std::vector<Stroke>& strokes) {
  double width = 0;
  for (const Stroke& stroke : strokes) {
    for (const Point& point : stroke) width = std::max(width, point.x);
  }
  return strokes.empty() ? space_units : width;
}

double distance_to_segment(const Point& q, const Point& a, const Point& b) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double t = squared > 0 ? std::clamp(((q.x - a.x) * dx + (q.y - a.y) * dy) / squared, 0.0, 1.0) : 0;
  return std::hypot(q.x - a.x - t * dx, q.y - a.y - t * dy);
}

double distance_to_strokes(const Point& q, const std::vector<Stroke>& strokes) {
  double nearest = HUGE_VAL;
  for (const Stroke& stroke : strokes) {
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
      nearest = std::min(nearest, distance_to_segment(q, stroke[i], stroke[i + 1]));
    }
  }
  return nearest;
}

/// `left` and `baseline` are in pixels; `unit` is the number of pixels per unit of the font.
void draw_glyph(Picture& picture, const std::vector<Stroke>& strokes, double left, double baseline, double unit,
                const Color& color) {
  const double half_width = std::max(0.55, 0.42 * unit);  // in pixels
  const double margin = half_width + 1;
  const int x0 = std::max(0, static_cast<int>(std::floor(left - margin)));
  const int x1 = std::min(picture.width() - 1, static_cast<int>(std::ceil(left + 4 * unit + margin)));
  const int y0 = std::max(0, static_cast<int>(std::floor(baseline - 6 * unit - margin)));
  const int y1 = std::min(picture.height() - 1, static_cast<int>(std::ceil(baseline + 2 * unit + margin)));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Point q{(x + 0.5 - left) / unit, (baseline - y - 0.5) / unit};
      const double cover = std::clamp(half_width + 0.5 - distance_to_strokes(q, strokes) * unit, 0.0, 1.0);
      if (cover > 0) picture.at(x, y) = mix(picture.at(x, y), color, static_cast<float>(cover));
    }
  }
}

}  // namespace

double text_width(std::string_view text, double height) {
  double units = 0;
  for (const char character : text) units += width_units(strokes_of(character)) + gap_units;
  return std::max(0.0, units - gap_units) * height / digit_units;
}

void draw_text(Picture& picture, double x, double baseline, double height, std::string_view text, const Color& color) {
  const double unit = height / digit_units;
  for (const char character : text) {
    const std::vector<Stroke> strokes = strokes_of(character);
    draw_glyph(picture, strokes, x, baseline, unit, color);
    x += (width_units(strokes) + gap_units) * unit;
  }
}

}  // namespace blum
