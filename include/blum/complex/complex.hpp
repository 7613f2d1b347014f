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

/// Edges and triangles as indices of their vertices, without positions and columns.
struct ComplexView {
  std::size_t vertex_count = 0;
  std::span<const std::array<std::uint32_t, 2>> edges;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// Vertices, edges and triangles in space, each kind with named columns of numbers. Examples are a medial axis, a mesh
/// with attributes, or pairs of witness points. The space of a complex is the union of its vertices, edges and
/// triangles. Sides of triangles belong to the complex, even if `edges` does not list them.
struct Complex {
  std::vector<Vec3d> positions;                         ///< Positions of the vertices.
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< Indices of the vertices of each listed edge.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Indices of the corners of each triangle.
  Columns vertex_columns;                               ///< One row for each vertex.
  Columns edge_columns;                                 ///< One row for each listed edge.
  Columns triangle_columns;                             ///< One row for each triangle.

  [[nodiscard]] ComplexView view() const { return {positions.size(), edges, triangles}; }
};

/// Returns one sentence about the first invalid edge or triangle of a complex, or an empty string if all are valid. The
/// vertices of each edge and triangle must exist and be distinct.
[[nodiscard]] std::string problem_of(const ComplexView& complex);
/// Returns one sentence about the first problem of a whole complex, or an empty string if the complex is valid. Edges
/// and triangles must satisfy the conditions of problem_of(ComplexView). In addition, every position must be finite,
/// and each column must have one row per vertex, edge or triangle.
[[nodiscard]] std::string problem_of(const Complex& complex);

/// Checks a complex.
/// @throws InvalidMesh if problem_of() returns a text; the message is this text.
void validate(const Complex& complex);

}  // namespace blum
