// Blum: charts of triangles in textures. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/scale.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/closest_point.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_atlas.hpp"

namespace blum::surface {

using ChartCorners = std::array<TexturePlace, 3>;

/// Returns twice the signed area of a chart, square texels.
[[nodiscard]] inline double twice_area(const ChartCorners& c) {
  return (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[2].x - c[0].x) * (c[1].y - c[0].y);
}

/// Returns true if the area of a chart is not 0, and the area and its reciprocal are finite.
[[nodiscard]] inline bool has_area(const ChartCorners& places) {
  const double area = twice_area(places);
  return area != 0 && std::isfinite(area) && std::isfinite(1 / area);
}

/// The affine map of a chart: from the texture to the plane of the triangle that the chart shows.
class Chart {
 public:
  /// @param corners  the triangle's corners in space.
  /// @param places   the triangle's corners in the texture; has_area() must be true for them.
  Chart(const std::array<Vec3d, 3>& corners, const ChartCorners& places) : corners_(corners), places_(places) {
    const double inverse = 1 / twice_area(places);
    sign_ = inverse < 0 ? -1 : 1;
    const Vec3d u = corners[1] - corners[0];
    const Vec3d v = corners[2] - corners[0];
    along_x_ = u * ((places[2].y - places[0].y) * inverse) - v * ((places[1].y - places[0].y) * inverse);
    along_y_ = v * ((places[1].x - places[0].x) * inverse) - u * ((places[2].x - places[0].x) * inverse);
    is_sliver_ = !(std::abs(twice_area(places)) > sliver_ratio * longest_square(places)) ||
                 !(length(cross(u, v)) > sliver_ratio * longest_square(corners));
  }

  /// Returns the point of the triangle's plane for a place in the texture.
  [[nodiscard]] Vec3d in_plane(const TexturePlace& at) const {
    return corners_[0] + along_x_ * (at.x - places_[0].x) + along_y_ * (at.y - places_[0].y);
  }
  /// Returns the point of the triangle for a place in the texture. If the place is outside the chart, the result is the
  /// point of the triangle that is closest to in_plane().
  [[nodiscard]] Vec3d on_triangle(const TexturePlace& at) const {
    const Vec3d point = in_plane(at);
    std::array<bool, 3> is_beyond{};
    for (std::size_t k = 0; k < 3; ++k) is_beyond[k] = beyond(k, at);
    if (!is_beyond[0] && !is_beyond[1] && !is_beyond[2]) return point;
    // The closest point lies on a side of the triangle that separates it from the place. For slivers, rounding may find
    // no such side or a wrong one, so all sides are tested.
    Vec3d best;
    double closest = HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_beyond[k] && !is_sliver_) continue;
      const Vec3d other = closest_point_on_segment(point, corners_[k], corners_[(k + 1) % 3]);
      const double squared = squared_length(point - other);
      if (squared < closest) {
        closest = squared;
        best = other;
      }
    }
    return best;
  }
  /// Returns the largest stretch of the map (its largest singular value), in the unit of `corners` per texel.
  [[nodiscard]] double stretch() const {
    const double xx = squared_length(along_x_);
    const double yy = squared_length(along_y_);
    const double xy = dot(along_x_, along_y_);
    return std::sqrt((xx + yy + std::hypot(xx - yy, 2 * xy)) / 2);
  }

 private:
  static constexpr double sliver_ratio = 1e-3;

  static double longest_square(const std::array<Vec3d, 3>& p) {
    return std::max({squared_length(p[1] - p[0]), squared_length(p[2] - p[1]), squared_length(p[0] - p[2])});
  }
  static double longest_square(const ChartCorners& p) {
    double out = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = p[(k + 1) % 3].x - p[k].x;
      const double y = p[(k + 1) % 3].y - p[k].y;
      out = std::max(out, x * x + y * y);
    }
    return out;
  }
  /// Returns true if a place lies outside the chart, beyond a given side.
  [[nodiscard]] bool beyond(std::size_t side, const TexturePlace& at) const {
    return sign_ * twice_area({places_[side], places_[(side + 1) % 3], at}) < 0;
  }

  std::array<Vec3d, 3> corners_;
  ChartCorners places_;
  bool is_sliver_ = false;   ///< true if the triangle is a sliver in the texture or in space
  double sign_ = 1;          ///< sign of the chart's area
  Vec3d along_x_, along_y_;  ///< steps in space for steps of one texel along x and along y
};

/// Charts of a mesh whose coordinates are multiplied by a power of two, so that products of coordinates neither
/// overflow nor underflow.
struct ScaledCharts {
  const MeshView& mesh;
  const SurfaceAtlas& atlas;
  double scale = scale_to_one(bounds(mesh).largest_coordinate());

  [[nodiscard]] Chart operator[](std::uint32_t triangle) const {
    std::array<Vec3d, 3> corners = triangle_corners(mesh, triangle);
    for (Vec3d& corner : corners) corner *= scale;
    return {corners, atlas.corners[triangle]};
  }
};

/// Returns the middle of the texel in column x and row y.
[[nodiscard]] inline TexturePlace middle_of(std::size_t x, std::size_t y) {
  return {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5};
}

