#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/surface_map_io.hpp"
#include "io/surface_map/surface_map_files.hpp"

namespace blum {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr int gutter = 4;  ///< texels around charts that get their colours

Rgb bytes_of(const Color& color) {
  return {byte_of(color.r), byte_of(color.g), byte_of(color.b)};
}

/// The colours of a scale at so many places that the next place has nearly always the same bytes.
class ColorTable {
 public:
  explicit ColorTable(const ColorScale& scale)
      : scale_(scale), first_(scale.diverges() ? -1 : 0), colors_(steps + 1), nothing_(bytes_of(nothing_color)) {
    for (int i = 0; i <= steps; ++i) colors_[static_cast<std::size_t>(i)] = bytes_of(scale.color_at(place(i)));
  }
  [[nodiscard]] const Rgb& color(float value) const {
    if (!std::isfinite(value)) return nothing_;
    const double at = (scale_.place(value) - first_) / (1 - first_) * steps;
    return colors_[static_cast<std::size_t>(std::lround(at))];
  }

 private:
  static constexpr int steps = 8192;  // even: zero has a place of its own
  [[nodiscard]] double place(int i) const { return first_ + (1 - first_) * i / steps; }

  const ColorScale& scale_;
  double first_;
  std::vector<Rgb> colors_;
  Rgb nothing_;
};

/// Carries the colours of charts beyond their borders, a texel further with each round.
class GutterFill {
 public:
  GutterFill(const SurfaceAtlas& atlas, std::vector<std::uint8_t>& pixels)
      : width_(atlas.width), height_(atlas.height), pixels_(pixels), filled_(atlas.size()) {
    for (std::size_t i = 0; i < atlas.size(); ++i) filled_[i] = atlas.triangle[i].has_value() ? 1 : 0;
  }

  void run(int rounds, const Context& context) {
    for (int round = 0; round < rounds; ++round) {
      throw_if_cancelled(context);
      const std::vector<Texel> border = empty_texels_at_border();
      if (border.empty()) return;
      for (const Texel& texel : border) std::copy(texel.color.begin(), texel.color.end(), &pixels_[3 * texel.index]);
      for (const Texel& texel : border) filled_[texel.index] = 1;
    }
  }

 private:
  struct Texel {
    std::size_t index = 0;
    Rgb color{};
  };

  [[nodiscard]] std::vector<Texel> empty_texels_at_border() const {
    std::vector<Texel> out;
    for (std::size_t y = 0; y < height_; ++y) {
      for (std::size_t x = 0; x < width_; ++x) {
        const std::size_t index = y * width_ + x;
        Rgb color{};
        if (filled_[index] == 0 && mean_around(x, y, color)) out.push_back({index, color});
      }
    }
    return out;
  }

  /// The mean colour of the texels around one that have one; false where none has.
  [[nodiscard]] bool mean_around(std::size_t x, std::size_t y, Rgb& color) const {
    std::array<unsigned, 3> sum{};
    unsigned count = 0;
    for (std::size_t v = y == 0 ? 0 : y - 1; v <= std::min(y + 1, height_ - 1); ++v) {
      for (std::size_t u = x == 0 ? 0 : x - 1; u <= std::min(x + 1, width_ - 1); ++u) {
        const std::size_t other = v * width_ + u;
        if (filled_[other] == 0) continue;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += pixels_[3 * other + c];
        ++count;
      }
    }
    if (count == 0) return false;
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
    return true;
  }

  std::size_t width_, height_;
  std::vector<std::uint8_t>& pixels_;
  std::vector<std::uint8_t> filled_;
};

}  // namespace

std::optional<std::pair<double, double>> finite_range(const SurfaceMap& map) {
  surface_map_files::check(map);
  double smallest = HUGE_VAL;
  double largest = -HUGE_VAL;
  for (std::size_t i = 0; i < map.distance.size(); ++i) {
    const double value = map.distance[i];
    if (!map.atlas->triangle[i].has_value() || !std::isfinite(value)) continue;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  if (smallest > largest) return std::nullopt;
  return std::pair{smallest, largest};
}

bool is_signed(const SurfaceMap& map) {
  return map.sign_rule != SignRule::none;
}

ColorScale color_scale_of(const SurfaceMap& map, const SurfaceMapWriteOptions& options) {
  const auto scale = is_signed(map) ? &ColorScale::diverging : &ColorScale::sequential;
  if (options.range) {
    const auto [first, second] = *options.range;
    if (!std::isfinite(first) || !std::isfinite(second) || !(first < second) || !std::isfinite(second - first)) {
      throw InvalidOption("the range of colours is " + exact_text(first) + " to " + exact_text(second) +
                          ", but must be two finite distances, the first less than the second");
    }
    return scale(first, second);
  }
  const auto range = finite_range(map).value_or(std::pair{0.0, 0.0});
  // Distances are seen from 0; a thickness is no distance from anything, and walls differ by little.
  const bool is_thickness =
      map.quantity == SurfaceQuantity::ray_thickness || map.quantity == SurfaceQuantity::ball_thickness;
  double lowest = is_signed(map) ? std::min(range.first, 0.0) : 0.0;
  if (is_thickness && range.first < range.second) lowest = range.first;
  return scale(lowest, range.second > lowest ? range.second : lowest + 1);
}

ColorTexture color_texture(const SurfaceMap& map, const ColorScale& scale, const Context& context) {
  surface_map_files::check(map);
  const SurfaceAtlas& atlas = *map.atlas;
  const Rgb paper = bytes_of(paper_color);
  const ColorTable table(scale);
  ColorTexture out{atlas.width, atlas.height, std::vector<std::uint8_t>(3 * atlas.size())};
  parallel_for(context, atlas.size(), std::size_t{1} << 16, "colour", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Rgb& color = atlas.triangle[i].has_value() ? table.color(map.distance[i]) : paper;
      std::copy(color.begin(), color.end(), &out.pixels[3 * i]);
    }
  });
  GutterFill(atlas, out.pixels).run(gutter, context);
  return out;
}

}  // namespace blum
