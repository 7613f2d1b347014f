#include "view/scene_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/color_scale.hpp"
#include "common/colors.hpp"

namespace blum::cli {
namespace {

/// Adds a table of colours. Each has one byte for red, green, blue and opacity, as in textures.
template <class ColorAt>
Json add_colors(SceneBlob& blob, std::uint32_t count, ColorAt color_at) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(std::size_t{4} * count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Color color = color_at(i);
    for (const float component : {color.r, color.g, color.b, 1.0F}) bytes.push_back(byte_of(component));
  }
  return blob.add(bytes);
}

/// Adds the colour tables of the tool's pictures. Sequential scales are for 0 to 1, diverging ones for -1 to 1.
Json colors_json(SceneBlob& blob) {
  constexpr std::uint32_t ramp_colors = 512;
  constexpr std::uint32_t legend_regions = 12;
  const auto add_ramp = [&](Color (*color_of)(double), double from) {
    const double step = (1 - from) / (ramp_colors - 1);
    return add_colors(blob, ramp_colors, [&](std::uint32_t i) { return color_of(from + step * i); });
  };
  return {{"diverging", add_ramp(diverging_color, -1)},
          {"sequential", add_ramp(sequential_color, 0)},
          {"palette", add_colors(blob, palette_rows * palette_hues, palette_color)},
          {"regions", add_colors(blob, legend_regions, region_color)}};
}

Json roles_json() {
  Json roles = Json::object();
  for (const auto& [role, name] : Description<MedialRole>::values)
    roles[std::string(name)] = static_cast<std::uint64_t>(role);
  return roles;
}

}  // namespace

Json add_places(SceneBlob& blob, std::span<const Vec3d> places, const Vec3d& origin) {
  std::vector<float> numbers;
  numbers.reserve(3 * places.size());
  for (const Vec3d& p : places) {
    for (std::size_t a = 0; a < 3; ++a) numbers.push_back(static_cast<float>(p[a] - origin[a]));
  }
  return blob.add(numbers);
}

Json fact(const char* label, const std::string& text) {
  return Json::array({label, text});
}

/// Browsers draw in single precision, so the extent is limited.
void check_extent(const Json& item, std::string_view what) {
  if (item["bounds"].is_null()) return;
  double extent = 0;
  double farthest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto lower = item["bounds"]["lower"][a].number();
    const auto upper = item["bounds"]["upper"][a].number();
    extent = std::max(extent, upper - lower);
    farthest = std::max({farthest, std::abs(lower), std::abs(upper)});
  }
  constexpr double least = 1e-12;
  constexpr double most = 1e30;
  if ((extent == 0 || extent >= least) && farthest <= most) return;
  throw FileError(std::string(what) + " cannot be drawn: " +
                  (farthest > most ? "it has coordinates of up to " + rounded_text(farthest)
                                   : "its longest side is " + rounded_text(extent)) +
                  ", but browsers draw sizes from 1e-12 to 1e30; scale it");
}

Json scene_header(SceneBlob& blob, Json items) {
  return {{"blum", BLUM_VERSION}, {"items", std::move(items)}, {"colors", colors_json(blob)}, {"roles", roles_json()}};
}

}  // namespace blum::cli
