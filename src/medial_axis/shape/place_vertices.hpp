// Blum: positions of the vertices of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/shape/witnesses.hpp"
#include "medial_axis/surface/governors.hpp"
#include "medial_axis/surface/solid_paths.hpp"

namespace blum::detail {

/// Returns the vertices of a complex. A vertex of the lattice moves from its lattice corner by at most 0.7 voxels along
/// each axis. The new position is equally far from two walls, or from all walls with footprints of the eight voxels
/// around. If only one wall is near, the vertex stays at its corner. Extra vertices lie in the middle of the component
/// of the solid that they represent. Radius and first footprint are those of an exact query.
/// @param cells  the cells of dimension 0 for which vertices are computed.
[[nodiscard]] std::vector<AxisVertex> place_vertices(const Witnesses& witnesses, std::span<const Cell> cells,
                                                     const Context& context);

/// Returns a box around the component of the solid that a vertex of a model represents. The box is a cube of the grid
/// or a part of it, slightly enlarged.
[[nodiscard]] Box3 box_of_vertex(const GovernorField& governors, const CellStructure& structure, Cell vertex);

/// Returns the stop (a point of paths in the solid) at the position of a vertex.
[[nodiscard]] inline Stop stop_of(const AxisVertex& vertex) {
  return {vertex.position, {vertex.footprints[0], vertex.radius, vertex.sites[0], vertex.elements[0]}};
}

/// Returns a vertex at the corner of the lattice itself, which must lie in the solid.
[[nodiscard]] AxisVertex vertex_at_corner(const GovernorField& governors, const std::array<std::int64_t, 3>& node);

}  // namespace blum::detail
