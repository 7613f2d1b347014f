// Blum: where the vertices of a medial axis lie. SPDX-License-Identifier: Apache-2.0
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

/// The vertices of a complex: each of those of the lattice is moved from its lattice corner to a point within its
/// voxel's reach that is as far from one wall as from another, and as far as the voxels around say from all of them; it
/// stays where it is where only one wall is near. Extra ones lie in the middle of the component of the solid that they
/// stand for. Radius and first footprint are those of an exact query.
/// @param cells  vertices of the structure.
[[nodiscard]] std::vector<AxisVertex> place_vertices(const Witnesses& witnesses, std::span<const Cell> cells,
                                                     const Context& context);

/// The box of the grid that a vertex of a model stands for a component in, a little larger than it is.
[[nodiscard]] Box3 box_of_vertex(const GovernorField& governors, const CellStructure& structure, Cell vertex);

/// The place of a vertex, as paths begin and end there.
[[nodiscard]] inline Stop stop_of(const AxisVertex& vertex) {
  return {vertex.position, {vertex.footprints[0], vertex.radius, vertex.sites[0], vertex.elements[0]}};
}

/// A vertex at the corner of the lattice itself, which must lie in the solid.
[[nodiscard]] AxisVertex vertex_at_corner(const GovernorField& governors, const std::array<std::int64_t, 3>& node);

}  // namespace blum::detail
