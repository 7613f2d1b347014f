// Blum: parts of charts in squares of a texture. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/surface_map/surface_atlas.hpp"
#include "surface_map/chart.hpp"

namespace blum::surface {

/// A convex polygon in a texture.
using ChartPart = InlineList<TexturePlace, 12>;

/// What is left on one side of a line along an axis.
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

/// The part of a chart in the square around a place. @param reach  half the square's side, texels.
[[nodiscard]] inline ChartPart part_around(const ChartCorners& places, const TexturePlace& middle, double reach) {
  ChartPart left;
  for (const TexturePlace& at : places) left.push_back(at);
  for (const double sign : {-1.0, 1.0}) {
    left = clipped(left, [](const TexturePlace& p) { return p.x; }, middle.x + sign * reach, sign);
    left = clipped(left, [](const TexturePlace& p) { return p.y; }, middle.y + sign * reach, sign);
  }
  return left;
}

/// Square texels.
[[nodiscard]] inline double area_of(const ChartPart& part) {
  double twice = 0;
  for (std::size_t k = 2; k < part.size(); ++k)
    twice += twice_area({part.data()[0], part.data()[k - 1], part.data()[k]});
  return std::abs(twice) / 2;
}

/// @throws InvalidMesh unless a mesh is valid and has as many triangles as an atlas.
inline void check_fits(const MeshView& mesh, const SurfaceAtlas& atlas) {
  validate(mesh);
  if (mesh.triangles.size() == atlas.corners.size()) return;
  throw InvalidMesh("the mesh has " + std::to_string(mesh.triangles.size()) + " triangles, but its atlas " +
                    std::to_string(atlas.corners.size()));
}

}  // namespace blum::surface
