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

/// Where a triangle crosses an edge of the grid.
struct GridCrossing {
  Cell edge = 0;
  std::uint32_t triangle = 0;
  bool leaves = false;  ///< whether the grid's edge leaves the solid there, followed upwards
};

/// An end of an arc.
struct ArcEnd {
  std::uint32_t id = 0;    ///< the grid's edge (Cell) where it crosses one, else the edge of the mesh
  bool on_border = false;  ///< whether it lies on an edge of the grid
};

/// The segment that a triangle and a square of the grid have in common.
struct Arc {
  Cell square = 0;
  std::uint32_t triangle = 0;
  std::array<ArcEnd, 2> ends;
  /// Which piece of the surface it bounds in the cube below the square, and in that above.
  std::array<std::uint32_t, 2> pieces{0, 0};
};

/// What a surface meets of the cells of a grid, exactly.
///
/// A piece is a part of the surface in one open cube, connected there. Pieces are numbered by what they are joined
/// from: each vertex, and each part of an edge or of a triangle in a cube that holds no end of it.
struct TracedSurface {
  std::vector<Place> cube_of_vertex;
  std::vector<GridCrossing> crossings;
  std::vector<Arc> arcs;  ///< by rising triangle
  UnionFind pieces;
  std::vector<std::int32_t> euler;  ///< of pieces, by the smallest number that they are joined from

  /// Vertices less edges plus triangles of a piece. @param piece  the smallest number that it is joined from.
  [[nodiscard]] std::int32_t euler_of(std::uint32_t piece) const { return euler[piece]; }
};

/// @param lattice  of the cubes between the planes. All vertices must lie between the outermost planes.
/// @throws Cancelled. Cost: linear in triangles and arcs; about 0.2 us for each on one core.
[[nodiscard]] TracedSurface trace_surface(const SurfaceMesh& mesh, const GridPlanes& planes, const CellLattice& lattice,
                                          const Context& context);

/// Whether an interval begins or ends at a crossing: crossing `index` of an edge, counted upwards, belongs to this one.
constexpr std::uint32_t interval_at(std::uint32_t index, bool begins_inside) {
  return (index + (begins_inside ? 1U : 0U)) / 2;
}
/// The number of intervals of an edge with so many crossings.
constexpr std::uint32_t intervals_of(std::uint32_t crossings, bool begins_inside) {
  return (crossings + (begins_inside ? 2U : 1U)) / 2;
}

/// The components of a solid in the cells of a uniform grid, and which lie in which. In cells that the surface does not
/// cut there is one where their corners are inside.
///
/// Components of edges, called intervals, are numbered upwards. Those of a square are numbered by the intervals on its
/// sides, in the order of sides_of(), and those of a cube by the components in its sides, in the order of its faces:
/// below, then above, along x, y, z.
class CutGrid {
 public:
  /// @throws Cancelled; InvalidMesh where the surface cannot bound a solid.
  CutGrid(const SurfaceMesh& mesh, GridPlanes planes, const Context& context);

  [[nodiscard]] const CellLattice& lattice() const { return lattice_; }
  [[nodiscard]] const GridPlanes& planes() const { return planes_; }
  [[nodiscard]] bool is_inside(std::size_t node) const { return inside_[node] != 0; }
  /// Whether the surface meets the inside of a cell.
  [[nodiscard]] bool is_cut(Cell cell) const { return cut_.contains(cell); }
  /// The number of components of the solid in a cell.
  [[nodiscard]] std::uint32_t components(Cell cell) const {
    return cut_.contains(cell) ? cells_[cut_.number(cell)].components : inside_[node_of(cell)];
  }
  /// The edges around a square: first those along its lower axis, then those along its upper.
  [[nodiscard]] std::array<Cell, 4> sides_of(Cell square) const;
  /// The component of a square that an interval of one of its sides belongs to.
  [[nodiscard]] std::uint32_t component_of_interval(Cell square, Cell side, std::uint32_t interval) const;
  /// The component of a cube that a component of one of its faces belongs to. @param face  0 to 5.
  [[nodiscard]] std::uint32_t component_of_part(Cell cube, std::size_t face, std::uint32_t part) const;
  /// The six squares around a cube.
  [[nodiscard]] std::array<Cell, 6> faces_of(Cell cube) const;

  /// The triangles that cross an edge, from below.
  [[nodiscard]] std::span<const std::uint32_t> crossings(Cell edge) const;

  /// The edges of the mesh around a component of a square that no interval belongs to, each twice; else none.
  [[nodiscard]] std::vector<ArcEnd> loose_ends(Cell square, std::uint32_t component) const;
  /// For each shell that lies wholly in a cube the cube and a vertex of it: these are the cube's last components.
  [[nodiscard]] std::span<const std::pair<Cell, std::uint32_t>> shells_in(Cell cube) const;

  /// Cells that the surface cuts, rising.
  [[nodiscard]] std::span<const Cell> cut_cells() const { return cut_cells_; }
  /// Cubes some component of which is no ball, or that have such a square: rising.
  [[nodiscard]] std::span<const Cell> failing_cubes() const { return failing_; }

 private:
  struct CutCell {
    std::uint32_t first = 0;       ///< edges: crossing; squares: arc
    std::uint32_t count = 0;       ///< of them
    std::uint32_t table = 0;       ///< squares: where the components of intervals begin; cubes: those of parts
    std::uint32_t components = 0;  ///< of the solid
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
  std::vector<CutCell> cells_;            ///< by number in cut_
  std::vector<std::uint32_t> crossings_;  ///< triangles, by edge and upwards
  std::vector<Arc> arcs_;                 ///< by square and triangle
  std::vector<std::uint32_t> arc_component_;
  std::vector<std::uint32_t> interval_component_;
  std::vector<std::uint32_t> part_component_;
  Buffer<std::uint8_t> inside_;  ///< 1 or 0 for each node
  /// Cubes that hold a shell wholly, rising, and a vertex of it.
  std::vector<std::pair<Cell, std::uint32_t>> whole_shells_;
  std::vector<Cell> failing_;
};

}  // namespace blum::detail
