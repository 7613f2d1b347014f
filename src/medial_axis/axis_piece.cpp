#include "medial_axis/axis_piece.hpp"

#include <algorithm>
#include <limits>

#include "blum/core/phase_timer.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/keep_edges_inside.hpp"
#include "medial_axis/place_vertices.hpp"
#include "medial_axis/thin_voxels.hpp"

namespace blum {
namespace {

constexpr double same_place = 1e-6;  ///< voxels

/// The cells of a complex, rising.
std::vector<AxisCell> cells_of(const CellComplex& complex, const Importance& importance) {
  std::vector<AxisCell> cells;
  const auto bytes = complex.bytes();
  for (std::size_t node = 0; node < bytes.size(); ++node) {
    for (unsigned rest = bytes[node]; rest != 0; rest &= rest - 1) {
      const Cell cell = cell_at(node, static_cast<CellAxes>(std::countr_zero(rest)));
      cells.push_back({cell, std::numeric_limits<float>::infinity(), importance.of(cell)});
    }
  }
  return cells;
}

std::size_t index_of(const std::vector<AxisCell>& cells, Cell cell) {
  const auto at =
      std::lower_bound(cells.begin(), cells.end(), cell, [](const AxisCell& a, Cell value) { return a.cell < value; });
  return static_cast<std::size_t>(at - cells.begin());
}

/// Makes ends of edges that are as good as at the same place the same: those of a ribbon around a curve, say.
void make_equal(AxisPiece& piece, double tolerance) {
  detail::UnionFind joined(piece.nodes.size());
  for (const AxisCell& cell : piece.cells) {
    if (dimension_of(cell.cell) != 1) continue;
    const auto [a, b] = ends_of(piece, cell.cell);
    if (squared_length(piece.vertices[a].position - piece.vertices[b].position) > tolerance * tolerance) continue;
    joined.join(a, b);
  }
  for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) piece.vertices[v] = piece.vertices[joined.find(v)];
}

/// What is left of a piece at an angle.
class Remainder {
 public:
  Remainder(const AxisPiece& piece, double theta, AxisLists& lists)
      : piece_(piece), lists_(lists), vertex_(piece.nodes.size(), 0), in_square_(piece.cells.size(), false) {
    for (std::size_t c = 0; c < piece.cells.size(); ++c) {
      if (piece.cells[c].level > theta) left_.push_back(c);
    }
  }

  void append(const Context& context) {
    for (const std::size_t c : left_) {
      if (dimension_of(piece_.cells[c].cell) == 0) append_vertex(node_of(piece_.cells[c].cell));
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (dimension_of(piece_.cells[c].cell) == 2) append_square(piece_.cells[c]);
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (dimension_of(piece_.cells[c].cell) == 1 && !in_square_[c]) append_curve(piece_.cells[c]);
    }
  }

 private:
  void append_vertex(std::size_t node) {
    const std::size_t place = piece_.place_of(node);
    vertex_[place] = static_cast<std::uint32_t>(lists_.vertices.size());
    lists_.vertices.push_back(piece_.vertices[place]);
  }

  void append_square(const AxisCell& square) {
    for (std::array<std::uint32_t, 3> places : triangles_of(piece_, square.cell)) {
      for (std::uint32_t& v : places) v = vertex_[v];
      lists_.add_triangle(places, square.angle);
    }
    piece_.lattice.for_each_face(square.cell, [&](Cell edge) { in_square_[index_of(piece_.cells, edge)] = true; });
  }

  void append_curve(const AxisCell& edge) {
    std::array<std::uint32_t, 2> ends = ends_of(piece_, edge.cell);
    for (std::uint32_t& v : ends) v = vertex_[v];
    lists_.add_edge(ends, edge.angle);
  }

  const AxisPiece& piece_;
  AxisLists& lists_;
  std::vector<std::size_t> left_;
  std::vector<std::uint32_t> vertex_;
  std::vector<bool> in_square_;
};

}  // namespace

std::size_t AxisPiece::place_of(std::size_t node) const {
  return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), static_cast<std::uint32_t>(node)) -
                                  nodes.begin());
}

std::array<std::uint32_t, 2> ends_of(const AxisPiece& piece, Cell edge) {
  const std::size_t node = node_of(edge);
  const std::size_t step = piece.lattice.stride(static_cast<std::size_t>(std::countr_zero(axes_of(edge))));
  return {static_cast<std::uint32_t>(piece.place_of(node)), static_cast<std::uint32_t>(piece.place_of(node + step))};
}

std::array<std::array<std::uint32_t, 3>, 2> triangles_of(const AxisPiece& piece, Cell square) {
  const CellAxes axes = axes_of(square);
  const std::size_t node = node_of(square);
  const std::size_t u = piece.lattice.stride(static_cast<std::size_t>(std::countr_zero(axes)));
  const std::size_t v = piece.lattice.stride(static_cast<std::size_t>(std::countr_zero(axes & (axes - 1))));
  const std::array<std::size_t, 4> corners{piece.place_of(node), piece.place_of(node + u), piece.place_of(node + u + v),
                                           piece.place_of(node + v)};
  const auto squared = [&](std::size_t a, std::size_t b) {
    return squared_length(piece.vertices[corners[a]].position - piece.vertices[corners[b]].position);
  };
  // The shorter diagonal, so that no triangle is needlessly thin.
  const std::size_t first = squared(0, 2) <= squared(1, 3) ? 0 : 1;
  const auto corner = [&](std::size_t k) { return static_cast<std::uint32_t>(corners[(first + k) % 4]); };
  return {{{corner(0), corner(1), corner(2)}, {corner(0), corner(2), corner(3)}}};
}

AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, std::vector<PhaseTime>& phases,
                          const Context& context) {
  PhaseTimer timer(phases);
  const VoxelSolid& solid = governors.solid();
  CellComplex complex(solid.voxels, context);
  timer.lap("cells");
  const Importance importance = separation_angles(governors, complex, floor, context);
  timer.lap("separation angles");
  AxisPiece piece;
  piece.lattice = complex.lattice();
  complex = CellComplex(thin_voxels(solid, piece.lattice, importance, context), context);
  timer.lap("thinning");
  const CollapseOrder order =
      collapse(std::move(complex), solid.depth.span(), 0.25 * governors.voxel(), importance, context);
  piece.cells = cells_of(order.base, importance);
  for (const Removal& removal : order.removals) {
    for (const Cell cell : {removal.cell, removal.face}) {
      piece.cells[index_of(piece.cells, cell)].level = removal.level;
    }
  }
  timer.lap("collapse");
  for (const AxisCell& cell : piece.cells) {
    if (dimension_of(cell.cell) == 0) piece.nodes.push_back(static_cast<std::uint32_t>(node_of(cell.cell)));
  }
  piece.vertices = place_vertices(governors, piece.lattice, piece.nodes, context);
  if (solid.is_exact) keep_edges_inside(piece, governors, context);
  make_equal(piece, same_place * governors.voxel());
  timer.lap("vertices");
  return piece;
}

void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context) {
  throw_if_cancelled(context);
  Remainder(piece, theta, lists).append(context);
}

}  // namespace blum
