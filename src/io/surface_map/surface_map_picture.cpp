#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/color_bar.hpp"
#include "blum/io/gltf_io.hpp"
#include "blum/io/png_io.hpp"
#include "blum/io/surface_map_io.hpp"
#include "io/surface_map/surface_map_files.hpp"

namespace blum::surface_map_files {
namespace {

constexpr int margin = 20;
constexpr int title_rows = 24;    // rows above the colour bar
constexpr int nothing_rows = 30;  // rows below the colour bar, for the colour of texels without a distance
constexpr int least_bar = 100;
constexpr int most_bar = 640;
constexpr int wanted_numbers = 8;

bool has_nothing(const SurfaceMap& map) {
  for (std::size_t i = 0; i < map.distance.size(); ++i) {
    if (map.atlas->triangle[i].has_value() && !std::isfinite(map.distance[i])) return true;
  }
  return false;
}

void draw_nothing(Picture& picture, int left, int top) {
  for (int y = 0; y < 14; ++y) {
    for (int x = 0; x < 20; ++x) picture.at(left + x, top + y) = nothing_color;
  }
  draw_frame(picture, left, top, 20, 14);
  draw_text(picture, left + 30, top + 12, color_bar_text_height, "none", ink_color);
}

/// Returns the colour bar with its numbers and a margin around it.
Picture legend_of(const Request& request, const ColorScale& scale) {
  const int rows = static_cast<int>(std::min<std::uint32_t>(request.map.atlas->height, 65536));
  const int height = std::clamp(rows - 2 * margin - title_rows - nothing_rows, least_bar, most_bar);
  const double range = scale.highest() - scale.lowest();
  const ColorBar bar{scale.lowest(), scale.highest(), round_step(range, wanted_numbers),
                     title_of(request.map, request.options.units),
                     [&](double value, double) { return scale.color(value); }};
  const bool shows_nothing = has_nothing(request.map);
  const int width = std::max(width_of(bar, height), shows_nothing ? 70 : 0);
  Picture picture(width + 2 * margin, height + 2 * margin + title_rows + nothing_rows, paper_color);
  draw(picture, bar, margin, margin, height);
  if (shows_nothing) draw_nothing(picture, margin, margin + title_rows + height + 14);
  return picture;
}

}  // namespace

void write_picture(const Request& request) {
  const ColorScale scale = color_scale_of(request.map, request.options);
  const ColorTexture texture = color_texture(request.map, scale, request.context);
  Picture legend = legend_of(request, scale);
  const std::size_t width = texture.width + static_cast<std::size_t>(legend.width());
  const std::size_t height = std::max<std::size_t>(texture.height, static_cast<std::size_t>(legend.height()));
  std::vector<std::uint8_t> pixels(3 * width * height, 255);
  for (std::size_t y = 0; y < texture.height; ++y) {
    const std::size_t row = 3 * std::size_t{texture.width};
    std::copy_n(&texture.pixels[y * row], row, &pixels[3 * y * width]);
  }
  for (int y = 0; y < legend.height(); ++y) {
    for (int x = 0; x < legend.width(); ++x) {
      const Color& color = legend.at(x, y);
      std::uint8_t* const pixel =
          &pixels[3 * (static_cast<std::size_t>(y) * width + texture.width + static_cast<std::size_t>(x))];
      pixel[0] = byte_of(color.r);
      pixel[1] = byte_of(color.g);
      pixel[2] = byte_of(color.b);
    }
  }
  throw_if_cancelled(request.context);
  write_png(request.path,
            {pixels, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), PngChannels::rgb});
}

}  // namespace blum::surface_map_files

namespace blum {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr int gutter = 4;  ///< width in texels of the border around charts that is filled with their colours

Rgb bytes_of(const Color& color) {
  return {byte_of(color.r), byte_of(color.g), byte_of(color.b)};
}

/// Table of a scale's colours. It is so fine that neighbouring entries nearly always have the same 8-bit colour.
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
  static constexpr int steps = 8192;  // an even number, so that zero has its own entry
  [[nodiscard]] double place(int i) const { return first_ + (1 - first_) * i / steps; }

  const ColorScale& scale_;
  double first_;
  std::vector<Rgb> colors_;
  Rgb nothing_;
};

/// Extends the colours of charts beyond their borders, by one texel per round.
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

  /// Sets the mean colour of those texels around a texel that have a colour. Returns false if none has one.
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
  return map.finite_range();
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
  // The scale for distances starts at 0. The scale for thicknesses does not start at 0: a thickness is not measured
  // from a reference, and walls often differ little.
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

namespace blum::surface_map_files {
namespace {

using Places = std::array<std::array<float, 2>, 3>;

/// Returns texture coordinates of corners as in glTF: fractions of the texture's sides, with v increasing downwards
/// like rows.
std::vector<Places> texture_coordinates(const SurfaceAtlas& atlas) {
  std::vector<Places> out;
  out.reserve(atlas.corners.size());
  for (std::uint32_t t = 0; t < atlas.corners.size(); ++t) out.push_back(atlas.texture_coordinates(TriangleId(t)));
  return out;
}

/// Converts to single precision. Values beyond float's range become infinite.
std::vector<float> floats_of(const std::vector<double>& numbers) {
  std::vector<float> out;
  out.reserve(numbers.size());
  for (const double number : numbers) out.push_back(static_cast<float>(number));
  return out;
}

GltfExtras extras_of(const Request& request, const ColorScale& scale) {
  GltfExtras extras;
  const auto range = finite_range(request.map);
  for (const auto& pair : request.metadata) {
    const bool is_ours = pair.first == "color_range" || pair.first == "colors";
    if (pair.first == "range" && range) {
      extras.emplace_back("range", std::vector<double>{range->first, range->second});
    } else if (!is_ours) {
      extras.emplace_back(pair.first, pair.second);
    }
  }
  extras.emplace_back("colors", scale.diverges() ? "diverging" : "sequential");
  extras.emplace_back("color_range", std::vector<double>{scale.lowest(), scale.highest()});
  return extras;
}

}  // namespace

void write_glb(const Request& request) {
  const SurfaceMap& map = request.map;
  const ColorScale scale = color_scale_of(map, request.options);
  const std::vector<std::byte> png = encode_png(color_texture(map, scale, request.context).view());
  const std::vector<Places> places = texture_coordinates(*map.atlas);
  const std::vector<float> distances = floats_of(map.vertex_distance);
  GltfMesh shown;
  shown.name = title_of(map, request.options.units);
  shown.vertices = request.mesh.vertices;
  shown.triangles = request.mesh.triangles;
  shown.attributes.push_back({"DISTANCE", 1, distances});
  shown.texture_coordinates = places;
  shown.texture = png;
  shown.extras = extras_of(request, scale);
  write_gltf(request.path, shown, request.context);
}

}  // namespace blum::surface_map_files
