// Blum: the components of a solid in the cells of a uniform grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/union_find.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "blum/grid/ranked_cells.hpp"
#include "solid/model/grid_planes.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// A point where a triangle crosses an edge of the grid.
struct GridCrossing {
  Cell edge = 0;
  std::uint32_t triangle = 0;
  bool leaves = false;  ///< true if the grid's edge, followed upwards, leaves the solid at the crossing
};

/// An end of an arc.
struct ArcEnd {
  std::uint32_t id = 0;    ///< the grid's edge (Cell) if on_border, otherwise the edge of the mesh
  bool on_border = false;  ///< true if the end lies on an edge of the grid
};

/// The segment in which a triangle meets a square of the grid.
struct Arc {
  Cell square = 0;
  std::uint32_t triangle = 0;
  std::array<ArcEnd, 2> ends;
  /// The pieces of the surface that the arc bounds, in the cubes below and above the square.
  std::array<std::uint32_t, 2> pieces{0, 0};
};

/// Exact intersections of a surface with the cells of a grid.
///
/// A piece is a connected part of the surface in one open cube. Each vertex has a number. A part of an edge has a
/// number in each cube that contains no end of the edge. A part of a triangle has a number in each cube that contains
/// no part of the triangle's sides. A piece has the smallest number of its elements.
struct TracedSurface {
  std::vector<Place> cube_of_vertex;
  std::vector<GridCrossing> crossings;
  std::vector<Arc> arcs;  ///< in ascending order of triangles
  UnionFind pieces;
  std::vector<std::int32_t> euler;  ///< Euler numbers, indexed by the number of the piece

  /// Returns vertices minus edges plus triangles of a piece.
  /// @param piece  the smallest number of its elements.
  [[nodiscard]] std::int32_t euler_of(std::uint32_t piece) const { return euler[piece]; }
};

/// Computes the intersections of a surface with the cells of a grid. Cost: linear, about 0.2 us per triangle or arc on
/// one core.
/// @param lattice  the lattice of the cubes between the planes. All vertices must lie between the outermost planes.
/// @throws Cancelled.
[[nodiscard]] TracedSurface trace_surface(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
                                          const Context& context);

/// Returns the index of the interval of an edge that begins or ends at crossing `index`. Both are counted upwards along
/// the edge.
constexpr std::uint32_t interval_at(std::uint32_t index, bool begins_inside) {
  return (index + (begins_inside ? 1U : 0U)) / 2;
}
/// Returns the number of intervals of an edge with this many crossings.
constexpr std::uint32_t intervals_of(std::uint32_t crossings, bool begins_inside) {
  return (crossings + (begins_inside ? 2U : 1U)) / 2;
}

/// The components of a solid in the cells of a uniform grid, and their incidences. A cell that the surface does not cut
/// has one component if its corners are inside the solid, otherwise none.
///
/// Components of edges are called intervals; they are numbered upwards along the edge. Components of a square are
/// numbered by their first interval on its sides, in the order of sides_of(). Components of a cube are numbered by
/// their first component in its faces, in the order of faces_of().
class CutGrid {
 public:
  /// Finds the components.
  /// @throws Cancelled; InvalidMesh if the surface cannot bound a solid.
  CutGrid(const SurfaceMesh& mesh, GridPlanes planes, const Context& context);

