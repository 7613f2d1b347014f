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

/// Corners and sides of the cells of a piece. Indices of cells refer to `piece.cells`.
class AxisCorners {
 public:
  /// @param piece  must contain its cells and their structure, and outlive this object.
  AxisCorners(const AxisPiece& piece, const Context& context);

  /// Returns the index of a cell in `piece.cells`.
  [[nodiscard]] std::uint32_t index_of(Cell cell) const;
  /// Returns the cells that are vertices, ascending. A "vertex place" is an index into this list of vertices.
  [[nodiscard]] std::span<const Cell> vertex_cells() const { return vertex_cells_; }
  /// Returns the corners of each cell, as vertex places: the vertex itself, both ends of an edge, or a polygon's
  /// corners in cyclic order.
  [[nodiscard]] const IndexRows& of_cells() const { return corners_; }
  /// Returns the edges of each polygon, as indices of cells: edge k joins corners k and k + 1.
  [[nodiscard]] const IndexRows& sides() const { return sides_; }

 private:
  void find_ends(std::uint32_t c, std::uint32_t* corners) const;
  void find_circle(std::uint32_t c, std::uint32_t* corners, std::uint32_t* sides) const;

  const AxisPiece& piece_;
  RankedCells ranked_;
  std::vector<std::uint32_t> index_of_extra_;
  std::vector<Cell> vertex_cells_;
  std::vector<std::uint32_t> vertex_place_;  ///< for each cell that is a vertex
  IndexRows corners_;
  IndexRows sides_;
};

/// Returns the two triangles of a quadrangle, split along its shorter diagonal so that neither is needlessly thin.
/// @param corners  the four corners in cyclic order, as indices into `vertices`.
[[nodiscard]] std::array<std::array<std::uint32_t, 3>, 2> triangles_of(std::span<const std::uint32_t> corners,
                                                                       std::span<const AxisVertex> vertices);

}  // namespace blum::detail
