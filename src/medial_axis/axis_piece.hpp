// Blum: the medial axis of one body, for all angles at once. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "medial_axis/axis_lists.hpp"
#include "medial_axis/axis_vertex.hpp"
#include "medial_axis/cell_complex.hpp"
#include "medial_axis/collapse.hpp"
#include "medial_axis/governors.hpp"
#include "medial_axis/separation_angles.hpp"

namespace blum {

/// A cell that a solid collapses to.
struct AxisCell {
  Cell cell;
  float level;  ///< degrees: it goes where theta is at least this; infinite where it never goes
  float angle;  ///< degrees: its importance
};

struct AxisPiece {
  CellLattice lattice;
  std::vector<AxisCell> cells;       ///< by rising cell
  std::vector<std::uint32_t> nodes;  ///< of the vertices among them, rising
  std::vector<AxisVertex> vertices;  ///< one per node; sites are the surface's

  /// Where a node is among `nodes`.
  [[nodiscard]] std::size_t place_of(std::size_t node) const;
};

/// Collapses the voxels of a solid to its medial axis.
/// @throws Cancelled, OutOfMemory.
[[nodiscard]] AxisPiece make_axis_piece(const GovernorField& governors, const NoiseFloor& floor,
                                        std::vector<PhaseTime>& phases, const Context& context);

/// The ends of an edge, and the two triangles of a square, as places of vertices.
[[nodiscard]] std::array<std::uint32_t, 2> ends_of(const AxisPiece& piece, Cell edge);
[[nodiscard]] std::array<std::array<std::uint32_t, 3>, 2> triangles_of(const AxisPiece& piece, Cell square);

/// Adds what is left of a piece at theta; edges are those of curves only.
/// @throws Cancelled.
void append_at(const AxisPiece& piece, double theta, AxisLists& lists, const Context& context);

}  // namespace blum
