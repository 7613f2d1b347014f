#include "blum/surface_map/surface_map_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "blum/core/vec3.hpp"
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

/// Values of small parts of the surface. Their weights are the areas of these parts, for the mesh multiplied by a
/// scale.
using PartValues = std::vector<surface::SpreadValue>;

/// Divides triangles into the squares of texels, and finds a value for each part.
///
/// A part at the border of a triangle is smaller than its square, and its texel may belong to a neighbouring triangle.
/// So the value at the centroid of the part is extrapolated from the texel's point, along the gradient of the distance.
/// The gradient is the unit vector away from the closest point. Its component along the triangle also gives the spread
/// of the values in the part. Thickness has no gradient of this kind, and may jump between triangles. So parts of
/// thickness maps use only texels of their own triangle, without extrapolation.
class SurfaceDivider {
 public:
  SurfaceDivider(const MeshView& mesh, const SurfaceMap& map)
      : map_(map),
        atlas_(*map.atlas),
        charts_{mesh, *map.atlas},
        is_smooth_(map.quantity == SurfaceQuantity::distance && map.vector.size() == map.distance.size()),
        own_texels_(mesh.triangles.size(), 0) {
    for (const TriangleId triangle : atlas_.triangle) {
      if (triangle.has_value()) ++own_texels_[triangle.value];
    }
  }

  [[nodiscard]] double scale() const { return charts_.scale; }

  [[nodiscard]] PartValues divide() {
    PartValues out;
    out.reserve(atlas_.size());
    std::vector<std::uint32_t> undivided;
    for (std::uint32_t t = 0; t < own_texels_.size(); ++t) {
      if (own_texels_[t] > 0 && !divide(t, out)) undivided.push_back(t);
    }
    if (!undivided.empty()) share_evenly(undivided, out);
    return out;
  }

 private:
  struct Part {
    std::size_t texel = 0;
    TexturePlace centroid;
    double area = 0;  ///< square texels
  };

  /// @return  false if the chart of a triangle has no area that texels cover.
  bool divide(std::uint32_t t, PartValues& out) {
    const surface::ChartCorners& places = atlas_.corners[t];
    if (!surface::has_area(places)) return false;
    parts_.clear();
    double covered = 0;
    surface::for_each_texel(places, atlas_.width, atlas_.height, [&](std::size_t x, std::size_t y, double) {
      const std::size_t texel = y * atlas_.width + x;
      const TriangleId owner = atlas_.triangle[texel];
      if (!owner.has_value() || (!is_smooth_ && owner.value != t)) return;
      const surface::ChartPart part = surface::part_around(places, surface::middle_of(x, y), 0.5);
      const double area = surface::area_of(part);
      if (!(area > 0)) return;
      parts_.push_back({texel, surface::centroid_of(part), area});
      covered += area;
    });
    if (!(covered > 0)) return false;
    const surface::Chart chart = charts_[t];
    const Vec3d normal = normal_of(t);
    const double whole = 0.5 * length(normal);
    for (const Part& part : parts_) add_part(part, t, chart, normal, whole * (part.area / covered), out);
    return true;
  }

  /// Adds a part with the value at its centroid.
  /// @param normal  normal_of() the triangle.
  /// @param area    area of the part, for the scaled mesh.
  void add_part(const Part& part, std::uint32_t t, const surface::Chart& chart, const Vec3d& normal, double area,
                PartValues& out) const {
    const double value = map_.distance[part.texel];
    Vec3d to_closest;
    if (is_smooth_) {
      const Vec3f& v = map_.vector[part.texel];
      to_closest = {v.x, v.y, v.z};
    }
    const double size = length(to_closest);
    if (!std::isfinite(value) || !(size > 0)) {
      out.push_back({value, 0, area});
      return;
    }
    const double change = -dot(to_closest, way_to_centroid(part, t, chart)) / size;
    const double along = length(cross(to_closest, normal)) / (size * length(normal));
    out.push_back({value + (value < 0 ? -change : change), 0.5 * along * std::sqrt(area) / charts_.scale, area});
  }

  /// Returns the vector from the point of a part's texel to the centroid of the part, mesh units.
  [[nodiscard]] Vec3d way_to_centroid(const Part& part, std::uint32_t t, const surface::Chart& chart) const {
    const TexturePlace middle = surface::middle_of(part.texel % atlas_.width, part.texel / atlas_.width);
    const std::uint32_t owner = atlas_.triangle[part.texel].value;
    const bool is_own = owner == t;
    if (is_own && part.area == 1) return {};  // the centroid is the texel's point
    const Vec3d from = is_own ? chart.on_triangle(middle) : charts_[owner].on_triangle(middle);
    return (chart.in_plane(part.centroid) - from) / charts_.scale;
  }

  /// Returns a vector at right angles to a triangle, twice as long as its area, for the scaled mesh.
  [[nodiscard]] Vec3d normal_of(std::uint32_t t) const {
    const auto [a, b, c] = triangle_corners(charts_.mesh, t);
    return cross((b - a) * charts_.scale, (c - a) * charts_.scale);
  }

  /// Divides triangles evenly among their texels.
  void share_evenly(const std::vector<std::uint32_t>& triangles, PartValues& out) const {
    std::vector<bool> is_shared(own_texels_.size(), false);
    for (const std::uint32_t t : triangles) is_shared[t] = true;
    for (std::size_t k = 0; k < atlas_.size(); ++k) {
      const TriangleId triangle = atlas_.triangle[k];
      if (!triangle.has_value() || !is_shared[triangle.value]) continue;
      out.push_back({map_.distance[k], 0, 0.5 * length(normal_of(triangle.value)) / own_texels_[triangle.value]});
    }
  }

  const SurfaceMap& map_;
  const SurfaceAtlas& atlas_;
  surface::ScaledCharts charts_;
  bool is_smooth_;
  std::vector<std::uint32_t> own_texels_;  ///< number of texels of each triangle
  std::vector<Part> parts_;                ///< parts of one triangle
};

}  // namespace

SurfaceMapStatistics surface_map_statistics(const MeshView& mesh, const SurfaceMap& map) {
  check(mesh, map);
  SurfaceDivider divider(mesh, map);
  const double scale = divider.scale();
  PartValues parts = divider.divide();
  std::erase_if(parts, [](const surface::SpreadValue& part) { return !(part.weight > 0); });
  LongSum area;
  for (const surface::SpreadValue& part : parts) area.add(part.weight);
  std::erase_if(parts, [](const surface::SpreadValue& part) { return !std::isfinite(part.middle); });
  LongSum measured;
  LongSum sum;
  double magnitude = 0;
  for (const surface::SpreadValue& part : parts) {
    measured.add(part.weight);
    sum.add(part.weight * part.middle);
    magnitude = std::max(magnitude, std::abs(part.middle));
  }
  SurfaceMapStatistics out;
  out.area = area.value() / scale / scale;
  if (parts.empty()) return out;
  out.measured_area = measured.value() / scale / scale;
  out.mean = sum.value() / measured.value();
  out.rms = surface::root_mean_square(parts, magnitude, measured.value());
  std::tie(out.smallest, out.largest) = map.finite_range().value();
  out.percentiles = surface::percentiles(parts, SurfaceMapStatistics::percents);
  for (double& p : out.percentiles) p = std::clamp(p, out.smallest, out.largest);
  return out;
}

}  // namespace blum
