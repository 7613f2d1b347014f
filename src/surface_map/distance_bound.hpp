// Blum: upper bound on the distance of a piece of a surface from another surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "surface_map/facing_surface.hpp"

namespace blum::surface {

/// A point of a surface, and the closest point of the other surface.
struct FacingPoint {
  Vec3d point;
  Vec3d closest;
  double distance = 0;
  SiteId site;
};

/// Returns an upper bound on the distance of all points of a triangle from a surface, except for rounding errors. The
/// triangle may have no area.
/// @param enough  the search for smaller bounds ends at a bound of at most this.
/// Cost: 10 ns if the distances at the corners and the size of the triangle already yield such a bound; else up to 1
/// us.
/// Method: docs/theory/surface-maps.md.
[[nodiscard]] double distance_bound(const std::array<const FacingPoint*, 3>& corners, const FacingSurface& surface,
                                    double enough);

}  // namespace blum::surface
