// Blum: how sheets bend at edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum {

/// Cosine of the angle by which two triangles of a sheet bend at their common side, -1 where one lies on the other; 1
/// where they are flat, or one has no area.
/// @param p, q  their third corners.
[[nodiscard]] inline double cosine_of_bend(const Vec3d& from, const Vec3d& to, const Vec3d& p, const Vec3d& q) {
  const Vec3d along = to - from;
  const Vec3d u = cross(along, p - from);
  const Vec3d v = cross(along, q - from);
  const double scale = length(u) * length(v);
  // On both sides of the edge, so that these face opposite ways.
  return scale > 0 ? -dot(u, v) / scale : 1;
}

}  // namespace blum
