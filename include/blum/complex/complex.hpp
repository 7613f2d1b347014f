// Blum: complexes of vertices, edges and triangles with attributes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "blum/complex/columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Corners of edges and triangles, nothing more.
struct ComplexView {
  std::size_t vertex_count = 0;
  std::span<const std::array<std::uint32_t, 2>> edges;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// Vertices, edges and triangles in space, with named columns of numbers on each: a medial axis, a mesh with
/// attributes, pairs of witness points. As a space it is made of all its vertices, edges and triangles, and of the
/// triangles' own edges, whether these are listed or not.
struct Complex {
  std::vector<Vec3d> positions;                         ///< of the vertices
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< of those that are listed: the vertices at their ends
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< their corners
  Columns vertex_columns;                               ///< a row for each vertex
  Columns edge_columns;                                 ///< a row for each listed edge
  Columns triangle_columns;                             ///< a row for each triangle

  [[nodiscard]] ComplexView view() const { return {positions.size(), edges, triangles}; }
};

/// What is wrong with the corners of a complex, in one sentence; empty where nothing is: edges and triangles name
/// vertices that exist, and none twice.
[[nodiscard]] std::string problem_of(const ComplexView& complex);
/// The same of all of a complex: besides, every position is finite, and columns have a row for each vertex, edge or
/// triangle.
[[nodiscard]] std::string problem_of(const Complex& complex);

/// @throws InvalidMesh saying problem_of().
void validate(const Complex& complex);

}  // namespace blum
