// Blum: solid angles of triangles seen from close to their edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/vec3.hpp"

namespace blum {

/// Half a solid angle, given by its cosine and sine. Both are multiplied by a common positive factor.
struct HalfAngle {
  double cosine = 1;
  double sine = 0;
};

/// Returns half the solid angle of a triangle seen from a point (van Oosterom and Strackee 1983). The angle is computed
/// with twice the digits of a double. If the point is close to an edge, or to a triangle without area, the cosine is a
/// small difference of large terms. At a distance of 1e-12 of the triangle's size, the result has about 8 correct
/// digits.
/// Cost: about 300 ns.
[[nodiscard]] HalfAngle half_solid_angle_nearby(const std::array<Vec3d, 3>& corners, const Vec3d& point);

}  // namespace blum
