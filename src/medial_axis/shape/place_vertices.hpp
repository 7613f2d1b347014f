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

/// Returns the vertices of a complex. A vertex of the lattice moves from its lattice corner to a point within reach of
/// its voxel. That point is equally far from two walls, or from all walls that the voxels around see. If only one wall
/// is near, the vertex stays in place. Extra vertices lie in the middle of the component of the solid that they stand
/// for. Radius and first footprint are those of an exact query.
/// @param cells  vertices of the structure.
[[nodiscard]] std::vector<AxisVertex> place_vertices(const Witnesses& witnesses, std::span<const Cell> cells,
                                                     const Context& context);

/// Returns the box of the grid in which a vertex of a model stands for a component, slightly enlarged.
[[nodiscard]] Box3 box_of_vertex(const GovernorField& governors, const CellStructure& structure, Cell vertex);

/// Returns a vertex as a stop, at which paths begin and end.
[[nodiscard]] inline Stop stop_of(const AxisVertex& vertex) {
  return {vertex.position, {vertex.footprints[0], vertex.radius, vertex.sites[0], vertex.elements[0]}};
}

/// Returns a vertex at the corner of the lattice itself, which must lie in the solid.
[[nodiscard]] AxisVertex vertex_at_corner(const GovernorField& governors, const std::array<std::int64_t, 3>& node);

}  // namespace blum::detail
