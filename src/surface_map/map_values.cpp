#include "surface_map/map_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/scale.hpp"
#include "blum/geometry/space_order.hpp"
#include "surface_map/chart.hpp"

namespace blum::surface {
namespace {

constexpr std::size_t triangles_per_range = 256;

/// Calls visit(texel) for the texels that belong to a triangle.
template <class Visit>
void for_each_own_texel(const SurfaceAtlas& atlas, std::uint32_t triangle, Visit visit) {
  const ChartCorners& places = atlas.corners[triangle];
  if (!has_area(places)) return;
  for_each_texel(places, atlas.width, atlas.height, [&](std::size_t x, std::size_t y, double /*outside*/) {
    const std::size_t texel = y * atlas.width + x;
    if (atlas.triangle[texel] == TriangleId(triangle)) visit(static_cast<std::uint32_t>(texel));
  });
}

constexpr std::size_t texels_per_range = 512;
constexpr std::size_t default_texels = 1'000'000;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

SurfaceMap::FaceSummary summary_of(const SurfaceMap& map, std::span<const std::uint32_t> texels) {
  if (texels.empty()) return {nan, nan, nan};
  SurfaceMap::FaceSummary out{std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), nan};
  double sum = 0;
  std::size_t count = 0;
  for (const std::uint32_t texel : texels) {
    const float value = map.distance[texel];
    out.smallest = std::min(out.smallest, value);
    out.largest = std::max(out.largest, value);
    if (!std::isfinite(value)) continue;
    sum += value;
    ++count;
  }
  if (count > 0) out.mean = static_cast<float>(sum / static_cast<double>(count));
  return out;
}

/// Returns the largest finite magnitude of a distance that is read in the chart of a triangle. Returns infinity if a
/// distance is too large for float32, or if the chart has no area.
double largest_read(const SurfaceMap& map, std::size_t triangle) {
  const SurfaceMap::FaceSummary& own = map.faces[triangle];
  const float largest = std::max(std::abs(own.smallest), std::abs(own.largest));
  if (map.atlas->is_separate && std::isfinite(largest)) return largest;
  const SurfaceAtlas& atlas = *map.atlas;
  if (!has_area(atlas.corners[triangle])) return HUGE_VAL;
  double out = 0;
  for_each_texel(atlas.corners[triangle], atlas.width, atlas.height, [&](std::size_t x, std::size_t y, double) {
    const std::size_t texel = y * atlas.width + x;
    const double here = std::abs(map.distance[texel]);
    if (std::isfinite(here) || map.site[texel].has_value()) out = std::max(out, here);
  });
  return out;
}

}  // namespace

TexelOrder texel_order(const MeshView& mesh, const SurfaceAtlas& atlas, const Context& context) {
  TexelOrder out;
  const std::size_t count = mesh.triangles.size();
  const auto middle = [&](std::size_t t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    return a / 3.0 + b / 3.0 + c / 3.0;
  };
  out.triangles = space_order(count, middle, context);
  out.first.assign(count + 1, 0);
  parallel_for(context, count, triangles_per_range, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      std::size_t texels = 0;
      for_each_own_texel(atlas, out.triangles[k], [&](std::uint32_t /*texel*/) { ++texels; });
      out.first[k + 1] = texels;
    }
  });
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  out.texels.resize(out.first.back());
  parallel_for(context, count, triangles_per_range, "", [&](const WorkRange& range) {
    std::size_t next = out.first[range.begin];
    for (std::size_t k = range.begin; k < range.end; ++k) {
      for_each_own_texel(atlas, out.triangles[k], [&](std::uint32_t texel) { out.texels[next++] = texel; });
    }
  });
  return out;
}

void find_points(const MeshView& mesh, const SurfaceAtlas& atlas, double scale, const TexelOrder& order,
                 std::size_t begin, std::size_t end, std::vector<Vec3d>& points) {
  const ScaledCharts charts{mesh, atlas, scale};
  const double unscale = 1 / scale;  // a power of two
  points.resize(end - begin);
  auto next = std::upper_bound(order.first.begin(), order.first.end(), begin);
  for (std::size_t k = begin; k < end; ++next) {
    const std::size_t last = std::min(end, *next);
    if (k == last) continue;
    const auto rank = static_cast<std::size_t>(next - order.first.begin()) - 1;
    const Chart chart = charts[order.triangles[rank]];
    // The texels of a triangle are sorted by row.
    std::size_t y = order.texels[k] / atlas.width;
    std::size_t row = y * atlas.width;
    for (; k < last; ++k) {
      for (; order.texels[k] - row >= atlas.width; row += atlas.width) ++y;
      points[k - begin] = chart.on_triangle(middle_of(order.texels[k] - row, y)) * unscale;
    }
  }
}

std::vector<TriangleId> triangles_at_vertices(const MeshView& mesh) {
  std::vector<TriangleId> out(mesh.vertices.size(), TriangleId::none());
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    for (const std::uint32_t v : mesh.triangles[t]) out[v] = TriangleId(static_cast<std::uint32_t>(t));
  }
  return out;
}

