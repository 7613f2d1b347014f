// Blum: exact position of a surface relative to the planes of a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"

namespace blum::detail {

// Every plane of a grid is treated as if it were moved infinitely little towards smaller coordinates (simulation of
// simplicity, Edelsbrunner and Muecke 1990). Planes across x move infinitely more than planes across y, which move
// infinitely more than planes across z. So no vertex lies in a plane, no edge meets a line of the grid, and no triangle
// meets a node. All answers are consistent, and exact for coordinates that are 0 or of magnitude 1e-45 to 1e45.
//
// A line along an axis is given by two coordinates: `u` along the next axis, and `v` along the axis after that. The
// order of axes is x, y, z, x, ...

/// Returns the axis after a given axis, in the order x, y, z, x, ...
constexpr std::size_t next_axis(std::size_t axis) {
  return (axis + 1) % 3;
}

using TriangleCorners = std::array<Vec3d, 3>;

/// Positions of the first and the second end of an edge.
using EdgeEnds = std::array<Vec3d, 2>;

/// Returns true if a coordinate is at least the coordinate of a plane. The coordinate is then above the moved plane.
[[nodiscard]] inline bool is_above(double coordinate, double plane) {
  return coordinate >= plane;
}

/// Returns 1 if a line along an axis lies left of an edge, and -1 if it lies right of it, seen against the axis. The
/// edge is directed from its first to its second end. Returns 0 if the edge is parallel to the axis.
[[nodiscard]] int side_of_line(const EdgeEnds& edge, std::size_t axis, double u, double v);

/// Returns the side (-1 or 1) of a triangle's plane on which a node of the grid lies. The side is 1 if the triangle
/// turns counter-clockwise seen from the node. Returns 0 if the corners of the triangle lie on one line.
[[nodiscard]] int side_of_node(const TriangleCorners& triangle, const Vec3d& node);

/// Returns the sign (-1, 0, 1) of the component of a triangle's normal along an axis. The sign is 1 if the triangle
/// turns counter-clockwise seen against the axis.
[[nodiscard]] int normal_sign(const TriangleCorners& triangle, std::size_t axis);

/// Returns true if a line along an axis crosses `first` at a smaller coordinate than `second`. The line must cross both
/// triangles, and neither may be parallel to the axis. Returns false for two triangles in one plane.
[[nodiscard]] bool is_crossed_before(const TriangleCorners& first, const TriangleCorners& second, std::size_t axis,
                                     double u, double v);

/// Returns true if the edge `first` crosses a plane at a smaller coordinate, along the axis `along`, than the edge
/// `second`. The plane is at right angles to the axis `across`, at coordinate `plane`. Both edges must cross the plane.
[[nodiscard]] bool passes_before(const EdgeEnds& first, const EdgeEnds& second, std::size_t across, double plane,
                                 std::size_t along);

}  // namespace blum::detail
