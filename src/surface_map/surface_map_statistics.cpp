#include "blum/surface_map/surface_map_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "blum/core/scale.hpp"
#include "surface_map/weighted_statistics.hpp"

namespace blum {
namespace {

using surface::LongSum;

void check_fit(const MeshView& mesh, const SurfaceMap& map) {
  validate(mesh);
  if (map.atlas == nullptr) throw InvalidMesh("the surface map has no atlas");
  const SurfaceAtlas& atlas = *map.atlas;
  if (atlas.corners.size() != mesh.triangles.size()) {
    throw InvalidMesh("the surface map is of " + std::to_string(atlas.corners.size()) +
                      " triangles, but the mesh has " + std::to_string(mesh.triangles.size()));
  }
  if (map.distance.size() != atlas.size()) {
    throw InvalidMesh("the surface map has " + std::to_string(map.distance.size()) + " distances, but " +
                      std::to_string(atlas.size()) + " texels");
  }
  for (const TriangleId triangle : atlas.triangle) {
    if (triangle.has_value() && triangle.value >= mesh.triangles.size()) {
      throw InvalidMesh("the surface map names triangle " + std::to_string(triangle.value) + ", but the mesh has " +
                        std::to_string(mesh.triangles.size()) + " triangles");
    }
  }
}

/// The area that a texel of each triangle stands for, of the mesh times a scale; 0 where a triangle has no texel.
std::vector<double> texel_areas(const MeshView& mesh, const SurfaceAtlas& atlas, double scale) {
  std::vector<std::uint32_t> counts(mesh.triangles.size());
  for (const TriangleId triangle : atlas.triangle) {
    if (triangle.has_value()) ++counts[triangle.value];
  }
  std::vector<double> out(counts.size());
  for (std::size_t t = 0; t < counts.size(); ++t) {
    if (counts[t] == 0) continue;
    const auto [a, b, c] = triangle_corners(mesh, t);
    out[t] = length(cross((b - a) * scale, (c - a) * scale)) / 2 / counts[t];
  }
  return out;
}

}  // namespace

SurfaceMapStatistics surface_map_statistics(const MeshView& mesh, const SurfaceMap& map) {
  check_fit(mesh, map);
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
    if (!triangle.has_value() || !(areas[triangle.value] > 0)) continue;
    const double weight = areas[triangle.value];
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