SurfaceMap empty_map(std::shared_ptr<const SurfaceAtlas> atlas, SurfaceQuantity quantity) {
  SurfaceMap out;
  const std::size_t size = atlas->size();
  out.distance = Buffer<float>(size, nan);
  out.vector = Buffer<Vec3f>(size, Vec3f{});
  out.site = Buffer<SiteId>(size, SiteId::none());
  out.quantity = quantity;
  out.atlas = std::move(atlas);
  return out;
}

void warn_of_nothing(SurfaceMap& map, const char* text) {
  if (std::any_of(map.site.begin(), map.site.end(), [](SiteId site) { return site.has_value(); })) return;
  map.warnings.emplace_back(WarningCode::nothing_found, text);
}

void put(SurfaceMap& map, std::size_t texel, const Vec3d& point, const SurfaceValue& value) {
  const Vec3d way = value.closest - point;
  map.distance[texel] = static_cast<float>(value.distance);
  map.vector[texel] = {static_cast<float>(way.x), static_cast<float>(way.y), static_cast<float>(way.z)};
  map.site[texel] = value.site;
}

void fill_texels(SurfaceMap& map, const TexelOrder& order, std::size_t texels_per_range,
                 FunctionRef<void(std::size_t begin, std::size_t end)> fill_range, const Context& context) {
  map.faces.resize(order.triangles.size());
  parallel_for(context, order.texels.size(), texels_per_range, "surface map", [&](const WorkRange& range) {
    fill_range(range.begin, range.end);
    // Triangles are summarized here, while their values are in the caches.
    const auto first = std::lower_bound(order.first.begin(), order.first.end(), range.begin);
    for (auto k = static_cast<std::size_t>(first - order.first.begin()); order.first[k] < range.end; ++k) {
      if (order.first[k + 1] <= range.end) map.faces[order.triangles[k]] = summary_of(map, order.of(k));
    }
  });
  // This loop summarizes the other triangles: those with texels in more than one range, and those without texels, which
  // may come after the last range.
  parallel_for(context, map.faces.size(), triangles_per_range, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      const std::size_t begin = order.first[k];
      const std::size_t end = order.first[k + 1];
      const bool is_in_one = begin < end && begin / texels_per_range == (end - 1) / texels_per_range;
      if (!is_in_one) map.faces[order.triangles[k]] = summary_of(map, order.of(k));
    }
  });
}

void fill(SurfaceMap& map, const MeshView& mesh, const TexelOrder& order, ValueAt value_at, const Context& context) {
  const SurfaceAtlas& atlas = *map.atlas;
  const double scale = scale_to_one(bounds(mesh).largest_coordinate());
  const auto fill_range = [&](std::size_t begin, std::size_t end) {
    const std::span texels = std::span(order.texels).subspan(begin, end - begin);
    std::vector<Vec3d> points;
    find_points(mesh, atlas, scale, order, begin, end, points);
    SurfaceValue last;
    for (std::size_t k = 0; k < texels.size(); ++k) {
      last = value_at(points[k], atlas.triangle[texels[k]], k > 0 ? &last : nullptr);
      put(map, texels[k], points[k], last);
    }
  };
  fill_texels(map, order, texels_per_range, fill_range, context);
  const std::vector<TriangleId> triangles = triangles_at_vertices(mesh);
  map.vertex_distance.assign(mesh.vertices.size(), std::numeric_limits<double>::quiet_NaN());
  parallel_for(context, mesh.vertices.size(), texels_per_range, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      if (!triangles[v].has_value()) continue;
      map.vertex_distance[v] = value_at(mesh.vertices[v], triangles[v], nullptr).distance;
    }
  });
}

void bound_errors(SurfaceMap& map, const MeshView& mesh, bool may_jump, const Context& context) {
  const std::vector<double> reaches = texel_reaches(mesh, *map.atlas, context);
  const double extent = bounds(mesh).largest_coordinate();
  map.error.resize(reaches.size());
  parallel_for(context, reaches.size(), triangles_per_range, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const double largest = largest_read(map, t);
      // Texels are stored as float32. Below 1e-38, the steps between float32 numbers all have the same length. Points
      // are also rounded.
      const double rounding = 1.2e-7 * largest + std::numeric_limits<float>::denorm_min() + 4e-15 * (extent + largest);
      const double jump = may_jump ? 2 * largest : 0;
      map.error[t] = static_cast<float>((reaches[t] + rounding + jump) * (1 + 1e-6));
    }
  });
}

std::shared_ptr<const SurfaceAtlas> make_atlas(const MeshView& mesh, const SurfaceMapOptions& options,
                                               const Context& context) {
  return std::make_shared<const SurfaceAtlas>(options.texel ? surface_atlas(mesh, *options.texel, context)
                                                            : surface_atlas_of_size(mesh, default_texels, context));
}

void check(const SurfaceMapOptions& options) {
  if (options.texel && !(*options.texel > 0 && std::isfinite(*options.texel))) {
    throw InvalidOption("texel is " + exact_text(*options.texel) + ", but must be above 0");
  }
  if (options.max_distance && !(*options.max_distance >= 0)) {
    throw InvalidOption("max_distance is " + exact_text(*options.max_distance) + ", but must be at least 0");
  }
}

}  // namespace blum::surface