/// Calls visit(x, y, outside) for the texels that nearest or bilinear reading at a place of a chart uses. The middle of
/// each of these texels is less than one texel, along x and along y, away from a point of the chart. `outside` is the
/// largest signed distance of the texel's middle beyond a side of the chart, in texels. It is 0 or less if the middle
/// is in the chart.
/// @param places  corners of the chart; has_area() must be true for them.
/// @param width, height  size of the texture; texels outside it are not visited.
template <class Visit>
void for_each_texel(const ChartCorners& places, std::uint32_t width, std::uint32_t height, Visit visit) {
  const double sign = twice_area(places) < 0 ? -1 : 1;
  std::array<double, 3> side{};   ///< lengths of the sides
  std::array<double, 3> reach{};  ///< half the extent, across each side, of a square of 2 x 2 texels
  for (std::size_t k = 0; k < 3; ++k) {
    const TexturePlace& a = places[k];
    const TexturePlace& b = places[(k + 1) % 3];
    side[k] = std::hypot(b.x - a.x, b.y - a.y);
    reach[k] = (std::abs(b.x - a.x) + std::abs(b.y - a.y)) / side[k];
  }
  const auto [left, right] = std::minmax({places[0].x, places[1].x, places[2].x});
  const auto [top, bottom] = std::minmax({places[0].y, places[1].y, places[2].y});
  // Middles are less than one texel away from the box of the chart: 0.5 + i > left - 1.
  const auto first = [](double from) { return static_cast<std::size_t>(std::max(std::floor(from - 1.5) + 1, 0.0)); };
  const auto end = [](double to, std::uint32_t size) {
    return static_cast<std::size_t>(std::clamp(std::ceil(to + 0.5), 0.0, static_cast<double>(size)));
  };
  for (std::size_t y = first(top); y < end(bottom, height); ++y) {
    for (std::size_t x = first(left); x < end(right, width); ++x) {
      const TexturePlace at = middle_of(x, y);
      double outside = -HUGE_VAL;
      bool is_near = true;
      for (std::size_t k = 0; k < 3 && is_near; ++k) {
        const double beyond = -sign * twice_area({places[k], places[(k + 1) % 3], at}) / side[k];
        outside = std::max(outside, beyond);
        is_near = beyond < reach[k];
      }
      if (is_near) visit(x, y, outside);
    }
  }
}

/// A convex polygon in a texture.
using ChartPart = InlineList<TexturePlace, 12>;

/// Returns the part of a polygon on one side of a line parallel to an axis.
template <class Coordinate>
ChartPart clipped(const ChartPart& in, const Coordinate& coordinate, double limit, double sign) {
  ChartPart out;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const TexturePlace& a = in.data()[k];
    const TexturePlace& b = in.data()[(k + 1) % in.size()];
    const double of_a = sign * (limit - coordinate(a));
    const double of_b = sign * (limit - coordinate(b));
    if (of_a >= 0) out.push_back(a);
    if ((of_a > 0 && of_b < 0) || (of_a < 0 && of_b > 0)) {
      const double t = of_a / (of_a - of_b);
      out.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t});
    }
  }
  return out;
}

/// Returns the part of a chart that lies in a square around a place.
/// @param reach  half the side of the square, texels.
[[nodiscard]] inline ChartPart part_around(const ChartCorners& places, const TexturePlace& middle, double reach) {
  ChartPart left;
  for (const TexturePlace& at : places) left.push_back(at);
  for (const double sign : {-1.0, 1.0}) {
    left = clipped(left, [](const TexturePlace& p) { return p.x; }, middle.x + sign * reach, sign);
    left = clipped(left, [](const TexturePlace& p) { return p.y; }, middle.y + sign * reach, sign);
  }
  return left;
}

/// Returns the area of a part of a chart, square texels.
[[nodiscard]] inline double area_of(const ChartPart& part) {
  double twice = 0;
  for (std::size_t k = 2; k < part.size(); ++k)
    twice += twice_area({part.data()[0], part.data()[k - 1], part.data()[k]});
  return std::abs(twice) / 2;
}

/// Returns the centroid of a part of a chart. The part must have an area.
[[nodiscard]] inline TexturePlace centroid_of(const ChartPart& part) {
  const TexturePlace& first = part.data()[0];
  TexturePlace sum{};
  double twice = 0;
  for (std::size_t k = 2; k < part.size(); ++k) {
    const TexturePlace& a = part.data()[k - 1];
    const TexturePlace& b = part.data()[k];
    const double own = twice_area({first, a, b});
    twice += own;
    sum.x += own * ((a.x - first.x) + (b.x - first.x));
    sum.y += own * ((a.y - first.y) + (b.y - first.y));
  }
  return {first.x + sum.x / (3 * twice), first.y + sum.y / (3 * twice)};
}

/// @throws InvalidMesh if the mesh is not valid, or if its number of triangles differs from that of the atlas.
inline void check_fits(const MeshView& mesh, const SurfaceAtlas& atlas) {
  validate(mesh);
  if (mesh.triangles.size() == atlas.corners.size()) return;
  throw InvalidMesh("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles, but its atlas has " +
                    std::to_string(atlas.corners.size()));
}

}  // namespace blum::surface
