// Blum: medial axes while they are put together. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/axis/shrinking_complex.hpp"
#include "blum/complex/complex.hpp"
#include "medial_axis/shape/axis_vertex.hpp"

namespace blum::detail {

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

/// Adds lists at the end of others.
void append(AxisLists more, AxisLists& lists);

/// Keeps what is left of a complex that was made of lists: its edges are those of the lists, in their order, and maybe
/// more.
void keep(const ShrinkingComplex& cells, AxisLists& lists);
/// Keeps some vertices and triangles, and all edges, which have only such vertices.
void keep(const std::vector<bool>& has_vertex, const std::vector<bool>& has_triangle, AxisLists& lists);

/// A complex with the columns of a medial axis, one sheet, and edges that are curves: to be labelled by label_sheets().
[[nodiscard]] Complex complex_of(AxisLists lists);

}  // namespace blum::detail
