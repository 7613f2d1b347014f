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

/// Indices of a node of the finest grid: 0 to Lattice::most along each axis.
using Node = std::array<std::uint32_t, 3>;

using detail::next_axis;

/// Positions of the nodes of the finest grid.
struct Lattice {
  static constexpr int depth = 26;
  static constexpr std::uint32_t most = 1U << depth;

  Vec3d origin;
  double unit = 1;  ///< distance between neighbouring nodes, mesh units

  [[nodiscard]] double at(std::size_t axis, std::uint32_t k) const { return origin[axis] + unit * k; }
  [[nodiscard]] Vec3d at(const Node& node) const { return {at(0, node[0]), at(1, node[1]), at(2, node[2])}; }
};

/// Index of an edge, square or cube in its list. The children of a cell have consecutive indices.
using CellId = std::uint32_t;
constexpr CellId no_cell = UINT32_MAX;

/// An edge of the grid, with the labels that are closest at its ends and its events. An event is a point where the
/// closest site changes.
struct GridEdge {
  Node low{};
  std::uint32_t length = 0;
  std::uint8_t axis = 0;
  LabelIndex first = outside;                     ///< closest label at the lower end
  LabelIndex last = outside;                      ///< closest label at the upper end
  std::uint32_t first_event = 0, last_event = 0;  ///< range of its events in CellTree::events
  CellId children = no_cell;                      ///< the first of two children

  /// Returns the node at the upper end.
  [[nodiscard]] Node high() const {
    Node out = low;
    out[axis] += length;
    return out;
  }
};

/// A square is `resolved` if its border is known to determine its contents.
enum class SquareState : std::uint8_t { unknown, resolved };

/// An arc in a square where the square meets a wall or the surface, which the requested part of the diagram drops
/// (PartRule). The arc need not reach the border of the square.
struct InnerArc {
  std::uint32_t first = 0;   ///< site on one side
  std::uint32_t second = 0;  ///< site on the other side; `outside` for the surface
  std::uint32_t event = 0;   ///< for the surface: an event of the border at the same part of the outside
};

/// A square at a right angle to `axis`. Below, u is the axis after it, and v the axis after u.
struct GridSquare {
  Node low{};
  std::uint32_t length = 0;
  std::uint8_t axis = 0;
  SquareState state = SquareState::unknown;
  /// The four edges around the square. Edges 0 and 2 run along u, at the lower and the upper v. Edges 1 and 3 run along
  /// v, at the upper and the lower u.
  std::array<CellId, 4> edges{};
  CellId children = no_cell;     ///< the first of four children; u varies fastest
  CellId inner_edges = no_cell;  ///< the first of four: along u below and above the middle, then along v
  std::vector<LabelIndex> governors;
  std::vector<std::uint32_t> triangles;  ///< triangles that may meet the square
  /// For each arc of the surface in the square: the two events of the border where it ends.
  std::vector<std::array<std::uint32_t, 2>> chains;
  std::vector<InnerArc> inner_arcs;    ///< set only for a part of the diagram
  std::uint32_t reflex_piercings = 0;  ///< number of reflex edges that pierce the square; set only for a part

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
  std::array<CellId, 6> squares{};  ///< below and above the cube along x, then y, then z
  CellId children = no_cell;        ///< the first of eight children; x varies fastest, then y
  std::vector<LabelIndex> governors;
  std::vector<std::uint32_t> triangles;  ///< triangles that may meet the cube
  std::size_t governors_of_parent = 0;
  std::uint32_t tested_squares = 0;  ///< number of leaf squares on its boundary when it was tested

  /// Returns the corner opposite to `low`.
  [[nodiscard]] Node high() const { return {low[0] + length, low[1] + length, low[2] + length}; }
};

/// An octree with its events, edges, squares and cubes. The grid's planes are treated as moved by infinitely small
/// amounts (simulation of simplicity, grid_predicates.hpp). So no vertex, edge or triangle of the surface lies in a
/// degenerate position relative to squares and cubes.
struct CellTree {
  Lattice lattice;
  std::vector<LineEvent> events;
  std::vector<GridEdge> edges;
  std::vector<GridSquare> squares;
  std::vector<GridCube> cubes;

  /// Calls visit(leaf, is_down) for each edge without children of which `edge` consists, in the order of traversal.
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
  /// Calls visit(leaf) for each leaf below `square`: the squares inside it that have no children, or `square` itself.
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
