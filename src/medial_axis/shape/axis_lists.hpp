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
  std::array<std::uint32_t, 2> elements{};  ///< of the surface, that contain the footprints
};

/// Returns a vertex for which only one wall is known.
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

/// Vertices, edges and triangles that are added one by one.
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

/// Appends lists to others.
void append(AxisLists more, AxisLists& lists);

/// Keeps the remaining cells of a complex that was made of lists. Its edges are those of the lists, in their order, and
/// maybe more.
void keep(const ShrinkingComplex& cells, AxisLists& lists);
/// Keeps some vertices and triangles, and all edges. All ends of edges must be among the kept vertices.
void keep(const std::vector<bool>& has_vertex, const std::vector<bool>& has_triangle, AxisLists& lists);

/// Returns a complex with the columns of a medial axis, one sheet, and edges that are curves. label_sheets() must label
/// it.
[[nodiscard]] Complex complex_of(AxisLists lists);

}  // namespace blum::detail
