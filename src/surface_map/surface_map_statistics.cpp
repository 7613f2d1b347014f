#include "blum/surface_map/surface_map_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/scale.hpp"
#include "surface_map/chart.hpp"
#include "surface_map/weighted_statistics.hpp"

namespace blum {
namespace {

using surface::LongSum;

void check(const MeshView& mesh, const SurfaceMap& map) {
  if (map.atlas == nullptr) throw InvalidMesh("the surface map has no atlas");
  const SurfaceAtlas& atlas = *map.atlas;
  surface::check_fits(mesh, atlas);
  if (map.distance.size() != atlas.size()) {
    throw InvalidMesh("the surface map has " + std::to_string(map.distance.size()) + " distances, but " +
                      std::to_string(atlas.size()) + " texels");
  }
  for (const TriangleId triangle : atlas.triangle) {
    if (triangle.has_value() && triangle.value >= mesh.triangles.size()) {
      throw InvalidMesh("the surface map uses triangle " + std::to_string(triangle.value) + ", but the mesh has " +
                        std::to_string(mesh.triangles.size()) + " triangles");
    }
  }
}

/// Returns the area of the surface that each texel represents, for the mesh multiplied by a scale. The area of a
/// triangle is divided among its texels in proportion to the part of each texel that its chart covers. If the chart
/// covers none of them, the area is divided evenly.
std::vector<double> texel_areas(const MeshView& mesh, const SurfaceAtlas& atlas, double scale) {
  std::vector<double> out(atlas.size());
  std::vector<double> sums(mesh.triangles.size());
  std::vector<std::uint32_t> counts(mesh.triangles.size());
  for (std::size_t k = 0; k < atlas.size(); ++k) {
    const TriangleId triangle = atlas.triangle[k];
    if (!triangle.has_value()) continue;
    const TexturePlace middle = surface::middle_of(k % atlas.width, k / atlas.width);
    out[k] = surface::area_of(surface::part_around(atlas.corners[triangle.value], middle, 0.5));
    sums[triangle.value] += out[k];
    ++counts[triangle.value];
  }
  std::vector<double> areas(mesh.triangles.size());
  for (std::size_t t = 0; t < areas.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    areas[t] = length(cross((b - a) * scale, (c - a) * scale)) / 2;
  }
  for (std::size_t k = 0; k < atlas.size(); ++k) {
    const TriangleId triangle = atlas.triangle[k];
    if (!triangle.has_value()) continue;
    const std::size_t t = triangle.value;
    out[k] = areas[t] * (sums[t] > 0 ? out[k] / sums[t] : 1.0 / counts[t]);
  }
  return out;
}

}  // namespace

SurfaceMapStatistics surface_map_statistics(const MeshView& mesh, const SurfaceMap& map) {
  check(mesh, map);
  const double scale = scale_to_one(bounds(mesh).largest_coordinate());
  const SurfaceAtlas& atlas = *map.atlas;
  const std::vector<double> areas = texel_areas(mesh, atlas, scale);
  std::vector<double> values;
  std::vector<double> weights;
  LongSum area;
  LongSum measured;
  LongSum sum;
  for (std::size_t k = 0; k < atlas.size(); ++k) {
    const TriangleId triangle = atlas.triangle[k];
    if (!triangle.has_value() || !(areas[k] > 0)) continue;
    const double weight = areas[k];
    area.add(weight);
    const double value = map.distance[k];
    if (!std::isfinite(value)) continue;
    measured.add(weight);
    sum.add(weight * value);
    values.push_back(value);
    weights.push_back(weight);
  }
  SurfaceMapStatistics out;
  out.area = area.value() / scale / scale;
  if (values.empty()) return out;
  const auto [smallest, largest] = std::minmax_element(values.begin(), values.end());
  const double magnitude = std::max(std::abs(*smallest), std::abs(*largest));
  out.measured_area = measured.value() / scale / scale;
  out.mean = sum.value() / measured.value();
  out.rms = surface::root_mean_square(values, weights, magnitude, measured.value());
  out.smallest = *smallest;
  out.largest = *largest;
  out.percentiles = surface::percentiles(values, weights, measured.value(), SurfaceMapStatistics::percents);
  return out;
}

}  // namespace blum
