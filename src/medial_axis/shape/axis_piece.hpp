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

/// A cell that a solid collapses to.
struct AxisCell {
  Cell cell;
  int dimension;
  float level;  ///< degrees: it goes where theta is at least this; infinite where it never goes
  float angle;  ///< degrees: its importance
};

struct AxisPiece {
  CellStructure structure;
  std::vector<AxisCell> cells;       ///< by rising cell
  std::vector<AxisVertex> vertices;  ///< of the vertices among the cells, in their order, then others; sites are the
                                     ///< surface's
  /// What each cell consists of, as places of vertices: a vertex; the corners of a chain of edges; corners of
  /// triangles, three by three.
  IndexRows shapes;
  IndexRows sides;  ///< of each polygon: its edges, as places of cells; empty for others
  /// Of a polyhedron, boxes of the model in which parts of cells leave the solid, as no better ones were found.
  std::vector<Box3> leaving;
};

/// Collapses the cells of a solid to its medial axis.
/// @param greatest_theta  degrees: of cells that are still there at that angle, nothing more is found out.
/// @throws Cancelled, OutOfMemory.
[[nodiscard]] AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, double greatest_theta,
                                        std::vector<PhaseTime>& phases, const Context& context);

/// Adds what is left of a piece at theta, which is no more than the greatest; edges are those of curves only.
/// @throws Cancelled.
void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context);

}  // namespace blum::detail
