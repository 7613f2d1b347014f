#include "field/slice_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/io/color_bar.hpp"
#include "blum/io/color_scale.hpp"
#include "common/colors.hpp"
#include "common/summary.hpp"
#include "field/slice_sampler.hpp"

namespace blum::cli {
namespace {

constexpr double wanted_side = 800;
constexpr double largest_side = 4096;
constexpr double largest_area = 50e6;
constexpr int margin = 20;
constexpr double text_height = color_bar_text_height;
constexpr int caption_height = 34;

/// Positions of the parts of a picture, in pixels.
struct Layout {
  int width = 0;  ///< width of the slice
  int height = 0;
  double per_u = 1;  ///< number of pixels per grid step
  double per_v = 1;
  int canvas_width = 0;
  int canvas_height = 0;
  /// Returns the position of a pixel's centre, in grid steps from the first node.
  [[nodiscard]] double u(int x) const { return (x + 0.5) / per_u - 0.5; }
  [[nodiscard]] double v(int y) const { return (height - y - 0.5) / per_v - 0.5; }
};

Layout make_layout(const Slice& slice, double scale, int legend_width) {
  const double finest = std::min(slice.u_step, slice.v_step);
  Layout layout;
  layout.per_u = scale * slice.u_step / finest;
  layout.per_v = scale * slice.v_step / finest;
  const double width = std::max(1.0, std::round(static_cast<double>(slice.width) * layout.per_u));
  const double height = std::max(1.0, std::round(static_cast<double>(slice.height) * layout.per_v));
  if (!(width * height <= largest_area) || width > 65000 || height > 65000) {
    throw InvalidOption("the picture would have " + rounded_text(width) + " x " + rounded_text(height) +
                        " pixels; use a smaller --scale (limits: 50 million pixels, 65000 per side)");
  }
  layout.width = static_cast<int>(width);
  layout.height = static_cast<int>(height);
  layout.per_u = width / static_cast<double>(slice.width);
  layout.per_v = height / static_cast<double>(slice.height);
  layout.canvas_width = layout.width + 2 * margin + legend_width;
  layout.canvas_height = std::max(layout.height, legend_width > 0 ? 160 : 1) + margin + caption_height;
  return layout;
}

/// Style that maps distances to colours and contour lines.
class DistanceStyle {
 public:
  explicit DistanceStyle(const Slice& slice)
      : signed_(slice.is_signed),
        band_(slice.band),
        scale_(signed_ ? ColorScale::diverging(slice.minimum, slice.maximum)
                       : ColorScale::sequential(0, slice.maximum)) {
    const double range = slice.maximum - slice.minimum;
    step_ = range > 0 && std::isfinite(range) ? round_step(range, 16) : 0;
  }

  [[nodiscard]] Color fill(double value) const { return beyond(value) ? nothing_color : scale_.color(value); }
  [[nodiscard]] bool beyond(double value) const {
    return !std::isfinite(value) || (band_ > 0 && std::abs(value) >= band_ * (1 - 1e-6));
  }
  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] bool has_surface() const { return signed_; }

  /// Draws contour lines over a colour, except the line of the surface. `slope` is the change of the value per pixel.
  [[nodiscard]] Color with_contours(const Color& color, double value, double slope) const {
    if (step_ <= 0 || beyond(value)) return color;
    const double level = std::round(value / step_);
    if (level == 0 || slope <= 0) return color;
    const bool strong = std::fmod(std::abs(level), 5) == 0;
    const double pixels = std::abs(value - level * step_) / slope;
    const double cover = std::clamp((strong ? 0.75 : 0.5) + 0.5 - pixels, 0.0, 1.0);
    // Lines less than 3 pixels apart would only darken the picture, so they fade out.
    const double room = std::clamp(step_ / slope / 3 - 1, 0.0, 1.0);
    return mix(color, ink_color, static_cast<float>(cover * room * steepness(slope) * (strong ? 0.55 : 0.28)));
  }
  [[nodiscard]] Color with_surface(const Color& color, double value, double slope) const {
    if (!signed_ || slope <= 0) return color;
    const double cover = std::clamp(1.8 - std::abs(value) / slope, 0.0, 1.0);
    return mix(color, ink_color, static_cast<float>(cover * steepness(slope)));
  }

