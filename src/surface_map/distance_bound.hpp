// Blum: upper bound on the distance of a piece of a surface from another surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "surface_map/facing_surface.hpp"

namespace blum::surface {

/// A point of a surface, and the closest point of the other one.
struct FacingPoint {
  Vec3d point;
  Vec3d closest;
  double distance = 0;
  SiteId site;
};

/// Returns an upper bound on the distance of all points of a triangle from a surface, except for rounding. The triangle
/// may have lost its area.
/// @param enough  any bound up to this one is good enough.
/// Cost: 10 ns if the corners' distances and the size of the triangle are enough, else up to 1 us.
/// Method: docs/theory/surface-maps.md.
[[nodiscard]] double distance_bound(const std::array<const FacingPoint*, 3>& corners, const FacingSurface& surface,
                                    double enough);

}  // namespace blum::surface
