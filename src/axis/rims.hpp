// Blum: the rims of medial axes, and which way they face. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/function_ref.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A rim edge and the points in front of it.
struct StripOutline {
  std::array<Vec3d, 2> rim;     ///< its ends, in the order of its triangle
  std::span<const Vec3d> line;  ///< from the first end's side to the other's, at least one point
  Vec3d normal;                 ///< of its triangle, of unit length
};

/// Triangles over the points rim[0], rim[1], line[0], line[1], ... by number. One of them has both ends of the rim, and
/// all face as the rim's triangle does. Of the ways to do it, that one whose worst triangle is the best; nullopt where
/// none keeps all within 80 degrees of the normal.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline);

/// Whether the middles of triangles of fill_strip() and of their sides are inside, but for those of the line, which
/// is the border.
[[nodiscard]] bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                                   FunctionRef<bool(const Vec3d&)> is_inside);

/// An edge of one triangle.
struct RimEdge {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 2> vertices{};  ///< in the order in which the triangle has them
  std::array<std::uint32_t, 2> corners{};   ///< of Rims::corners, at the vertices
  Vec3d normal;                             ///< of the triangle, of unit length; 0 where it has no area
  Vec3d outwards;                           ///< in its plane, away from it, of unit length; 0 where it has no area
  double length = 0;
};

/// A vertex of rims, once for each group of triangles around it that hang together through edges.
struct RimCorner {
  std::uint32_t vertex = 0;
  Vec3d outwards;               ///< in the tangent plane, away from the triangles; of unit length, or 0: not known
  std::optional<Vec3d> normal;  ///< of the tangent plane; none where a seam ends, or no triangle has area
  bool is_on_sheet = false;     ///< whether the vertex lies in the middle of other triangles
};

struct Rims {
  std::vector<RimEdge> edges;      ///< by rising (smaller vertex, larger vertex)
  std::vector<RimCorner> corners;  ///< by rising vertex
};

/// @param axis  with radii; it has no problem (problem_of_medial). @throws Cancelled.
[[nodiscard]] Rims find_rims(const Complex& axis, const Context& context);

}  // namespace blum::detail
