// Blum: where the vertices of a medial axis lie. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/axis_vertex.hpp"
#include "medial_axis/cell_complex.hpp"
#include "medial_axis/governors.hpp"

namespace blum {

/// The vertices of a complex, by node: each moved from its lattice corner to a point within its voxel's reach that is
/// as far from one wall as from another, and as far as the voxels around say from all of them; it stays where it is
/// where only one wall is near. Radius and first footprint are those of an exact query.
[[nodiscard]] std::vector<AxisVertex> place_vertices(const GovernorField& governors, const CellLattice& lattice,
                                                     const std::vector<std::uint32_t>& nodes, const Context& context);

/// A vertex at the corner of the lattice itself, which must lie in the solid.
[[nodiscard]] AxisVertex vertex_at_corner(const GovernorField& governors, const std::array<std::int64_t, 3>& node);

}  // namespace blum
