// Blum: incidences of the cells of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/index_rows.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Edges of a complex without duplicates, and the incidences of its vertices, edges and triangles. The object contains
/// copies, so it stays valid if the complex changes.
class Incidence {
 public:
  Incidence() = default;
  /// Computes the incidences of a complex.
  /// @throws InvalidOption if an edge or a triangle has a vertex that does not exist, or the same vertex twice.
  /// InvalidOption is also thrown if there are 2^32 or more listed edges and sides of triangles in total. Cancelled.
  /// Cost: linear except for sorting the edges of each vertex; about 60 bytes per triangle.
  explicit Incidence(const ComplexView& complex, const Context& context = {});

  /// Returns all listed edges and all sides of triangles, each once, in ascending order. The smaller vertex of an edge
  /// comes first.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> edges() const { return edges_; }
  /// Returns the index in edges() of each listed edge.
  [[nodiscard]] std::span<const std::uint32_t> edge_of_listed() const { return edge_of_listed_; }
  /// Returns the indices in edges() of the sides of each triangle: from corner 0 to 1, from 1 to 2, from 2 to 0.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> sides() const { return sides_; }
  /// Returns the triangles at each edge of edges(), ascending. A triangle that is listed twice occurs twice.
  [[nodiscard]] const IndexRows& triangles_of_edge() const { return triangles_of_edge_; }
  /// Returns the indices in edges() of the edges at each vertex, ascending.
  [[nodiscard]] const IndexRows& edges_of_vertex() const { return edges_of_vertex_; }
  /// Returns the triangles at each vertex, ascending.
  [[nodiscard]] const IndexRows& triangles_of_vertex() const { return triangles_of_vertex_; }

  /// Returns the index in edges() of the edge between two vertices; nullopt if none exists.
  [[nodiscard]] std::optional<std::uint32_t> find_edge(std::uint32_t a, std::uint32_t b) const;

 private:
  void find_edges(const ComplexView& complex, const Context& context);

  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<std::uint32_t> edge_of_listed_;
  std::vector<std::array<std::uint32_t, 3>> sides_;
  IndexRows triangles_of_edge_, edges_of_vertex_, triangles_of_vertex_;
};

}  // namespace blum