 private:
  /// Returns a factor for the strength of a line: 0 on a plateau, 1 on slopes. A plateau at a contour's level must not
  /// become a line, and rounding would add noise to it. Its steep border gets a line.
  [[nodiscard]] double steepness(double slope) const {
    return step_ <= 0 ? 1 : std::clamp(slope / step_ * 500 - 0.25, 0.0, 1.0);
  }

  bool signed_;
  double band_;
  ColorScale scale_;
  double step_ = 0;
};

double slope_per_pixel(const Sample& sample, const Layout& layout) {
  return std::hypot(sample.slope_u / layout.per_u, sample.slope_v / layout.per_v);
}

/// Returns true if the distance becomes 0 at the place that its slope predicts. Near a kink the distance may increase
/// again before that place, and a line there would be wrong.
bool reaches_surface(const DistanceSampler& sampler, const Layout& layout, double u, double v, const Sample& sample) {
  const double squared = sample.slope_u * sample.slope_u + sample.slope_v * sample.slope_v;
  if (!(squared > 0)) return false;
  const double step = 1.1 * sample.value / squared;
  const Sample there = sampler.at(u - step * sample.slope_u, v - step * sample.slope_v);
  const double slack = 0.1 * slope_per_pixel(sample, layout);
  return std::abs(there.value) < 0.5 * std::abs(sample.value) + slack || (there.value > 0) != (sample.value > 0);
}

void for_each_row(const Layout& layout, const Context& context, const std::function<void(int)>& row) {
  parallel_for(context, static_cast<std::size_t>(layout.height), 16, "slice", [&](const WorkRange& range) {
    for (std::size_t y = range.begin; y < range.end; ++y) row(static_cast<int>(y));
  });
}

void draw_caption(Picture& picture, const std::string& text) {
  double height = text_height;
  while (height > 6 && text_width(text, height) > picture.width() - 2 * margin) height -= 0.5;
  draw_text(picture, margin, picture.height() - 12, height, text, ink_color);
}

int bar_height(const Layout& layout) {
  return std::clamp(layout.height - 24, 100, 640);
}

ColorBar legend_of(const Slice& slice, const DistanceStyle& style) {
  return {slice.minimum, slice.maximum, style.step(), "distance", [&style](double value, double per_pixel) {
            const Color lines = style.with_contours(style.fill(value), value, per_pixel);
            return style.with_surface(lines, value, per_pixel);
          }};
}

/// Sizes of regions, which determine the strength of their borders. Regions of a few pixels get no border.
class RegionSizes {
 public:
  RegionSizes(const Slice& slice, double pixels_per_node) {
    for (const SiteId id : slice.site) areas_[id.value] += pixels_per_node;
  }
  [[nodiscard]] std::size_t count() const { return areas_.size() - (areas_.contains(SiteId::none().value) ? 1 : 0); }
  [[nodiscard]] double border_strength(SiteId a, SiteId b) const {
    const double area = std::min(areas_.at(a.value), areas_.at(b.value));
    return std::clamp((area - 40) / 300, 0.0, 1.0);
  }

