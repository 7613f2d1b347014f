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

/// Two sheets that form less than 15 degrees continue each other. At larger angles, they meet.
inline constexpr double sine_of_meeting = 0.26;
inline constexpr double cosine_of_meeting = 0.966;

/// A rim edge and the line of points in front of it.
struct StripOutline {
  std::array<Vec3d, 2> rim;     ///< Ends of the edge, in the order of its triangle.
  std::span<const Vec3d> line;  ///< From near the first end to near the second; at least one point.
  Vec3d normal;                 ///< Unit normal of the edge's triangle.
};

/// Returns triangles between a rim edge and its line. They number the points rim[0], rim[1], line[0], line[1], ... from
/// 0. One triangle contains both ends of the rim edge, and all face as the edge's own triangle does. Among all choices,
/// the one whose worst triangle is best is returned. Returns nullopt if no choice keeps all triangles within 80 degrees
/// of the normal.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> fill_strip(const StripOutline& outline);

/// Returns true if the centroids of triangles of fill_strip(), and the midpoints of their sides, are inside. Sides
/// along the line are not tested, because the line may lie on the surface of the solid.
[[nodiscard]] bool is_strip_inside(const StripOutline& outline, std::span<const std::array<std::uint32_t, 3>> triangles,
                                   FunctionRef<bool(const Vec3d&)> is_inside);

/// Rim edge: an edge that belongs to exactly one triangle.
struct RimEdge {
  std::uint32_t triangle = 0;
  std::array<std::uint32_t, 2> vertices{};  ///< Ends, in the order of the triangle.
  std::array<std::uint32_t, 2> corners{};   ///< Indices in Rims::corners of the corners at both ends.
  Vec3d normal;                             ///< Unit normal of the triangle; 0 if it has no area.
  Vec3d outwards;                           ///< Unit vector in the triangle's plane, away from it; 0 if it has no area.
  double length = 0;
};

/// A vertex of rims and one group of triangles at it. Edges at the vertex connect the triangles of a group. A vertex
/// has one corner for each group with rim edges.
struct RimCorner {
  std::uint32_t vertex = 0;
  Vec3d outwards;               ///< Unit vector in the tangent plane, away from the triangles; 0 if unknown.
  std::optional<Vec3d> normal;  ///< Unit normal of the tangent plane; none if a seam ends here or no triangle has area.
  bool is_on_sheet = false;     ///< True if another group of triangles at the vertex has no rim edge at the vertex.
  /// True if `outwards` leads through another group of triangles at the vertex, at 15 degrees or more. `outwards` then
  /// lies in the planes of both groups, or is 0: see way_beside().
  bool is_beside_sheet = false;
};

struct Rims {
  std::vector<RimEdge> edges;      ///< ordered by smaller vertex, then larger vertex
  std::vector<RimCorner> corners;  ///< ordered by vertex
};

/// Returns the component of a direction that lies in the planes of two sheets, if the direction leads through the
/// second sheet. The result is 0 if hardly any component lies in both planes. Returns nullopt if the direction does not
/// lead through the second sheet, or if the planes form less than 15 degrees.
/// @param way     unit vector outwards, in the plane of the first sheet.
/// @param normal  unit normal of the first sheet.
/// @param other   unit normal of the second sheet, either sign.
/// @param beyond  vector from the second sheet to the start of the way. If 0, the way starts on the second sheet.
[[nodiscard]] std::optional<Vec3d> way_beside(const Vec3d& way, const Vec3d& normal, const Vec3d& other,
                                              const Vec3d& beyond);

/// Returns the rims of an axis.
/// @param axis  has radii, and problem_of_medial() finds no problem in it.
/// @throws Cancelled.
[[nodiscard]] Rims find_rims(const Complex& axis, const Context& context);

}  // namespace blum::detail
