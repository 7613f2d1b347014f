// Blum: an octree with the edges, squares and cubes of its leaves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "voronoi/line_labels.hpp"

namespace blum::voronoi {

/// A node of the finest grid, 0 to Lattice::most along each axis.
using Node = std::array<std::uint32_t, 3>;

using detail::next_axis;

/// Positions of the nodes of the finest grid.
struct Lattice {
  static constexpr int depth = 26;
  static constexpr std::uint32_t most = 1U << depth;

  Vec3d origin;
  double unit = 1;  ///< distance of neighbouring nodes, mesh units

  [[nodiscard]] double at(std::size_t axis, std::uint32_t k) const { return origin[axis] + unit * k; }
  [[nodiscard]] Vec3d at(const Node& node) const { return {at(0, node[0]), at(1, node[1]), at(2, node[2])}; }
};

/// Number of an edge, square or cube. Children have consecutive numbers.
using CellId = std::uint32_t;
constexpr CellId no_cell = UINT32_MAX;

/// An edge of the grid, and the labels that are closest along it.
struct GridEdge {
  Node low{};
  std::uint32_t length = 0;
  std::uint8_t axis = 0;
  LabelIndex first = outside;                     ///< closest at its lower end
  LabelIndex last = outside;                      ///< closest at its upper end
  std::uint32_t first_event = 0, last_event = 0;  ///< its events in CellTree::events
  CellId children = no_cell;                      ///< the first of two

  /// Returns the node at the upper end.
  [[nodiscard]] Node high() const {
    Node out = low;
    out[axis] += length;
    return out;
  }
};

/// `resolved` if a square's border determines the contents of the square.
enum class SquareState : std::uint8_t { unknown, resolved };

/// A wall or a part of the surface in a square that a part of the diagram drops (PartRule). It need not reach the
/// border of the square.
struct InnerArc {
  std::uint32_t first = 0;   ///< site on one side
  std::uint32_t second = 0;  ///< site on the other; `outside` for the surface
  std::uint32_t event = 0;   ///< for the surface: an event of the border next to the same part of the outside
};

/// A square across an axis; u is the axis after it, and v the one after u.
struct GridSquare {
  Node low{};
  std::uint32_t length = 0;
  std::uint8_t axis = 0;
  SquareState state = SquareState::unknown;
  /// Along u at the lower v, along v at the upper u, along u at the upper v, along v at the lower u.
  std::array<CellId, 4> edges{};
  CellId children = no_cell;     ///< the first of four: u counts first
  CellId inner_edges = no_cell;  ///< the first of four: along u below and above the middle, along v likewise
  std::vector<LabelIndex> governors;
  std::vector<std::uint32_t> triangles;  ///< triangles that may meet it
  /// Pairs of events of its border at which the surface enters and leaves.
  std::vector<std::array<std::uint32_t, 2>> chains;
  std::vector<InnerArc> inner_arcs;    ///< set only for a part of the diagram
  std::uint32_t reflex_piercings = 0;  ///< number of reflex edges that pierce it; set only for a part

  /// Returns the corner opposite to `low`.
  [[nodiscard]] Node high() const {
    Node out = low;
    out[next_axis(axis)] += length;
    out[next_axis(next_axis(axis))] += length;
    return out;
  }
};

enum class CubeState : std::uint8_t { unknown, trivial, passed, failed, split };

struct GridCube {
  Node low{};
  std::uint32_t length = 0;
  CubeState state = CubeState::unknown;
  std::array<CellId, 6> squares{};  ///< below and above across x, y, z
  CellId children = no_cell;        ///< the first of eight: x counts first, then y
  std::vector<LabelIndex> governors;
  std::vector<std::uint32_t> triangles;  ///< triangles that may meet it
  std::size_t governors_of_parent = 0;
  std::uint32_t tested_squares = 0;  ///< number of squares without children that it had at its test

  /// Returns the corner opposite to `low`.
  [[nodiscard]] Node high() const { return {low[0] + length, low[1] + length, low[2] + length}; }
};

/// An octree with its events, edges, squares and cubes. Simulation of simplicity moves the grid's planes
/// (grid_predicates.hpp). It decides whether a vertex, edge or triangle of the surface is in a square or cube.
struct CellTree {
  Lattice lattice;
  std::vector<LineEvent> events;
  std::vector<GridEdge> edges;
  std::vector<GridSquare> squares;
  std::vector<GridCube> cubes;

  /// Calls visit(edge, is_down) for each edge without children that an edge consists of, in the order of traversal.
  /// `is_down` is true if the edge is traversed downwards.
  template <class Visit>
  void visit_leaf_edges(CellId edge, bool is_down, const Visit& visit) const {
    const GridEdge& e = edges[edge];
    if (e.children == no_cell) {
      visit(edge, is_down);
      return;
    }
    visit_leaf_edges(e.children + (is_down ? 1U : 0U), is_down, visit);
    visit_leaf_edges(e.children + (is_down ? 0U : 1U), is_down, visit);
  }
  /// Calls visit(square) for each square without children that a square consists of.
  template <class Visit>
  void visit_leaf_squares(CellId square, const Visit& visit) const {
    const GridSquare& s = squares[square];
    if (s.children == no_cell) {
      visit(square);
      return;
    }
    for (CellId k = 0; k < 4; ++k) visit_leaf_squares(s.children + k, visit);
  }
};

}  // namespace blum::voronoi