 private:
  std::unordered_map<std::uint32_t, double> areas_;
};

Color region_fill(SiteId id) {
  return id.has_value() ? region_color(id.value) : nothing_color;
}

Color region_pixel(const Slice& slice, const RegionSizes& sizes, const Layout& layout, double u, double v) {
  const RegionSample sample = region_at(slice, u, v);
  const Color color = region_fill(sample.site);
  if (sample.alone) return color;
  const double pixels = sample.margin / 1.5 * std::min(layout.per_u, layout.per_v);
  const double cover = std::clamp(1.1 - pixels, 0.0, 1.0);
  if (cover <= 0) return color;
  return mix(color, ink_color, static_cast<float>(cover * 0.6 * sizes.border_strength(sample.site, sample.rival)));
}

/// Changes the values of nodes beyond the band, which are all equal to its half-width. Nodes next to the band get
/// values that are extrapolated from inside the band. Other nodes get a larger value. So the edge of the band is drawn
/// at its true position, not along grid lines.
void continue_beyond_band(Slice& slice) {
  const std::vector<float> given = slice.distance;
  const auto limit = static_cast<float>(slice.band * (1 - 1e-6));
  // This value is so large that a smooth curve through it stays above the band's half-width.
  const double plateau = slice.band + 1.5 * std::min(slice.u_step, slice.v_step);
  const auto at = [&](std::int64_t i, std::int64_t j) { return given[static_cast<std::size_t>(j * slice.width + i)]; };
  const auto within = [&](std::int64_t i, std::int64_t j) {
    return i >= 0 && j >= 0 && i < slice.width && j < slice.height && std::abs(at(i, j)) < limit;
  };
  for (std::int64_t j = 0; j < slice.height; ++j) {
    for (std::int64_t i = 0; i < slice.width; ++i) {
      if (within(i, j)) continue;
      double sum = 0;
      int count = 0;
      for (std::int64_t dj = -1; dj <= 1; ++dj) {
        for (std::int64_t di = -1; di <= 1; ++di) {
          if (!within(i + di, j + dj) || !within(i + 2 * di, j + 2 * dj)) continue;
          const double near = std::abs(at(i + di, j + dj));
          sum += std::max(0.0, 2 * near - std::abs(at(i + 2 * di, j + 2 * dj)));
          ++count;
        }
      }
      const double expected = count == 0 ? plateau : std::clamp(sum / count, slice.band, plateau);
      float& node = slice.distance[static_cast<std::size_t>(j * slice.width + i)];
      node = static_cast<float>(std::copysign(expected, static_cast<double>(node)));
    }
  }
}

}  // namespace

std::optional<double> along_world(const GridSpec& grid, std::size_t axis) {
  const double along = grid.direction.columns[axis][axis];
  if (std::abs(along) != 1) return std::nullopt;
  return along;
}

Slice take_slice(const Field& field, std::size_t axis, std::int64_t index) {
  Slice slice;
  slice.axis = axis;
  slice.index = index;
  slice.u_axis = axis == 0 ? 1 : 0;
  slice.v_axis = axis == 2 ? 1 : 2;
  slice.width = field.grid.size[slice.u_axis];
  slice.height = field.grid.size[slice.v_axis];
  slice.u_step = field.grid.spacing[slice.u_axis];
  slice.v_step = field.grid.spacing[slice.v_axis];
  slice.is_signed = field.sign_rule != SignRule::none;
  slice.band = field.band.value_or(0);
  slice.minimum = std::numeric_limits<double>::infinity();
  slice.maximum = -std::numeric_limits<double>::infinity();
  const bool has_sites = !field.site.empty();
  std::array<std::int64_t, 3> node{};
  node[axis] = index;
  for (std::int64_t j = 0; j < slice.height; ++j) {
    for (std::int64_t i = 0; i < slice.width; ++i) {
      node[slice.u_axis] = i;
      node[slice.v_axis] = j;
      const std::size_t at = field.grid.index(node[0], node[1], node[2]);
      slice.distance.push_back(field.distance[at]);
      if (has_sites) slice.site.push_back(field.site[at]);
      const double value = field.distance[at];
      if (!std::isfinite(value)) continue;
      slice.minimum = std::min(slice.minimum, value);
      slice.maximum = std::max(slice.maximum, value);
    }
  }
  if (slice.minimum > slice.maximum) slice.minimum = slice.maximum = 0;
  if (slice.minimum < 0) slice.is_signed = true;  // files of other programs do not record if distances are signed
  const char* const names[] = {"x", "y", "z"};
  if (slice.band > 0) continue_beyond_band(slice);
  const std::int64_t layers = field.grid.size[axis];
  slice.place = layers == 1 ? "one layer" : "layer " + std::to_string(index) + " of 0 to " + std::to_string(layers - 1);
  if (const std::optional<double> along = along_world(field.grid, axis)) {
    const double place = field.grid.origin[axis] + *along * static_cast<double>(index) * field.grid.spacing[axis];
    slice.place = std::string(names[axis]) + " = " + rounded_text(place) + ", " + slice.place;
  } else {
    slice.place = std::string("axis ") + names[axis] + ", " + slice.place;
  }
  return slice;
}

