// Blum: kinds of vertices and triangles of an axis, from its edges. SPDX-License-Identifier: Apache-2.0
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

/// Returns the other end of an edge of which one end is given.
inline std::uint32_t other_end(const std::array<std::uint32_t, 2>& edge, std::uint32_t v) {
  return edge[0] == v ? edge[1] : edge[0];
}
/// Returns the corner of a triangle that is not on the given side.
inline std::uint32_t third_corner(const std::array<std::uint32_t, 3>& triangle,
                                  const std::array<std::uint32_t, 2>& side) {
  return triangle[0] ^ triangle[1] ^ triangle[2] ^ side[0] ^ side[1];
}

/// Kind of a vertex: the numbers of its edges on rims (one triangle), seams (three or more) and curves (none), and
/// inside sheets (two).
struct Kind {
  std::uint32_t rims = 0, seams = 0, curves = 0, inner = 0;

  [[nodiscard]] bool is_rim() const { return rims == 2 && seams == 0 && curves == 0; }
  [[nodiscard]] bool is_seam() const { return seams == 2 && rims == 0 && curves == 0; }
  [[nodiscard]] bool is_seam_end() const { return seams == 1 && rims > 0 && curves == 0; }
  [[nodiscard]] bool is_curve() const { return curves == 2 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_curve_end() const { return curves == 1 && rims + seams + inner == 0; }
  [[nodiscard]] bool is_junction() const { return seams > 2 || (seams > 0 && curves > 0); }
};

/// Joins the triangles of each sheet: triangles that are connected through edges of exactly two triangles.
inline detail::UnionFind sheets_of(const Incidence& incidence) {
  detail::UnionFind sheets(incidence.sides().size());
  for (std::size_t e = 0; e < incidence.edges().size(); ++e) {
    const auto at = incidence.triangles_of_edge()[e];
    if (at.size() == 2) sheets.join(at[0], at[1]);
  }
  return sheets;
}

/// Returns the kind of each vertex.
/// @param incidence  the incidence of a complex with `vertices` vertices.
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

/// Returns the cosine of the angle by which two triangles of a sheet bend at their common side. The cosine is -1 if one
/// triangle is folded onto the other. It is 1 if the triangles form a flat sheet, or if one of them has no area.
/// @param p, q  corners of the triangles that are not on the common side.
[[nodiscard]] inline double cosine_of_bend(const Vec3d& from, const Vec3d& to, const Vec3d& p, const Vec3d& q) {
  const Vec3d along = to - from;
  const Vec3d u = cross(along, p - from);
  const Vec3d v = cross(along, q - from);
  const double scale = length(u) * length(v);
  // If the triangles lie side by side in one plane, u and v have opposite directions.
  return scale > 0 ? -dot(u, v) / scale : 1;
}

/// Returns the least cosine of the angles by which a sheet bends at the edges of one of its inner vertices. It is 1 if
/// the sheet is flat.
/// @param incidence  the incidence of the lists.
/// @param position   actual or assumed position of the vertex.
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
