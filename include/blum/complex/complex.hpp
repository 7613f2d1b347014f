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

/// Corners of edges and triangles, without positions and columns.
struct ComplexView {
  std::size_t vertex_count = 0;
  std::span<const std::array<std::uint32_t, 2>> edges;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// Vertices, edges and triangles in space, with named columns of numbers on each. Examples are a medial axis, a mesh
/// with attributes, or pairs of witness points. As a space it consists of all vertices, edges and triangles, and of the
/// sides of the triangles, listed or not.
struct Complex {
  std::vector<Vec3d> positions;                         ///< Positions of the vertices.
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< Vertices at the ends of the listed edges.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Corners of the triangles.
  Columns vertex_columns;                               ///< One row for each vertex.
  Columns edge_columns;                                 ///< One row for each listed edge.
  Columns triangle_columns;                             ///< One row for each triangle.

  [[nodiscard]] ComplexView view() const { return {positions.size(), edges, triangles}; }
};

/// Returns the first problem of the corners of a complex in one sentence, or an empty string. Edges and triangles must
/// name vertices that exist, and none twice.
[[nodiscard]] std::string problem_of(const ComplexView& complex);
/// Returns the first problem of a whole complex in one sentence, or an empty string. In addition, every position must
/// be finite, and columns must have a row for each vertex, edge or triangle.
[[nodiscard]] std::string problem_of(const Complex& complex);

/// Checks a complex.
/// @throws InvalidMesh with the text of problem_of().
void validate(const Complex& complex);

}  // namespace blum
