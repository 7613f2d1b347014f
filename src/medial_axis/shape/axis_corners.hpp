// Blum: corners of the cells of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/grid/ranked_cells.hpp"
#include "medial_axis/shape/axis_piece.hpp"

namespace blum::detail {

/// Corners and sides of the cells of a piece. Cells are looked up by their names.
class AxisCorners {
 public:
  /// @param piece  with its cells and their structure. It must outlive this object.
  AxisCorners(const AxisPiece& piece, const Context& context);

  /// Returns the place of a cell among those of the piece.
  [[nodiscard]] std::uint32_t index_of(Cell cell) const;
  /// Vertices among the cells, ascending. A vertex place is an index into this list.
  [[nodiscard]] std::span<const Cell> vertex_cells() const { return vertex_cells_; }
  /// Corners of each cell, as vertex places: a vertex itself, the two ends of an edge, or the corners of a polygon in
  /// cyclic order.
  [[nodiscard]] const IndexRows& of_cells() const { return corners_; }
  /// Edges of polygons, as places of cells: edge k joins corners k and k + 1.
  [[nodiscard]] const IndexRows& sides() const { return sides_; }

 private:
  void find_ends(std::uint32_t c, std::uint32_t* corners) const;
  void find_circle(std::uint32_t c, std::uint32_t* corners, std::uint32_t* sides) const;

  const AxisPiece& piece_;
  RankedCells ranked_;
  std::vector<std::uint32_t> index_of_extra_;
  std::vector<Cell> vertex_cells_;
  std::vector<std::uint32_t> vertex_place_;  ///< of each cell that is a vertex
  IndexRows corners_;
  IndexRows sides_;
};

/// Returns the two triangles of a quadrangle, split along its shorter diagonal so that none is needlessly thin.
/// @param corners  four, in cyclic order.
[[nodiscard]] std::array<std::array<std::uint32_t, 3>, 2> triangles_of(std::span<const std::uint32_t> corners,
                                                                       std::span<const AxisVertex> vertices);

}  // namespace blum::detail
