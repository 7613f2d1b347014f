// Blum: simple, slow reading of surface maps at points of the surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_distance_map.hpp"

namespace blum::test {

/// The place of a point of a triangle in the texture.
inline TexturePlace place_of(const MeshView& mesh, const SurfaceAtlas& atlas, std::uint32_t t, const Vec3d& point) {
  const auto [a, b, c] = triangle_corners(mesh, t);
  // Vectors have a length of about 1, so that products neither overflow nor underflow.
  const double size = std::max({length(b - a), length(c - a), length(c - b)});
  const Vec3d to_b = (b - a) / size;
  const Vec3d to_c = (c - a) / size;
  const Vec3d to_point = (point - a) / size;
  const Vec3d normal = cross(to_b, to_c);
  const double whole = squared_length(normal);
  const double u = dot(cross(to_point, to_c), normal) / whole;
  const double v = dot(cross(to_b, to_point), normal) / whole;
  const auto& [pa, pb, pc] = atlas.corners[t];
  return {pa.x + (pb.x - pa.x) * u + (pc.x - pa.x) * v, pa.y + (pb.y - pa.y) * u + (pc.y - pa.y) * v};
}

inline double read_nearest(const SurfaceMap& map, const TexturePlace& at) {
  const auto x = static_cast<std::size_t>(std::clamp(std::floor(at.x), 0.0, map.atlas->width - 1.0));
  const auto y = static_cast<std::size_t>(std::clamp(std::floor(at.y), 0.0, map.atlas->height - 1.0));
  return map.distance[y * map.atlas->width + x];
}

inline double read_bilinear(const SurfaceMap& map, const TexturePlace& at) {
  const double x = std::floor(at.x - 0.5);
  const double y = std::floor(at.y - 0.5);
  double sum = 0;
  for (const double i : {x, x + 1}) {
    for (const double j : {y, y + 1}) {
      const double weight = (1 - std::abs(at.x - 0.5 - i)) * (1 - std::abs(at.y - 0.5 - j));
      if (weight > 1e-9) sum += weight * read_nearest(map, {i + 0.5, j + 0.5});
    }
  }
  return sum;
}

}  // namespace blum::test
