// Blum: exact position of a surface relative to the planes of a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"

namespace blum::detail {

// Every plane of a grid counts as moved down by an infinitely small amount (simulation of simplicity, Edelsbrunner and
// Muecke 1990). The amount across x is infinitely larger than that across y, which is infinitely larger than that
// across z. So no vertex lies in a plane, no edge meets a line, and no triangle meets a node. All answers are
// consistent, and exact for coordinates that are 0 or of magnitude 1e-45 to 1e45.
//
// A line along an axis has the coordinates `u` and `v` along the next axis and the one after: (x, y, z, x, ...).

/// Returns the axis after an axis: x, y, z, x, ...
constexpr std::size_t next_axis(std::size_t axis) {
  return (axis + 1) % 3;
}

using TriangleCorners = std::array<Vec3d, 3>;

/// Two ends.
using EdgeEnds = std::array<Vec3d, 2>;

/// Returns true if a coordinate is above a plane.
[[nodiscard]] inline bool is_above(double coordinate, double plane) {
  return coordinate >= plane;
}

/// Returns 1 if a line along an axis passes an edge on its left, seen against the axis, and -1 on its right. Returns 0
/// if the edge runs along the axis, too.
[[nodiscard]] int side_of_line(const EdgeEnds& edge, std::size_t axis, double u, double v);

/// Returns the side (-1, 1) of a triangle's plane that contains a node of the grid. It is 1 if the triangle turns
/// counter-clockwise seen from the node. Returns 0 if its corners lie on one line.
[[nodiscard]] int side_of_node(const TriangleCorners& triangle, const Vec3d& node);

/// Returns the sign (-1, 0, 1) of a component of a triangle's normal. It is 1 if the triangle turns counter-clockwise
/// seen against the axis.
[[nodiscard]] int normal_sign(const TriangleCorners& triangle, std::size_t axis);

/// Returns true if a line along an axis crosses `first` below `second`. The line must cross both triangles, and neither
/// may be parallel to the axis. Returns false for two triangles in one plane.
[[nodiscard]] bool is_crossed_before(const TriangleCorners& first, const TriangleCorners& second, std::size_t axis,
                                     double u, double v);

/// Returns true if `first` passes the plane across an axis at a smaller coordinate along another axis than `second`.
/// Both edges must cross the plane.
[[nodiscard]] bool passes_before(const EdgeEnds& first, const EdgeEnds& second, std::size_t across, double plane,
                                 std::size_t along);

}  // namespace blum::detail
