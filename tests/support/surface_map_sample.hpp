// Blum: a surface map with known values. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_distance_map.hpp"

namespace blum::test {

/// A box with one square chart per side, three in a row. The map contains a linear function, which bilinear reading of
/// the texture reproduces.
class BoxMap {
 public:
  static constexpr std::uint32_t side = 16;   ///< texels of a chart
  static constexpr std::uint32_t gutter = 8;  ///< texels around each chart
  static constexpr std::uint32_t cell = side + 2 * gutter;

  TriangleMesh mesh;
  SurfaceMap map;

  /// @param first    the value at the centre of the box.
  /// @param nothing  a side whose texels have no distance, 0 to 5; -1: none.
  explicit BoxMap(double first, int nothing = -1) : first_(first) {
    for (std::uint32_t v = 0; v < 8; ++v) mesh.vertices.push_back(corner(v));
    auto atlas = std::make_shared<SurfaceAtlas>();
    atlas->width = 3 * cell;
    atlas->height = 2 * cell;
    atlas->is_separate = false;  // the two triangles of a side share a chart
    const std::size_t texels = std::size_t{atlas->width} * atlas->height;
    atlas->triangle = Buffer<TriangleId>(texels, TriangleId::none());
    map.distance = Buffer<float>(texels, std::numeric_limits<float>::quiet_NaN());
    map.vector = Buffer<Vec3f>(texels, Vec3f{});
    map.site = Buffer<SiteId>(texels, SiteId::none());
    for (std::uint32_t s = 0; s < 6; ++s) add_side(*atlas, s, static_cast<int>(s) == nothing);
    for (const Vec3d& vertex : mesh.vertices) map.vertex_distance.push_back(value_at(vertex));
    map.atlas = std::move(atlas);
    map.sign_rule = first < 2 ? SignRule::winding : SignRule::none;
    map.sign_reason = "made for tests";
  }

  /// The value at a point: between first - 2.75 and first + 2.75 on the box.
  [[nodiscard]] double value_at(const Vec3d& p) const { return first_ + p.x + 2 * p.y + 3 * p.z; }

 private:
  static Vec3d corner(std::uint32_t v) {
    return {(v & 1) != 0 ? 1.0 : -1.0, (v & 2) != 0 ? 0.5 : -0.5, (v & 4) != 0 ? 0.25 : -0.25};
  }

  void add_side(SurfaceAtlas& atlas, std::uint32_t s, bool is_nothing) {
    // The corners of each side, counter-clockwise as seen from outside.
    constexpr std::array<std::array<std::uint32_t, 4>, 6> sides{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    const auto& [a, b, c, d] = sides[s];
    const double left = (s % 3) * cell + gutter;
    const double top = (s / 3) * cell + gutter;  // NOLINT: whole on purpose
    const std::array<TexturePlace, 4> places{
        {{left, top}, {left + side, top}, {left + side, top + side}, {left, top + side}}};
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
    atlas.corners.push_back({places[0], places[1], places[2]});
    atlas.corners.push_back({places[0], places[2], places[3]});
    const Vec3d origin = mesh.vertices[a];
    const Vec3d u_step = (mesh.vertices[b] - origin) / double{side};
    const Vec3d v_step = (mesh.vertices[d] - origin) / double{side};
    for (int v = -1; v <= static_cast<int>(side); ++v) {  // bilinear reading uses one more texel on each side
      for (int u = -1; u <= static_cast<int>(side); ++u) {
        const auto x = static_cast<std::size_t>(left) + static_cast<std::size_t>(u + 1) - 1;
        const auto y = static_cast<std::size_t>(top) + static_cast<std::size_t>(v + 1) - 1;
        const std::size_t texel = y * atlas.width + x;
        const double value = value_at(origin + u_step * (u + 0.5) + v_step * (v + 0.5));
        atlas.triangle[texel] = TriangleId(2 * s + (u < v ? 1 : 0));
        map.distance[texel] = is_nothing ? std::numeric_limits<float>::infinity() : static_cast<float>(value);
        map.vector[texel] = is_nothing ? Vec3f{} : Vec3f{static_cast<float>(value), 0, 0};
        map.site[texel] = is_nothing ? SiteId::none() : SiteId(static_cast<std::uint32_t>(texel));
      }
    }
    for (float t = 0; t < 2; ++t) {
      map.faces.push_back({2 * static_cast<float>(s) + t, 20 + static_cast<float>(s) + t, 10.5F + t});
      map.error.push_back(0.125F + static_cast<float>(s) + t / 2);
    }
  }

  double first_;
};

}  // namespace blum::test
