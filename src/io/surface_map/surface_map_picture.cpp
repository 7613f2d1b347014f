#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/io/color_bar.hpp"
#include "blum/io/png_io.hpp"
#include "io/surface_map/surface_map_files.hpp"

namespace blum::surface_map_files {
namespace {

constexpr int margin = 20;
constexpr int title_rows = 24;    // above the bar
constexpr int nothing_rows = 30;  // below it, for the colour of nothing
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

/// The bar with its numbers, and a margin around it.
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
