// Blum: how a surface lies to the planes of a grid, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"

namespace blum::detail {

// Every plane of a grid counts as moved down by an infinitely small amount, those across x by far more than those
// across y, and these by far more than those across z (simulation of simplicity, Edelsbrunner and Muecke 1990). So no
// vertex lies in a plane, no edge meets a line and no triangle a node, whatever the coordinates are, and all answers
// fit together. They are exact for coordinates that are 0 or of magnitude 1e-45 to 1e45.
//
// A line along an axis has the coordinates `u` and `v` along the next axis and the one after: (x, y, z, x, ...).

/// The axis after an axis: x, y, z, x, ...
constexpr std::size_t next_axis(std::size_t axis) {
  return (axis + 1) % 3;
}

using TriangleCorners = std::array<Vec3d, 3>;

/// Two ends.
using EdgeEnds = std::array<Vec3d, 2>;

/// Whether a coordinate is above a plane.
[[nodiscard]] inline bool is_above(double coordinate, double plane) {
  return coordinate >= plane;
}

/// The side (-1, 1) of an edge that a line along an axis passes on, seen against the axis: 1 where it lies to the left.
/// 0 where the edge runs along the axis, too.
[[nodiscard]] int side_of_line(const EdgeEnds& edge, std::size_t axis, double u, double v);

/// The side (-1, 1) of a triangle's plane that a node of the grid lies on: 1 where the triangle turns counter-clockwise
/// seen from there. 0 where its corners lie on one line.
[[nodiscard]] int side_of_node(const TriangleCorners& triangle, const Vec3d& node);

/// The sign (-1, 0, 1) of a component of the normal of a triangle: 1 where it turns counter-clockwise seen against the
/// axis.
[[nodiscard]] int normal_sign(const TriangleCorners& triangle, std::size_t axis);

/// Whether a line along an axis, which crosses both triangles, crosses `first` below `second`. Neither may be parallel
/// to the axis. Two triangles in one plane do not come one after the other.
[[nodiscard]] bool is_crossed_before(const TriangleCorners& first, const TriangleCorners& second, std::size_t axis,
                                     double u, double v);

/// Whether an edge passes the plane across an axis at a smaller coordinate along another axis than a second edge does.
/// Both must cross the plane.
[[nodiscard]] bool passes_before(const EdgeEnds& first, const EdgeEnds& second, std::size_t across, double plane,
                                 std::size_t along);

}  // namespace blum::detail
