// Blum: what vertices and triangles of an axis are by its edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// The end of an edge that is not this one.
inline std::uint32_t other_end(const std::array<std::uint32_t, 2>& edge, std::uint32_t v) {
  return edge[0] == v ? edge[1] : edge[0];
}
/// The corner of a triangle that is not on its side.
inline std::uint32_t third_corner(const std::array<std::uint32_t, 3>& triangle,
                                  const std::array<std::uint32_t, 2>& side) {
  return triangle[0] ^ triangle[1] ^ triangle[2] ^ side[0] ^ side[1];
}

/// What the edges at a vertex are.
struct Kind {
  std::uint32_t rims = 0, seams = 0, curves = 0, inner = 0;

  [[nodiscard]] bool is_rim() const { return rims == 2 && seams == 0 && curves == 0; }
  [[nodiscard]] bool is_seam() const { return seams == 2 && rims == 0 && curves == 0; }
  [[nodiscard]] bool is_seam_end() const { return seams == 1 && rims > 0 && curves == 0; }
  [[nodiscard]] bool is_curve() const { return curves == 2 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_curve_end() const { return curves == 1 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_junction() const { return seams > 2 || (seams > 0 && curves > 0); }
};

/// Which triangles are of one sheet: those that edges of exactly two triangles join.
inline detail::UnionFind sheets_of(const Incidence& incidence) {
  detail::UnionFind sheets(incidence.sides().size());
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const auto at = incidence.triangles_of_edge()[e];
    if (at.size() == 2) sheets.join(at[0], at[1]);
  }
  return sheets;
}

/// @param incidence  of a complex of so many vertices.
inline std::vector<Kind> kinds_of(const Incidence& incidence, std::size_t vertices) {
  std::vector<Kind> kinds(vertices);
  for (std::uint32_t e = 0; e < incidence.edges().size(); ++e) {
    const std::size_t count = incidence.triangles_of_edge()[e].size();
    for (const std::uint32_t v : incidence.edges()[e]) {
      ++(count == 0 ? kinds[v].curves : count == 1 ? kinds[v].rims : count == 2 ? kinds[v].inner : kinds[v].seams);
    }
  }
  return kinds;
}

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
