// Blum: which cells of a complex touch which. SPDX-License-Identifier: Apache-2.0
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

/// The edges of a complex, each once, and what touches what; a copy that does not need the complex again.
class Incidence {
 public:
  Incidence() = default;
  /// @throws InvalidOption for an edge or a triangle that names a vertex that is none, or one twice, and for 2^32 or
  /// more listed edges and sides of triangles; Cancelled.
  /// Cost: linear but for sorting the edges of each vertex; about 60 bytes per triangle.
  explicit Incidence(const ComplexView& complex, const Context& context = {});

  /// The edges that are listed and the sides of triangles, each once, the smaller vertex first, in rising order.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> edges() const { return edges_; }
  /// Which of edges() each listed edge is.
  [[nodiscard]] std::span<const std::uint32_t> edge_of_listed() const { return edge_of_listed_; }
  /// Which of edges() the sides of each triangle are: from corner 0 to 1, from 1 to 2, from 2 to 0.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> sides() const { return sides_; }
  /// The triangles at each of edges(), rising; one that is listed twice is there twice.
  [[nodiscard]] const IndexRows& triangles_of_edge() const { return triangles_of_edge_; }
  /// Which of edges() end at each vertex, rising.
  [[nodiscard]] const IndexRows& edges_of_vertex() const { return edges_of_vertex_; }
  /// The triangles at each vertex, rising.
  [[nodiscard]] const IndexRows& triangles_of_vertex() const { return triangles_of_vertex_; }

  /// Which of edges() joins two vertices, if any does.
  [[nodiscard]] std::optional<std::uint32_t> find_edge(std::uint32_t a, std::uint32_t b) const;

 private:
  void find_edges(const ComplexView& complex, const Context& context);

  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<std::uint32_t> edge_of_listed_;
  std::vector<std::array<std::uint32_t, 3>> sides_;
  IndexRows triangles_of_edge_, edges_of_vertex_, triangles_of_vertex_;
};

}  // namespace blum
