#include "medial_axis/shape/axis_piece.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "blum/core/phase_timer.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/cells/attached_voxels.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/cells/collapse.hpp"
#include "medial_axis/shape/keep_edges_inside.hpp"
#include "medial_axis/shape/place_vertices.hpp"
#include "medial_axis/shape/shape_cells.hpp"
#include "medial_axis/cells/thin_voxels.hpp"

namespace blum {
namespace {

constexpr double same_place = 1e-6;  ///< voxels

/// The cells of a complex, rising.
std::vector<AxisCell> cells_of(const CellComplex& complex, const Importance& importance) {
  std::vector<AxisCell> cells;
  complex.for_each_cell([&](Cell cell) {
    cells.push_back(
        {cell, complex.structure().dimension(cell), std::numeric_limits<float>::infinity(), importance.of(cell)});
  });
  return cells;
}

/// Half the length of the intervals that extra polygons stand for, and for their faces the largest of these: how deep
/// in the solid extra cells lie.
std::vector<float> depths_of_extra(const CellStructure& structure) {
  std::vector<float> depths(structure.extra_count(), 0);
  const Cell first = structure.first_extra();
  for (int dimension = 2; dimension > 0; --dimension) {
    for (std::size_t k = 0; k < depths.size(); ++k) {
      const ExtraCell& cell = structure.extra()->cell(first + static_cast<Cell>(k));
      if (cell.dimension != dimension) continue;
      if (dimension == 2) depths[k] = static_cast<float>(0.5 * length(cell.ends[1].point - cell.ends[0].point));
      for (const Cell face : structure.extra()->faces_of(first + static_cast<Cell>(k))) {
        if (structure.is_extra(face)) depths[face - first] = std::max(depths[face - first], depths[k]);
      }
    }
  }
  return depths;
}

/// Makes ends of edges that are as good as at the same place the same: those of a ribbon around a curve, say.
void make_equal(AxisPiece& piece, const IndexRows& corners, double tolerance) {
  detail::UnionFind joined(piece.vertices.size());
  for (std::size_t c = 0; c < piece.cells.size(); ++c) {
    if (piece.cells[c].dimension != 1) continue;
    const std::uint32_t a = corners[c][0];
    const std::uint32_t b = corners[c][1];
    if (squared_length(piece.vertices[a].position - piece.vertices[b].position) > tolerance * tolerance) continue;
    joined.join(a, b);
  }
  for (std::uint32_t v = 0; v < piece.vertices.size(); ++v) piece.vertices[v] = piece.vertices[joined.find(v)];
}

/// What is left of a piece at an angle.
class Remainder {
 public:
  Remainder(const AxisPiece& piece, double theta, AxisLists& lists)
      : piece_(piece), lists_(lists), vertex_(piece.vertices.size(), nobody), in_polygon_(piece.cells.size(), false) {
    for (std::size_t c = 0; c < piece.cells.size(); ++c) {
      if (piece.cells[c].level > theta) left_.push_back(c);
    }
  }

  void append(const Context& context) {
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 0) static_cast<void>(number(piece_.shapes[c][0]));
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 2) append_polygon(c);
    }
    throw_if_cancelled(context);
    for (const std::size_t c : left_) {
      if (piece_.cells[c].dimension == 1 && !in_polygon_[c]) append_curve(c);
    }
  }

 private:
  static constexpr std::uint32_t nobody = 0xffffffffU;

  /// Of a vertex of the piece, in the lists.
  [[nodiscard]] std::uint32_t number(std::uint32_t place) {
    if (vertex_[place] == nobody) {
      vertex_[place] = static_cast<std::uint32_t>(lists_.vertices.size());
      lists_.vertices.push_back(piece_.vertices[place]);
    }
    return vertex_[place];
  }

  void append_polygon(std::size_t c) {
    const auto shape = piece_.shapes[c];
    for (std::size_t k = 0; k < shape.size(); k += 3) {
      lists_.add_triangle({number(shape[k]), number(shape[k + 1]), number(shape[k + 2])}, piece_.cells[c].angle);
    }
    for (const std::uint32_t edge : piece_.sides[c]) in_polygon_[edge] = true;
  }

  void append_curve(std::size_t c) {
    const auto shape = piece_.shapes[c];
    for (std::size_t k = 0; k + 1 < shape.size(); ++k) {
      lists_.add_edge({number(shape[k]), number(shape[k + 1])}, piece_.cells[c].angle);
    }
  }

  const AxisPiece& piece_;
  AxisLists& lists_;
  std::vector<std::size_t> left_;
  std::vector<std::uint32_t> vertex_;
  std::vector<bool> in_polygon_;
};

}  // namespace

AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, double greatest_theta,
                          std::vector<PhaseTime>& phases, const Context& context) {
  PhaseTimer timer(phases);
  const VoxelSolid& solid = governors.solid();
  CellComplex complex(solid.voxels, solid.extra, context);
  timer.lap("cells");
  const Importance importance = separation_angles(governors, complex, floor, context);
  timer.lap("separation angles");
  AxisPiece piece;
  piece.structure = complex.structure();
  collapse_extra(complex, importance);
  {
    const AttachedVoxels attached(complex, solid.voxels, importance);
    complex = attached.rest(thin_voxels(solid, attached, complex.lattice(), importance, context), context);
  }
  timer.lap("thinning");
  const std::vector<float> depths = depths_of_extra(piece.structure);
  const CollapseOrder order = collapse(std::move(complex), {solid.depth.span(), depths}, 0.25 * governors.voxel(),
                                       importance, greatest_theta, context);
  piece.cells = cells_of(order.base, importance);
  const AxisCorners corners(piece, context);
  for (const Removal& removal : order.removals) {
    for (const Cell cell : {removal.cell, removal.face}) piece.cells[corners.index_of(cell)].level = removal.level;
  }
  timer.lap("collapse");
  const Witnesses witnesses(governors, piece.structure);
  piece.vertices = place_vertices(witnesses, corners.vertex_cells(), context);
  if (solid.is_exact) keep_edges_inside(piece, corners, governors, context);
  make_equal(piece, corners.of_cells(), same_place * governors.voxel());
  shape_cells(piece, corners, witnesses, context);
  timer.lap("vertices");
  return piece;
}

void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context) {
  throw_if_cancelled(context);
  Remainder(piece, theta, lists).append(context);
}

}  // namespace blum