  [[nodiscard]] const CellLattice& lattice() const { return lattice_; }
  [[nodiscard]] const GridPlanes& planes() const { return planes_; }
  [[nodiscard]] bool is_inside(std::size_t node) const { return inside_[node] != 0; }
  /// Returns true if the surface meets the interior of a cell.
  [[nodiscard]] bool is_cut(Cell cell) const { return cut_.contains(cell); }
  /// Returns the number of components of the solid in a cell.
  [[nodiscard]] std::uint32_t components(Cell cell) const {
    return cut_.contains(cell) ? cells_[cut_.number(cell)].components : inside_[node_of(cell)];
  }
  /// Returns the edges around a square: two along its lower axis, then two along its upper axis.
  [[nodiscard]] std::array<Cell, 4> sides_of(Cell square) const;
  /// Returns the component of a square to which an interval of one of its sides belongs.
  [[nodiscard]] std::uint32_t component_of_interval(Cell square, Cell side, std::uint32_t interval) const;
  /// Returns the component of a cube to which a component of one of its faces belongs.
  /// @param face  index in faces_of(), 0 to 5.
  [[nodiscard]] std::uint32_t component_of_part(Cell cube, std::size_t face, std::uint32_t part) const;
  /// Returns the six squares around a cube: below and above it along x, then y, then z.
  [[nodiscard]] std::array<Cell, 6> faces_of(Cell cube) const;

  /// Returns the triangles that cross an edge, in the order of their crossings upwards along the edge.
  [[nodiscard]] std::span<const std::uint32_t> crossings(Cell edge) const;

  /// For a component of a square without intervals, returns the edges of the mesh on its border, each twice. Empty if
  /// the component has intervals.
  [[nodiscard]] std::vector<ArcEnd> loose_ends(Cell square, std::uint32_t component) const;
  /// Returns for each shell that lies wholly in a cube the pair of the cube and a vertex of the shell. These shells are
  /// the last components of the cube.
  [[nodiscard]] std::span<const std::pair<Cell, std::uint32_t>> shells_in(Cell cube) const;

  /// Returns the cells that the surface cuts, in ascending order.
  [[nodiscard]] std::span<const Cell> cut_cells() const { return cut_cells_; }
  /// Returns the cubes that fail, in ascending order. A component in the cube is not a ball, or a component in one of
  /// its squares is not a disc.
  [[nodiscard]] std::span<const Cell> failing_cubes() const { return failing_; }

 private:
  struct CutCell {
    std::uint32_t first = 0;       ///< edges: first crossing; squares: first arc
    std::uint32_t count = 0;       ///< number of crossings or arcs
    std::uint32_t table = 0;       ///< squares: first entry of intervals; cubes: first entry of parts
    std::uint32_t components = 0;  ///< number of components of the solid
  };
  struct Scratch;

  void number_cells(TracedSurface& surface);
  void sort_crossings(const SurfaceMesh& mesh, const TracedSurface& surface);
  void sort_arcs(TracedSurface& surface);
  void find_inside(const Context& context);
  void connect_squares(const SurfaceMesh& mesh, const Context& context);
  void connect_cubes(TracedSurface& surface, const Context& context);
  [[nodiscard]] bool connect_square(const SurfaceMesh& mesh, Cell square, Scratch& scratch);
  [[nodiscard]] bool connect_cube(const TracedSurface& surface, Cell cube, Scratch& scratch);
  void take_closed_shells(const SurfaceMesh& mesh, TracedSurface& surface);
  [[nodiscard]] const CutCell& cut(Cell cell) const { return cells_[cut_.number(cell)]; }
  [[nodiscard]] CutCell& cut(Cell cell) { return cells_[cut_.number(cell)]; }

  GridPlanes planes_;
  CellLattice lattice_;
  RankedCells cut_;
  std::vector<Cell> cut_cells_;
  std::vector<CutCell> cells_;            ///< indexed by the cell's number in cut_
  std::vector<std::uint32_t> crossings_;  ///< triangles, sorted by edge, then upwards along it
  std::vector<Arc> arcs_;                 ///< sorted by square, then triangle
  std::vector<std::uint32_t> arc_component_;
  std::vector<std::uint32_t> interval_component_;
  std::vector<std::uint32_t> part_component_;
  Buffer<std::uint8_t> inside_;  ///< 1 or 0 for each node
  /// Pairs of a cube that contains a whole shell, in ascending order, and a vertex of the shell.
  std::vector<std::pair<Cell, std::uint32_t>> whole_shells_;
  std::vector<Cell> failing_;
};

}  // namespace blum::detail
