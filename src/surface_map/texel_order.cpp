#include "surface_map/texel_order.hpp"

#include <algorithm>
#include <numeric>

#include "blum/core/parallel.hpp"
#include "blum/geometry/space_order.hpp"
#include "surface_map/chart.hpp"

namespace blum::surface {
namespace {

constexpr std::size_t triangles_per_range = 256;

/// Calls visit(texel) for the texels that a triangle has.
template <class Visit>
void for_each_own_texel(const SurfaceAtlas& atlas, std::uint32_t triangle, Visit visit) {
  const ChartCorners& places = atlas.corners[triangle];
  if (!has_area(places)) return;
  for_each_texel(places, atlas.width, atlas.height, [&](std::size_t x, std::size_t y, double /*outside*/) {
    const std::size_t texel = y * atlas.width + x;
    if (atlas.triangle[texel] == TriangleId(triangle)) visit(static_cast<std::uint32_t>(texel));
  });
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
    // Texels come row by row.
    std::size_t y = order.texels[k] / atlas.width;
    std::size_t row = y * atlas.width;
    for (; k < last; ++k) {
      for (; order.texels[k] - row >= atlas.width; row += atlas.width) ++y;
      points[k - begin] = chart.on_triangle(middle_of(order.texels[k] - row, y)) * unscale;
    }
  }
}

}  // namespace blum::surface
