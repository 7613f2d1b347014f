#include "blum/surface_map/surface_map_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
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

/// Twice the area of a triangle of a texture from a place on: positive where a, b, c turn as x to y.
double turn(const TexturePlace& a, const TexturePlace& b, const TexturePlace& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Which part of a texel's square a chart covers, 0 to 1 (Sutherland and Hodgman 1974).
double covered_part(const std::array<TexturePlace, 3>& chart, double x, double y) {
  const double way = turn(chart[0], chart[1], chart[2]) < 0 ? -1 : 1;
  std::vector<TexturePlace> polygon{{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}};
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<TexturePlace> inside;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const TexturePlace& from = polygon[i];
      const TexturePlace& to = polygon[(i + 1) % polygon.size()];
      const double before = way * turn(chart[k], chart[(k + 1) % 3], from);
      const double after = way * turn(chart[k], chart[(k + 1) % 3], to);
      if (before >= 0) inside.push_back(from);
      if (before * after >= 0) continue;
      const double part = before / (before - after);
      inside.push_back({from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)});
    }
    polygon = std::move(inside);
  }
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) twice += turn(polygon[0], polygon[i - 1], polygon[i]);
  return std::abs(twice) / 2;
}

/// The area of the surface that each texel stands for, of the mesh times a scale: its triangle's, shared out by what
/// the triangle's chart covers of the texels, or evenly where that is nothing.
std::vector<double> texel_areas(const MeshView& mesh, const SurfaceAtlas& atlas, double scale) {
  std::vector<double> out(atlas.size());
  std::vector<double> sums(mesh.triangles.size());
  std::vector<std::uint32_t> counts(mesh.triangles.size());
  for (std::size_t k = 0; k < atlas.size(); ++k) {
    const TriangleId triangle = atlas.triangle[k];
    if (!triangle.has_value()) continue;
    const auto x = static_cast<double>(k % atlas.width);
    const auto y = static_cast<double>(k / atlas.width);
    out[k] = covered_part(atlas.corners[triangle.value], x, y);
    sums[triangle.value] += out[k];
    ++counts[triangle.value];
  }
  for (std::size_t k = 0; k < atlas.size(); ++k) {
    const TriangleId triangle = atlas.triangle[k];
    if (!triangle.has_value()) continue;
    const auto [a, b, c] = triangle_corners(mesh, triangle.value);
    const double area = length(cross((b - a) * scale, (c - a) * scale)) / 2;
    out[k] = area * (sums[triangle.value] > 0 ? out[k] / sums[triangle.value] : 1.0 / counts[triangle.value]);
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