double default_scale(const Slice& slice) {
  const double finest = std::min(slice.u_step, slice.v_step);
  const double longest =
      std::max(static_cast<double>(slice.width) * slice.u_step, static_cast<double>(slice.height) * slice.v_step) /
      finest;
  return longest > largest_side ? largest_side / longest : std::ceil(wanted_side / longest);
}

Picture distance_picture(const Slice& slice, double scale, const Context& context) {
  const DistanceStyle style(slice);
  Layout layout = make_layout(slice, scale, 0);
  const ColorBar legend = legend_of(slice, style);
  layout = make_layout(slice, scale, width_of(legend, bar_height(layout)) + margin);
  Picture picture(layout.canvas_width, layout.canvas_height, paper_color);
  const DistanceSampler sampler(slice);
  for_each_row(layout, context, [&](int y) {
    for (int x = 0; x < layout.width; ++x) {
      const Sample sample = sampler.at(layout.u(x), layout.v(y));
      Color color = style.fill(sample.value);
      if (sample.continuous && !style.beyond(sample.value)) {
        const Sample smooth = sampler.smoothed(layout.u(x), layout.v(y));
        color = style.with_contours(color, smooth.value, slope_per_pixel(smooth, layout));
        if (reaches_surface(sampler, layout, layout.u(x), layout.v(y), sample)) {
          color = style.with_surface(color, sample.value, slope_per_pixel(sample, layout));
        }
      }
      picture.at(margin + x, margin + y) = color;
    }
  });
  draw_frame(picture, margin, margin, layout.width, layout.height);
  draw(picture, legend, 2 * margin + layout.width, margin, bar_height(layout));
  draw_caption(picture, slice.place + (style.step() > 0 ? ", contours every " + rounded_text(style.step()) : ""));
  return picture;
}

Picture sites_picture(const Slice& slice, double scale, const Context& context) {
  const Layout layout = make_layout(slice, scale, 0);
  Picture picture(layout.canvas_width, layout.canvas_height, paper_color);
  const RegionSizes sizes(slice, layout.per_u * layout.per_v);
  const DistanceStyle style(slice);
  const DistanceSampler sampler(slice);
  for_each_row(layout, context, [&](int y) {
    for (int x = 0; x < layout.width; ++x) {
      const double u = layout.u(x);
      const double v = layout.v(y);
      const double du = 0.25 / layout.per_u;
      const double dv = 0.25 / layout.per_v;
      const Color top = mix(region_pixel(slice, sizes, layout, u - du, v + dv),
                            region_pixel(slice, sizes, layout, u + du, v + dv), 0.5F);
      const Color bottom = mix(region_pixel(slice, sizes, layout, u - du, v - dv),
                               region_pixel(slice, sizes, layout, u + du, v - dv), 0.5F);
      const Sample sample = sampler.at(u, v);
      Color color = mix(top, bottom, 0.5F);
      if (sample.continuous && reaches_surface(sampler, layout, u, v, sample))
        color = style.with_surface(color, sample.value, slope_per_pixel(sample, layout));
      picture.at(margin + x, margin + y) = color;
    }
  });
  draw_frame(picture, margin, margin, layout.width, layout.height);
  draw_caption(picture, slice.place + ", " + plural(sizes.count(), "region", "regions"));
  return picture;
}

}  // namespace blum::cli
