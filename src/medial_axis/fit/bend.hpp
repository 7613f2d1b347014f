// Blum: how sheets bend at edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "blum/complex/incidence.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

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

/// Of the angles by which a sheet bends at the edges of a vertex inside of it, the least cosine; 1 where it is flat.
/// @param incidence  of the lists.
/// @param position   where the vertex is, or would be.
[[nodiscard]] inline double least_cosine_at(const AxisLists& lists, const Incidence& incidence, std::uint32_t v,
                                            const Vec3d& position) {
  double least = 1;
  for (const std::uint32_t e : incidence.edges_of_vertex()[v]) {
    const auto& edge = incidence.edges()[e];
    const auto at = incidence.triangles_of_edge()[e];
    const auto beside = [&](std::uint32_t t) {
      return lists.vertices[third_corner(lists.triangles[t], edge)].position;
    };
    const Vec3d& end = lists.vertices[other_end(edge, v)].position;
    least = std::min(least, cosine_of_bend(position, end, beside(at[0]), beside(at[1])));
  }
  return least;
}

}  // namespace blum::detail
