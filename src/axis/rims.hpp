// Blum: rims of medial axes and their outward directions. SPDX-License-Identifier: Apache-2.0
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

/// Rim edge and the points in front of it.
struct StripOutline {
  std::array<Vec3d, 2> rim;     ///< Ends, in the order of the triangle.
  std::span<const Vec3d> line;  ///< From the first end's side to the other's, at least one point.
  Vec3d normal;                 ///< Unit normal of the triangle.
};

/// Returns triangles over the points rim[0], rim[1], line[0], line[1], ... by number. One of them has both ends of the
/// rim, and all face as the rim's triangle does. The choice with the best worst triangle is taken. Returns nullopt if
/// no choice keeps all triangles within 80 degrees of the normal.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline);

/// Returns true if the middles of triangles of fill_strip() and of their sides are inside. Sides on the line are not
/// tested, because it is the border.
[[nodiscard]] bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                                   FunctionRef<bool(const Vec3d&)> is_inside);

/// Edge of one triangle.
struct RimEdge {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 2> vertices{};  ///< In the order of the triangle.
  std::array<std::uint32_t, 2> corners{};   ///< Numbers in Rims::corners, at the vertices.
  Vec3d normal;                             ///< Unit normal of the triangle; 0 if it has no area.
  Vec3d outwards;                           ///< Unit vector in its plane, away from it; 0 if it has no area.
  double length = 0;
};

/// Vertex of rims, once for each group of triangles around it that are connected through edges.
struct RimCorner {
  std::uint32_t vertex = 0;
  Vec3d outwards;               ///< Unit vector in the tangent plane, away from the triangles; 0 if unknown.
  std::optional<Vec3d> normal;  ///< Unit normal of the tangent plane; none if a seam ends here or no triangle has area.
  bool is_on_sheet = false;     ///< True if the vertex lies in the middle of other triangles.
};

struct Rims {
  std::vector<RimEdge> edges;      ///< by ascending (smaller vertex, larger vertex)
  std::vector<RimCorner> corners;  ///< by ascending vertex
};

/// Returns the rims of an axis.
/// @param axis  with radii; it has no problem (problem_of_medial). @throws Cancelled.
[[nodiscard]] Rims find_rims(const Complex& axis, const Context& context);

}  // namespace blum::detail
