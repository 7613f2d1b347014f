#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "blum/core/parallel.hpp"
#include "blum/surface_map/surface_atlas.hpp"
#include "surface_map/chart.hpp"

namespace blum {
namespace {

using surface::Chart;
using surface::ChartCorners;
using surface::ChartPart;
using surface::check_fits;
using surface::middle_of;
using surface::part_around;
using surface::ScaledCharts;

constexpr std::size_t texels_per_range = 1 << 14;

/// Returns the largest distance of `point` from points of a chart at which a texel is read. These points are the part
/// of the chart in the square of 2 x 2 texels around the texel's middle. The furthest of them is a corner of that part.
double furthest_reader(const Chart& chart, const ChartCorners& places, const TexturePlace& middle, const Vec3d& point) {
  const ChartPart left = part_around(places, middle, 1);
  double furthest = 0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    furthest = std::max(furthest, length(chart.in_plane(left.data()[k]) - point));
  }
  return furthest;
}

double reach_of(const ScaledCharts& charts, std::uint32_t triangle) {
  const SurfaceAtlas& atlas = charts.atlas;
  const ChartCorners& places = atlas.corners[triangle];
  if (!surface::has_area(places)) return HUGE_VAL;
  const Chart chart = charts[triangle];
  const double own = chart.stretch() * std::sqrt(0.5);
  if (atlas.is_separate) return own / charts.scale;
  double others = 0;
  surface::for_each_texel(places, atlas.width, atlas.height, [&](std::size_t x, std::size_t y, double /*outside*/) {
    const TriangleId owner = atlas.triangle[y * atlas.width + x];
    if (owner == TriangleId(triangle)) return;
    const TexturePlace middle = middle_of(x, y);
    const Vec3d point = charts[owner.value].on_triangle(middle);
    others = std::max(others, furthest_reader(chart, places, middle, point));
  });
  return (own + others) / charts.scale;
}

}  // namespace

Vec3d surface_point(const MeshView& mesh, const SurfaceAtlas& atlas, std::size_t texel) {
  const ScaledCharts charts{mesh, atlas};
  const Chart chart = charts[atlas.triangle[texel].value];
  return chart.on_triangle(middle_of(texel % atlas.width, texel / atlas.width)) / charts.scale;
}

SurfaceTexels surface_texels(const MeshView& mesh, const SurfaceAtlas& atlas, const Context& context) {
  check_fits(mesh, atlas);
  const std::size_t ranges = (atlas.size() + texels_per_range - 1) / texels_per_range;
  std::vector<std::size_t> first(ranges + 1, 0);
  parallel_for(context, atlas.size(), texels_per_range, "", [&](const WorkRange& range) {
    std::size_t count = 0;
    for (std::size_t k = range.begin; k < range.end; ++k) count += atlas.triangle[k].has_value() ? 1 : 0;
    first[range.begin / texels_per_range + 1] = count;
  });
  for (std::size_t k = 0; k < ranges; ++k) first[k + 1] += first[k];
  SurfaceTexels out{std::vector<std::uint32_t>(first.back()), std::vector<Vec3d>(first.back())};
  const ScaledCharts scaled{mesh, atlas};
  std::vector<Chart> charts;
  charts.reserve(atlas.corners.size());
  for (std::uint32_t t = 0; t < atlas.corners.size(); ++t) charts.push_back(scaled[t]);
  parallel_for(context, atlas.size(), texels_per_range, "", [&](const WorkRange& range) {
    std::size_t next = first[range.begin / texels_per_range];
    for (std::size_t k = range.begin; k < range.end; ++k) {
      if (!atlas.triangle[k].has_value()) continue;
      out.texels[next] = static_cast<std::uint32_t>(k);
      const TexturePlace middle = middle_of(k % atlas.width, k / atlas.width);
      out.points[next] = charts[atlas.triangle[k].value].on_triangle(middle) / scaled.scale;
      ++next;
    }
  });
  return out;
}

std::vector<double> texel_reaches(const MeshView& mesh, const SurfaceAtlas& atlas, const Context& context) {
  check_fits(mesh, atlas);
  const ScaledCharts charts{mesh, atlas};
  std::vector<double> out(mesh.triangles.size());
  parallel_for(context, out.size(), 256, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) out[t] = reach_of(charts, static_cast<std::uint32_t>(t));
  });
  return out;
}

}  // namespace blum
