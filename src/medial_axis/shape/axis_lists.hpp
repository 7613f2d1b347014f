// Blum: medial axes during their construction. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/axis/shrinking_complex.hpp"
#include "blum/complex/complex.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "medial_axis/surface/surface.hpp"
#include "medial_axis/surface/thin_ball.hpp"

namespace blum::detail {

/// All data of a vertex. medial_columns describes the members.
struct AxisVertex {
  Vec3d position;
  double radius = 0;
  std::array<Vec3d, 2> footprints;
  std::array<SiteId, 2> sites;
  double separation_angle = 0;
  std::array<std::uint32_t, 2> elements{};  ///< elements of the surface that contain the footprints
};

/// Returns a vertex that has only one footprint. Its separation angle is 0.
inline AxisVertex vertex_of_one_wall(const Vec3d& x, const NearestPoint& nearest) {
  return {x,
          nearest.distance,
          {nearest.point, nearest.point},
          {nearest.site, nearest.site},
          0,
          {nearest.element, nearest.element}};
}

/// Returns a vertex at the centre of a ball in a thin part.
inline AxisVertex vertex_of_ball(const ThinBall& ball) {
  return {ball.centre,
          ball.nearest.distance,
          {ball.nearest.point, ball.other.point},
          {ball.nearest.site, ball.other.site},
          ball.angle,
          {ball.nearest.element, ball.other.element}};
}

/// Vertices, edges and triangles of an axis, to which more can be added.
struct AxisLists {
  std::vector<AxisVertex> vertices;
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<float> edge_angles;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<float> triangle_angles;

  void add_edge(const std::array<std::uint32_t, 2>& ends, float angle) {
    edges.push_back(ends);
    edge_angles.push_back(angle);
  }
  void add_triangle(const std::array<std::uint32_t, 3>& corners, float angle) {
    triangles.push_back(corners);
    triangle_angles.push_back(angle);
  }
};

/// Appends the cells of `more` to `lists`.
void append(AxisLists more, AxisLists& lists);

/// Removes from the lists all cells that are no longer in a complex made from them. The edges of the complex must begin
/// with those of the lists, in the same order.
void keep(const ShrinkingComplex& cells, AxisLists& lists);
/// Removes the vertices and triangles whose flag is false. All edges stay, so all their ends must stay.
void keep(const std::vector<bool>& has_vertex, const std::vector<bool>& has_triangle, AxisLists& lists);

/// Returns a complex with the columns of a medial axis. All triangles get one sheet and all edges the role of curves,
/// until label_sheets() is called.
[[nodiscard]] Complex complex_of(AxisLists lists);

}  // namespace blum::detail
