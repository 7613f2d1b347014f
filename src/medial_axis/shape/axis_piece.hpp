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

/// Cell of the complex to which a solid collapses.
struct AxisCell {
  Cell cell;
  int dimension;
  float level;  ///< degrees: the cell is removed if theta >= level; infinite if it is never removed
  float angle;  ///< degrees: its importance
};

struct AxisPiece {
  CellStructure structure;
  std::vector<AxisCell> cells;  ///< Ascending by `cell`.
  /// First the vertices among `cells`, in the same order, then others. Sites are those of the surface.
  std::vector<AxisVertex> vertices;
  /// Shape of each cell, as indices into `vertices`. A vertex has one index, an edge those of a chain of segments, a
  /// polygon three for each of its triangles.
  IndexRows shapes;
  IndexRows sides;  ///< Edges of each polygon, as indices into `cells`. Empty for other cells.
  /// For a polyhedron: boxes of the model in which parts of cells leave the solid, because no shape inside was found.
  std::vector<Box3> leaving;
};

/// Collapses the cells of a solid to its medial axis.
/// @param greatest_theta  degrees. Removals above this level are not computed.
/// @throws Cancelled, OutOfMemory.
[[nodiscard]] AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor, double greatest_theta,
                                        std::vector<PhaseTime>& phases, const Context& context);

/// Adds the cells of a piece that are left at theta to `lists`. Theta must be at most `greatest_theta`. Edges of
/// triangles are not added.
/// @throws Cancelled.
void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context);

}  // namespace blum::detail
