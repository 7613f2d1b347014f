// Blum: complexes whose edges are contracted one after the other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/complex.hpp"

namespace blum::detail {

/// Vertices linked to the ends of an edge that is examined. Each thread reuses one object, so that memory is allocated
/// only once.
struct LinkScratch {
  std::vector<std::uint32_t> linked, linked_to_edge;
};

/// Complex from which edges and triangles are removed. The class lists the remaining edges and triangles at each
/// vertex. Sides of triangles need not be listed as edges.
class ShrinkingComplex {
 public:
  explicit ShrinkingComplex(const ComplexView& complex);

  [[nodiscard]] bool has_triangle(std::uint32_t t) const { return !is_triangle_gone_[t]; }
  [[nodiscard]] bool has_edge(std::uint32_t e) const { return !is_edge_gone_[e]; }
  [[nodiscard]] bool has_vertex(std::uint32_t v) const { return !is_vertex_gone_[v]; }
  [[nodiscard]] const std::array<std::uint32_t, 3>& triangle(std::uint32_t t) const { return triangles_[t]; }
  [[nodiscard]] const std::array<std::uint32_t, 2>& edge(std::uint32_t e) const { return edges_[e]; }

  /// Calls visit(triangle, next, last) for each triangle at a vertex, where `next` and `last` are its other two corners
  /// in their order.
  template <class Visit>
  void for_each_triangle(std::uint32_t v, const Visit& visit) const {
    for (std::uint32_t c = first_corner_[v]; c != none; c = next_corner_[c]) {
      const auto& corners = triangles_[c / 3];
      visit(c / 3, corners[(c + 1) % 3], corners[(c + 2) % 3]);
    }
  }
  /// Calls visit(edge, other end) for each listed edge at a vertex.
  template <class Visit>
  void for_each_edge(std::uint32_t v, const Visit& visit) const {
    for (std::uint32_t c = first_end_[v]; c != none; c = next_end_[c]) visit(c / 2, edges_[c / 2][(c + 1) % 2]);
  }

  /// Returns true if contracting the edge between two vertices preserves the homotopy type. The link condition decides:
  /// a vertex or edge that is in the links of both ends must also be in the link of the edge. (Dey, Edelsbrunner, Guha,
  /// Nekhayev, "Topology preserving edge contraction", 1999; Attali, Lieutier, Salinas, "Efficient data structure for
  /// representing and simplifying simplicial complexes in high dimensions", 2012.)
  /// Cost: near-linear in the number of edges and triangles at both ends. Any number of threads may call it while no
  /// edge is contracted.
  [[nodiscard]] bool may_contract(std::uint32_t from, std::uint32_t to, LinkScratch& scratch) const;

  /// Removed triangle, and its corner that was not an end of the contracted edge.
  struct Gone {
    std::uint32_t triangle, third;
  };
  /// Contracts an edge: in all edges and triangles at `from`, replaces `from` by `to`. Triangles and listed edges that
  /// contain both vertices are removed.
  /// @return  the removed triangles, valid until the next call.
  std::span<const Gone> contract(std::uint32_t from, std::uint32_t to);

  /// Adds an edge after all others.
  void add_edge(const std::array<std::uint32_t, 2>& ends);

  /// Returns the remaining part of a complex, with its columns.
  /// @param whole  complex from which this object was made. The complex may lack edges that were added later.
  [[nodiscard]] Complex rest_of(const Complex& whole) const;

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  void unlink_triangle(std::uint32_t t, std::uint32_t v);
  void unlink_edge(std::uint32_t e, std::uint32_t v);
  [[nodiscard]] bool has_triangle_of(std::uint32_t u, std::uint32_t x, std::uint32_t y) const;

  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<bool> is_edge_gone_, is_triangle_gone_, is_vertex_gone_;
  std::vector<std::uint32_t> first_corner_, next_corner_;  ///< Corners are numbered 3 * triangle + 0, 1, 2.
  std::vector<std::uint32_t> first_end_, next_end_;        ///< Ends are numbered 2 * edge + 0, 1.
  std::vector<Gone> gone_;
};

}  // namespace blum::detail
