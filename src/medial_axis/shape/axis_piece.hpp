// Blum: the medial axis of one body, for all angles at once. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/shape/separation_angles.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {

/// Cell of the complex that a solid collapses to.
struct AxisCell {
  Cell cell;
  int dimension;
  float level;  ///< degrees: it is removed if theta >= level; infinite if it is never removed
  float angle;  ///< degrees: its importance
};

struct AxisPiece {
  CellStructure structure;
  std::vector<AxisCell> cells;       ///< By ascending cell.
  std::vector<AxisVertex> vertices;  ///< Those of the cells, in order, then others. Sites are of the surface.
  /// Vertices of each cell, as places: a vertex; the corners of a chain of edges; the corners of triangles, three by
  /// three.
  IndexRows shapes;
  IndexRows sides;  ///< Edges of each polygon, as places of cells. Empty for other cells.
  /// For a polyhedron: boxes of the model in which parts of cells leave the solid, because no better shapes were found.
  std::vector<Box3> leaving;
};

/// Collapses the cells of a solid to its medial axis.
/// @param greatest_theta  degrees. For cells that are left at this angle, no further order is computed.
/// @throws Cancelled, OutOfMemory.
[[nodiscard]] AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, double greatest_theta,
                                        std::vector<PhaseTime>& phases, const Context& context);

/// Adds the cells of a piece that are left at theta, which is at most the greatest one. Only edges of curves are added.
/// @throws Cancelled.
void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context);

}  // namespace blum::detail
